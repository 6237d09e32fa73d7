"""
A column in an earthquake: from an accelerogram to a verdict
============================================================

You have an accelerogram and a free-standing column. Does the column rock, does it
overturn, and how close was it? This tutorial answers in ten small steps for the
El Centro record of 1940, which comes with the package. Replace the record and the
dimensions by your own. No knowledge of rocking dynamics is needed.

All quantities are in SI units.
"""

# %%
# Step 1: read the record
# -----------------------
#
# :func:`stylobate.sample_record` returns the record that comes with the package: three
# components of the ground acceleration, here with the drift of the digitization
# removed.
import tempfile
from pathlib import Path

import numpy as np

import stylobate as sb

quake = sb.sample_record("el centro 1940 corrected")
print(quake)

# %%
# Your own record is usually a set of files, one per component. To see how they are
# read, write the three components as PEER AT2 files into a temporary folder.
folder = Path(tempfile.mkdtemp())
for axis, name in (("x", "north"), ("y", "west"), ("z", "up")):
    sb.records.write_at2(quake, folder / f"elcentro_{name}.AT2", axis=axis)

for line in (folder / "elcentro_north.AT2").read_text().splitlines()[:5]:
    print(line)

# %%
# :func:`stylobate.read_records` reads files and joins the components of one event.
# The unit and the time step stand in the header of each file. If neither headers nor
# names state the azimuths (clockwise from north, in degrees), pass `directions`.
files = {
    "El Centro": [folder / f"elcentro_{name}.AT2" for name in ("north", "west", "up")]
}
azimuths = {"elcentro_north.AT2": 0.0, "elcentro_west.AT2": 270.0}
(mine,) = sb.read_records(files, directions=azimuths)
print(mine)
for note in mine.provenance:
    print("-", note)

# %%
# Check `provenance`: it states the unit, and which file became which axis. Here x
# points north, y points west, and z points up. For other formats, such as columns of
# text, see
# :doc:`the guide to records </how-to/records>`.

# %%
# Step 2: look at the record
# --------------------------
#
# Plot the components and their response spectra (5 % damping), then print the
# intensities. In a program of your own, save each figure:
# ``figure.savefig("record.png")``.
periods = np.geomspace(0.05, 5.0, 60)
spectra = sb.records.response_spectra(quake, periods, damping=0.05)
sb.earthquakes.plot_records([quake], {quake.name: spectra})

# %%
# PGA and PGV are the peak ground acceleration and velocity; D5-95 is the time between 5
# % and 95 % of the Arias intensity.
measures = sb.records.intensity_measures(quake)
for axis in measures["axis"].values:
    one = measures.sel(axis=axis)
    print(
        f"{axis}: PGA {one.pga.item():.2f} m/s², PGV {one.pgv.item():.2f} m/s, "
        f"D5-95 {one.duration_5_95.item():.1f} s"
    )

# %%
# Step 3: describe the column
# ---------------------------
#
# A solid stone column, 3 m high and 0.7 m in diameter. Mass, centre of mass and moments
# of inertia follow from the shape and the density.
column = sb.Column.solid(radius=0.35, height=3.0, density=2700.0)
print(f"mass: {column.mass:.0f} kg")
print(f"slenderness c = r/h = {column.slenderness:.3f}")
print(f"tipping angle: {np.degrees(column.tipping_angle):.1f}°")

# %%
# The tipping angle is the tilt at which the centre of mass stands above the rim: beyond
# it gravity pulls the resting column over. Structural engineers' slenderness ratio is
# the inverse, h/r.
#
# An upright column starts to rock when the horizontal ground acceleration exceeds c g
# (if the vertical acceleration is small). Compare that with the record.
print(f"rocking starts above {column.slenderness * column.gravity:.2f} m/s²")
print(f"peak of the horizontal vector: {quake.peak_horizontal():.2f} m/s²")

# %%
# The record exceeds the threshold, so the column will rock. Whether it overturns needs
# a simulation.

# %%
# Step 4: choose the model and the damping
# ----------------------------------------
#
# :class:`stylobate.Wobbling` describes a column that rocks and rolls on its rim in
# three dimensions without turning about its own axis. It is the model for columns under
# earthquakes (:doc:`/getting-started/choose-a-model`). :class:`stylobate.Rolling` lets
# the column spin about its axis; step 9 compares the two.
#
# `damping` is the dimensionless damping parameter η. It states how quickly a rocking
# column loses energy. It is seldom measured, so one value is not enough.
# :doc:`/how-to/choose-damping` has a recipe, which for this column gives 0.05 to 0.21.
# This tutorial uses less, 0.03, so that the case is a close one; step 8 varies it.
model = sb.Wobbling(column, damping=0.03)

