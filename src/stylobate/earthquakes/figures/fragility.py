"""Figures of fragility: curves with observed fractions, annual rates; and of verdicts under small variations."""

import textwrap
from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from stylobate.plots.cells import ink_on
from stylobate.plots.kinds import figure_of
from stylobate.plots.labels import axis_label
from stylobate.plots.result_figure import heading
from stylobate.plots.style import (
    AS_DRAWN,
    BLACK,
    BLUE,
    DASHES,
    GREY,
    ORANGE,
    PALETTE,
    SKY,
    VERMILION,
    new_figure,
    styled,
)
from stylobate.results.verdict import CONTACT_LAW, KIND, LABELS, Verdict, percent

_HEIGHT = 4.2
_RATE_HEIGHT = 5.2
_MARKS = ("o", "s", "^", "D", "v", "P", "X")
_BAND = 0.18
# Height of the row of a record in the figure of intervals, and of the rest of that figure [inches].
_ROW, _FRAME = 0.17, 1.5
_TALLEST = 7.5
_BAR = 0.72
# Maximum number of characters in a line of a legend.
_LEGEND = 30
# Factor between the points of several limit states at one intensity.
_APART = 1.012


@figure_of("fragility")
@styled
def plot_fragility(found: xr.Dataset) -> Figure:
    """Draw fragility curves with their confidence bands and the observed fractions.

    Curves end where the data end. Points are fractions of the runs at an intensity, or near it, with Wilson intervals;
    the points of several limit states are slightly offset. A limit state without a fit has points, and the legend gives
    the reason. The title states the number of records that survive above an intensity that reached the limit state,
    and the counting of their runs.
    """
    figure = new_figure(_HEIGHT)
    axes = figure.subplots()
    handles = [_draw_state(axes, found.isel(limit_state=place), place) for place in range(found.sizes["limit_state"])]
    if "stripe_share" in found:
        look: dict[str, Any] = {"color": GREY, "marker": "|", "markersize": 9, "linestyle": "none"}
        percent = 100.0 * float(found.attrs["confidence"])
        handles.append(Line2D([], [], **look, label=f"{percent:g} % intervals"))
    if not np.isfinite(axes.dataLim.minposx):  # no run is decided: without data, an axis has no logarithm
        axes.set_xlim(0.1, 10.0)
    axes.set(xscale="log", ylim=(-0.02, 1.02), ylabel="probability of reaching the limit state")
    axes.set_xlabel(axis_label(found["curve_intensity"]))
    _plain_ticks(axes)
    axes.set_title("\n".join(_title_lines(found)))
    figure.legend(handles=handles, loc="outside right upper")
    return figure


def _draw_state(axes: Axes, state: xr.Dataset, place: int) -> Line2D:
    """Draw one limit state and return its entry in the legend."""
    colour, mark = PALETTE[place % len(PALETTE)], _MARKS[place % len(_MARKS)]
    dash: Any = DASHES[place % len(DASHES)]
    x = state["curve_intensity"].to_numpy()
    axes.plot(x, state["probability"].to_numpy(), color=colour, linestyle=dash, linewidth=1.8)
    if "probability_low" in state:
        low, high = (state[name].to_numpy() for name in ("probability_low", "probability_high"))
        axes.fill_between(x, low, high, color=colour, alpha=_BAND, linewidth=0.0)
    if "stripe_share" not in state:
        mark = ""
    else:
        share = state["stripe_share"].to_numpy()
        spread = [
            share - state["stripe_share_low"].to_numpy(),
            state["stripe_share_high"].to_numpy() - share,
        ]
        axes.errorbar(
            state["stripe_intensity"].to_numpy() * _APART**place,
            share,
            yerr=np.maximum(spread, 0.0),
            fmt=mark,
            markersize=4.0,
            color=colour,
            mfc="white",
            elinewidth=0.9,
            capsize=0.0,
            zorder=3,
        )
    fitted = bool(np.isfinite(state["median"]))
    return Line2D(
        [],
        [],
        color=colour,
        linestyle=dash if fitted else "none",
        marker=mark,
        markersize=4.0,
        mfc="white",
        label=_named(state, fitted=fitted),
    )


