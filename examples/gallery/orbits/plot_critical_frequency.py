"""
Above which frequency is steady rolling stable?
===============================================

The critical frequency separates unstable from stable steady rolling on a circularly
moving base. It depends on the amplitude of the base; the damping matters at small
amplitudes only.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

c = 0.1  # slenderness
amplitude = np.linspace(0.002, 0.3, 150)  # g

figure, axes = plt.subplots(figsize=(7.2, 4.0), layout="constrained")
for eta in (0.01, 0.1, 0.3):  # damping
    frequency = sb.theory.critical_frequency(amplitude, c=c, eta=eta)
    axes.plot(frequency, amplitude / c, label=f"damping {eta:g}")
axes.plot(
    sb.theory.undamped_critical_frequency(amplitude, c=c),
    amplitude / c,
    "k--",
    label="no damping, closed form",
)
axes.set(xlabel="critical frequency Ω/ω₀", ylabel="base acceleration / (c g)")
axes.legend()

# %%
# Steady rolling is stable to the right of each curve. A stronger base motion needs a
# higher frequency. See :func:`stylobate.theory.critical_frequency` and, for paths that
# are no circles, :func:`stylobate.studies.stability_boundary`.
