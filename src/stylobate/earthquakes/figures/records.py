"""Figures of records: accelerations over time, with response spectra."""

from collections.abc import Mapping, Sequence
from typing import Any

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from stylobate.base_motions import Record
from stylobate.base_motions.record import AXES
from stylobate.plots.base_motion import COMPONENT_LOOKS, draw_spectra
from stylobate.plots.labels import literal
from stylobate.plots.result_figure import WIDTH
from stylobate.plots.style import new_figure, styled

_HEIGHT_OF_RECORD = 2.1


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
    figure = new_figure(_HEIGHT_OF_RECORD * len(records) + 0.4, width=1.3 * WIDTH)
    grid = figure.subplots(len(records), 2, squeeze=False, width_ratios=(2, 1))
    for (left, right), record in zip(grid, records, strict=True):
        _history(left, record)
        draw_spectra(right, spectra[record.name])
    grid[-1][0].set_xlabel("time [s]")
    grid[-1][1].set_xlabel("period [s]")
    return figure


def _history(axes: Axes, record: Record) -> None:
    for axis in record.axes:
        place = AXES.index(axis)  # the vertical component lies behind
        look: dict[str, Any] = {"linewidth": 0.6, "zorder": 3.0 - place, "label": axis} | COMPONENT_LOOKS[place]
        axes.plot(record.times, record.samples[:, place], **look)
    axes.set_title(literal(record.name))
    axes.set_ylabel("acceleration [m/s²]")
    axes.legend(loc="upper right", ncols=3)
