"""
At which frequency of a sine sweep does a column overturn?
==========================================================

A shaking table often sweeps slowly through the frequencies at constant acceleration.
This sweep goes from fast to slow, because slow shaking is the dangerous one.
"""

import matplotlib.pyplot as plt

import stylobate as sb

column = sb.Column.solid(radius=0.5, height=10.0, density=2700.0)  # m, m, kg/m³
model = sb.Slender(column, damping=0.1)
sweep = sb.SineSweep.logarithmic(
    acceleration=1.2,  # m/s², above c g = 0.98 m/s²
    frequencies=(1.5, 0.15),  # Hz
    length=120.0,  # s
)
run = sb.simulate(model, sweep, duration=120.0)
print(f"{run.outcome.label} at {sweep.frequency(run.decided_at):.2f} Hz")

time = run.data["time"].values  # s
figure, axes = plt.subplots(figsize=(7.2, 3.6), layout="constrained")
axes.plot(sweep.frequency(time), run.data["amplitude"] / column.slenderness, lw=0.9)
axes.set(xlabel="frequency of the base [Hz]", ylabel="tilt / c", ylim=(0.0, 1.2))
axes.set_xscale("log")
axes.invert_xaxis()  # time runs to the right
axes.set_xticks([1.5, 1.0, 0.5, 0.3, 0.2], labels=["1.5", "1", "0.5", "0.3", "0.2"])
axes.minorticks_off()

# %%
# The peak tilt of the rocking grows as the frequency falls, until the column overturns.
# See :doc:`/how-to/base-motions` and :class:`stylobate.SineSweep`; for steps of
# constant frequency see :func:`stylobate.studies.slow_sweep`.
