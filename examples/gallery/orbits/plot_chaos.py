"""
Is the rolling of a column chaotic? Poincaré section and Lyapunov exponent
==========================================================================

Record the tilt once in each period of the base. A modulated motion draws closed curves;
a chaotic one draws a ragged set, and nearby motions separate exponentially.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.13, angular_frequency=2.0)  # g, ω₀
rolling = sb.orbits.continue_branch(
    sb.orbits.periodic_orbit(model, line), "angular_frequency", bounds=(1.5, 2.0)
)
asymmetric = sb.orbits.switch_branch(rolling.bifurcations[0], bounds=(1.5, 2.0))

figure, panels = plt.subplots(1, 2, figsize=(7.6, 3.6), layout="constrained")
for axes, omega in zip(panels, (1.56, 1.558), strict=True):  # Ω/ω₀
    orbit = asymmetric.orbits_at(omega)[0]  # unstable: start right beside it
    start = {"tilt": 1.0005 * np.array(orbit.tilt), "tilt_rate": orbit.tilt_rate}
    section = sb.studies.poincare_section(model, orbit.motion, **start, periods=1000)
    rates = sb.studies.lyapunov_exponents(
        model, orbit.motion, **start, periods=800, skip=300
    )
    largest, error = float(rates["lyapunov_exponent"][0]), float(rates["error"][0])
    points = section["section_tilt"].squeeze() / 0.1
    axes.plot(points.sel(axis="x"), points.sel(axis="y"), ".", markersize=2)
    axes.set_title(f"Ω/ω₀ = {omega}, exponent {largest:.4f} ± {error:.4f}", fontsize=9)
    axes.set(xlabel="tilt θ_x / c", ylabel="tilt θ_y / c")

# %%
# Left: closed curves, and an exponent of zero within its error: modulated rolling.
# Right: a ragged set and a positive exponent: chaos, within a narrow range of
# frequencies. See :doc:`/results/exact-orbits`.
