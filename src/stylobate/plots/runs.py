"""Figures of runs: what moves against time, the path of the tilt vector, kinds of contact; one run, or several."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib import colormaps, rcParams
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from stylobate.errors import ParameterError
from stylobate.models import Contact
from stylobate.plots.geometry import Floats
from stylobate.plots.labels import axis_label, unit_label, what_varies
from stylobate.plots.result_figure import InAxes, ResultFigure, font_ratio, heading
from stylobate.plots.style import BLACK, BLUE, DASHES, GREY, ORANGE, PALETTE, SKY, VERMILION, new_figure, styled
from stylobate.results import Run

COLOURS = {
    Contact.RESTING: GREY,
    Contact.SLIDING: ORANGE,
    Contact.ROLLING: BLUE,
    Contact.SLIPPING: VERMILION,
    Contact.FLYING: SKY,
    Contact.JAMMED: BLACK,
}
_THICK = 0.64


@dataclass(frozen=True, slots=True)
class ContactHistory:
    """Kinds of contact of a run: `kinds`[i] between `edges`[i] and `edges`[i + 1] [s]."""

    edges: Floats
    kinds: npt.NDArray[np.integer]

    @classmethod
    def of(cls, run: Run) -> Self:
        """Return the contact history of a run, with changes at its events or, if there is no event, between samples."""
        time = run.data["time"].to_numpy()
        if run.sampler is None:
            return cls(time, run.data["contact"].to_numpy()[:-1])
        edges = np.unique(np.concatenate([time, [event.time for event in run.events]]).clip(time[0], time[-1]))
        return cls(edges, run.sample(0.5 * (edges[1:] + edges[:-1]))["contact"].to_numpy())

    @property
    def shown(self) -> list[Contact]:
        """The kinds that occur, in the order from resting to flight."""
        return [Contact(value) for value in np.unique(self.kinds).tolist()]

    def spans(self, kind: Contact) -> list[tuple[float, float]]:
        """Return begin and length of each stretch of a kind [s]."""
        changes = np.diff((self.kinds == kind).astype(np.int8), prepend=0, append=0)
        begins, ends = self.edges[changes == 1], self.edges[changes == -1]
        return list(zip(begins.tolist(), (ends - begins).tolist(), strict=True))


def draw_contact(axes: Axes, history: ContactHistory) -> None:
    """Draw the contact history, a row for each kind; the shortest intervals are visible as lines."""
    shown = history.shown
    for row, kind in enumerate(shown):
        look: dict[str, Any] = {"facecolor": COLOURS[kind], "edgecolor": COLOURS[kind], "linewidth": 0.6}
        axes.broken_barh(history.spans(kind), (row - 0.5 * _THICK, _THICK), **look)
    axes.set_yticks(range(len(shown)), [kind.name.lower() for kind in shown])
    axes.set_ylim(-0.6, len(shown) - 0.4)
    axes.grid(visible=False, axis="y")
    axes.set_axisbelow(True)
    axes.tick_params(axis="y", length=0)


EVENT_NAMES = {
    "uplift": "uplift",
    "rest": "at rest",
    "overturned": "overturned",
    "limit": "tilt limit",
    "lifted": "lifted off",
    "failed": "failed",
}
# Heights of the panels, of a row of kinds of contact, and of the margin about the rows [inches].
_HEIGHTS = {"tilt": 1.75, "azimuth": 1.45, "travel": 1.45, "clearance": 1.0, "twist": 1.0, "base": 1.7, "path": 3.0}
_ROW, _GAP = 0.19, 0.3
# Panels in the order in which a figure of a given height leaves them out, and the part of its height a panel needs.
_LEFT_OUT, _NEEDED = ("twist", "clearance", "azimuth", "contact", "path", "travel", "base"), 0.55
# Height of the title and the label of the time [inches].
_MARGIN = 0.45
# Minimum height of all panels, alone or beside the path of the tilt vector [inches]. Panels stand below the path only
# if that lowers the figure by this factor.
_ALONE, _BESIDE_PATH, _LOWER = 2.4, 3.9, 0.85
# Panels have this part of their height at least.
_LEAST = 0.84
# The name of an event later than this fraction of the run is written to its left; a name needs this fraction.
_LATE, _BESIDE = 0.8, 0.25
# Tolerance for rounding: a direction with no more than this fraction along x is the direction of y.
_ALONG_Y = 1e-9
# Movements within this of the largest are rounding; movements below this fraction of the radius are not drawn.
_ROUNDING, _SMALL = 1e-9, 1e-3
# A line with more turning points than this looks like a solid block: its extremes in so many intervals are drawn. A
# line that varies by less than this fraction is drawn as it is.
_TURNS, _INTERVALS, _FLAT = 150, 240, 0.02
# Margin about the orbit.
_ROOM = 1.08
_LIMIT: dict[str, Any] = {"color": GREY, "linewidth": 0.9, "linestyle": (0, (4, 2))}


@styled
def plot_runs(runs: Sequence[Run], labels: Sequence[str] | None = None) -> Figure:
    """Return a figure of one run, or of several compared.

    The panels show what moves, against time: the tilt (for planar motion with its sign), the azimuth of the lean,
    travel and clearance of parts that slide and fly, their turn about the axis, and the acceleration of the base;
    beside them the path of the tilt vector. Dashed lines show the tilt c, beyond which the column falls on a base at
    rest, and the acceleration c g at which it uplifts. For one run of a model that changes its contact, a strip shows
    the contact history. A curve that would be a solid block is drawn between its extremes. In given axes only the tilt
    is drawn; a figure of a given height that cannot hold all panels has the most important, the tilt first.

    Parameters
    ----------
    runs
        The runs, at least one.
    labels
        A name for each; by default the values that differ between the runs.

    Raises
    ------
    ParameterError
        If the height asked for cannot hold the tilt.
    """
    names = list(labels or what_varies(runs))
    planar = all(run.planar for run in runs)
    panels = panels_of(runs, planar=planar)
    figure, axes = _arranged(panels, axis_label(runs[0].data["time"]))
    lines = _looks(runs)
    draw = _DRAWN | {"tilt": _draw_signed_tilt if planar else _draw_tilt}
    for run, line in zip(runs, lines, strict=True):
        for name in axes.keys() - {"contact", "base"}:
            draw[name](axes[name], run, line)
    if "base" in axes:
        for run, line in _with_other_bases(runs, lines):
            _draw_base(axes["base"], run, line)
    _finish(axes, runs, planar=planar)
    if len(runs) == 1:
        if "contact" in axes and (history := panels.get("contact")) is not None:
            draw_contact(axes["contact"], history)
        if "tilt" in axes:
            _mark_events(axes["tilt"], runs[0])
    _write(figure, runs, names, lines)
    return figure


def panels_of(runs: Sequence[Run], *, planar: bool) -> dict[str, Any]:
    """Return the names of the panels that show something, in their order, with the contact history."""
    tilted = any(float(run.data["amplitude"].max()) > 0.0 for run in runs)
    found: dict[str, Any] = dict.fromkeys(["tilt"] if tilted else [])
    if len(runs) == 1 and "contact" in runs[0].data:
        found["contact"] = ContactHistory.of(runs[0])
    if tilted and not planar:
        found |= {"azimuth": None, "path": None}
    found |= dict.fromkeys(name for name in ("travel", "clearance", "twist") if any(_moves(run, name) for run in runs))
    if any(bool((run.data["base_acceleration"] != 0.0).any()) for run in runs):
        found["base"] = None
    return found or {"tilt": None}


def _moves(run: Run, name: str) -> bool:
    """Whether the column slides, flies or turns about its axis far enough to be seen."""
    data, radius = run.data, float(run.data.attrs.get("base_radius", 1.0))
    if "contact" not in data:
        return False
    moved = {"travel": "footprint"}.get(name, name)
    return float(np.abs(data[moved]).max()) > _SMALL * (1.0 if name == "twist" else radius)


def _arranged(panels: Mapping[str, Any], time: str) -> tuple[Figure, dict[str, Axes]]:
    """Return a figure and its panels by name: those against `time` below each other, the path beside or below them."""
    heights = {name: _HEIGHTS.get(name, 0.0) for name in panels}
    if panels.get("contact") is not None:
        heights["contact"] = _GAP + _ROW * len(panels["contact"].shown)
    figure = new_figure(_ALONE)
    if isinstance(figure, InAxes):
        tilt = figure.subplots()
        tilt.set_xlabel(time)
        return figure, {"tilt": tilt}
    assert isinstance(figure, ResultFigure)
    beside = not figure.narrow
    if figure.fixed:
        columns = _that_fit(heights, figure.get_figheight(), beside=beside)
    else:
        columns = _columns(heights, beside=beside)
        lowest = _BESIDE_PATH if len(columns) > 1 else _ALONE
        figure.set_figheight(max(font_ratio(), _LEAST) * max(_height(columns), lowest))
    axes: dict[str, Axes] = {}
    whole = figure.add_gridspec(1, len(columns), width_ratios=(1.25, 1.0)[: len(columns)])
    if len(columns) > 1 and len(columns[1]) == 1:  # in one grid, the upper edges of the panels align
        whole = figure.add_gridspec(len(columns[0]), 2, width_ratios=(1.25, 1.0), height_ratios=[*columns[0].values()])
    for place, column in enumerate(columns):
        if whole.nrows > 1:
            places = [whole[row, 0] for row in range(len(column))] if place == 0 else [whole[:, 1]]
        else:
            rows = whole[place].subgridspec(len(column), 1, height_ratios=[*column.values()])
            places = [rows[row] for row in range(len(column))]
        axes |= {name: figure.add_subplot(spot) for name, spot in zip(column, places, strict=True)}
        along = [axes[name] for name in column if name != "path"]
        for one in along:
            if one is not axes[next(iter(axes))]:
                one.sharex(axes[next(iter(axes))])
            one.tick_params(axis="x", labelbottom=one is along[-1])
        if along:
            along[-1].set_xlabel(time)
    return figure, axes


def _columns(heights: Mapping[str, float], *, beside: bool) -> list[dict[str, float]]:
    """Return the heights of the panels in each column: with the path `beside`, the last may stand below it."""
    along, path = {**heights}, {"path": heights.get("path", 0.0)}
    if "path" not in along:
        return [along]
    del along["path"]
    if not beside:
        return [along | path]
    names = list(along)
    ways = [
        [{name: along[name] for name in names[:count]}, path | {name: along[name] for name in names[count:]}]
        for count in range(len(names), 0, -1)
    ]
    lowest = min(ways, key=_height)
    return lowest if _height(lowest) < _LOWER * _height(ways[0]) else ways[0]


def _height(columns: Sequence[Mapping[str, float]]) -> float:
    return max(sum(column.values()) for column in columns)


def _that_fit(heights: Mapping[str, float], height: float, *, beside: bool) -> list[dict[str, float]]:
    """Return the columns of the most important panels that a figure of this `height` can hold.

    Raises
    ------
    ParameterError
        If it cannot hold the most important one.
    """
    kept = {**heights}
    for name in ("", *_LEFT_OUT):
        if len(kept) > 1:
            kept.pop(name, None)
        columns = _columns(kept, beside=beside)
        needed = font_ratio() * (_MARGIN + _NEEDED * _height(columns))
        if needed <= height:
            return columns
    raise ParameterError(
        f"size: a figure of a run must be {needed:.2f} inches high or more, got {height:g}. Give the width only"
    )


def _looks(runs: Sequence[Run]) -> list[dict[str, Any]]:
    """Return colour and dashes of each run."""
    colours = colours_of(len(runs))
    return [{"color": colour, "linestyle": DASHES[i % len(DASHES)]} for i, colour in enumerate(colours)]


def colours_of(count: int) -> list[Any]:
    """Return so many colours that differ: those of the palette or, if there are too few, of a sequence."""
    return [*PALETTE[:count]] if count <= len(PALETTE) else [*colormaps["viridis"](np.linspace(0.0, 0.9, count))]


def _with_other_bases(runs: Sequence[Run], lines: Sequence[dict[str, Any]]) -> list[tuple[Run, Any]]:
    """Return the runs with their looks, without repetition of a base motion; one of all runs is black."""
    first = {repr(run.provenance.get("motion")): (run, line) for run, line in zip(runs[::-1], lines[::-1], strict=True)}
    if len(first) == 1 and len(runs) > 1:
        longest = max(runs, key=lambda run: float(run.data["time"][-1]))
        return [(longest, {"color": BLACK, "linestyle": "-"})]
    return list(first.values())[::-1]


def draw_history(axes: Axes, time: Any, values: Floats, **line: Any) -> bool:
    """Draw `values` against time; if the line would be a solid block, fill between its extremes and return True."""
    time = np.asarray(time, dtype=float)
    turns = np.count_nonzero(np.diff(np.sign(np.diff(values))) != 0.0)
    if turns <= _TURNS or np.ptp(values) < _FLAT * np.abs(values).max():
        axes.plot(time, values, **line)
        return False
    edges = np.linspace(time[0], time[-1], _INTERVALS + 1)
    first = np.unique(np.searchsorted(time, edges[:-1]))
    look = {"color": line.get("color"), "alpha": 0.55, "linewidth": 0.3, "zorder": line.get("zorder", 2.0)}
    low, high = np.fmin.reduceat(values, first), np.fmax.reduceat(values, first)
    axes.fill_between(time[first], low, high, label=line.get("label"), **look)
    return True


def _draw_tilt(axes: Axes, run: Run, line: dict[str, Any]) -> None:
    draw_history(axes, run.data["time"], run.data["amplitude"].to_numpy(), linewidth=1.1, **line)


def _draw_signed_tilt(axes: Axes, run: Run, line: dict[str, Any]) -> None:
    draw_history(axes, run.data["time"], along_line(run.data["tilt"].to_numpy()), linewidth=1.1, **line)


def _draw_azimuth(axes: Axes, run: Run, line: dict[str, Any]) -> None:
    axes.plot(run.data["time"], run.data["azimuth"] / (2.0 * np.pi), linewidth=1.1, **line)


def _draw_travel(axes: Axes, run: Run, line: dict[str, Any]) -> None:
    travel = in_print(run.data["footprint"])
    moving = [along for along in (0, 1) if np.abs(travel[:, along]).max() > _ROUNDING * np.abs(travel).max()]
    higher = int(np.argmax(travel[-1]))
    for along in moving:
        draw_history(axes, run.data["time"], travel[:, along], linewidth=(1.1, 0.7)[along], **line)
        if moving != [0]:
            end = float(run.data["time"][-1]), float(travel[-1, along])
            look: dict[str, Any] = {"textcoords": "offset points", "fontsize": "small"}
            axes.annotate("xy"[along], end, xytext=(4, 0), va="bottom" if along == higher else "top", **look)


def _draw_clearance(axes: Axes, run: Run, line: dict[str, Any]) -> None:
    draw_history(axes, run.data["time"], in_print(run.data["clearance"]), linewidth=1.0, **line)


def _draw_twist(axes: Axes, run: Run, line: dict[str, Any]) -> None:
    draw_history(axes, run.data["time"], run.data["twist"].to_numpy() / (2.0 * np.pi), linewidth=1.0, **line)


def _draw_base(axes: Axes, run: Run, line: dict[str, Any]) -> None:
    """Draw the horizontal acceleration of the base, with its sign if it has one direction; dotted the vertical one."""
    acceleration = run.data["base_acceleration"].to_numpy()
    plane = acceleration[:, :2]
    horizontal = along_line(plane) if is_along_a_line(plane) else np.hypot(*plane.T)
    # Later runs below, so that weaker ones stay visible.
    below = 2.0 - 0.01 * len(axes.lines)
    filled = False
    if np.any(horizontal):
        filled = draw_history(axes, run.data["time"], horizontal, linewidth=0.9, zorder=below, **line)
    if np.any(acceleration[:, 2]):
        look = line | {"linestyle": ":", "color": line["color"] if not np.any(horizontal) else GREY}
        filled |= draw_history(axes, run.data["time"], acceleration[:, 2], linewidth=0.8, zorder=below - 0.5, **look)
    notes = ["filled between extremes"] if filled else []
    if np.any(acceleration[:, 2]):
        notes.append("grey: vertical" if np.any(horizontal) else "vertical")
    axes.set_title("; ".join(notes), fontsize="small", pad=2.0)


def _draw_path(axes: Axes, run: Run, line: dict[str, Any]) -> None:
    x, y = run.data["tilt"].sel(axis="x"), run.data["tilt"].sel(axis="y")
    axes.plot(x, y, linewidth=0.9, **line)
    axes.plot(x[:1], y[:1], marker="o", markersize=5, markerfacecolor="white", color=line["color"])
    axes.plot(x[-1:], y[-1:], marker="s", markersize=5, color=line["color"])


_DRAWN = {
    "tilt": _draw_tilt,
    "azimuth": _draw_azimuth,
    "path": _draw_path,
    "travel": _draw_travel,
    "clearance": _draw_clearance,
    "twist": _draw_twist,
}


def in_print(quantity: xr.DataArray) -> Floats:
    """Return lengths in mm, or in the units of a dimensionless column."""
    return np.asarray(quantity.to_numpy() * (1e3 if unit_label(quantity) == "m" else 1.0))


def is_along_a_line(vectors: Floats) -> bool:
    """Whether plane `vectors` have a common line."""
    x, y = vectors[np.argmax(np.hypot(*vectors.T))]
    return bool(np.abs(vectors @ (-y, x)).max() <= _ROUNDING * (x * x + y * y))


def along_line(vectors: Floats) -> Floats:
    """Return components of plane `vectors` along the line of the longest, positive towards +x, or +y along y."""
    x, y = vectors[np.argmax(np.hypot(*vectors.T))]
    length = np.hypot(x, y)
    if length == 0.0:
        return np.zeros(len(vectors))
    positive = x > 0.0 if abs(x) > _ALONG_Y * length else y > 0.0
    return np.asarray(vectors @ (x, y) / (length if positive else -length))


def _mark_events(axes: Axes, run: Run) -> None:
    """Name the first and the last event above the panel, where they cover no curve."""
    # The first and the last only: a run may uplift and come to rest in every period.
    events = [event for event in run.events if not event.repeats]
    ends = {event.kind: event for event in (*events[-1:], *events[:1])}  # of one kind, the first
    named = sorted((one for one in ends.values() if one.kind in EVENT_NAMES), key=lambda one: one.time)
    end = float(run.data["time"][-1])
    for place, event in enumerate(named):
        late = event.time > _LATE * end
        # A name beside another one stands above it.
        crowded = place > 0 and event.time - named[0].time < (2.0 if late else 1.0) * _BESIDE * end
        axes.axvline(event.time, color=BLACK, linewidth=0.6, linestyle=DASHES[3])
        axes.annotate(
            EVENT_NAMES[event.kind],
            (event.time, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(0, 2.0 + 1.2 * rcParams["font.size"] * crowded),
            textcoords="offset points",
            ha="right" if late else "left",
            va="bottom",
            fontsize="small",
        )


def _finish(axes: Mapping[str, Axes], runs: Sequence[Run], *, planar: bool) -> None:
    """Label the panels and draw the limits in them."""
    data = runs[0].data
    limits = sorted({float(run.data.attrs["slenderness"]) for run in runs})
    peak = max(float(run.data["amplitude"].max()) for run in runs)
    if "tilt" in axes:
        _finish_tilt(axes["tilt"], runs, limits, peak, planar=planar)
    labels = {
        "azimuth": "azimuth $\\beta$\n[turns]",
        "travel": f"travel\n[{length_unit(data)}]",
        "clearance": f"clearance\n[{length_unit(data)}]",
        "twist": "twist\n[turns]",
        "base": _base_label(data["base_acceleration"]),
    }
    for name, text in labels.items():
        if name in axes:
            axes[name].set_ylabel(text)
    if "base" in axes:
        signed = all(is_along_a_line(run.data["base_acceleration"].to_numpy()[:, :2]) for run in runs)
        levels = sorted({float(run.data.attrs["uplift_acceleration"]) for run in runs})
        _draw_limits(axes["base"], r"c\,g", dict(zip(levels, limits, strict=len(levels) == len(limits))), signed=signed)
        if not signed and not any(bool((run.data["base_acceleration"][:, 2] != 0.0).any()) for run in runs):
            axes["base"].set_ylim(bottom=0.0)
    if (path := axes.get("path")) is not None:
        for c in limits:
            path.add_patch(Circle((0.0, 0.0), c, fill=False, **_LIMIT))
        reach = _ROOM * max(*limits, *(float(np.abs(run.data["tilt"]).max()) for run in runs))
        path.set(xlim=(-reach, reach), ylim=(-reach, reach))
        path.set_aspect("equal", adjustable="box", anchor="N")
        path.set(xlabel=r"tilt $\theta_x$ [rad]", ylabel=r"tilt $\theta_y$ [rad]")
        path.locator_params(nbins=5)
        mark: dict[str, Any] = {"linestyle": "none", "color": BLACK, "markersize": 4}
        ends = [Line2D([], [], marker="o", markerfacecolor="white", label="start", **mark)]
        ends += [Line2D([], [], marker="s", label="end", **mark)]
        path.legend(handles=ends, loc="best", fontsize="small", handlelength=1.0, borderaxespad=0.0)


def _finish_tilt(axes: Axes, runs: Sequence[Run], limits: Sequence[float], peak: float, *, planar: bool) -> None:
    axes.set_ylabel("tilt [rad]" if planar else r"tilt $\theta$ [rad]")
    axes.margins(y=0.15)
    # A limit far above the tilts would press them to the bottom.
    shown = [c for c in limits if peak > c / 8.0 or peak == 0.0]
    fallen = any(abs(float(run.data["amplitude"][-1])) > run.data.attrs["slenderness"] / 2.0 for run in runs)
    _draw_limits(axes, r"\theta = c", {c: c for c in shown}, signed=planar, right=not fallen)
    if not planar:
        axes.set_ylim(bottom=0.0)


def _draw_limits(axes: Axes, symbol: str, limits: Mapping[float, float], *, signed: bool, right: bool = True) -> None:
    """Draw a dashed line at each of the `limits`, with its symbol; with the slenderness if there are several."""
    look: dict[str, Any] = {"ha": "right" if right else "left", "va": "bottom", "fontsize": "small", "color": GREY}
    for level, c in limits.items():
        for sign in (1.0, -1.0) if signed else (1.0,):
            axes.axhline(sign * level, **_LIMIT)
        name = f"${symbol}$" if len(limits) == 1 else f"${symbol}$, $c$ = {c:.3g}"
        axes.annotate(name, (0.99 if right else 0.01, level), xycoords=("axes fraction", "data"), **look)


def length_unit(data: xr.Dataset) -> str:
    """Return the unit of lengths in print: mm, or that of a dimensionless column."""
    unit = unit_label(data["base_displacement"])
    return "mm" if unit == "m" else unit


def _base_label(quantity: xr.DataArray) -> str:
    unit = unit_label(quantity)
    return f"base acceleration\n{f'[{unit}]' if unit == 'm/s²' else '$a/g$'}"


def _write(figure: Figure, runs: Sequence[Run], names: Sequence[str], lines: Sequence[dict[str, Any]]) -> None:
    """Write outcome and reason above one run, and a key to several below them."""
    if isinstance(figure, InAxes):
        if len(runs) > 1 or names != what_varies(runs):
            figure.legend(handles=[Line2D([], [], label=n, **line) for n, line in zip(names, lines, strict=True)])
        return
    if len(runs) == 1:
        label = runs[0].outcome.label
        name = f"{names[0][:1].upper()}{names[0][1:]}" if names[0].startswith(label) else names[0]
        heading(figure, f"{name if label in name.lower() else f'{name}: {label}'}: {runs[0].reason}")
        return
    entries = [
        Line2D([], [], label=name if run.outcome.label in name else f"{name}: {run.outcome.label}", **line)
        for run, name, line in zip(runs, names, lines, strict=True)
    ]
    figure.legend(handles=entries, loc="outside lower left", ncols=3)