def _named(state: xr.Dataset, *, fitted: bool) -> str:
    name = str(state["limit_state"].item()).replace("α", r"$\alpha_c$")
    unit = axis_label(state["median"]).partition("[")[2].rstrip("]")
    if fitted:
        median = f"{name}\nmedian {state['median'].item():.3g} {unit}".rstrip()
        return rf"{median}, $\beta_f$ = {state['dispersion'].item():.2g}"
    meanings = str(state["status"].attrs["flag_meanings"]).split()
    reason = meanings[int(state["status"])].lower().replace("_", " ")
    low, high = (state[f"median_{side}"].item() for side in ("low", "high"))
    return f"{name}\nno fit: {reason}\nmedian {_between(low, high)} {unit}".rstrip()


def _between(low: float, high: float) -> str:
    if low > 0.0 and np.isfinite(high):
        return f"from {low:.3g} to {high:.3g}"
    if low > 0.0:
        return f"above {low:.3g}"
    return f"below {high:.3g}" if np.isfinite(high) else "open"


def _title_lines(found: xr.Dataset) -> list[str]:
    """Return the lines of the title: method of the intervals, and number of records that are not monotonic."""
    lines = []
    if "confidence" in found.attrs and np.isfinite(found["median"]).any():
        lines.append(f"band: {found.attrs['band']}")
    worst = int(found["non_monotone_records"].max()) if "non_monotone_records" in found else 0
    if worst > 0:
        lines.append(f"not monotonic: {worst} of {found.attrs['records']} records survive a higher scale,")
        lines.append(f"runs counted {found.attrs['counting']}")
    return lines


# Multiples of powers of ten at which there are ticks, for axes whose ends have less than this ratio.
_TICKS = ((20.0, (1.0, 2.0, 3.0, 5.0)), (300.0, (1.0, 2.0, 5.0)))


def _plain_ticks(axes: Axes) -> None:
    """Write intensities as plain numbers; shorter axes have more ticks in each decade."""
    low, high = axes.get_xlim()
    subs = next((subs for ratio, subs in _TICKS if high / low < ratio), (1.0,))
    axes.xaxis.set_major_locator(LogLocator(subs=subs))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.xaxis.set_minor_formatter(NullFormatter())


@figure_of("annual rate")
@styled
def plot_annual_rate(found: xr.Dataset) -> Figure:
    """Draw the hazard curve, and below it the contribution of each intensity to the annual rate.

    Contributions are fractions of the rate of their limit state, over the logarithm of the intensity, so that areas are
    fractions. Vertical lines are the medians of the fragilities. The legend states the fraction beyond the curve.
    """
    return _draw_rates(found, _rate_of)


@figure_of("empirical annual rate")
@styled
def plot_empirical_rate(found: xr.Dataset) -> Figure:
    """Draw the hazard curve, and below it the contribution of each intensity to the annual rate counted from runs.

    Contributions are drawn as in the figure of an annual rate. The legend states the rate with its interval over
    records, and the fraction above the highest intensity of the runs.
    """
    return _draw_rates(found, _counted_rate_of)


def _draw_rates(found: xr.Dataset, label: Callable[[xr.Dataset, float], str]) -> Figure:
    """Draw a hazard curve with the medians, if there are any, and the contributions to the annual rates."""
    figure = new_figure(_RATE_HEIGHT)
    above, below = figure.subplots(2, 1, sharex=True)
    curve = found.isel(limit_state=0)
    above.plot(curve["hazard_intensity"], curve["hazard_rate"], color=BLACK, marker="o", markersize=3.5)
    above.set(xscale="log", yscale="log", ylabel="annual rate\nof exceedance [1/a]")
    handles = []
    for place in range(found.sizes["limit_state"]):
        state = found.isel(limit_state=place)
        colour = PALETTE[place % len(PALETTE)]
        dash: Any = DASHES[place % len(DASHES)]
        rate, edges = state["annual_rate"].item(), np.append(state["bin_from"], state["bin_to"][-1:])
        if rate > 0.0:
            share = state["contribution"].to_numpy() / rate / np.diff(np.log(edges))
            below.stairs(share, edges, color=colour, linestyle=dash, linewidth=1.6)
        if "median" in state:
            above.axvline(state["median"].item(), color=colour, linestyle=dash, linewidth=1.2)
        handles.append(Line2D([], [], color=colour, linestyle=dash, label=label(state, found.attrs["years"])))
    below.set_ylabel("share of the annual rate,\nfor each factor e of intensity")
    below.set_ylim(bottom=0.0)
    below.set_xlabel(axis_label(found["bin_intensity"]))
    _plain_ticks(below)
    figure.legend(handles=handles, loc="outside right upper")
    return figure


