"""
How do I combine, turn and scale base motions?
==============================================

Add two motions, turn one about the vertical, delay one: each operation makes a new
motion that any model accepts. The figure shows the paths of the base acceleration.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

circle = sb.Harmonic.circular(acceleration=1.0, angular_frequency=2.0)  # m/s², rad/s
line = sb.Harmonic.straight(acceleration=1.0, angular_frequency=6.0)
ellipse = sb.Harmonic.elliptic(
    amplitude=(1.0, 0.4), phase=-math.pi / 2.0, angular_frequency=2.0
)
motions = {
    "circle": circle,
    "circle + 0.5 line": circle + 0.5 * line,
    "ellipse": ellipse,
    "ellipse turned by 45°": ellipse.rotated(math.pi / 4.0),
}

figure, panels = plt.subplots(
    1, 4, figsize=(9.6, 2.9), sharey=True, layout="constrained"
)
time = np.linspace(0.0, circle.period, 400)
for axes, (name, motion) in zip(panels, motions.items(), strict=True):
    x, y, _ = motion.acceleration(time).T
    axes.plot(x, y)
    axes.set_title(name, fontsize=10)
    axes.set(xlabel="a_x [m/s²]", aspect="equal", xlim=(-1.7, 1.7), ylim=(-1.7, 1.7))
    print(f"{name}: peak {motion.peak_horizontal():.2f} m/s²")
panels[0].set_ylabel("a_y [m/s²]")

# %%
# The peak of a sum is a bound from its parts, so it can be larger than the true peak.
# See :doc:`/how-to/base-motions`.
