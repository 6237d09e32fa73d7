"""
How do I detect an event of my own?
===================================

Pass functions that change sign at an event. The run records the exact time of each
event, and an event can end the run.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

stone = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)  # m, m, kg/m³
model = sb.Wobbling(stone, damping=0.03)
quake = sb.sample_record("el centro 1940")


def three_degrees(time, state):
    return state["amplitude"] - np.radians(3.0)


upward = sb.EventFunction("above 3°", three_degrees, direction=1, terminal=5)
run = sb.simulate(model, quake, events=[upward])
times = np.array([event.time for event in run.events if event.kind == "above 3°"])
print(run.reason)
print("times:", times.round(3), "s")

figure, axes = plt.subplots(figsize=(7.2, 3.4), layout="constrained")
axes.plot(run.data["time"], np.degrees(run.data["amplitude"]))
axes.plot(times, np.full(times.size, 3.0), "o", label="tilt rises above 3°")
axes.set(xlabel="time [s]", ylabel="tilt [°]")
axes.legend()

# %%
# The fifth event ends the run. See :class:`stylobate.EventFunction` and
# :doc:`/getting-started/first-steps`.
