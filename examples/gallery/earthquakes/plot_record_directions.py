"""
Does the direction of an earthquake record matter?
==================================================

A planar model sees one direction of the ground motion, so its answer depends on the
direction that you choose. A round column in three dimensions has no such choice.
"""

import numpy as np

import stylobate as sb

column = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)  # m, m, kg/m³
found = sb.earthquakes.planar_bias(
    sb.Wobbling(column, damping=0.03),
    sb.sample_record("el centro 1940"),
    scales=np.geomspace(0.6, 4.0, 20),
    directions=np.radians(np.arange(0.0, 180.0, 15.0)),
)
planar = found["least_planar_overturning"].values
print(f"planar: overturned from {np.nanmin(planar):.2f} to {np.nanmax(planar):.2f}")
print(f"three-dimensional: from {found['least_overturning'].values[0]:.2f}")
sb.earthquakes.plot_directions(found)

# %%
# The radius is the lowest scale of the record that overturns the planar column when it
# rocks in that direction. The circle is the three-dimensional column. See
# :doc:`/how-to/scaled-records`.
