"""Interactive figures with Plotly: zoom, hover over any run or sample, and pages that need no server."""

import re
import textwrap
from collections.abc import Callable, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib import rcParams
from matplotlib.colors import to_hex, to_rgb

from stylobate.errors import ParameterError, require_extra
from stylobate.plots.cells import Look, MapClass, attractor_classes, contact_classes, outcome_classes
from stylobate.plots.kinds import HasPoints, check_sequence
from stylobate.plots.labels import axis_label, in_own_units, unit_label, what_varies
from stylobate.plots.runs import (
    COLOURS,
    EVENT_NAMES,
    ContactHistory,
    along_line,
    colours_of,
    in_print,
    is_along_a_line,
    length_unit,
    panels_of,
)
from stylobate.plots.style import BLACK, GREY, PALETTE
from stylobate.results import Run, Verdict
from stylobate.results.verdict import CONTACT_LAW, LABELS

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

Floats = npt.NDArray[np.float64]

_LETTERS = {"theta": "θ", "Omega": "Ω", "omega": "ω", "beta": "β", "alpha": "α", "eta": "η", "sigma": "σ"}
_SUBSCRIPTS = str.maketrans("0123456789xy", "₀₁₂₃₄₅₆₇₈₉ₓᵧ")
# Samples of a curve; more make a page slow.
_MOST_SAMPLES = 4000
_PLANE = 2
# Dashes of the first and the second curve of a panel.
_DASHES = ("solid", "dot")
# Height of a panel, of the contact strip in panels, and the least of a figure [pixels].
_ROW_HEIGHT, _STRIP, _LEAST_HEIGHT = 190, 0.6, 450
# A limit farther above the tilts than this ratio would press them to the bottom.
_FAR = 8.0
# Characters in a line of a title; space above it and height of the menu of a verdict [pixels].
_TITLE_WIDTH, _TITLE_PAD, _MENU = 90, 14, 45
# Panels beside which the path of the tilt vector stands.
_BESIDE = 3
# Ratio of tilt to tipping angle at which overturned runs are drawn.
_OVERTURNED_AT = 1.2
# Width within which the runs of one contact law stand side by side.
_SIDE_BY_SIDE = 0.6


def plot_interactive(
    result: Run | Verdict | xr.Dataset | HasPoints | Sequence[Run] | Sequence[HasPoints],
    *,
    labels: Sequence[str] | None = None,
) -> "Figure":
    """Draw a result as an interactive figure of Plotly (`pip install stylobate[interactive]`).

    Parameters
    ----------
    result
        A run or several, a verdict, branches of orbits, or an ensemble, sweep or map over one or two dimensions. The
        hover text of a run in an ensemble states all its numbers.
    labels
        A name for each run or branch.

    Returns
    -------
    plotly.graph_objects.Figure
        A notebook shows it; `write_html` writes a page that needs no network. It is dark if Matplotlib's style is dark.

    Raises
    ------
    UnsupportedError
        If Plotly is not installed.
    ParameterError
        If there is no interactive figure for this result.
    """
    require_plotly()
    results: Sequence[Any] = [result]
    if isinstance(result, Sequence) and not isinstance(result, str):
        check_sequence(result)
        results = result
    shown = [in_own_units(one) for one in results]
    if shown and all(isinstance(one, Run) for one in shown):
        figure = _of_runs(shown, list(labels or what_varies(shown)))
    elif shown and all(isinstance(one, HasPoints) for one in shown):
        figure = _of_branches([in_own_units(one.points) for one in shown], labels)
    elif len(shown) == 1 and isinstance(shown[0], Verdict):
        figure = _of_verdict(shown[0])
    elif len(shown) == 1 and isinstance(shown[0], xr.Dataset) and "outcome" in shown[0]:
        figure = _of_ensemble(shown[0])
    else:
        kind = result.attrs.get("kind") if isinstance(result, xr.Dataset) else type(result).__name__
        raise ParameterError(
            "result must be runs, branches, a verdict, or runs over one or two dimensions to be drawn interactively, "
            f"got {kind}. Draw it by plot"
        )
    dark = np.mean(to_rgb(rcParams["axes.facecolor"])) < np.mean(to_rgb(rcParams["text.color"]))
    figure.update_layout(template="plotly_dark" if dark else "simple_white")
    return figure


