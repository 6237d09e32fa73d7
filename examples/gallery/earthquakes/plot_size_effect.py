"""
Is the larger of two columns of one shape safer?
================================================

Two columns of one shape and density differ in size only. Housner found in 1963 that the
larger one resists earthquakes better. This example tests it for one record.
"""

import numpy as np

import stylobate as sb

stone = sb.Column.solid(radius=0.2, height=2.0, density=2700.0)  # m, m, kg/m³
found = sb.earthquakes.overturning_intervals(
    sb.Wobbling(stone, damping=0.05),
    sb.sample_record("el centro 1940"),
    scales=np.geomspace(0.25, 4.0, 21),
    over={"size": np.geomspace(0.5, 6.0, 16)},  # 1 m to 12 m high
    width=0.02,  # relative error of the edges
)
lowest = found["interval_from"].min("interval")
small, large = float(lowest[0]), float(lowest[-1])
print(f"1 m column: overturned from {small:.2f} times the record on")
print(f"12 m column: overturned from {large:.2f} times the record on")
sb.plot(found)

# %%
# On the whole a larger column needs a stronger record. In detail the limit goes up and
# down, so two columns of nearly one size can have different outcomes. See
# :doc:`/how-to/rocking-spectra`.
