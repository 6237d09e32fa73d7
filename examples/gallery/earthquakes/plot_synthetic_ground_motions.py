"""
How do I make synthetic ground motions?
=======================================

If you have too few records, draw synthetic ones from a stochastic model. Its numbers
are those that an engineer reads off an accelerogram.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

model = sb.records.EvolvingNoise(
    arias=1.2,  # Arias intensity [m/s]
    duration_5_95=8.0,  # significant duration [s]
    middle_time=5.0,  # when half of the Arias intensity has come [s]
    frequency=2.5,  # in the middle of the motion [Hz]
    frequency_rate=-0.1,  # Hz/s: the motion becomes slower
    bandwidth=0.3,
)

figure, panels = plt.subplots(3, 1, sharex=True, sharey=True, layout="constrained")
for seed, axes in enumerate(panels):
    quake = model.record(np.random.default_rng(seed), components=2, step=0.01)
    axes.plot(quake.step * np.arange(len(quake.samples)), quake.samples[:, 0], lw=0.8)
    peak = quake.peak_horizontal()  # m/s²
    axes.set_title(f"seed {seed}: peak of the horizontal vector {peak:.1f} m/s²")
    axes.set_xlim(0.0, 20.0)
panels[1].set_ylabel("acceleration along x [m/s²]")
panels[-1].set_xlabel("time [s]")

# %%
# Three motions of one model: the same intensity and duration on average, different
# peaks. A seed repeats its motion exactly. See :doc:`/how-to/records` and
# :class:`stylobate.records.EvolvingNoise`.
