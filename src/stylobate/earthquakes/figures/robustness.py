"""Figure of robustness: verdicts that small changes flip, by record and change."""

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from stylobate.errors import Outcome
from stylobate.plots.cells import fill_options
from stylobate.plots.classes import OUTCOME_LOOKS, UNFINISHED, Look
from stylobate.plots.kinds import figure_of
from stylobate.plots.style import new_figure, styled
from stylobate.text import plural

_STATE = "overturning"
_LOOKS = {
    "survives, as given": OUTCOME_LOOKS[Outcome.AT_REST],
    "overturns, as given": OUTCOME_LOOKS[Outcome.OVERTURNED],
    "flips: now overturns": Look("#D55E00", "xx"),
    "flips: now survives": Look("#74C0EA", "////", "#333333"),
    "does not apply, or not known": UNFINISHED,
}
_ROW, _FRAME, _TALLEST = 0.19, 1.6, 9.0
# More columns than this have no names.
_NAMED = 24


@figure_of("robustness")
@styled
def plot_robustness(found: xr.Dataset) -> Figure:
    """Draw the verdicts on overturning, with a row for each change and a column for each record.

    The bars on the right count the records that a change flips; a star marks records that no change flips.
    """
    cells = _cells(found)
    changes, records = cells.shape
    figure = new_figure(min(_FRAME + _ROW * changes, _TALLEST))
    table, bars = figure.subplots(1, 2, sharey=True, width_ratios=(3.0, 1.0))
    _draw(table, cells)
    names = _columns(found)
    table.set_yticks(np.arange(changes), [str(name) for name in found["change"].to_numpy()])
    table.set(xlim=(-0.5, records - 0.5), ylim=(changes - 0.5, -0.5))
    if records <= _NAMED:
        table.set_xticks(np.arange(records), names, rotation=90 if records > 3 else 0)  # noqa: PLR2004
    else:
        table.set(xticks=[], xlabel=plural(records, "record"))
    table.grid(visible=False)
    flips = (cells == 2) | (cells == 3)  # noqa: PLR2004  places in _LOOKS
    bars.barh(np.arange(changes), flips.sum(axis=1), 0.75, color=_LOOKS["flips: now overturns"].colour)
    bars.set(xlabel="records with a flip", xlim=(0.0, max(1.0, 1.1 * flips.sum(axis=1).max())))
    bars.grid(visible=False, axis="y")
    bars.xaxis.get_major_locator().set_params(integer=True)
    standing = int(np.count_nonzero(~flips.any(axis=0)))
    table.set_title(f"{standing} of {records} verdicts stay under every change (*)")
    figure.legend(
        handles=[Patch(label=name, **fill_options(look)) for name, look in _LOOKS.items()],
        loc="outside lower center",
        ncols=3,
    )
    return figure


def _cells(found: xr.Dataset) -> npt.NDArray[np.integer]:
    """Return the index in _LOOKS for each change and column."""
    others = [dim for dim in found["outcome"].dims if dim != "change"]
    after = found["reached"].sel(limit_state=_STATE, drop=True)
    before = found["reached_as_given"].sel(limit_state=_STATE, drop=True).broadcast_like(after)
    then, now = (
        (one.stack(column=others) if others else one.expand_dims("column")).transpose("change", "column").to_numpy()
        for one in (state.drop_vars(list(state.coords)) for state in (before, after))
    )
    return np.select([(now < 0) | (then < 0), now > then, now < then], [4, 2, 3], default=then)


def _columns(found: xr.Dataset) -> list[str]:
    steady = found["repeatable"]
    names = [str(name) for name in np.atleast_1d(found["record"].to_numpy())]
    if "rotation" in steady.dims:
        turns = np.degrees(found["rotation"].to_numpy())
        names = [f"{name} {turn:g}°" for name in names for turn in turns]
    return [f"{name}{' *' if calm else ''}" for name, calm in zip(names, steady.to_numpy().ravel(), strict=True)]


def _draw(axes: Axes, cells: npt.NDArray[np.integer]) -> None:
    for (row, column), place in np.ndenumerate(cells):
        options = fill_options(list(_LOOKS.values())[place])
        axes.add_patch(Rectangle((column - 0.5, row - 0.5), 1.0, 1.0, **options))
    for edge in np.arange(-0.5, cells.shape[1]):
        axes.axvline(edge, color="white", linewidth=0.8)
    for edge in np.arange(-0.5, cells.shape[0]):
        axes.axhline(edge, color="white", linewidth=0.8)
