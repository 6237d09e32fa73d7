"""
Steady rolling and its bifurcations
===================================

Follow steady rolling of a column from its closed form to its loss of stability.

A column on a base that moves in a circle can roll steadily round its rim, like a coin
that settles. This tutorial computes this motion in closed form, finds the frequency at
which it becomes unstable, and shows the motion beyond. It then replaces the circle by
a straight line, where no closed form exists, and continues the exact periodic orbit
through a pitchfork.

It is for readers who know Floquet multipliers and bifurcations. It takes about 15 s.
"""

# %%
# The column and its base motion
# ------------------------------
# A dimensionless column needs only its slenderness :math:`c = r/h` and its damping
# :math:`\eta`. Accelerations are then in g, angular frequencies in :math:`\omega_0`,
# and times in :math:`1/\omega_0`. The frequency ratio is
# :math:`\nu = \Omega/\omega_0`. The base moves in a circle with the acceleration
# amplitude :math:`a_0 = 0.065`.
import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

c, eta = 0.1, 0.1
model = sb.Slender(sb.Column.dimensionless(slenderness=c), damping=eta)
circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)

# %%
# Steady rolling in closed form
# -----------------------------
# Under circular motion steady rolling is an exact solution: the tilt is constant, and
# the contact point goes round once per period of the base.
# :func:`stylobate.studies.response_curves` evaluates it over the frequency. At each
# frequency there are two solutions. The lower branch is always unstable. The upper one
# is stable (bold) above a critical frequency.
frequencies = np.linspace(0.5, 4.0, 351)
curves = sb.studies.response_curves(model, circle, angular_frequency=frequencies)
critical = float(curves["critical_frequency"].item())
print(f"critical frequency: {critical:.7f}")
sb.plot(curves)

# %%
# A simulation confirms the stable branch: start on it, and the column keeps rolling.
start = sb.studies.steady_start(model, circle)
run = sb.simulate(model, circle, **start, duration=40.0 * circle.period)
tilt = sb.theory.steady_rolling(1.8, 0.065, c=c, eta=eta).upper.amplitude
print(run.outcome.name, "-", run.reason)
print(
    f"mean tilt: {run.measures['mean_tilt_late']:.9f}, closed form: {float(tilt):.9f}"
)

# %%
# Just below the critical frequency: modulated rolling
# ----------------------------------------------------
# At the critical frequency a pair of eigenvalues crosses the imaginary axis: a Hopf
# bifurcation in the frame that turns with the base, a Neimark-Sacker bifurcation of
# the period map. Choose a frequency just below, disturb steady rolling by 1 %, and
# simulate.
below = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.36)
start = sb.studies.steady_start(model, below)
disturbed = {**start, "tilt": tuple(1.01 * np.array(start["tilt"]))}
run = sb.simulate(model, below, **disturbed, duration=150.0 * below.period)
print(run.outcome.name, "-", run.reason)

time = np.linspace(0.0, 150.0 * below.period, 6001)
tilt = np.hypot(*run.sample(time)["tilt"].values.T) / c
figure, axes = plt.subplots(figsize=(7.4, 3.0), layout="constrained")
axes.set(xlabel="periods of the base", ylabel=r"tilt angle $\theta/c$")
lines = axes.plot(time / below.period, tilt, color="#0072b2", linewidth=0.8)

# %%
# The tilt does not grow until the column overturns. It settles on a modulated motion.
# Stroboscopic (Poincaré) samples, one per period, show its type: a closed curve means
# that the motion is quasi-periodic.
section = sb.studies.poincare_section(model, below, **disturbed, periods=400, skip=200)
sb.plot(section)

# %%
# The Lyapunov exponents agree. The largest one is zero within its error, and the others
# are negative: the motion is an attractor, and it is not chaotic. The bifurcation is
# supercritical.
exponents = sb.studies.lyapunov_exponents(
    model, below, **disturbed, periods=1000, skip=300
)
for value, error in zip(
    exponents["lyapunov_exponent"].values, exponents["error"].values, strict=True
):
    print(f"{value:+.5f} ± {error:.5f}")

# %%
# Straight-line motion: an exact orbit
# ------------------------------------
# A straight-line motion of amplitude :math:`a_1` is the sum of two circular motions of
# :math:`a_1/2`, one in each sense. Averaging keeps the one that turns with the column.
# For :math:`a_1 = 0.13` it therefore predicts stable rolling down to the critical
# frequency computed above.
#
# :func:`stylobate.orbits.periodic_orbit` finds the exact orbit by shooting, without
# averaging. All its Floquet multipliers lie inside the unit circle: it is stable.
line = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
orbit = sb.orbits.periodic_orbit(model, line)
print(orbit)

