"""
When does a part begin to hop? The throw number
===============================================

A part leaves a vibrating tray when the tray falls faster than gravity: when the throw
number exceeds 1. This example increases the vertical acceleration of a tray.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

part = sb.Column.solid(radius=0.02, height=0.03, density=7800.0)  # m, m, kg/m³
model = sb.Sliding(part, friction_coefficient=0.3)
tray = sb.Harmonic.vertical(acceleration=9.80665, angular_frequency=60.0)  # m/s², rad/s

scale = np.linspace(0.8, 3.0, 45)  # times g
runs = sb.simulate_ensemble(
    model, tray, duration=40.0 * tray.period, parameters={"scale": scale}
)
throw = sb.theory.throw_number(scale)  # a horizontal tray: the acceleration in g
flying = runs["time_flying"] / runs["end_time"]

figure, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
axes.plot(throw, 100.0 * flying, "o-")
axes.axvline(1.0, color="k", linestyle="--")
axes.set(xlabel="throw number Γ", ylabel="time in flight [%]")

# %%
# Up to a throw number of 1 the part stays on the tray. Beyond it, it flies for a part
# of each period that grows with the throw number. See
# :func:`stylobate.theory.throw_number` and :doc:`/explanation/sliding`.
