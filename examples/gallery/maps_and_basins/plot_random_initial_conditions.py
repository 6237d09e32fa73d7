"""
How do I simulate thousands of random initial conditions?
=========================================================

An ensemble runs many columns at once in compiled code. Here 4000 columns start from
random tilts and tilt rates under one base motion.
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
circle = sb.Harmonic.circular(acceleration=0.06, angular_frequency=4.0)  # g, ω₀

rng = np.random.default_rng(1)
tilt = rng.uniform(-0.08, 0.08, (4000, 2))  # rad
rate = rng.uniform(-0.03, 0.03, (4000, 2))  # rad × ω₀
runs = sb.simulate_ensemble(
    model, circle, tilt=tilt, tilt_rate=rate, duration=40.0 * circle.period
)
fallen = (runs["outcome"] == sb.Outcome.OVERTURNED).values
print(f"{100.0 * fallen.mean():.1f} % overturn")

figure, axes = plt.subplots(figsize=(7.2, 3.8), layout="constrained")
size = np.hypot(*tilt.T) / 0.1  # initial tilt in units of c
axes.hist(
    [size[~fallen], size[fallen]],
    bins=24,
    stacked=True,
    label=["survives", "overturns"],
)
axes.set(xlabel="initial tilt / c", ylabel="number of columns")
axes.legend()

# %%
# From small initial tilts hardly any column overturns; the larger the tilt, the larger
# the fraction that does. Some columns return even from beyond c, because their initial
# tilt rate points back. See :doc:`/how-to/ensembles` and
# :func:`stylobate.simulate_ensemble`.
