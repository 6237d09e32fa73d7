"""
How large a push overturns a standing column? Integrity and erosion
===================================================================

A weak base motion never moves a column that stands at rest. Yet the base motion shrinks
the push that overturns it. The integrity is the distance to the nearest initial
condition that overturns.
"""

import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
circle = sb.Harmonic.circular(acceleration=0.1, angular_frequency=2.0)  # g, ω₀

axis = np.linspace(-0.105, 0.105, 21)  # rad: a coarse grid of initial tilts
erosion = sb.studies.erosion(
    model,
    circle,
    along={"acceleration": np.linspace(0.0, 0.05, 11)},  # g
    over={"tilt_x": axis, "tilt_y": axis},
    periods=30.0,
)
sb.plot(erosion)

# %%
# Without base motion only tilts near c overturn the column. At half of c g, a small
# part of c is enough. A finer grid narrows the range in which the boundary lies. See
# :doc:`/how-to/maps` and :func:`stylobate.studies.erosion`.
