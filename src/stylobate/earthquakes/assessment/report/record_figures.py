"""Figures of the ground motions: components against time, and response spectra with the design spectrum."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from stylobate.column import STANDARD_GRAVITY
from stylobate.plots.labels import literal
from stylobate.plots.style import BLACK, GREY, PALETTE, VERMILION, new_figure, styled
from stylobate.results.assessment import Assessment

RECORDS_A_FIGURE = 6
"""Number of records in one figure of components."""
# Height of a row and of the frame [inches]; largest number of records that have a colour each.
_RECORD_ROW, _RECORD_FRAME, _COLOURED = 0.85, 0.75, 6


@styled
def records_figure(assessment: Assessment, records: Sequence[str]) -> Figure:
    """Draw the components of records against time, one row for each record."""
    own = assessment.data["ground_motions"]
    figure = new_figure(_RECORD_FRAME + _RECORD_ROW * len(records))
    grid = figure.subplots(len(records), 3, squeeze=False, sharey="row", sharex="row")
    for row, name in zip(grid, records, strict=True):
        one = own.sel(record=name)
        for axes, axis in zip(row, ("x", "y", "z"), strict=True):
            acceleration = one["acceleration"].sel(axis=axis) / STANDARD_GRAVITY
            axes.plot(one["time"], acceleration, color=BLACK, linewidth=0.4)
            if not bool((acceleration != 0.0).where(one["time"].notnull()).any()):
                axes.text(0.5, 0.6, "none", transform=axes.transAxes, color=GREY, ha="center", fontsize="small")
            axes.tick_params(labelsize=7.5)
        row[0].set_title(name, fontsize="small", pad=2.0)
    for axes, title in zip(grid[-1], ("along x", "along y", "up"), strict=True):
        axes.set_xlabel(f"{title}: time [s]", fontsize="small")
    figure.supylabel("ground acceleration [g]", fontsize="small")
    return figure


@styled
def spectra_figure(assessment: Assessment) -> Figure:
    """Draw the response spectra of the records, their mean, and the design spectrum if it is given."""
    own = assessment.data["spectra"]["spectral_acceleration"].transpose("record", "period") / STANDARD_GRAVITY
    period = own["period"].to_numpy()
    figure = new_figure(3.3)
    axes = figure.subplots()
    few = own.sizes["record"] <= _COLOURED
    for place, name in enumerate(own["record"].to_numpy()):
        look = {"color": PALETTE[place], "label": str(name)} if few else {"color": GREY, "alpha": 0.6}
        axes.plot(period, own.sel(record=name), linewidth=0.9, **look)
    if own.sizes["record"] > 1:
        axes.plot(period, own.mean("record"), color=BLACK, linewidth=2.2, label="mean of the records")
    design = assessment.setting.get("details", {}).get("design_spectrum")
    if design:
        axes.plot(
            design["period"],
            np.array(design["acceleration"]) / STANDARD_GRAVITY,
            color=VERMILION,
            linestyle="--",
            linewidth=2.2,
            label=literal(str(design["name"])),
        )
    axes.set(xlim=(0.0, float(period[-1])), ylim=(0.0, None), xlabel="natural period [s]", ylabel="Sa [g]")
    axes.legend(loc="upper right", fontsize="small")
    axes.set_title("Response spectra, 5 % damping, records as recorded (scale 1)")
    return figure
