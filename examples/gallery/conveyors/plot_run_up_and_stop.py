"""
What does a part do while the machine runs up and stops?
========================================================

A feeder with an unbalance drive starts from rest, passes the resonance of its springs,
works at 25 Hz and runs down to rest. Where does the part hop, and where does it stop?
"""

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

bottle = sb.Column.solid(radius=0.03, height=0.2, density=884.0)  # m, m, kg/m³
part = sb.Sliding(bottle, friction_coefficient=0.25, damping=0.05)
machine = sb.MachineRun(
    stroke=0.0024,  # m, from peak to peak at 25 Hz
    frequency=25.0,  # Hz
    angle=0.436,  # rad, 25°
    run_up=6.0,  # s
    steady=1.0,
    run_down=8.0,
    resonance=5.0,  # Hz
    resonance_damping=0.1,
)
run = sb.simulate(part, machine, tilt=(0.0, 0.01))
print(run)

time = np.linspace(0.0, machine.duration, 20001)
vertical = -machine.acceleration(time)[:, 2] / bottle.gravity
path = 1000.0 * machine.displacement(time)[:, 0]
sample = run.sample(time[time <= run.data["time"].values[-1]])
position = 1000.0 * sample["footprint"].sel(axis="x").values
work_ends = machine.run_up + machine.steady

figure, panels = plt.subplots(
    3, 1, figsize=(7.2, 6.0), sharex=True, layout="constrained"
)
panels[0].plot(time, path, linewidth=0.4)
panels[0].set_ylabel("base, along x [mm]")
panels[1].plot(time, vertical, linewidth=0.4)
panels[1].axhline(1.0, color="k", linestyle="--", linewidth=0.8)
panels[1].set_ylabel("downwards [g]")
panels[2].plot(sample["time"], position)
panels[2].set(xlabel="time [s]", ylabel="part on the track [mm]")
for axes in panels:
    axes.axvspan(machine.run_up, work_ends, color="0.93")

# %%
# Grey: steady vibration. Above the dashed line the part hops. The stroke grows where
# the frequency passes 5 Hz, on the way up and down. The acceleration there stays below
# gravity, because it grows with the square of the frequency.
#
# The part keeps moving for a while after the drive is switched off:

after = np.interp(work_ends, sample["time"], position)
print(f"after switching off: {position[-1] - after:.1f} mm")

# %%
# This is a machine that stops. A wall at the end of a track is not part of the model:
# a part that runs against a stop, or against another part, needs other software. See
# :class:`stylobate.MachineRun` and :doc:`/how-to/conveyors`.
