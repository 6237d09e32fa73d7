"""
How does a column move just below the critical frequency?
=========================================================

Below the critical frequency steady rolling is unstable, but the column need not
overturn. It rolls on with a tilt that grows and shrinks: modulated rolling.
"""

import matplotlib.pyplot as plt

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
critical = float(sb.theory.critical_frequency(0.065, c=0.1, eta=0.1))

figure, axes = plt.subplots(figsize=(7.2, 3.8), layout="constrained")
for omega in (1.45, 1.36):  # Ω/ω₀, above and below the critical frequency
    circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=omega)
    start = sb.studies.steady_start(model, circle)  # on the unstable steady rolling,
    start["tilt"] = [1.02 * tilt for tilt in start["tilt"]]  # 2 % away from it
    run = sb.simulate(model, circle, duration=150.0 * circle.period, **start)
    print(f"Ω/ω₀ = {omega}: {run.outcome.label}")
    periods = run.data["time"] / circle.period
    axes.plot(periods, run.data["amplitude"] / 0.1, label=f"Ω/ω₀ = {omega}")
axes.set(xlabel="time in periods of the base", ylabel="tilt / c")
axes.set(xlim=(0.0, 40.0), ylim=(0.0, 0.9))
axes.legend()
print(f"critical frequency: {critical:.4f}")

# %%
# Above the critical frequency the disturbance dies out. Below it the tilt ends in a
# steady modulation. :func:`stylobate.theory.modulated_rolling` computes the modulated
# motion itself; :doc:`/explanation/equations` has its theory.
