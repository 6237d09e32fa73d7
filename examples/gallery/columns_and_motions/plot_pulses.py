"""
Which pulses of the rocking literature are there?
=================================================

Draw the acceleration of six pulses of the same period: from the half sine of Housner to
the near-fault pulse of Mavroeidis and Papageorgiou.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

omega = 2.0 * np.pi  # rad/s: a period of 1 s
peak = {"acceleration": 1.0, "angular_frequency": omega}  # m/s²
speed = {"velocity": 1.0 / omega, "angular_frequency": omega}  # m/s
pulses = {
    "half sine": sb.Pulse.half_sine(**peak),
    "one sine": sb.Pulse.one_sine(**peak),
    "one cosine": sb.Pulse.one_cosine(**peak),
    "type C, 2 cycles": sb.Pulse.type_c(**speed, cycles=2),
    "Ricker": sb.Pulse.ricker(**peak),
    "Mavroeidis–Papageorgiou": sb.Pulse.mavroeidis_papageorgiou(
        velocity=1.0 / omega, frequency=1.0, phase=0.0, oscillations=2.0
    ),
}

figure, panels = plt.subplots(
    2, 3, figsize=(7.6, 4.0), sharey=True, layout="constrained"
)
for axes, (name, pulse) in zip(panels.flat, pulses.items(), strict=True):
    middle = 0.5 * pulse.duration
    time = np.linspace(-1.6, 1.6, 500)
    later = pulse.delayed(2.0)  # so that the base is at rest before
    axes.plot(time, later.acceleration(2.0 + middle + time)[:, 0])
    axes.set_title(name, fontsize=10)
figure.supxlabel("time from the middle of the pulse [s]")
figure.supylabel("acceleration [m/s²]")

# %%
# A pulse is a base motion like any other: pass it to :func:`stylobate.simulate`. See
# :doc:`/how-to/base-motions` and :class:`stylobate.Pulse`.
