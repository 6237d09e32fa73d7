"""
How does a tilted column rock to rest?
======================================

Release a stone column from a tilt and let it rock freely in a vertical plane. Its
period is not constant: small swings are fast swings. Each impact takes a fixed fraction
of the tilt rate, so the column comes to rest in a finite time.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

stone = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)  # m, m, kg/m³
model = sb.PlanarRocking(stone)  # loses energy at each impact by Housner's restitution
tipping_angle = stone.tipping_angle  # rad
run = sb.simulate(model, tilt=(0.8 * tipping_angle, 0.0), duration=30.0)  # s
print(run)

# Times at which the base lands flat: between two of them lies half a period.
impacts = np.array([event.time for event in run.events if event.kind == "impact"])
half_periods = np.diff(impacts)
middles = 0.5 * (impacts[1:] + impacts[:-1])

figure, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
above.plot(run.data["time"], run.data["tilt"].sel(axis="x") / tipping_angle)
above.set_ylabel("tilt / tipping angle")
below.plot(middles, 2.0 * half_periods, "o")
below.set(xlabel="time [s]", ylabel="period of the swing [s]", xlim=(0.0, 12.0))

# %%
# Above: the tilt in units of the tipping angle. Below: the period of each swing, which
# shrinks with the tilt. See :doc:`/explanation/models` for the model and
# :func:`stylobate.theory.planar_free_period` for the period in closed form.
