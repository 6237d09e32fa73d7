"""
Does a free spin reduce the tilt of a rolling column?
=====================================================

A column that cannot turn about its own axis rolls round its rim at a certain tilt. If
it may spin, the base spins it up, and the tilt falls. This example compares both in
closed form.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

c, eta = 0.1, 0.1  # slenderness, damping
amplitude = 0.065  # radius of the circular base acceleration, in g
frequency = np.linspace(1.6, 6.0, 200)  # Ω/ω₀

fixed = sb.theory.steady_rolling(frequency, amplitude, c=c, eta=eta).upper
figure, axes = plt.subplots(figsize=(7.2, 3.8), layout="constrained")
axes.plot(frequency, fixed.amplitude / c, "k", label="no spin")
for zeta in (1.0, 0.1, 0.03):  # spin damping
    spinning = sb.theory.free_twist_rolling(
        frequency, amplitude, c=c, eta=eta, zeta=zeta
    )
    axes.plot(
        frequency, spinning.amplitude / c, label=f"free spin, spin damping {zeta:g}"
    )
axes.set(xlabel="Ω/ω₀", ylabel="tilt of steady rolling / c", ylim=(0.0, None))
axes.legend()

# %%
# At a spin damping of 0.1 and three times ω₀ a free spin halves the tilt. The less spin
# damping, the smaller the tilt. See :doc:`/explanation/models` and
# :func:`stylobate.theory.free_twist_rolling`.
