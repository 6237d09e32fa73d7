"""
Does a rocking column stay in its vertical plane?
=================================================

Planar models assume that a column rocks to and fro in one vertical plane. Give a free
column a small sideways push and see how long that assumption holds.
"""

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.02)
start = {"tilt": (0.06, 0.0), "duration": 40.0}  # rad; time in units of 1/ω₀

inside = sb.simulate(model, **start)
pushed = sb.simulate(model, tilt_rate=(0.0, 0.006), **start)  # rad × ω₀
print(f"planar motion: {inside.planar} without the push, {pushed.planar} with it")
print(f"turns of the contact point with the push: {pushed.measures['turns']:.1f}")

sb.plot([inside, pushed], labels=["no push", "sideways push"])

# %%
# The contact point of the pushed column runs half round the rim at each passage near
# the vertical, and a little farther each time. So the plane of rocking turns, and the
# path of the tilt becomes a rosette. :doc:`/explanation/equations` derives why planar
# motion is unstable.
