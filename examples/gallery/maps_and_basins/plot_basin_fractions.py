"""
How often does each motion occur? Basin fractions with intervals
================================================================

Start many columns from random initial conditions and count their final motions. A
fraction from a sample needs an interval: the figure shows both along the amplitude.
"""

import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.1, angular_frequency=6.0)  # g, ω₀
names = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")

fractions = sb.studies.basin_fractions(
    model,
    line,
    along={"acceleration": np.linspace(0.03, 0.3, 8)},  # g
    over=dict.fromkeys(names, (-0.06, 0.06)),  # rad and rad × ω₀
    count=100,  # random initial conditions at each amplitude: a small sample
    periods=300.0,
    attractor_rules=sb.studies.AttractorRules(branch_tolerance=2.0),
)
sb.plot(fractions)

# %%
# The height of a band is the fraction of columns that end in its motion. Each bar is
# the 95 % interval that 100 random initial conditions leave open. See
# :doc:`/how-to/maps` and :func:`stylobate.studies.basin_fractions`.
