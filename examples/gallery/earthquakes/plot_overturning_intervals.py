"""
Can a stronger earthquake spare a column that a weaker one overturns?
=====================================================================

Scale one record up step by step. Overturning is not monotonic in the scale: a column
can survive above a scale that overturns it.
"""

import numpy as np

import stylobate as sb

column = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)  # m, m, kg/m³
quake = sb.sample_record("el centro 1940")

found = sb.earthquakes.overturning_intervals(
    sb.Wobbling(column, damping=0.03), quake, scales=np.geomspace(0.5, 2.0, 41)
)
pairs = zip(found["interval_from"].values, found["interval_to"].values, strict=True)
for low, high in pairs:
    print(f"overturns from {low:.4f} to {high:.4f} times the record")
sb.plot(found)

# %%
# Dark intervals overturn the column; in the hatched ones it survives although a weaker
# record overturns it. So look at all intervals, and never at a bisection alone. See
# :doc:`/how-to/rocking-spectra`.
