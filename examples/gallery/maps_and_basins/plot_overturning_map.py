"""
Which shaking overturns a column? An overturning map
====================================================

Compute the outcome of a column over two parameters of the base motion, frequency and
amplitude. The boundary of overturning is ragged, so a single run says little about its
neighbours.
"""

import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.1, angular_frequency=1.0)

found = sb.studies.overturning_map(
    model,
    line,
    over={  # a small map: 60 × 45 runs from rest
        "angular_frequency": np.linspace(0.5, 8.0, 60),  # Ω/ω₀
        "acceleration": np.linspace(0.06, 0.6, 45),  # g
    },
    periods=60.0,
)
for name, share in zip(
    found["outcome_name"].values, found["share"].values, strict=True
):
    if share > 0.0:
        print(f"{name}: {100.0 * share:.1f} %")
sb.plot(found)

# %%
# Up to c g, here 0.1 g, nothing moves. Above it slow motions overturn the column. Under
# fast ones it rocks; "still moving" means that the rocking has not settled within 60
# periods. Islands of survival lie within overturning. See :doc:`/how-to/maps` and
# :func:`stylobate.studies.overturning_map`.
