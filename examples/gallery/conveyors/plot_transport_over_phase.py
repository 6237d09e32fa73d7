"""
Which way does a vibrating base convey? Transport velocity against phase
========================================================================

Move a base in a horizontal circle and up and down at the same frequency, as in a
helical feeder. The phase of the vertical motion sets the direction of transport.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

part = sb.Column.solid(radius=0.02, height=0.03, density=7800.0)  # m, m, kg/m³
model = sb.Sliding(part, friction_coefficient=0.2)
omega = 60.0  # rad/s

phases = np.linspace(0.0, 2.0 * np.pi, 13)
velocity = []
for phase in phases:
    circle = sb.Harmonic.circular(acceleration=4.0, angular_frequency=omega)
    lift = sb.Harmonic.vertical(
        acceleration=5.0, angular_frequency=omega, start_phase=-phase
    )
    run = sb.simulate_ensemble(model, circle + lift, duration=40.0 * circle.period)
    velocity.append(run["mean_velocity"].values[0])
x, y = 1000.0 * np.array(velocity).T  # mm/s

figure, axes = plt.subplots(figsize=(7.2, 3.8), layout="constrained")
axes.plot(np.degrees(phases), x, "o-", label="along x")
axes.plot(np.degrees(phases), y, "s-", label="along y")
axes.plot(np.degrees(phases), np.hypot(x, y), "k--", label="magnitude")
axes.set(
    xlabel="phase delay of the vertical motion [°]",
    ylabel="mean transport velocity [mm/s]",
)
figure.legend(loc="outside upper center", ncols=3)

# %%
# A phase delay rotates the transport velocity by the same angle and leaves its
# magnitude. See :doc:`/explanation/sliding` and :func:`stylobate.conveying.drift`.