# %%
# Step 5: run, and read the verdict
# ---------------------------------
#
# The column starts upright and at rest. Without `duration`, the run continues after the
# end of the record, long enough for a column near its balance to decide.
run = sb.simulate(model, quake)
print(run.outcome.name)
print(run.reason)

# %%
# `SURVIVED` means: the column still rocked when the run ended, but its energy was too
# small to overturn. `AT_REST` also means that the column did not overturn. The other
# outcomes are explained in :doc:`Outcomes </explanation/outcomes>`.
#
# How far did the column tilt, when, and how much friction did its base need?
peak, time = run.measures["peak_tilt"], run.measures["time_of_peak_tilt"]
print(f"peak tilt: {np.degrees(peak):.1f}° at {time:.1f} s")
print(f"as a fraction of the tipping angle: {peak / column.tipping_angle:.2f}")
print(f"friction needed: {run.measures['peak_friction_demand']:.2f}")

# %%
# If the friction coefficient of the joint is below the last number, the base would
# slip, and you need :class:`stylobate.Sliding` instead.

# %%
# Step 6: plot the response
# -------------------------
#
# On the left, against time: the tilt angle θ, the azimuth β of the lean and the
# horizontal base acceleration. At the tilt c (dashed) the column would balance on its
# rim; above the acceleration c g (dashed) its edge lifts. On the right, the path of the
# tilt vector: the direction in which the column leans. This version of the record
# begins with 20 s of rest, so the column starts to rock late.
sb.plot(run)

# %%
# Step 7: find the margin
# -----------------------
#
# At which scale of the record does the column overturn? Do not stop at the first such
# scale: a column that overturns at one scale may survive a larger one.
# :func:`stylobate.earthquakes.overturning_intervals` finds all *overturning intervals*
# between the scales that you give, and refines their ends by bisection.
scales = np.linspace(0.5, 2.0, 31)
intervals = sb.earthquakes.overturning_intervals(
    model, quake, scales=scales, width=0.005
)
ends = zip(
    intervals["interval_from"].values, intervals["interval_to"].values, strict=True
)
for low, high in ends:
    reach = f"from {low:.3f} to {high:.3f}" if high - low > 0.001 else f"near {low:.3f}"
    print(f"overturns {reach} times the record")
sb.plot(intervals)

# %%
# The first interval begins a few percent above the recorded level: a small margin.
# Between a scale that overturns the column and the next one that does not lies an edge
# (grey), no wider than `width`: here 0.5 %. Above some intervals the column survives
# again (hatched). Such *survival above an overturning scale* is common in rocking: a
# stronger motion can bring the column back.

# %%
# Step 8: how surely does it stand?
# ---------------------------------
#
# One run answers for one set of numbers. :func:`stylobate.verdict` runs 300 small
# variations at once: of the record, the damping, the dimensions, the level of the base,
# the integration, and the contact law.
verdict = sb.verdict(model, quake)
print(verdict)
sb.plot(verdict)

# %%
# The case is *undecided*: this column survived the record in the run of step 5, but
# many variations that measurements cannot exclude overturn it. Report the printed line,
# not the run.
#
# Which variation decides? The right panel ranks them. The damping is the least certain
# number, so it varies from half to twice its value; a free-decay test narrows it.

# %%
# Step 9: does the contact law matter?
# ------------------------------------
#
# A column that stands on a point of its rim can also turn about its axis.
# :class:`stylobate.Wobbling` excludes this spin, :class:`stylobate.Rolling` allows it.
# Half of the variations used each of the two. Report both shares:
for law, share in verdict.share_by_model.items():
    print(f"{law}: {100.0 * share:.0f} % of the variations overturn")

# %%
# Step 10: a larger column of the same shape
# ------------------------------------------
#
# A large column needs longer pulses to overturn than a small one of the same shape.
# `size` multiplies all lengths at constant density.
sizes = np.geomspace(1.0, 4.0, 9)
larger = sb.earthquakes.overturning_intervals(
    model, quake, scales=scales, over={"size": sizes}, width=0.01
)
for place in (0, 4, 8):
    first = larger["interval_from"].isel(size=place).min().item()
    limit = "none up to 2" if np.isnan(first) else f"{first:.2f}"
    print(f"{3.0 * sizes[place]:4.1f} m high: smallest overturning scale {limit}")
sb.plot(larger)

# %%
# The figure shows the size 2R, twice the distance from the centre of mass to the rim:
# here 1.03 times the height. Larger columns of one shape are safer on average. For a
# single record there are exceptions, because each record overturns each column at its
# own scales.
#
# What you have learned
# ---------------------
#
# * A verdict is more than one run: state the share that overturns, its interval, and
#   the damping.
# * Survival is not monotonic in the scale: look at all overturning intervals.
# * One record is one sample. The next tutorial,
#   :doc:`plot_2_from_records_to_a_report`, runs several records and columns, and writes
#   a report.
