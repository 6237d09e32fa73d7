"""
Why does a settling coin roll faster and faster?
================================================

Let a steel disc go on its rim. It rolls round its rim, and rolling resistance takes
energy, so the tilt falls. The lower the disc lies, the faster its contact point runs
round.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

disc = sb.Column.solid(radius=0.04, height=0.008, density=8000.0)  # m, m, kg/m³
model = sb.Rolling(disc, rolling_resistance=0.01)  # in units of the radius

# Start on the steady rolling that theory gives at a tilt of 0.6 rad.
steady = sb.theory.free_rolling(
    0.6,
    c=disc.slenderness,
    inertia_ratio=disc.inertia_ratio,
    axial_ratio=disc.axial_ratio,
)
rate = steady.rate[0] * disc.frequency_scale  # rad/s, of the contact point
run = sb.simulate(model, tilt=(0.6, 0.0), tilt_rate=(0.0, 0.6 * rate), duration=4.0)

figure, (above, below) = plt.subplots(2, 1, sharex=True, layout="constrained")
above.plot(run.data["time"], np.degrees(run.data["amplitude"]))
above.set(ylabel="tilt [°]", ylim=(0.0, None))
below.plot(run.data["time"], run.data["rolling_rate"] / (2.0 * np.pi))
below.set(xlabel="time [s]", ylabel="turns of the contact point [1/s]")
for axes in (above, below):
    axes.grid(color="0.9")

# %%
# The tilt falls while the rate of the contact point rises. The page
# :doc:`/how-to/animations` shows such a disc in motion, and
# :func:`stylobate.theory.free_rolling` computes steady free rolling. A real coin ends
# more abruptly: the page :doc:`/results/validation` compares the exponents of this law
# of dissipation with those of measured disks.
