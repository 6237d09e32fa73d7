"""
Maps and basins of attraction
=============================

Compute an overturning map, measure how rough its boundaries are, and find which initial
conditions lead to which attractor.

A single run shows the outcome for one base motion and one initial condition. This
tutorial computes thousands of runs, first over frequency and amplitude, then over
initial conditions. The grids are kept small, so that everything takes well under a
minute; the figures of :doc:`/results/maps` use ten times as many runs.

It is for readers who know basins of attraction and Poincaré sections.
"""

# %%
# The column and its base motion
# ------------------------------
# A dimensionless column needs only its slenderness :math:`c = r/h` and its damping
# :math:`\eta`. Accelerations are then in g, angular frequencies in :math:`\omega_0`,
# and times in :math:`1/\omega_0`. The base moves along a straight line.
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.09, angular_frequency=4.0)

# %%
# An overturning map
# ------------------
# :func:`stylobate.studies.overturning_map` computes one run per cell, here 4800 runs
# from rest.
frequencies = np.linspace(0.5, 8.0, 80)
accelerations = np.linspace(0.06, 0.6, 60)
over = {"angular_frequency": frequencies, "acceleration": accelerations}
found = sb.studies.overturning_map(model, line, over=over, duration=500.0)
sb.plot(found)

# %%
# Read the map from below:
#
# * Below the amplitude :math:`c = 0.1` the column stays at rest: the moment of the
#   inertia force is too small to lift the edge.
# * Above it the column overturns at low frequencies and rocks at high ones. The shorter
#   the period, the less the column tilts before the acceleration reverses.
# * *Still moving* means that the motion has not repeated by the end of the run. It may
#   repeat after many periods, or never.
# * Between the two lies a ragged region. Here a *larger* amplitude can be survived
#   although a smaller one overturns the column. Survival is not monotonic.
for name, share in zip(
    found["outcome_name"].values, found["share"].values, strict=True
):
    if share > 0.0:
        print(f"{name}: {100.0 * share:.1f} %")

# %%
# The peak tilt of the survivors shows more than the outcome. The result is an
# xarray Dataset, so plot any of its variables.
survived = found["outcome"] != sb.Outcome.OVERTURNED
figure, axes = plt.subplots(figsize=(7.4, 4.0), layout="constrained")
largest = found["peak_tilt"].where(survived).T / 0.1
image = axes.pcolormesh(frequencies, accelerations, largest, cmap="cividis")
axes.set(xlabel=r"frequency ratio $\Omega/\omega_0$", ylabel="amplitude $a_1$ [g]")
figure.colorbar(image, label="maximum tilt / c (white: overturned)")

# %%
# How rough is the boundary?
# --------------------------
# If an initial condition is known to :math:`\varepsilon` only, a fraction
# :math:`f \sim \varepsilon^\upsilon` of initial conditions has an uncertain outcome.
# The uncertainty exponent :math:`\upsilon` is 1 at a smooth boundary and smaller at a
# rough one. :func:`stylobate.studies.uncertainty_exponent` draws random initial
# conditions, shifts each by :math:`\pm\varepsilon` and counts changed outcomes.
circle = sb.Harmonic.circular(acceleration=0.02, angular_frequency=1.2)
exponent = sb.studies.uncertainty_exponent(
    model,
    circle,
    over={"tilt_x": (-0.1, 0.1), "tilt_rate_y": (-0.1, 0.1)},
    shifted="tilt_x",
    count=300,
    overturning_only=True,
    periods=30.0,
)
value, error = (
    float(exponent[name]) for name in ("uncertainty_exponent", "standard_error")
)
print(f"uncertainty exponent {value:.2f} ± {error:.2f}")
print(f"an initial condition ten times as accurate: uncertainty / {10.0**value:.1f}")
sb.plot(exponent)

# %%
# Basins of attraction
# --------------------
# Now keep the base motion and vary the initial tilt. :func:`stylobate.studies.basins`
# classifies each run by its stroboscopic (Poincaré) samples. It lists the attractors
# that it finds; none is specified in advance.
axis = np.linspace(-0.105, 0.105, 61)
basins = sb.studies.basins(
    model,
    line,
    over={"tilt_x": axis, "tilt_y": axis},
    periods=300.0,
)
sb.plot(basins)

