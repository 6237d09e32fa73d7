"""
How far do columns of every size rock? A rocking spectrum
=========================================================

A rocking spectrum shows the peak tilt under one record for columns of many sizes, as a
response spectrum does for oscillators.
"""

import numpy as np

import stylobate as sb

stone = sb.Column.solid(radius=0.5, height=5.0, density=2000.0)  # m, m, kg/m³
quake = sb.sample_record("el centro 1940")

peaks = sb.earthquakes.rocking_spectrum(
    sb.Wobbling(stone, damping=0.05),
    quake,
    over={"size": np.geomspace(0.1, 10.0, 40), "slenderness": [0.1, 0.15, 0.2]},
)
sb.plot(peaks)

# %%
# Triangles mark columns that overturn. The horizontal axis is the size, as the time
# unit 2π/p of the rocking literature. Large columns survive, and the peak tilt, in
# units of the tipping angle, falls with size and with slenderness c. See
# :doc:`/how-to/rocking-spectra`.
