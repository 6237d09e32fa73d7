"""
From a set of records to a report: incremental analysis, fragility, assessment
==============================================================================

One record gives one answer. An assessment needs several records, several damping
values, and a document that others can check. This tutorial takes two columns and a
small set of ground motions. It leads to fragility curves, an annual rate of
overturning, and a report. It continues :doc:`plot_1_column_in_an_earthquake`.
"""

# %%
# Step 1: collect ground motions
# ------------------------------
#
# With recorded ground motions at hand, read them: ``sb.read_records("records/*.AT2")``.
# Here twenty *synthetic ground motions* take their place.
# :class:`stylobate.records.EvolvingNoise` draws them from a stochastic model. Its
# parameters are quantities that an engineer reads from an accelerogram: Arias intensity
# [m/s], significant duration and middle of the strong shaking [s], the predominant
# frequency [Hz] with its rate of change, and the bandwidth.
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import stylobate as sb

source = sb.records.EvolvingNoise(
    arias=1.2,
    duration_5_95=8.0,
    middle_time=5.0,
    frequency=2.5,
    frequency_rate=-0.1,
    bandwidth=0.3,
)
quakes = {}
for number in range(1, 21):
    rng, name = np.random.default_rng(number), f"synthetic {number}"
    whole = source.record(rng, components=2, step=0.02, name=name)
    quakes[name] = whole.trimmed(0.0, 14.0)

# %%
# Each random seed gives one record with two horizontal components. Plot two of them
# with their response spectra.
shown = list(quakes.values())[:2]
periods = np.geomspace(0.05, 5.0, 60)
spectra = {one.name: sb.records.response_spectra(one, periods) for one in shown}
sb.earthquakes.plot_records(shown, spectra)

# %%
# Step 2: describe the columns
# ----------------------------
#
# Two solid stone columns of one height. Their damping is not measured. So the study
# starts from *Housner's damping*, which loses as much energy per cycle as the impacts
# of a planar block, and step 6 adds half and twice as much. This is the recipe of
# :doc:`/how-to/choose-damping`.
slim = sb.Column.solid(radius=0.35, height=3.0, density=2700.0)
stout = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
for name, column in (("slim", slim), ("stout", stout)):
    threshold = column.slenderness * column.gravity
    print(
        f"{name}: c = r/h = {column.slenderness:.3f}, rocks above {threshold:.2f} m/s²,"
        f" Housner's damping {column.housner_damping():.3f}"
    )

# %%
# Step 3: incremental dynamic analysis
# ------------------------------------
#
# Run the slim column under every record at every scale. The result has the dimensions
# `record` and `scale`, and the peak tilt of each run over the tipping angle.
model = sb.Wobbling(slim, damping=slim.housner_damping())
runs = sb.earthquakes.incremental_dynamic_analysis(
    model, quakes, scales=np.geomspace(0.6, 2.4, 15)
)
sb.plot(runs)

# %%
# Each grey line is one record. In the upper panel, crosses are runs that overturned.
# Circles are runs that survived above a scale that overturned: the record is
# *non-monotonic*. Count these records.
overturned = runs["reached"].sel(limit_state="overturning")
intervals = sb.earthquakes.reached_intervals(runs["intensity"], overturned)
count = int((~intervals["monotone"]).sum())
print(f"{count} of {runs.sizes['record']} records are non-monotonic at these scales")

# %%
# Step 4: fit fragility curves
# ----------------------------
#
# A fragility curve states the probability of a limit state against the intensity of the
# ground motion, here the peak ground acceleration (RotD50). It is lognormal: the median
# and the dispersion define it. The runs of one record are not independent, so the
# intervals come from a bootstrap over records (`resamples`).
fits = sb.earthquakes.fragility_of_runs(
    runs, resamples=300, rng=np.random.default_rng(1)
)
for state in ("tilt 0.5 α", "overturning"):
    one = fits.sel(limit_state=state)
    print(
        f"{state}: median {one['median'].item():.2f} m/s² "
        f"({one['median_low'].item():.2f} to {one['median_high'].item():.2f}), "
        f"dispersion {one['dispersion'].item():.2f} "
        f"({one['dispersion_low'].item():.2f} to {one['dispersion_high'].item():.2f})"
    )
sb.plot(fits.sel(limit_state=["tilt 0.5 α", "overturning"]))

# %%
# Step 5: the annual rate of overturning
# --------------------------------------
#
# Combine the fragility with the hazard curve of a site: the annual rate at which each
# intensity is exceeded. The curve below is an example, not a real site. Its intensity
# measure and its definition of the horizontal component must be those of the fragility.
hazard = sb.earthquakes.HazardCurve(
    intensity=[0.5, 1.0, 2.0, 4.0, 8.0],
    rate=[3e-2, 1e-2, 2.2e-3, 3e-4, 2.5e-5],
    units="m s-2",
    quantity="peak ground acceleration",
    component="RotD50",
)
rates = sb.earthquakes.annual_rate(fits.sel(limit_state="overturning"), hazard)
print(f"annual rate of overturning: {rates['annual_rate'].item():.1e} per year")
print(f"probability in 50 years: {100 * rates['probability'].item():.1f} %")

