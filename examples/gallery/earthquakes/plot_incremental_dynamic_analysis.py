"""
How does the peak tilt grow with the ground motion? Incremental dynamic analysis
================================================================================

Run a column under several records at many scales. For a rocking column these curves are
ragged, and some records overturn it at one scale and not at a larger one.
"""

import numpy as np

import stylobate as sb

noise = sb.records.EvolvingNoise(
    arias=1.2, duration_5_95=8.0, middle_time=5.0, frequency=2.5, bandwidth=0.3
)
# Eight synthetic records, each scaled to the same peak of 1 m/s².
quakes = {}
for seed in range(8):
    made = noise.record(np.random.default_rng(seed), components=2, step=0.02)
    quakes[f"synthetic {seed}"] = made.trimmed(0.0, 14.0).scaled_to(1.0)  # m/s²
column = sb.Column.solid(radius=0.4, height=4.0, density=2700.0)  # m, m, kg/m³
runs = sb.earthquakes.incremental_dynamic_analysis(
    sb.Wobbling(column, damping=0.03), quakes, scales=np.linspace(1.6, 5.4, 16)
)
sb.plot(runs)

# %%
# Each curve is one record; crosses mark runs that overturn. A circle is a run that
# survives although a weaker one of the same record overturns the column. See
# :doc:`/how-to/scaled-records` and
# :func:`stylobate.earthquakes.incremental_dynamic_analysis`.
