"""
Does a gentle start of the shaking save a column?
=================================================

A harmonic motion can grow to its full amplitude over a ramp. This example varies the
duration of the ramp and asks how far the column tilts and whether it overturns.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
# Acceleration in g, frequency in units of ω₀, ramp in units of 1/ω₀.
circle = sb.Harmonic.circular(acceleration=0.17, angular_frequency=4.0, ramp=1.0)

ramps = np.linspace(0.5, 30.0, 300)
runs = sb.simulate_ensemble(model, circle, duration=200.0, parameters={"ramp": ramps})
fallen = (runs["outcome"] == sb.Outcome.OVERTURNED).values
tilt = runs["peak_tilt"].values / 0.1  # in units of c
print(f"{fallen.sum()} of {len(ramps)} columns overturn")
print(f"the longest ramp that overturns one is {ramps[fallen].max():.1f}/ω₀")

figure, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
axes.plot(ramps[~fallen], tilt[~fallen], ".", label="survives")
axes.plot(ramps[fallen], np.full(fallen.sum(), 1.2), "x", label="overturns")
axes.set(xlabel="ramp × ω₀", ylabel="peak tilt / c", ylim=(0.0, 1.3))
axes.legend()

# %%
# Each dot is one run from rest; a cross marks a run that overturns. Most of the short
# ramps overturn the column. Under longer ramps it survives the same motion, and its
# peak tilt stays below half of c. See :doc:`/how-to/base-motions` for ramps and start
# phases.