angle = np.linspace(0.0, 2.0 * np.pi, 200)
figure, (left, right) = plt.subplots(1, 2, figsize=(7.4, 3.7), layout="constrained")
left.plot(np.cos(angle), np.sin(angle), color="0.6", linewidth=0.8)
left.plot(orbit.multipliers.real, orbit.multipliers.imag, "o", color="#0072b2")
left.set(aspect="equal", xlabel="real part", ylabel="imaginary part")
left.set_title("Floquet multipliers", fontsize="medium")
path = np.append(orbit.path[:2], orbit.path[:2, :1], axis=1) / c
right.plot(*path, color="#0072b2")
right.plot(0.0, 0.0, "+", color="black")
right.set(xlabel=r"$\theta_x/c$", ylabel=r"$\theta_y/c$")
right.set_title("path of the tilt vector", fontsize="medium")

# %%
# Continuation: a pitchfork where averaging expects stability
# -----------------------------------------------------------
# Continue the orbit to lower frequencies. It loses its stability in a pitchfork, at a
# frequency clearly above the prediction of averaging.
branch = sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(1.3, 3.0))
pitchfork = branch.bifurcations[-1]
print(pitchfork)
print(f"averaging predicts stability down to {critical:.6f}")

points = branch.points
frequency, largest = points["angular_frequency"], points["peak_tilt"] / c
stable = points["stable"].values
figure, axes = plt.subplots(figsize=(7.4, 3.7), layout="constrained")
axes.plot(frequency, largest, color="#0072b2", linewidth=1.0, label="unstable")
bold = largest.where(stable)
axes.plot(frequency, bold, color="#0072b2", linewidth=3.0, label="stable")
axes.plot(
    pitchfork.parameter,
    pitchfork.orbit.peak_tilt / c,
    "D",
    color="black",
    label="pitchfork",
)
axes.axvline(critical, color="0.4", linestyle=":", label="critical, by averaging")
axes.set(xlabel=r"frequency ratio $\Omega/\omega_0$", ylabel="maximum tilt / c")
axes.legend(frameon=False)

# %%
# A simulation between both frequencies confirms this. Start on the averaged solution at
# :math:`\nu = 1.5`, where averaging predicts stable rolling: the column overturns.
between = sb.Harmonic.straight(acceleration=0.13, angular_frequency=1.5)
start = sb.studies.steady_start(model, between)
run = sb.simulate(model, between, **start, duration=100.0 * between.period)
print(run.outcome.name, "-", run.reason)

# %%
# Switch to the bifurcating branches
# ----------------------------------
# Symmetric rolling leans the opposite way half a period later:
# :math:`\boldsymbol\theta(t + T/2) = -\boldsymbol\theta(t)`. At the pitchfork two
# orbits without this symmetry branch off, symmetry-related to each other.
# ``supercritical`` is True, so these orbits are stable.
asymmetric = sb.orbits.switch_branch(pitchfork, bounds=(1.5, 2.5))
related = sb.orbits.switch_branch(pitchfork, bounds=(1.5, 2.5), opposite=True)
for bifurcation in asymmetric.bifurcations:
    print(bifurcation)

figure, axes = plt.subplots(figsize=(7.4, 4.2), layout="constrained")
for family, style, label in (
    (branch, {"color": "0.5", "linestyle": "--"}, "symmetric, unstable"),
    (asymmetric, {"color": "#d55e00"}, "asymmetric, stable"),
    (related, {"color": "#009e73"}, "symmetry-related, stable"),
):
    (orbit,) = family.orbits_at(1.58)
    path = np.append(orbit.path[:2], orbit.path[:2, :1], axis=1) / c
    axes.plot(*path, label=label, **style)
axes.plot(0.0, 0.0, "+", color="black")
axes.set(xlabel=r"$\theta_x/c$, along the base motion", ylabel=r"$\theta_y/c$")
axes.set_title(r"paths of the tilt vector at $\nu = 1.58$", fontsize="medium")
figure.legend(frameon=False, fontsize="small", ncols=3, loc="outside lower center")

# %%
# Check by simulation which attractors are reached near the symmetric orbit: symmetric
# rolling above the pitchfork and asymmetric rolling below it, then orbits of two and
# four periods below the period doublings. At the lowest value all runs overturn. Each
# bar is divided by the shares of the attractors; here one attractor takes each bar.
values = [1.65, 1.6, 1.568, 1.562, 1.5]
after = sb.studies.after_bifurcation(pitchfork, values=values, count=8)
sb.plot(after)

# %%
# The whole frequency response in one call
# ----------------------------------------
# :func:`stylobate.studies.exact_response` continues rolling, switches to the branches
# of its pitchforks and period doublings, and adds the averaged solution. Lines are mean
# tilts; where an orbit is stable, a band shows the range of its tilt over a period. The
# mean tilt of averaging is close; the frequency of the loss of stability is not.
response = sb.studies.exact_response(model, line, angular_frequency=(1.3, 2.2))
sb.plot(response)

# %%
# Where to go on
# --------------
# * :doc:`/how-to/orbits`: orbits from guesses, runs and random initial conditions;
#   bifurcation curves in two parameters.
# * :doc:`/how-to/base-motions`: ellipses and other base motions. Replace ``line`` by a
#   ``sb.Harmonic.elliptic(...)`` to repeat this tutorial for an ellipse.
# * :doc:`/how-to/bifurcation-studies`: stability boundaries, slow sweeps, chaos.
# * :doc:`/results/exact-orbits`: what happens below the pitchfork.