def require_plotly() -> None:
    """Import Plotly and the parts of it that figures use, or raise UnsupportedError if it is not installed."""
    for module in ("plotly.graph_objects", "plotly.subplots"):
        require_extra(module, "interactive figures need Plotly. Install it by: pip install stylobate[interactive]")


def _of_runs(runs: Sequence[Run], names: Sequence[str]) -> "Figure":
    """Draw the panels of the static figure of runs; the time axes zoom together."""
    from plotly.subplots import make_subplots

    planar = all(run.planar for run in runs)
    panels = panels_of(runs, planar=planar)
    rows = [name for name in panels if name != "path"]
    path = [{"rowspan": min(len(rows), _BESIDE)}] if "path" in panels else []
    specs: list[list[Any]] = [[{}, *path], *([[{}, *([None] * len(path))]] * (len(rows) - 1))]
    heights = [_STRIP if name == "contact" else 1.0 for name in rows]
    figure = make_subplots(
        len(rows), 1 + len(path), shared_xaxes="columns", specs=specs, row_heights=heights, vertical_spacing=0.045
    )
    unit = _plain(unit_label(runs[0].data["time"]))
    for run, name, colour in zip(runs, names, colours_of(len(runs)), strict=True):
        look: dict[str, Any] = {"line": {"color": to_hex(colour), "width": 1.2}, "name": name, "legendgroup": name}
        time = run.data["time"].to_numpy()
        for row, panel in enumerate(rows, start=1):
            if panel == "contact":
                _add_contact(figure, panels[panel], unit, row)
                continue
            for place, curve in enumerate(_curves(run, panel, planar=planar)):
                kept = _extremes(curve.values)
                hover = f"time: %{{x:.6g}} {unit}<br>{curve.name}: %{{y:.4g}} {curve.unit}<extra>{name}</extra>"
                figure.add_scatter(
                    x=time[kept],
                    y=curve.values[kept],
                    hovertemplate=hover,
                    showlegend=row == 1 and place == 0,
                    row=row,
                    col=1,
                    **look | {"line": look["line"] | {"dash": _DASHES[place]}},
                )
                figure.update_yaxes(title_text=_panel_label(run, panel, curve.unit), row=row, col=1)
        if path:
            x, y = (run.data["tilt"].sel(axis=axis).to_numpy() for axis in "xy")
            kept = np.union1d(_extremes(x), _extremes(y))
            hover = f"time: %{{customdata:.6g}} {unit}<br>tilt along x: %{{x:.4g}} rad<br>along y: %{{y:.4g}} rad"
            figure.add_scatter(
                x=x[kept],
                y=y[kept],
                customdata=time[kept],
                hovertemplate=f"{hover}<extra>{name}</extra>",
                showlegend=False,
                row=1,
                col=2,
                **look,
            )
    figure.update_xaxes(title_text=_plain(axis_label(runs[0].data["time"])), row=len(rows), col=1)
    _draw_limits(figure, runs, rows, planar=planar, path=bool(path))
    if len(runs) == 1 and "tilt" in rows:
        _add_events(figure, runs[0], unit, rows.index("tilt") + 1, planar=planar)
    title = None
    if len(runs) == 1:
        outcome = runs[0].outcome.label
        title = f"{names[0] if outcome in names[0] else outcome}: {runs[0].reason}"
    figure.update_layout(showlegend=len(runs) > 1, height=max(_LEAST_HEIGHT, round(_ROW_HEIGHT * sum(heights))))
    _set_title(figure, title)
    return figure


class _Curve(NamedTuple):
    """A curve of a panel against time: its name, the unit in print, and a value for each sample."""

    name: str
    unit: str
    values: Floats


