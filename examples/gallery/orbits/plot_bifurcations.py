"""
Where does steady rolling lose its stability? Continuation
==========================================================

Follow a periodic orbit over the frequency of a straight-line base motion, locate its
bifurcations, and follow the families that begin there.
"""

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)  # g, ω₀

curves = sb.studies.exact_response(model, line, angular_frequency=(1.2, 3.0))
kinds = curves["bifurcation_kind"].values
for kind, at in zip(kinds, curves["bifurcation_angular_frequency"].values, strict=True):
    print(f"{kind} at {at:.6f} ω₀")
averaged = float(curves["averaged_critical_frequency"])
print(f"averaged theory: stable above {averaged:.6f} ω₀")

sb.plot(curves)

# %%
# Bold: stable orbits; shaded: the range of the tilt over a period. The averaged theory
# of rolling (dashed) is close to the mean tilt, but its critical frequency is too low.
# See :doc:`/results/exact-orbits`.
