"""
Where do two models disagree about overturning?
===============================================

A column that may spin can survive a motion that overturns a column that cannot spin.
This map marks where the choice of the model decides the outcome.
"""

import numpy as np

import stylobate as sb

column = sb.Column.dimensionless(slenderness=0.1)
found = sb.studies.outcome_differences(
    sb.Wobbling(column, damping=0.1),  # no spin
    sb.Rolling(column, damping=0.1, spin_damping=0.1),  # free spin
    sb.Harmonic.circular(acceleration=0.1, angular_frequency=1.0),
    over={  # a small map; Ω/ω₀ and g
        "angular_frequency": np.linspace(0.5, 6.0, 40),
        "acceleration": np.linspace(0.05, 0.6, 32),
    },
    periods=40.0,
)
for name, count in zip(
    found["comparison_name"].values, found["count"].values, strict=True
):
    print(f"{name}: {count} runs")
sb.plot(found)

# %%
# All runs start at rest. :doc:`/explanation/model-hierarchy` discusses a finer map, and
# :func:`stylobate.studies.outcome_differences` compares any two models.
