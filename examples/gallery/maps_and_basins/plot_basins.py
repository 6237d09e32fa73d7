"""
Which initial tilt leads to which motion? Basins of attraction
==============================================================

Under one and the same base motion a column can end in different motions. This example
starts it from many initial tilts and colours each by the motion that it comes to.
"""

import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.09, angular_frequency=4.0)  # g, ω₀

axis = np.linspace(-0.105, 0.105, 41)  # rad: a small grid
found = sb.studies.basins(
    model, line, over={"tilt_x": axis, "tilt_y": axis}, periods=200.0
)
print(*found["attractor_name"].values, sep="\n")
sb.plot(found)

# %%
# Each cell is an initial tilt with the column at rest in it. The disc has the radius c:
# outside of it the column overturns. Inside, the two senses of rolling are so finely
# mixed that the final one is practically unpredictable. See :doc:`/how-to/maps`.
