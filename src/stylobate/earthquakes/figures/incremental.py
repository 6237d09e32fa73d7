"""Figures of incremental dynamic analyses: peak tilts over the intensity by record, and overturning."""

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from stylobate.errors import ParameterError
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import BLACK, GREY, PALETTE, STABLE_WIDTH, new_figure, styled
from stylobate.text import plural

Floats = npt.NDArray[np.float64]

_HEIGHT = 4.6
# Maximum number of records with a colour and a name; more are grey.
_NAMED = 6
_MARKS = "osD^vP"
# Height of the strip of overturned runs: frame, and row of each record [fractions of the panel of tilts].
_STRIP, _ROW = 0.06, 0.035
_MOST_ROWS = 24
_QUANTILES = (0.16, 0.5, 0.84)
# Intensities that differ by less than this fraction count as equal.
_ONE_LEVEL = 1e-6
_NUMBERS_TO_SPAN = 20.0


@figure_of("incremental dynamic analysis")
@styled
def plot_incremental(found: xr.Dataset) -> Figure:
    """Draw peak tilts over α_c against the intensity, with one line for each record and a strip of overturned runs.

    Lines end where the column overturns and continue where it survives again. The strip above shows the intensities at
    which each record overturned the column. If all records have the same intensities, the figure shows the median and,
    dashed, the 16 and 84 % quantiles; overturned runs count as above all tilts, so these lines end at overturning.

    Raises
    ------
    ParameterError
        If the runs have no dimension `scale`.
    """
    if "scale" not in found.dims:
        raise ParameterError(
            "found must have the dimension scale to be drawn over the intensity; take runs.isel(scale=[0])"
        )
    names, level, tilt = _series(found)
    order = list(dict.fromkeys(names))
    figure = new_figure(_HEIGHT)
    rows = min(len(order), _MOST_ROWS)
    strip, tilts = figure.subplots(2, 1, sharex=True, height_ratios=(_STRIP + _ROW * rows, 1.0))
    for name, *one in zip(names, level, tilt, strict=True):
        _draw(tilts, strip, *one, place=order.index(name), records=len(order))
    handles = _legend(order)
    drawn = _draw_quantiles(tilts, level, tilt)
    handles += drawn
    tilts.set(ylabel=r"peak tilt $\theta/\alpha_c$", ylim=(0.0, None))
    tilts.set_xlabel(axis_label(found["intensity"]))
    _axis_of(tilts, level)
    strip.set(ylim=(-0.7, len(order) - 0.3), yticks=[])
    strip.set_ylabel("over-\nturned", rotation=0, ha="right", va="center")
    strip.grid(visible=False)
    strip.set_title(_title(found, quantiles=bool(drawn)), fontsize="small")
    figure.legend(handles=handles, loc="outside right upper")
    return figure


def _series(found: xr.Dataset) -> tuple[list[str], Floats, Floats]:
    """Return the record of each series of runs, with its intensities and peak tilts over α_c: (series, scale)."""
    others = [dim for dim in found["tilt_ratio"].dims if dim != "scale"]
    tilt = found["tilt_ratio"].transpose(*others, "scale")
    level = found["intensity"].broadcast_like(tilt).transpose(*others, "scale")
    number = found.sizes["scale"]
    record = found["record"] if "record" in found.coords else xr.DataArray("record")
    record = xr.DataArray(record.to_numpy(), dims=record.dims)
    names = record.broadcast_like(tilt.isel(scale=0, drop=True).drop_vars(list(tilt.coords), errors="ignore"))
    listed = names.transpose(*others).to_numpy().ravel()
    return [str(name) for name in listed], level.to_numpy().reshape(-1, number), tilt.to_numpy().reshape(-1, number)


def _look(place: int, records: int) -> tuple[str, str, float]:
    """Return colour, mark and width of the lines of a record."""
    if records > _NAMED:
        return GREY, "o", 0.7
    return PALETTE[place % len(PALETTE)], _MARKS[place % len(_MARKS)], 1.3


def _draw(tilts: Axes, strip: Axes, level: Floats, tilt: Floats, *, place: int, records: int) -> None:
    colour, mark, width = _look(place, records)
    order = np.argsort(level)
    level, tilt = level[order], tilt[order]
    shown = np.where(np.isfinite(tilt), tilt, np.nan)
    tilts.plot(level, shown, color=colour, marker=mark, markersize=3.0, linewidth=width, alpha=0.9)
    fallen = np.isinf(tilt)
    row = records - 1 - place
    strip.plot(level[fallen], np.full(np.count_nonzero(fallen), row), "x", color=colour, markersize=3.5)
    back = ~fallen & (level > np.min(level, where=fallen, initial=np.inf)) & np.isfinite(tilt)
    strip.plot(level[back], np.full(np.count_nonzero(back), row), "o", color=colour, markersize=3.5, mfc="white")


def _draw_quantiles(axes: Axes, level: Floats, tilt: Floats) -> list[Line2D]:
    """Draw quantiles over the series at common intensities; return the legend entries, none without quantiles."""
    if len(level) < 3 or np.any(np.ptp(level, axis=0) > _ONE_LEVEL * level.max(axis=0)):  # noqa: PLR2004
        return []
    quantiles = _quantiles(tilt)
    for share, line in zip(_QUANTILES, quantiles, strict=True):
        shown = np.where(np.isfinite(line), line, np.nan)
        middle = share == _QUANTILES[1]
        axes.plot(
            level[0],
            shown,
            color=BLACK,
            dashes=(None, None) if middle else (4, 2),
            linewidth=STABLE_WIDTH if middle else 1.4,
            zorder=4,
        )
    return [
        Line2D([], [], color=BLACK, linewidth=STABLE_WIDTH, label="median"),
        Line2D([], [], color=BLACK, linewidth=1.4, linestyle="--", label="16 and 84 %"),
    ]


def _quantiles(tilt: Floats) -> Floats:
    """Compute quantiles over the first axis, with overturned runs above all; NaN where a run is undecided."""
    known = ~np.isnan(tilt).any(axis=0)
    found = np.quantile(np.where(known, tilt, 0.0), _QUANTILES, axis=0, method="inverted_cdf")
    return np.where(known, found, np.nan)


def _axis_of(axes: Axes, level: Floats) -> None:
    low, high = float(level.min()), float(level.max())
    if low > 0.0 and high / low > _NUMBERS_TO_SPAN:
        axes.set_xscale("log")


def _legend(names: list[str]) -> list[Line2D]:
    if len(names) > _NAMED:
        handles = [Line2D([], [], color=GREY, marker="o", markersize=3.0, linewidth=0.7, label=f"{len(names)} records")]
    else:
        looks = [_look(place, len(names)) for place in range(len(names))]
        handles = [
            Line2D([], [], color=colour, marker=mark, markersize=3.5, linewidth=width, label=name)
            for name, (colour, mark, width) in zip(names, looks, strict=True)
        ]
    handles.append(Line2D([], [], color=GREY, marker="x", markersize=4.0, linestyle="none", label="overturned"))
    again = Line2D(
        [], [], color=GREY, marker="o", mfc="white", markersize=4.0, linestyle="none", label="survives again"
    )
    return [*handles, again]


def _title(found: xr.Dataset, *, quantiles: bool) -> str:
    others = [plural(found.sizes[dim], str(dim).replace("_", " ")) for dim in found["tilt_ratio"].dims]
    note = f"runs: {', '.join(others)}"
    return note if quantiles else f"{note}; no quantiles: the records have different intensities"
