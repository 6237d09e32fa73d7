"""
Is a periodic motion of the column stable? Floquet multipliers
==============================================================

A periodic orbit can be found whether it attracts or not. Its Floquet multipliers are
the factors by which small disturbances grow in one period.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)

figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.8), layout="constrained")
unit = np.exp(1j * np.linspace(0.0, 2.0 * np.pi, 200))
right.plot(unit.real, unit.imag, "k--", linewidth=0.8)
for omega in (2.0, 1.38):  # Ω/ω₀
    base = sb.Harmonic.circular(acceleration=0.065, angular_frequency=omega)
    orbit = sb.orbits.periodic_orbit(model, base)  # rolling, found by shooting
    largest = abs(orbit.multipliers).max()
    print(f"Ω/ω₀ = {omega}: stable {orbit.stable}, largest multiplier {largest:.4f}")
    x, y = orbit.path[:2] / 0.1  # then the tilt rates
    left.plot(x, y, label=f"Ω/ω₀ = {omega}")
    right.plot(orbit.multipliers.real, orbit.multipliers.imag, "o")
left.set(xlabel="tilt θ_x / c", ylabel="tilt θ_y / c", aspect="equal")
right.set(xlabel="real part", ylabel="imaginary part", aspect="equal")
right.set_title("Floquet multipliers")
left.legend()

# %%
# Left: the path of the tilt over one period of a circular base motion. Right: the orbit
# is stable if all multipliers lie inside the unit circle. At the lower frequency two
# multipliers have left it. See :doc:`/how-to/orbits`.
