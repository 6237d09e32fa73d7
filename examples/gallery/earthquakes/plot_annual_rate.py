"""
How often in a year does a column overturn at a site? Annual rate
=================================================================

A fragility curve and the hazard curve of a site give the mean annual rate of
overturning. Both numbers here are examples and describe no real site.
"""

import stylobate as sb

fragility = sb.earthquakes.lognormal_fragility(
    4.5, 0.35, name="overturning", units="m s-2", component="RotD50"
)
hazard = sb.earthquakes.HazardCurve(
    intensity=[0.3, 1.0, 2.0, 4.0, 8.0],  # peak ground acceleration [m/s²]
    rate=[6e-2, 1e-2, 2.2e-3, 3e-4, 2.5e-5],  # exceedances in a year
    units="m s-2",
    quantity="peak ground acceleration",
    component="RotD50",
)

rates = sb.earthquakes.annual_rate(fragility, hazard, years=50.0)
print(f"mean annual rate: {rates['annual_rate'].item():.1e}")
print(f"probability in 50 years: {100.0 * rates['probability'].item():.1f} %")
sb.plot(rates)

# %%
# The figure shows which intensities contribute to the rate. Fragility and hazard must
# use the same intensity measure. See :doc:`/how-to/fragility`.
