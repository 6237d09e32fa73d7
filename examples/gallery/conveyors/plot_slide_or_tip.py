"""
Does a column slide or tip on a shaking base?
=============================================

A column slides if friction is smaller than its slenderness, and tips if friction is
larger. This map shows its final motion over friction and acceleration.
"""

import numpy as np

import stylobate as sb

column = sb.Column.dimensionless(slenderness=0.1)
line = sb.Harmonic.straight(acceleration=0.2, angular_frequency=2.0)  # g, ω₀
found = sb.studies.overturning_map(
    sb.Sliding(column, friction_coefficient=0.1, damping=0.05),
    line,
    over={  # a small map
        "friction_coefficient": np.geomspace(0.02, 0.6, 24),
        "acceleration": np.geomspace(0.02, 0.8, 24),  # g
    },
    periods=10.0,
)
sb.plot(found)

# %%
# The column stays where the acceleration is below both limits: μ g, at which it slides,
# and c g, at which it tips. See :doc:`/explanation/sliding` and
# :func:`stylobate.theory.start_of_motion`.
