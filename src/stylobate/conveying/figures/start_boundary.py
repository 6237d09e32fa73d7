"""Figure of the onset of motion over slenderness."""

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from stylobate.errors import Outcome, ParameterError
from stylobate.plots.cells import KIND_LOOKS, OUTCOME_LOOKS, Look, fill_options
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    PURPLE,
    STABLE_WIDTH,
    UNSTABLE_WIDTH,
    VERMILION,
    new_figure,
    styled,
)

_HEIGHT = 4.4
_DASHED = (0, (4, 2))
# Maximum number of frictions and of panels.
_COLOURS, _MOST = (BLUE, VERMILION, GREEN, PURPLE), 4
# End of the axis over the largest threshold other than lift-off.
_ROOM = 1.25

_STAYS, _SLIDES, _ROCKS = OUTCOME_LOOKS[Outcome.AT_REST], OUTCOME_LOOKS[Outcome.SLID], KIND_LOOKS["rocking"]
_REGIONS: dict[str, Look] = {"stays": _STAYS, "slides": _SLIDES, "rocks": _ROCKS}


@figure_of("start boundary")
@styled
def plot_start_boundary(found: xr.Dataset) -> Figure:
    """Draw the onset of motion over slenderness, with one panel for each vertical ratio and incline.

    The black line is the onset of rocking, coloured lines are the onset of sliding for each friction coefficient. A
    line is bold if its motion begins first, otherwise thin and dashed. With one coefficient the regions are filled. A
    dash-dotted line, if in range, is the acceleration at which the normal force vanishes.

    Raises
    ------
    ParameterError
        If there are more than four friction coefficients or panels. Choose some by `found.sel`.
    """
    chosen = [name for name in ("friction_coefficient", "vertical_ratio", "incline") if name not in found.dims]
    found = found.expand_dims(chosen)
    cases = found.stack(case=("vertical_ratio", "incline"))
    if cases.sizes["case"] > _MOST or cases.sizes["friction_coefficient"] > _MOST:
        raise ParameterError(
            f"a figure of the start of motion has up to {_MOST} frictions, and {_MOST} panels for ratios and inclines; "
            f"got {cases.sizes['friction_coefficient']} and {cases.sizes['case']}: choose some by found.sel(...)"
        )
    figure = new_figure(_HEIGHT)
    panels = figure.subplots(1, cases.sizes["case"], sharex=True, sharey=True, squeeze=False)[0]
    for place, axes in enumerate(panels):
        _draw(axes, cases.isel(case=place).sortby("slenderness"))
        axes.set_title(_name(cases.isel(case=place), found), fontsize="small")
        axes.set_xlabel(axis_label(found["slenderness"]))
    panels[0].set_ylabel(axis_label(found["acceleration"], "acceleration of the base"))
    panels[0].set_xlim(float(found["slenderness"].min()), float(found["slenderness"].max()))
    panels[0].set_ylim(0.0, _top(found))
    figure.legend(handles=_legend(found), loc="outside lower center", ncols=3)
    return figure


def _draw(axes: Axes, case: xr.Dataset) -> None:
    c = case["slenderness"].to_numpy()
    frictions = case["friction_coefficient"].to_numpy()
    if frictions.size == 1:
        _fill(axes, case.isel(friction_coefficient=0))
    slips = case["slide"].to_numpy() < case["rock"].to_numpy()  # (slenderness, friction)
    _line(axes, c, case["rock"].isel(friction_coefficient=0).to_numpy(), ~np.all(slips, axis=1), BLACK)
    for index, colour in enumerate(_COLOURS[: frictions.size]):
        _line(axes, c, case["slide"].isel(friction_coefficient=index).to_numpy(), slips[:, index], colour)
    lift = case["lift_off"].isel(friction_coefficient=0).to_numpy()
    axes.plot(c, np.where(np.isfinite(lift), lift, np.nan), color=GREY, linestyle="-.", linewidth=1.2)


def _line(axes: Axes, c: np.ndarray, threshold: np.ndarray, first: npt.ArrayLike, colour: str) -> None:
    shown = np.where(np.isfinite(threshold), threshold, np.nan)
    axes.plot(c, shown, color=colour, linewidth=UNSTABLE_WIDTH, linestyle=_DASHED)
    axes.plot(c, np.where(np.asarray(first), shown, np.nan), color=colour, linewidth=STABLE_WIDTH)


def _fill(axes: Axes, case: xr.Dataset) -> None:
    c, least, slides = (case[name].to_numpy() for name in ("slenderness", "acceleration", "slide"))
    rocks, top = case["rock"].to_numpy(), 10.0 * np.nanmax(np.where(np.isfinite(least), least, 0.0))
    least = np.minimum(least, top)
    axes.fill_between(c, 0.0, least, **fill_options(_STAYS))
    inside = slides < rocks
    # The regions meet between two samples: each region extends to the first sample of the next.
    touching = inside | np.append(inside[1:], False) | np.append(False, inside[:-1])
    for where, look in ((touching, _SLIDES), (~inside, _ROCKS)):
        axes.fill_between(c, least, top, where=where, **fill_options(look))
    axes.grid(visible=False)


def _top(found: xr.Dataset) -> float:
    held = np.minimum(found["slide"].to_numpy(), found["rock"].to_numpy())
    return _ROOM * float(held[np.isfinite(held)].max())


def _name(case: xr.Dataset, found: xr.Dataset) -> str:
    lines = []
    ratio, incline = float(case["vertical_ratio"]), float(case["incline"])
    if found.sizes["vertical_ratio"] > 1 or ratio != 0.0:
        lines.append(f"vertical / horizontal {ratio:.3g}")
    if found.sizes["incline"] > 1 or incline != 0.0:
        lines.append(f"incline {incline:.3g} rad")
    return "\n".join(lines)


def _legend(found: xr.Dataset) -> list[Line2D | Patch]:
    frictions = found["friction_coefficient"].to_numpy()
    entries: list[Line2D | Patch] = [Line2D([], [], color=BLACK, linewidth=STABLE_WIDTH, label="begins to rock")]
    entries += [
        Line2D([], [], color=colour, linewidth=STABLE_WIDTH, label=rf"begins to slide, $\mu$ = {friction:.3g}")
        for friction, colour in zip(frictions, _COLOURS, strict=False)
    ]
    if (found["lift_off"] < _top(found)).any():
        entries.append(Line2D([], [], color=GREY, linestyle="-.", linewidth=1.2, label="is lifted"))
    entries.append(
        Line2D([], [], color=BLACK, linewidth=UNSTABLE_WIDTH, linestyle=_DASHED, label="not the first motion")
    )
    if frictions.size == 1:
        entries += [Patch(label=name, **fill_options(look)) for name, look in _REGIONS.items()]
    return entries