def _curves(run: Run, panel: str, *, planar: bool) -> list[_Curve]:
    """Return the curves of a panel, at most one for each component."""
    data = run.data
    if panel == "tilt":
        return [_Curve("tilt", "rad", along_line(data["tilt"].to_numpy()) if planar else data["amplitude"].to_numpy())]
    if panel in ("azimuth", "twist"):
        return [_Curve(panel, "turns", data[panel].to_numpy() / (2.0 * np.pi))]
    if panel == "clearance":
        return [_Curve(panel, _plain(length_unit(data)), in_print(data[panel]))]
    if panel == "travel":
        travel = in_print(data["footprint"])
        curves = [
            _Curve(f"travel along {axis}", _plain(length_unit(data)), travel[:, i]) for i, axis in enumerate("xy")
        ]
        return [one for one in curves if np.any(one.values)]
    acceleration, unit = data["base_acceleration"].to_numpy(), _plain(unit_label(data["base_acceleration"]))
    plane = acceleration[:, :2]
    horizontal = along_line(plane) if is_along_a_line(plane) else np.hypot(*plane.T)
    curves = [
        _Curve("horizontal base acceleration", unit, horizontal),
        _Curve("vertical base acceleration", unit, acceleration[:, 2]),
    ]
    return [one for one in curves if np.any(one.values)]


def _panel_label(run: Run, panel: str, unit: str) -> str:
    return (
        _plain(axis_label(run.data["base_acceleration"])).replace(" [", "<br>[")
        if panel == "base"
        else f"{panel} [{unit}]"
    )