def _rate_of(state: xr.Dataset, years: float) -> str:
    name = str(state["limit_state"].item()).replace("α", r"$\alpha_c$")
    rate, low, high = (state[key].item() for key in ("annual_rate", "rate_low", "rate_high"))
    if not np.isfinite(rate):
        return f"{name}\nno fit"
    bounds = f"bounds {low:.2e} to {high:.2e}"
    if why := str(state["withheld_reason"].item()):
        reason = textwrap.fill(f"withheld: {why}", _LEGEND)
        return f"{name}\n{reason}\n{bounds}"
    return (
        f"{name}\n{rate:.2e} /a, {100.0 * state['probability'].item():.2g} % in {years:g} a\n"
        f"{bounds}\n{100.0 * state['share_beyond'].item():.2g} % from beyond the curve"
    )


def _counted_rate_of(state: xr.Dataset, years: float) -> str:
    name = str(state["limit_state"].item()).replace("α", r"$\alpha_c$")
    rate, low, high = (state[key].item() for key in ("annual_rate", "rate_low", "rate_high"))
    if not rate > 0.0:
        return f"{name}\n{'not reached' if rate == 0.0 else 'no run known'}"
    interval = f"\n{100.0 * state.attrs['confidence']:g} %: {low:.2e} to {high:.2e}" if np.isfinite(low) else ""
    above = 100.0 * state["rate_above"].item() / rate
    chance = f"{100.0 * state['probability'].item():.2g} % in {years:g} a"
    return f"{name}\n{rate:.2e} /a, {chance}{interval}\n{above:.2g} % from above the runs"


@figure_of("reached intervals")
@styled
def plot_reached_intervals(found: xr.Dataset) -> Figure:
    """Draw the intervals of each record: survival, limit state reached, and survival above it.

    Records are sorted by the smallest scale that reached the limit state. A star marks records that are not monotonic;
    a figure of many records names only these. Gaps between intervals contain no runs.
    """
    rows = found.sizes["record"]
    figure = new_figure(_FRAME + min(_ROW * rows, _TALLEST))
    axes = figure.subplots()
    first = found["first_reached"].to_numpy()
    order = np.argsort(np.where(np.isnan(first), np.inf, first), kind="stable")
    height = np.empty(rows)
    height[order] = np.arange(rows)
    owner = found["interval_record"].to_numpy()
    reached = found["interval_reached"].to_numpy()
    low, high = found["interval_from"].to_numpy(), found["interval_to"].to_numpy()
    kinds = {
        "survives": (~reached & ~(low > first[owner]), SKY, "", "o"),
        "reached": (reached, VERMILION, "", "s"),
        "survives again": (~reached & (low > first[owner]), BLUE, "////", "D"),
    }
    legend: list[Patch] = []
    for name, (chosen, colour, hatch, mark) in kinds.items():
        if not chosen.any():
            continue
        look: dict[str, Any] = {"facecolor": colour, "hatch": hatch, "edgecolor": "white"}
        axes.barh(height[owner[chosen]], (high - low)[chosen], _BAR, left=low[chosen], linewidth=0.0, **look)
        # An interval of one scale has no length.
        single = chosen & (high == low)
        axes.plot(low[single], height[owner[single]], linestyle="none", marker=mark, markersize=3.5, color=colour)
        legend.append(Patch(label=name, **look))
    names, monotone = found["record"].to_numpy()[order], found["monotone"].to_numpy()[order]
    named = np.flatnonzero(~monotone | (_ROW * rows <= _TALLEST))
    axes.set_yticks(named, [f"{names[row]}{'' if monotone[row] else ' *'}" for row in named])
    axes.set(ylim=(-0.7, rows - 0.3), ylabel="record", xscale="log")
    axes.set_xlabel(axis_label(found["interval_from"]))
    _plain_ticks(axes)
    axes.grid(visible=False, axis="y")
    share = 100.0 * float(found.attrs["non_monotone_share"])
    axes.set_title(f"{found.attrs['limit_state']}: {share:.0f} % of {rows} records survive again at a higher scale (*)")
    figure.legend(handles=legend, loc="outside right upper")
    return figure