# %%
# Step 6: write a study file
# --------------------------
#
# For a report, describe the study in one TOML file. It needs two inputs that no record
# contains: the friction coefficient of the contact, and the damping at three levels. To
# keep this tutorial short, the study has three records: El Centro 1940, which comes
# with the package, and two of the synthetic ones as AT2 files.
folder = Path(tempfile.mkdtemp())
(folder / "records").mkdir()
for number in (1, 3):
    for axis in ("x", "y"):
        path = folder / "records" / f"synthetic{number}_{axis}.AT2"
        sb.records.write_at2(quakes[f"synthetic {number}"], path, axis=axis)

study = folder / "study.toml"
study.write_text(
    """
title = "Two columns under three records"
friction_coefficient = 0.6
planar = false              # no comparison with a planar block
variations = 100            # small variations of each verdict; 200 by default

[columns."slim column"]
shape = "solid"
radius = 0.35
height = 3.0
density = 2700.0

[columns."stout column"]
shape = "solid"
radius = 0.5
height = 3.0
density = 2700.0

[dissipation."slim column"]
low = {damping = 0.05}
central = {damping = "housner"}
high = {damping = 0.2}

[dissipation."stout column"]
low = {damping = 0.1}
central = {damping = "housner"}
high = {damping = 0.4}

[records]
source = "records/*.AT2"
samples = ["el centro 1940 corrected"]

[margin]
from = 0.4
to = 4.0
number = 16
""",
    encoding="utf-8",
)

# %%
# Step 7: assess the columns
# --------------------------
#
# On the command line, one command reads this file and writes the report:
#
# .. code-block:: console
#
#    $ stylobate assess study.toml
#
# In Python the same takes three statements.
config = sb.earthquakes.AssessConfig.parse(sb.config.read_config(study))
setup = config.build()
found = sb.earthquakes.assess(setup.columns, setup.records, **setup.options)

# %%
# The report is one HTML page that needs no other file and no network; with `pdf=True`
# (`--pdf`) it is also a PDF. Beside it are tables (CSV, xlsx), figures (PNG), a
# summary, and all numbers (`assessment.nc`).
report = sb.earthquakes.assessment_report(found, folder / "study-assessment")
for path in sorted(report.parent.iterdir()):
    print(path.name)

# %%
# Step 8: read the report
# -----------------------
#
# The report begins with the answer: a verdict per column, and the probability that a
# record of this kind overturns it. The summary has the same lines.
summary = (report.parent / "summary.txt").read_text(encoding="utf-8")
print("\n".join(line for line in summary.splitlines() if "column: " in line))

# %%
# "NOT shown safe" means that at least one record overturned the column at one of the
# stated damping values. The other classes are "Survival NOT robust", "Survived every
# run" and "Not described by these runs". Then come the tables. This one lists the
# verdict for each record at each level of damping.
table = sb.earthquakes.assessment_tables(found)["verdicts-by-record"]
for row in (table.header, *table.rows):
    print(" | ".join(row))

# %%
# None of these runs overturned a column. Yet the survival of the slim column is not
# robust: at scales within 10 % of the recorded level it overturned. A table of single
# runs would not show this.

# %%
# Three figures. The first page of the report shows the columns to scale, each with the
# record that governs it. The second figure shows all overturning intervals of the scale
# for the slim column, for each record and each damping value.
figures = report.parent / "figures"


def show(path):
    """Draw a saved figure again, without axes."""
    image = plt.imread(path)
    height, width = image.shape[:2]
    axes = plt.figure(figsize=(width / 180, height / 180)).add_axes((0, 0, 1, 1))
    axes.imshow(image)
    axes.set_axis_off()


show(figures / "objects-1.png")
show(figures / "margins-1.png")

# %%
# The third shows the share of small variations that overturn the column at the
# recorded level, and the share of the scales within 10 % that do so. Between the dashed
# limits a case is undecided, even if the central run survived.
show(figures / "variations-1-scale-1.png")

# %%
# The report also contains the ground motions and their spectra, the contact demand (the
# friction that the runs needed against the stated coefficient), the assumptions, and
# what the study does not cover.
#
# Where to go next
# ----------------
#
# * :doc:`/how-to/assess` explains each line of the study file and each part of the
#   report. With twenty records or more, the report also contains fragility curves.
# * :doc:`/how-to/scaled-records` and :doc:`/how-to/fragility` explain steps 3 to 5.
# * :doc:`/results/earthquakes` shows what larger samples of records showed.