def _extremes(values: Floats) -> npt.NDArray[np.intp]:
    """Return the places of all samples or, of too many, those of the extremes in equal intervals."""
    if values.size <= _MOST_SAMPLES:
        return np.arange(values.size)
    parts = np.array_split(np.arange(values.size), _MOST_SAMPLES // 2)
    found = [[part[0] + choose(values[part]) for choose in (np.argmin, np.argmax)] for part in parts]
    return np.unique([0, values.size - 1, *np.ravel(found)])


def _add_contact(figure: "Figure", history: ContactHistory, unit: str, row: int) -> None:
    """Add a row for each kind of contact, with a mark where each of its intervals begins."""
    names = [kind.name.lower() for kind in history.shown]
    for kind, name in zip(history.shown, names, strict=True):
        spans = history.spans(kind)
        figure.add_scatter(
            x=[time for begin, length in spans for time in (begin, begin + length, None)],
            y=[name] * (3 * len(spans)),
            mode="lines+markers",
            line={"color": COLOURS[kind], "width": 9},
            marker={"symbol": "line-ns-open", "size": 9, "line": {"width": 1}},
            hovertext=[f"{name} from {a:.6g} to {a + b:.6g} {unit}" for a, b in spans for _ in range(3)],
            hoverinfo="text",
            showlegend=False,
            row=row,
            col=1,
        )
    figure.update_yaxes(categoryorder="array", categoryarray=names, row=row, col=1)


def _draw_limits(figure: "Figure", runs: Sequence[Run], rows: Sequence[str], *, planar: bool, path: bool) -> None:
    """Draw the tilt c and the acceleration of uplift as dashed lines, where the static figure has them."""
    look: dict[str, Any] = {"line_dash": "dash", "line_color": GREY, "line_width": 1}
    peak = max(float(run.data["amplitude"].max()) for run in runs)
    for c in {float(run.data.attrs["slenderness"]) for run in runs}:
        if "tilt" in rows and peak > c / _FAR:
            for sign in (1.0, -1.0) if planar else (1.0,):
                figure.add_hline(y=sign * c, row=rows.index("tilt") + 1, col=1, **look)
        if path:
            figure.add_shape(type="circle", x0=-c, x1=c, y0=-c, y1=c, fillcolor="rgba(0,0,0,0)", row=1, col=2, **look)
    if "base" in rows:
        signed = all(is_along_a_line(run.data["base_acceleration"].to_numpy()[:, :2]) for run in runs)
        for level in {float(run.data.attrs["uplift_acceleration"]) for run in runs}:
            for sign in (1.0, -1.0) if signed else (1.0,):
                figure.add_hline(y=sign * level, row=rows.index("base") + 1, col=1, **look)
    if path:
        figure.update_xaxes(title_text="tilt along x [rad]", constrain="domain", row=1, col=2)
        figure.update_yaxes(title_text="tilt along y [rad]", scaleanchor=f"x{_PLANE}", constrain="domain", row=1, col=2)


def _add_events(figure: "Figure", run: Run, unit: str, row: int, *, planar: bool) -> None:
    """Mark the events that decide a run, at its tilt."""
    events = [event for event in run.events if event.kind in EVENT_NAMES]
    (tilt,) = _curves(run, "tilt", planar=planar)
    times = [event.time for event in events]
    figure.add_scatter(
        x=times,
        y=np.interp(times, run.data["time"], tilt.values),
        mode="markers",
        marker={"symbol": "diamond-open", "color": GREY},
        text=[EVENT_NAMES[event.kind] for event in events],
        hovertemplate=f"%{{text}}: %{{x:.6g}} {unit}<extra></extra>",
        name="events",
        showlegend=False,
        row=row,
        col=1,
    )


def _set_title(figure: "Figure", text: str | None) -> None:
    """Write a title in lines that fit, with room for them."""
    if text is not None:
        lines = textwrap.wrap(text, _TITLE_WIDTH)
        title: dict[str, Any] = {
            "text": "<br>".join(map(escape, lines)),
            "x": 0.01,
            "y": 1.0,
            "yanchor": "top",
            "font": {"size": 14},
        }
        title |= {"yref": "container", "pad": {"t": _TITLE_PAD}}
        figure.update_layout(title=title, margin={"t": 40 + 20 * len(lines)})


def _of_branches(branches: Sequence[xr.Dataset], labels: Sequence[str] | None) -> "Figure":
    """Draw mean tilts of branches: stable orbits bold, unstable ones dashed, bifurcations as marks."""
    from plotly.graph_objects import Figure

    figure = Figure()
    for index, points in enumerate(branches):
        if "mean_tilt" not in points:
            raise ParameterError("result must be branches of orbits, got curves of bifurcations. Draw them by plot")
        x, stable = str(points.attrs["parameter"]), points["stable"].to_numpy().astype(bool)
        name = labels[index] if labels else f"branch {index + 1}"
        hover = _numbers(points, [str(points[x].dims[0])])
        for inside, line, kind in (
            (stable, {"width": 3}, "stable"),
            (~stable, {"width": 1, "dash": "dash"}, "unstable"),
        ):
            figure.add_scatter(
                x=points[x],
                y=np.where(inside, points["mean_tilt"], np.nan),
                mode="lines",
                line=line | {"color": PALETTE[index % len(PALETTE)]},
                name=f"{name}, {kind}",
                hovertext=hover,
                hoverinfo="text",
            )
        kinds = points["bifurcation_kind"].to_numpy().astype(str)
        figure.add_scatter(
            x=points["bifurcation_parameter"],
            y=points["bifurcation_mean_tilt"],
            mode="markers",
            marker={"color": BLACK, "symbol": "diamond"},
            text=kinds,
            name="bifurcations",
        )
        figure.update_xaxes(title_text=_plain(axis_label(points[x])))
    figure.update_yaxes(title_text="mean tilt [rad]")
    return figure


def _of_verdict(verdict: Verdict) -> "Figure":
    """Draw the peak tilt of each variation over one varied number, which a menu chooses."""
    from plotly.graph_objects import Figure

    data = verdict.data.sortby(-verdict.data["influence"])
    names = [str(name) for name in data["variation"].to_numpy()]
    labels = [LABELS.get(name, name.replace("_", " ")) for name in names]
    value = data["value"].transpose("variation", "run").to_numpy()
    laws = [str(law) for law in data["model"].to_numpy()]
    law = data["law"].to_numpy()
    # Runs of one contact law stand side by side; the spread has no meaning.
    spread = _SIDE_BY_SIDE * (np.arange(law.size) / max(law.size - 1, 1) - 0.5)
    x = [law + spread if name == CONTACT_LAW else one for name, one in zip(names, value, strict=True)]
    tilt = np.minimum(data["tilt_ratio"].to_numpy(), _OVERTURNED_AT)
    figure = Figure()
    states = {
        1: ("overturned", PALETTE[1], "x"),
        0: ("stood", PALETTE[0], "circle"),
        -1: ("not decided", GREY, "diamond"),
    }
    state = data["overturned"].to_numpy()
    varied = {label: ("run", one) for name, label, one in zip(names, labels, value, strict=True) if name != CONTACT_LAW}
    numbers = _numbers(xr.Dataset(varied).assign(peak_tilt=data["peak_tilt"]), ["run"])
    hover = np.array(
        [f"{LABELS[CONTACT_LAW]}: {laws[place]}<br>{text}" for place, text in zip(law, numbers, strict=True)]
    )
    present = [code for code in states if np.any(state == code)]
    for code in present:
        name, colour, mark = states[code]
        inside = np.flatnonzero(state == code)
        figure.add_scatter(
            x=x[0][inside],
            y=tilt[inside],
            mode="markers",
            marker={"color": colour, "symbol": mark},
            name=f"{name}: {inside.size}",
            hovertext=hover[inside],
            hoverinfo="text",
        )
    named = {"tickmode": "array", "tickvals": list(range(len(laws))), "ticktext": laws}
    axes = [
        {"title.text": label} | (named if name == CONTACT_LAW else {"tickmode": "auto", "tickvals": None})
        for name, label in zip(names, labels, strict=True)
    ]
    buttons = [
        {
            "label": label,
            "method": "update",
            "args": [{"x": [one[state == code] for code in present]}, {f"xaxis.{key}": v for key, v in axis.items()}],
        }
        for label, one, axis in zip(labels, x, axes, strict=True)
    ]
    _set_title(figure, str(verdict))
    menu = {"buttons": buttons, "x": 0.0, "xanchor": "left", "y": 1.02, "yanchor": "bottom"}
    figure.update_layout(updatemenus=[menu], margin_t=figure.layout.margin.t + _MENU)
    figure.update_xaxes(**{key.replace(".", "_"): v for key, v in axes[0].items()})
    ticks = [0.0, 0.25, 0.5, 0.75, 1.0]
    figure.update_yaxes(
        title_text="peak tilt / tipping angle",
        tickvals=[*ticks, _OVERTURNED_AT],
        ticktext=[*(f"{one:g}" for one in ticks), f"{_OVERTURNED_AT} or more"],
    )
    return figure


def _of_ensemble(runs: xr.Dataset) -> "Figure":
    """Draw runs over one dimension as points and over two as a map; the hover text states all numbers of a run.

    The classes are those of the static figure: attractors, classes of contact, or outcomes.
    """
    from plotly.graph_objects import Figure

    dims = [str(dim) for dim in runs["outcome"].dims]
    if not 1 <= len(dims) <= _PLANE:
        raise ParameterError(
            f"runs must be over one or two dimensions, got {dict(runs['outcome'].sizes)}. Choose others by .isel"
        )
    shown, all_classes = next((name, of(runs)) for name, of in _CLASSES.items() if name in runs)
    codes = runs[shown].to_numpy()
    classes = [one for one in all_classes if np.any(codes == one.code)]
    hover = _numbers(runs, dims)
    figure = Figure()
    if len(dims) == 1:
        (dim,) = dims
        varied = [name for name, one in runs.coords.items() if one.dims == (dim,) and one.dtype.kind in "fiu"]
        x = runs[varied[0]] if len(varied) == 1 else xr.DataArray(np.arange(codes.size), attrs={"long_name": "run"})
        for one, colour in zip(classes, _plain_colours(classes), strict=True):
            inside = np.flatnonzero(codes == one.code)
            figure.add_scatter(
                x=x.to_numpy()[inside],
                y=runs["peak_tilt"].to_numpy()[inside],
                mode="markers",
                marker={"color": colour, "line": {"color": GREY, "width": 0.5}},
                name=one.name,
                hovertext=hover[inside],
                hoverinfo="text",
            )
        figure.update_xaxes(title_text=_plain(axis_label(x)))
        figure.update_yaxes(title_text=_plain(axis_label(runs["peak_tilt"])))
        return figure
    x, y = (runs[dim] for dim in dims)
    classes.sort(key=lambda one: one.code)
    places = np.searchsorted([one.code for one in classes], codes)
    steps = np.repeat(np.arange(len(classes) + 1) / len(classes), 2)[1:-1].tolist()
    colours = np.repeat(_plain_colours(classes), 2).tolist()
    figure.add_heatmap(
        x=x,
        y=y,
        z=places.T,
        zmin=-0.5,
        zmax=len(classes) - 0.5,
        colorscale=list(zip(steps, colours, strict=True)),
        colorbar={"tickvals": list(range(len(classes))), "ticktext": [one.name for one in classes]},
        hovertext=hover.T,
        hoverinfo="text",
    )
    figure.update_xaxes(title_text=_plain(axis_label(x)))
    figure.update_yaxes(title_text=_plain(axis_label(y)))
    return figure


_CLASSES: dict[str, Callable[[xr.Dataset], Sequence[MapClass]]] = {
    "attractor": attractor_classes,
    "contact_class": contact_classes,
    "outcome": lambda _: outcome_classes(),
}
"""Classes of a map by the first of these variables that it has."""


def _plain_colours(classes: Sequence[MapClass]) -> list[str]:
    """Return a colour for each class; where only textures differ, the colours of the textures for the others."""
    used: list[str] = []
    for one in classes:
        colour = one.look.colour
        while colour in used:
            colour = one.look.ink if colour == one.look.colour else Look(colour).ink
        used.append(colour)
    return used


def _numbers(runs: xr.Dataset, dims: Sequence[str]) -> npt.NDArray[np.str_]:
    """Return the numbers of each run or point over `dims` in lines; those that it does not have are left out."""
    shape = tuple(runs.sizes[dim] for dim in dims)
    grid = xr.DataArray(np.zeros(shape), dims=dims)
    lines: list[list[str]] = [[] for _ in range(int(np.prod(shape)))]
    for name, values in {**runs.coords, **runs.data_vars}.items():
        if values.dtype.kind not in "fiub" or not set(map(str, values.dims)) <= set(dims):
            continue
        words, unit = str(name).replace("_", " "), _plain(unit_label(values))
        codes = values.attrs.get("flag_values", ())
        meanings = dict(
            zip(map(int, np.atleast_1d(codes)), str(values.attrs.get("flag_meanings")).split(), strict=False)
        )
        everywhere = values.broadcast_like(grid).transpose(*dims).to_numpy().ravel().tolist()
        for own, number in zip(lines, everywhere, strict=True):
            if meanings:
                own.append(f"{words}: {meanings.get(number, str(number)).lower().replace('_', ' ')}")
            elif isinstance(number, bool):
                own.append(f"{words}: {'yes' if number else 'no'}")
            elif not isinstance(number, float):
                own.append(f"{words}: {number} {unit}".rstrip())
            elif np.isfinite(number):
                own.append(f"{words}: {number:.4g} {unit}".rstrip())
    return np.array(["<br>".join(own) for own in lines]).reshape(shape)


def _plain(label: str) -> str:
    """Return a label without TeX."""
    text = re.sub(r"\\([a-zA-Z]+)", lambda found: _LETTERS.get(found.group(1), found.group(1)), label.replace("$", ""))
    return re.sub(r"_(\w)", lambda found: found.group(1).translate(_SUBSCRIPTS), text).replace("\n", " ")
