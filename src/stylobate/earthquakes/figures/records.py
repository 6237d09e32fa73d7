"""Figures of records: accelerations over time, with response spectra."""

from collections.abc import Mapping, Sequence

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from stylobate.base_motions import Record
from stylobate.base_motions.records.record import AXES
from stylobate.plots.labels import literal
from stylobate.plots.style import BLACK, BLUE, GREY, VERMILION, WIDTH, new_figure, styled

_COLOURS = dict(zip(AXES, (BLUE, VERMILION, GREY), strict=True))
_HEIGHT = 2.1


@styled
def plot_records(records: Sequence[Record], spectra: Mapping[str, xr.Dataset]) -> Figure:
    """Draw each record in a row: accelerations over time on the left, response spectra on the right.

    Parameters
    ----------
    records
        Records with nonzero acceleration.
    spectra
        Spectra from `response_spectra`, by name of the record.
    """
    figure = new_figure(_HEIGHT * len(records) + 0.4, width=1.3 * WIDTH)
    grid = figure.subplots(len(records), 2, squeeze=False, width_ratios=(2, 1))
    for (left, right), record in zip(grid, records, strict=True):
        _history(left, record)
        _spectrum(right, spectra[record.name])
    grid[-1][0].set_xlabel("time [s]")
    grid[-1][1].set_xlabel("period [s]")
    return figure


def _history(axes: Axes, record: Record) -> None:
    for axis in record.axes:
        place = AXES.index(axis)  # the vertical component lies behind
        axes.plot(
            record.times, record.samples[:, place], color=_COLOURS[axis], linewidth=0.6, zorder=3.0 - place, label=axis
        )
    axes.set_title(literal(record.name))
    axes.set_ylabel("acceleration [m/s²]")
    axes.legend(loc="upper right", ncols=3)


def _spectrum(axes: Axes, spectra: xr.Dataset) -> None:
    for axis in spectra["axis"].to_numpy().tolist():
        axes.loglog(spectra["period"], spectra["psa"].sel(axis=axis), color=_COLOURS[axis], linewidth=1.0, label=axis)
    if "rotd50" in spectra:
        axes.loglog(spectra["period"], spectra["rotd50"], color=BLACK, linewidth=1.4, label="RotD50")
    for one in (axes.xaxis, axes.yaxis):
        one.set_major_formatter("{x:g}")
        one.set_minor_formatter(NullFormatter())
    axes.set_title(f"{100.0 * spectra.attrs['damping']:g} % damping")
    axes.set_ylabel("PSA [m/s²]")
    axes.legend(loc="lower left", ncols=2)
