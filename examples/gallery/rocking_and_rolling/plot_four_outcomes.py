"""
Does a column stand, rock, roll or overturn on a shaking base?
==============================================================

One slender column starts at rest under four harmonic base motions. The amplitude
decides whether the column moves at all. The frequency and the path of the base decide
between rocking, rolling and overturning.
"""

import matplotlib.pyplot as plt

import stylobate as sb

# A dimensionless column: accelerations in g, frequencies in units of ω₀, time in 1/ω₀.
column = sb.Column.dimensionless(slenderness=0.1)  # c = r/h
model = sb.Slender(column, damping=0.1)
motions = {
    "circle, 0.09 g, 4 ω₀": sb.Harmonic.circular(
        acceleration=0.09, angular_frequency=4
    ),
    "line, 0.14 g, 4 ω₀": sb.Harmonic.straight(acceleration=0.14, angular_frequency=4),
    "circle, 0.14 g, 4 ω₀": sb.Harmonic.circular(
        acceleration=0.14, angular_frequency=4
    ),
    "circle, 0.14 g, 1 ω₀": sb.Harmonic.circular(
        acceleration=0.14, angular_frequency=1
    ),
}

figure, panels = plt.subplots(
    1, 4, figsize=(9.6, 3.1), sharey=True, layout="constrained"
)
for axes, (name, motion) in zip(panels, motions.items(), strict=True):
    run = sb.simulate(model, motion, duration=500.0)
    print(f"{name}: {run.outcome.label}, {run.reason}")
    x, y = (run.data["tilt"].sel(axis=axis) / 0.1 for axis in "xy")  # in units of c
    axes.plot(x, y, linewidth=0.8)
    axes.plot(x[-1], y[-1], "ko", markersize=4)  # the end of the run
    axes.add_patch(plt.Circle((0.0, 0.0), 1.0, fill=False, linestyle="--"))
    axes.set_title(f"{run.outcome.label}\n{name}", fontsize=10)
    axes.set(xlim=(-1.3, 1.3), ylim=(-1.3, 1.3), xlabel="tilt θ_x / c", aspect="equal")
panels[0].set_ylabel("tilt θ_y / c")

# %%
# Each panel shows the path of the tilt vector from rest; the dot is the end of the run.
# On the dashed circle the centre of mass stands above the rim. An acceleration below c
# g, here 0.1 g, never moves a standing column. :doc:`/explanation/outcomes` states the
# rule behind each outcome.
