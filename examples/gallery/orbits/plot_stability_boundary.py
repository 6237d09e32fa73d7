"""
How does the stability limit depend on the amplitude? A bifurcation curve
=========================================================================

Follow a bifurcation over two parameters, frequency and amplitude. The curve bounds the
motions of the base under which a column rolls steadily.
"""

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.13, angular_frequency=2.0)  # g, ω₀

boundary = sb.studies.stability_boundary(
    model,
    line,
    parameter="acceleration",
    bounds=(0.1, 0.16),  # g
    angular_frequency=(1.3, 2.0),  # Ω/ω₀
    values=[0.13],  # the amplitude at which the search begins
    control=sb.orbits.StepControl(first=0.02, largest=0.2),  # long steps, to be quick
)
print("kinds of curves:", *boundary["curve_kind"].values)
sb.plot(boundary)

# %%
# Rolling is stable to the right of the bold curve. Averaged theory calls it stable from
# the dashed curve on, which is too optimistic at every amplitude shown. See
# :func:`stylobate.studies.stability_boundary` and :doc:`/results/exact-orbits`.
