"""
How much friction does a rolling column need?
=============================================

Most models assume that the rim does not slip. Every run reports the friction that this
assumption needs: the contact demand. Compare it with the friction of your floor.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

c, eta, zeta = 0.1, 0.1, 0.1  # slenderness, damping, spin damping
amplitude = 0.065  # g
model = sb.SlenderRolling(sb.Column.dimensionless(c), damping=eta, spin_damping=zeta)
frequency = np.linspace(1.2, 5.0, 30)  # Ω/ω₀

needed = []
for omega in frequency:
    circle = sb.Harmonic.circular(acceleration=amplitude, angular_frequency=omega)
    start = sb.studies.steady_start(model, circle)  # on the steady rolling
    run = sb.simulate(model, circle, duration=5.0 * circle.period, **start)
    needed.append(run.measures["peak_friction_demand"])
theory = sb.theory.rolling_required_friction(
    frequency, amplitude, c=c, eta=eta, zeta=zeta
)

figure, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
axes.plot(frequency, needed, "o", label="simulated")
axes.plot(frequency, theory.upper, label="closed form")
axes.set(xlabel="Ω/ω₀", ylabel="friction coefficient needed", ylim=(0.0, None))
axes.legend()

# %%
# Below the curve the rim slips. ``run.measures`` has the contact demands of every run;
# pass ``friction_coefficient=`` to :func:`stylobate.simulate` for a warning. See
# :doc:`/explanation/models`.