_SHARES = LinearSegmentedColormap.from_list("share", [BLUE, "#f4f4f4", VERMILION])
_LAWS = (BLUE, ORANGE)
_HATCHES = ("", "////")
_BINS = np.linspace(0.0, 1.25, 26)
_FALLEN_AT, _FALLEN_WIDTH = 1.32, 0.1
"""Place of the bar of overturned runs on the axis of the peak tilt over α_c."""


@figure_of(KIND)
@styled
def plot_verdict(found: xr.Dataset) -> Figure:
    """Draw the peak tilts by contact law, and the share of overturning from low to high values of each variation."""
    figure = new_figure(1.6 + 0.24 * max(found.sizes["variation"], 8))
    tilts, shares = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
    _draw_tilts(tilts, found)
    _draw_shares(shares, found)
    heading(figure, str(Verdict(found)))
    return figure


def _draw_tilts(axes: Axes, found: xr.Dataset) -> None:
    names = [str(name) for name in found["model"].to_numpy()]
    law, ratio, state = (found[name].to_numpy() for name in ("law", "tilt_ratio", "overturned"))
    below, stacked = 0, np.zeros(_BINS.size - 1)
    for place, name in enumerate(names):
        look: dict[str, Any] = {
            "color": _LAWS[place % 2],
            "hatch": _HATCHES[place % 2],
            "edgecolor": "white",
            "linewidth": 0.4,
            "align": "edge",
        }
        heights = np.histogram(np.clip(ratio[(law == place) & (state == 0)], 0.0, _BINS[-1]), _BINS)[0]
        fallen = int(((law == place) & (state == 1)).sum())
        share = percent(float(found["model_share"][place]))
        axes.bar(_BINS[:-1], heights, np.diff(_BINS), stacked, label=f"{name}: {share} overturn", **look)
        axes.bar(_FALLEN_AT, fallen, _FALLEN_WIDTH, below, **look)
        stacked, below = stacked + heights, below + fallen
    unknown = int((state < 0).sum())
    axes.axvline(1.0, color=GREY, linewidth=0.8, linestyle=DASHES[1])
    ticks = [0.0, 0.25, 0.5, 0.75, 1.0, _FALLEN_AT + 0.5 * _FALLEN_WIDTH]
    axes.set_xticks(ticks, ["0", "0.25", "0.5", "0.75", "1", "over-\nturned"])
    axes.set(xlabel=r"peak tilt / $\alpha_c$", xlim=(0.0, 1.46))
    axes.set_ylabel("variations" + (f" ({unknown} not decided)" if unknown else ""))
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.06), borderaxespad=0.0)


def _draw_shares(axes: Axes, found: xr.Dataset) -> None:
    """Draw a row for each variation, the most influential on top."""
    order = np.argsort(-found["influence"].to_numpy(), kind="stable")
    names = [str(found["variation"].to_numpy()[place]) for place in order]
    for row, place in enumerate(order):
        cells = found["part_share"].to_numpy()[place]
        cells = cells[~np.isnan(cells)]
        width = 1.0 / max(cells.size, 1)
        starts = np.arange(cells.size) * width
        look: dict[str, Any] = {"color": _SHARES(cells), "edgecolor": "white", "gid": AS_DRAWN}
        axes.barh(np.full(cells.size, row), width, 0.8, starts, **look)
        laws = found["model"].to_numpy() if names[row] == CONTACT_LAW else np.full(cells.size, "")
        for start, cell, law in zip(starts, cells, laws, strict=True):
            label = f"{law} {100.0 * cell:.0f}".strip()
            ink = ink_on(_SHARES(cell))
            look = {"ha": "center", "va": "center", "fontsize": "x-small", "color": ink, "gid": AS_DRAWN}
            axes.text(start + 0.5 * width, row, label, **look)
        axes.text(1.02, row, percent(float(found["influence"][place])), va="center", fontsize="small")
    axes.set_yticks(np.arange(len(names)), [LABELS.get(name, name.replace("_", " ")) for name in names])
    axes.set(xlim=(0.0, 1.0), ylim=(len(names) - 0.5, -0.5), xticks=[0.08, 0.92])
    axes.set_xticklabels(["low values", "high values"])
    axes.tick_params(axis="both", length=0)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.set_title("share of overturning [%]; right: influence", loc="right")
