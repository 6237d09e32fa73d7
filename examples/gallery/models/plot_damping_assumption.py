"""
How much does the assumed damping matter?
=========================================

Nobody knows the damping of a rocking column well. This example asks at which strength
an earthquake record overturns a column, for dampings over a factor of 40.
"""

import numpy as np

import stylobate as sb

column = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)  # m, m, kg/m³
quake = sb.sample_record("el centro 1940")

# Each damping at 24 scales of the record: a small study.
found = sb.earthquakes.overturning_intervals(
    sb.Wobbling(column),
    quake,
    scales=np.geomspace(0.5, 4.0, 24),
    over={"damping": np.geomspace(0.005, 0.2, 12)},
    width=0.02,  # relative error of the edges
)
lowest = found["interval_from"].min("interval")
for damping in found["damping"].values[[0, -1]]:
    scale = float(lowest.sel(damping=damping))
    print(f"damping {damping:.3f}: the record overturns it from {scale:.2f} times on")
sb.plot(found)

# %%
# The lowest scale that overturns the column more than doubles from the smallest to the
# largest damping. Dark intervals of the scale overturn the column. If an outcome
# changes within the plausible range of damping, report it as undecided. See
# :doc:`/how-to/rocking-spectra`.
