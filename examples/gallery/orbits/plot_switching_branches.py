"""
Which motions begin at a bifurcation? Switching branches
========================================================

Where symmetric rolling loses its stability in a pitchfork, two asymmetric motions
begin. Follow one of them, and find where it doubles its period.
"""

import matplotlib.pyplot as plt

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.13, angular_frequency=2.0)  # g, ω₀

orbit = sb.orbits.periodic_orbit(model, line)
symmetric = sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(1.5, 2.0))
pitchfork = symmetric.bifurcations[0]
asymmetric = sb.orbits.switch_branch(pitchfork, bounds=(1.5, 2.0))
mirrored = sb.orbits.switch_branch(pitchfork, bounds=(1.5, 2.0), opposite=True)
print(pitchfork)
print(asymmetric.bifurcations[0])

sb.plot([symmetric, asymmetric], labels=["symmetric", "asymmetric"])

# %%
# Bold: stable orbits; shaded: the range of the tilt over a period. The mirrored branch
# has the same tilt as the asymmetric one.
#
# The paths of the tilt at one frequency below the pitchfork are two stable motions,
# each the mirror image of the other, and the unstable symmetric one between them:

figure, axes = plt.subplots(figsize=(7.2, 3.8), layout="constrained")
branches = {"symmetric": symmetric, "asymmetric": asymmetric, "mirrored": mirrored}
for name, branch in branches.items():
    found = branch.orbits_at(1.58)[0]  # the orbit of this branch at Ω/ω₀ = 1.58
    x, y = found.path[:2] / 0.1
    style = "-" if found.stable else ":"
    axes.plot(x, y, style, label=f"{name}, {'' if found.stable else 'un'}stable")
axes.set(xlabel="tilt θ_x / c", ylabel="tilt θ_y / c")
axes.legend(loc="center")

# %%
# See :func:`stylobate.orbits.switch_branch` and :doc:`/how-to/orbits`.
