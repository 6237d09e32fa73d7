"""
Does a conveyed part turn about its axis?
=========================================

The label of a bottle must face the camera at the end of the track. A part that rocks
while it is conveyed rolls on its rim, and twists. How far?
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

pin = sb.Column.solid(radius=0.006, height=0.040, density=7850.0)  # m, m, kg/m³
trough = sb.Harmonic.stroke(stroke=0.0006, frequency=50.0, angle=math.radians(25.0))

figure, axes = plt.subplots(1, 2, figsize=(7.2, 3.4), layout="constrained")
for friction, colour in ((0.15, "#0072b2"), (0.28, "#d55e00"), (0.45, "#009e73")):
    part = sb.Sliding(
        pin, friction_coefficient=friction, damping=0.05, normal_restitution=0.1
    )
    run = sb.simulate(part, trough, tilt=(0.0, 0.01), duration=1.5)
    travelled = 1000.0 * run.data["footprint"].sel(axis="x")
    axes[0].plot(
        travelled,
        np.degrees(run.data["twist"]),
        color=colour,
        label=f"μ = {friction:g}",
    )
    # The same from 64 directions of the initial tilt and phases of the vibration.
    found = sb.conveying.upright(part, trough, tilts=[0.01], periods=75)
    stands = found["posture"].values != sb.conveying.Posture.FALLEN
    way = 1000.0 * found["end_footprint"].sel(axis="x").values[stands]
    per_way = 100.0 * np.degrees(found["end_twist"].values[stands]) / way
    axes[1].hist(per_way, np.linspace(-1500.0, 1500.0, 31), color=colour, alpha=0.6)
    low, high = np.quantile(per_way, [0.05, 0.95])
    print(f"μ = {friction:g}: {low:.0f} to {high:.0f} degrees over 100 mm")
axes[0].set(xlabel="distance on the track [mm]", ylabel="twist [°]")
axes[0].legend()
axes[1].set(xlabel="twist over 100 mm [°]", ylabel="runs of 64")

# %%
# Left: one run each, tilted across the direction of transport. Right: all directions
# of the tilt. Friction resists the twist, but no friction coefficient prevents it, and
# its sense depends on the start: nine tenths of the runs lie in the printed ranges. A
# part that starts flat does not twist, which no real part can rely on.
#
# Pivoting friction of a flat base stops a twist only while the part stands on it. See
# :func:`stylobate.conveying.upright` and :doc:`/how-to/conveyors`.