# %%
# Outside the circle of radius :math:`c` the column overturns at once. Within it,
# rolling clockwise and anticlockwise are finely mixed: for most initial conditions the
# sense of rolling cannot be predicted in practice. On the line through the centre the
# motion is planar, and the column rocks. The coherent islands belong to an *aperiodic*
# motion: the contact point goes round about once in three periods of the base.
for index in range(basins.sizes["attractor_index"]):
    row = basins.isel(attractor_index=index)
    name, turns = row["attractor_name"].item(), float(row["attractor_turns"])
    print(f"{name}: {turns:+.2f} turns per period, {int(row['count'])} runs")

# %%
# Is the aperiodic motion chaotic? Follow one of its runs on. A closed curve in the
# Poincaré section and a largest Lyapunov exponent of zero mean quasi-periodic motion.
kinds = basins["attractor_kind"].values[basins["attractor"].values]
place = np.argwhere(np.char.startswith(kinds, "aperiodic"))[0]
run = basins.isel(tilt_x=place[0], tilt_y=place[1])
start = {"tilt": run["end_tilt"].values, "tilt_rate": run["end_tilt_rate"].values}
section = sb.studies.poincare_section(model, line, **start, periods=1000, skip=200)
exponents = sb.studies.lyapunov_exponents(
    model, line, **start, periods=2000, skip=500, count=2
)
for value, error in zip(
    exponents["lyapunov_exponent"].values, exponents["error"].values, strict=True
):
    print(f"Lyapunov exponent {value:+.5f} ± {error:.5f}")
sb.plot(section)

# %%
# Basin fractions with intervals
# ------------------------------
# The map above is one section of a four-dimensional space. To estimate how often
# each attractor is reached, draw random initial conditions in all four components.
# Each fraction has its 95 % interval. :func:`stylobate.studies.basin_fractions` repeats
# this along a parameter, with the same initial conditions at every value.
names = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")
fractions = sb.studies.basin_fractions(
    model,
    line,
    along={"acceleration": np.linspace(0.03, 0.15, 7)},
    over=dict.fromkeys(names, (-0.06, 0.06)),
    count=300,
    periods=300.0,
)
sb.plot(fractions)

# %%
# Below about 0.09 g the column rolls once round per period in either sense. Above,
# quasi-periodic rolling takes over. The intervals depend on the sample size, the
# fractions on the box of initial conditions: state both with a result.
last = fractions.isel(acceleration=-1)
for index in np.flatnonzero(last["count"].values):
    row = last.isel(attractor_index=index)
    low, high = 100.0 * float(row["fraction_low"]), 100.0 * float(row["fraction_high"])
    name, share = row["attractor_name"].item(), 100.0 * float(row["fraction"])
    print(f"{name}: {share:.1f} % ({low:.1f} to {high:.1f} %)")

# %%
# A store that resumes after an interruption
# ------------------------------------------
# Large maps take hours. Compute them into a store on disk: after Ctrl-C, a crash or a
# time limit, ``resume=True`` computes only what is missing. Here the callback for
# progress interrupts the computation after half of the runs, as Ctrl-C would.
folder = tempfile.TemporaryDirectory()
store = Path(folder.name) / "map.zarr"


def interrupt_halfway(done: int, total: int) -> None:
    """Stop after half of the runs."""
    if done > total // 2:
        raise KeyboardInterrupt


study = {"over": over, "duration": 500.0, "store": store}
try:
    sb.studies.overturning_map(model, line, **study, progress=interrupt_halfway)
except sb.Interrupted as stop:
    print(stop)

# %%
# An unfinished store can be opened and drawn; runs not yet computed stay blank.
half = sb.load(store)
figure, axes = plt.subplots(figsize=(7.4, 3.4), layout="constrained")
outcome = half["outcome"].where(half["outcome"] >= 0).T
axes.pcolormesh(frequencies, accelerations, outcome, cmap="cividis")
axes.set(xlabel=r"frequency ratio $\Omega/\omega_0$", ylabel="amplitude $a_1$ [g]")
axes.set_title(f"{half.attrs['runs_done']} of {half['outcome'].size} runs in the store")

# %%
# Resume it. The complete map equals the one computed without interruption.
resumed = sb.studies.overturning_map(model, line, **study, resume=True)
print("cells that differ:", int((resumed["outcome"] != found["outcome"]).sum()))
folder.cleanup()

# %%
# Where to go on
# --------------
# * :doc:`/how-to/maps`: integrity measures and all options of the studies.
# * :doc:`/how-to/sweeps`: several machines, Slurm, checks of damaged stores.
# * :doc:`/results/maps`: attractors found so far, with samples and intervals.
