"""
How likely is overturning at a given intensity? A fragility curve
=================================================================

Fit a lognormal fragility curve to runs under 20 synthetic records at 10 scales, with
intervals from a bootstrap over the records. An engineer combines the curve with the
seismic hazard of a site.
"""

import numpy as np

import stylobate as sb

noise = sb.records.EvolvingNoise(
    arias=1.2, duration_5_95=8.0, middle_time=5.0, frequency=2.5, bandwidth=0.3
)
quakes = {}
for seed in range(20):
    made = noise.record(np.random.default_rng(seed), components=2, step=0.02)
    quakes[f"synthetic {seed}"] = made.trimmed(0.0, 14.0).scaled_to(1.0)  # m/s²

column = sb.Column.solid(radius=0.4, height=4.0, density=2700.0)  # m, m, kg/m³
runs = sb.earthquakes.incremental_dynamic_analysis(
    sb.Wobbling(column, damping=0.03), quakes, scales=np.geomspace(1.6, 10.0, 10)
)
fits = sb.earthquakes.fragility_of_runs(
    runs, resamples=200, rng=np.random.default_rng(0)
)
fall = fits.sel(limit_state="overturning")
low, median, high = (float(fall[f"median{end}"]) for end in ("_low", "", "_high"))
print(f"overturning: median {median:.1f} m/s², 95 % interval {low:.1f} to {high:.1f}")

# Draw two of the limit states: half the tipping angle, and overturning.
sb.plot(fits.sel(limit_state=["tilt 0.5 α", "overturning"]))

# %%
# Bands are 95 % intervals. A curve describes these records, and no site. See
# :doc:`/how-to/fragility`.
