"""
How fast does a vibrating conveyor move a part?
===============================================

A tray that vibrates along an oblique line conveys a part that slides on it. Compare the
simulated mean transport velocity with the closed form for a block.
"""

import math

import matplotlib.pyplot as plt

import stylobate as sb

part = sb.Column.solid(radius=0.02, height=0.03, density=7800.0)  # m, m, kg/m³
model = sb.Sliding(part, friction_coefficient=0.3)
angle = math.radians(30.0)  # of the line of vibration above the horizontal
tray = sb.Harmonic.oblique(acceleration=10.0, angular_frequency=60.0, angle=angle)
run = sb.simulate(model, tray, duration=1.5)  # s
print(run)

g = 9.80665  # m/s²
speed = sb.theory.mean_block_speed(  # in units of g/Ω
    10.0 / g, 10.0 * math.tan(angle) / g, static_friction=0.3
)
speed = float(speed) * g / 60.0  # m/s
print(f"closed form: {1000.0 * speed:.1f} mm/s")

time = run.data["time"]
path = run.data["footprint"].sel(axis="x")  # centre of the base, on the tray
figure, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
axes.plot(time, 1000.0 * path, label="simulated")
axes.plot(time, 1000.0 * speed * time, "--", label="closed form, mean velocity")
axes.set(xlabel="time [s]", ylabel="distance on the tray [mm]")
axes.legend()

# %%
# In every period of the tray the part slides forward and a little back; the difference
# is the transport. See :doc:`/explanation/sliding` and
# :func:`stylobate.theory.mean_block_speed`.
