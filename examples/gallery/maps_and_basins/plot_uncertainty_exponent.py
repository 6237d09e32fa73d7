"""
Does a more exact start make the outcome more certain? Uncertainty exponent
===========================================================================

If the boundary of a basin is fractal, even a much more exact initial condition leaves
the outcome uncertain. The uncertainty exponent measures this.
"""

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
circle = sb.Harmonic.circular(acceleration=0.02, angular_frequency=1.2)  # g, ω₀

found = sb.studies.uncertainty_exponent(
    model,
    circle,
    over={"tilt_x": (-0.1, 0.1), "tilt_rate_y": (-0.1, 0.1)},  # rad, rad × ω₀
    shifted="tilt_x",  # the number that is known inexactly
    count=150,  # initial conditions for each error: a small sample
    overturning_only=True,
    periods=30.0,
)
exponent, error = float(found["uncertainty_exponent"]), float(found["standard_error"])
print(f"uncertainty exponent: {exponent:.2f} ± {error:.2f}")
sb.plot(found)

# %%
# The fraction of uncertain initial conditions falls with the error of the start, as a
# straight line on logarithmic axes. With the exponent 1 the boundary would be smooth: a
# tenth of the error would leave a tenth of the uncertainty. Here it leaves more. See
# :func:`stylobate.studies.uncertainty_exponent`.
