"""Interactive figures with Plotly: zoom, hover over any run or sample, and pages that need no server."""

import re
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib import rcParams
from matplotlib.colors import to_hex, to_rgb

from stylobate.errors import Outcome, ParameterError, UnsupportedError
from stylobate.plots.classes import outcome_classes
from stylobate.plots.kinds import HasPoints
from stylobate.plots.labels import axis_label, in_own_units
from stylobate.plots.runs import along_line, colours_of
from stylobate.plots.style import BLACK, GREY, PALETTE
from stylobate.plots.varied import what_varies
from stylobate.results import Response, Verdict
from stylobate.results.outcomes import NOT_COMPUTED

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

_LETTERS = {"theta": "θ", "Omega": "Ω", "omega": "ω", "beta": "β", "alpha": "α", "eta": "η", "sigma": "σ"}
_SUBSCRIPTS = str.maketrans("0123456789xy", "₀₁₂₃₄₅₆₇₈₉ₓᵧ")
# Samples of a history; more make a page slow.
_MOST_SAMPLES = 4000
_PLANE = 2
# Ratio of tilt to tipping angle at which overturned runs are drawn.
_OVERTURNED_AT = 1.2


def plot_interactive(
    result: Response | Verdict | xr.Dataset | HasPoints | Sequence[Response] | Sequence[HasPoints],
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
    try:
        import plotly.graph_objects  # noqa: F401, PLC0415  an extra, slow to import
    except ImportError:
        message = "interactive figures need Plotly. Install it by: pip install stylobate[interactive]"
        raise UnsupportedError(message) from None
    results: Sequence[Any] = result if isinstance(result, Sequence) else [result]
    shown = [in_own_units(one) for one in results]
    if shown and all(isinstance(one, Response) for one in shown):
        figure = _of_runs(shown, list(labels or what_varies(shown)))
    elif shown and all(isinstance(one, HasPoints) for one in shown):
        figure = _of_branches([in_own_units(one.points) for one in shown], labels)
    elif len(shown) == 1 and isinstance(shown[0], Verdict):
        figure = _of_verdict(shown[0])
    elif len(shown) == 1 and isinstance(shown[0], xr.Dataset) and "outcome" in shown[0]:
        figure = _of_ensemble(shown[0])
    else:
        kind = result.attrs.get("kind") if isinstance(result, xr.Dataset) else type(result).__name__
        message = (
            "result must be runs, branches, a verdict, or runs over one or two dimensions to be drawn interactively, "
            f"got {kind}. Draw it by plot"
        )
        raise ParameterError(message)
    dark = np.mean(to_rgb(rcParams["axes.facecolor"])) < np.mean(to_rgb(rcParams["text.color"]))
    figure.update_layout(template="plotly_dark" if dark else "simple_white")
    return figure


def _of_runs(runs: Sequence[Response], names: Sequence[str]) -> "Figure":
    """Draw tilt and base motion against time, and the path of the tilt vector; the time axes zoom together."""
    from plotly.subplots import make_subplots  # noqa: PLC0415

    planar = all(run.planar for run in runs)
    rows: dict[str, Callable[[xr.Dataset], Any]] = {
        "tilt [rad]": (lambda data: along_line(data["tilt"].to_numpy()))
        if planar
        else (lambda data: data["amplitude"]),
        "azimuth [turns]": lambda data: data["azimuth"] / (2.0 * np.pi),
        _plain(axis_label(runs[0].data["base_acceleration"])): lambda data: np.hypot(
            *data["base_acceleration"].to_numpy()[:, :2].T
        ),
    }
    if planar:
        del rows["azimuth [turns]"]
    path: list[Any] = [{}] if planar else [{}, {"rowspan": len(rows)}]
    specs: list[list[Any]] = [path, *([[{}] if planar else [{}, None]] * (len(rows) - 1))]
    figure = make_subplots(len(rows), len(path), shared_xaxes="columns", specs=specs, vertical_spacing=0.06)
    for run, name, colour in zip(runs, names, colours_of(len(runs)), strict=True):
        data = run.data.isel(time=slice(None, None, 1 + run.data.sizes["time"] // _MOST_SAMPLES))
        look: dict[str, Any] = {"line": {"color": to_hex(colour), "width": 1.2}, "name": name, "legendgroup": name}
        for row, (label, values) in enumerate(rows.items(), start=1):
            hover = f"%{{x:.4g}}, %{{y:.4g}}<extra>{name}</extra>"
            figure.add_scatter(
                x=data["time"], y=values(data), hovertemplate=hover, showlegend=row == 1, row=row, col=1, **look
            )
            figure.update_yaxes(title_text=label, row=row, col=1)
        if not planar:
            hover = "time %{customdata:.4g}: (%{x:.4g}, %{y:.4g}) rad<extra></extra>"
            x, y = (data["tilt"].sel(axis=axis) for axis in "xy")
            figure.add_scatter(
                x=x, y=y, customdata=data["time"], hovertemplate=hover, showlegend=False, row=1, col=2, **look
            )
    figure.update_xaxes(title_text=_plain(axis_label(runs[0].data["time"])), row=len(rows), col=1)
    for c in {float(run.data.attrs["slenderness"]) for run in runs}:
        figure.add_hline(y=c, line_dash="dash", line_color=GREY, line_width=1, row=1, col=1)
    if not planar:
        figure.update_xaxes(title_text="tilt along x [rad]", row=1, col=2)
        figure.update_yaxes(title_text="tilt along y [rad]", scaleanchor=f"x{_PLANE}", row=1, col=2)
    title = None
    if len(runs) == 1:
        outcome = runs[0].outcome.label
        title = f"{names[0] if outcome in names[0] else outcome}: {runs[0].reason}"
    figure.update_layout(title=title, showlegend=len(runs) > 1)
    return figure


def _of_branches(branches: Sequence[xr.Dataset], labels: Sequence[str] | None) -> "Figure":
    """Draw mean tilts of branches: stable orbits bold, unstable ones dashed, bifurcations as marks."""
    from plotly.graph_objects import Figure  # noqa: PLC0415

    figure = Figure()
    for index, points in enumerate(branches):
        if "mean_tilt" not in points:
            message = "result must be branches of orbits, got curves of bifurcations. Draw them by plot"
            raise ParameterError(message)
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
    from plotly.graph_objects import Figure  # noqa: PLC0415

    data = verdict.data.sortby(-verdict.data["influence"])
    names = [str(name) for name in data["variation"].to_numpy()]
    value = data["value"].transpose("variation", "run").to_numpy()
    tilt = np.minimum(data["tilt_ratio"].to_numpy(), _OVERTURNED_AT)
    figure = Figure()
    states = {
        1: ("overturned", PALETTE[1], "x"),
        0: ("stood", PALETTE[0], "circle"),
        -1: ("not decided", GREY, "diamond"),
    }
    state = data["overturned"].to_numpy()
    varied = xr.Dataset({name: ("run", one) for name, one in zip(names, value, strict=True)})
    hover = _numbers(varied.assign(peak_tilt=data["peak_tilt"]), ["run"])
    present = [code for code in states if np.any(state == code)]
    for code in present:
        name, colour, mark = states[code]
        inside = np.flatnonzero(state == code)
        figure.add_scatter(
            x=value[0, inside],
            y=tilt[inside],
            mode="markers",
            marker={"color": colour, "symbol": mark},
            name=f"{name}: {inside.size}",
            hovertext=hover[inside],
            hoverinfo="text",
        )
    buttons = [
        {
            "label": name.replace("_", " "),
            "method": "update",
            "args": [
                {"x": [value[place, state == code] for code in present]},
                {"xaxis.title.text": name.replace("_", " ")},
            ],
        }
        for place, name in enumerate(names)
    ]
    menu = {"buttons": buttons, "x": 1.0, "xanchor": "right", "y": 1.12}
    figure.update_layout(title=str(verdict), updatemenus=[menu])
    figure.update_xaxes(title_text=names[0].replace("_", " "))
    figure.update_yaxes(title_text="peak tilt / tipping angle")
    return figure


def _of_ensemble(runs: xr.Dataset) -> "Figure":
    """Draw runs over one dimension as points and over two as a map; the hover text states all numbers of a run."""
    from plotly.graph_objects import Figure  # noqa: PLC0415

    dims = [str(dim) for dim in runs["outcome"].dims]
    if not 1 <= len(dims) <= _PLANE:
        message = f"runs must be over one or two dimensions, got {dict(runs['outcome'].sizes)}. Choose others by .isel"
        raise ParameterError(message)
    hover = _numbers(runs, dims)
    figure = Figure()
    codes = runs["outcome"].to_numpy()
    classes = [one for one in outcome_classes() if np.any(codes == one.code)]
    if len(dims) == 1:
        (dim,) = dims
        varied = [name for name, one in runs.coords.items() if one.dims == (dim,) and one.dtype.kind in "fiu"]
        x = runs[varied[0]] if len(varied) == 1 else xr.DataArray(np.arange(codes.size), attrs={"long_name": "run"})
        for one in classes:
            inside = np.flatnonzero(codes == one.code)
            figure.add_scatter(
                x=x.to_numpy()[inside],
                y=runs["peak_tilt"].to_numpy()[inside],
                mode="markers",
                marker={"color": one.look.colour, "line": {"color": GREY, "width": 0.5}},
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
    colours = np.repeat([one.look.colour for one in classes], 2).tolist()
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


def _numbers(runs: xr.Dataset, dims: Sequence[str]) -> npt.NDArray[np.str_]:
    """Return the numbers of each run or point over `dims` in lines; those that it does not have are left out."""
    shape = tuple(runs.sizes[dim] for dim in dims)
    grid = xr.DataArray(np.zeros(shape), dims=dims)
    lines: list[list[str]] = [[] for _ in range(int(np.prod(shape)))]
    for name, values in {**runs.coords, **runs.data_vars}.items():
        if values.dtype.kind not in "fiub" or not set(map(str, values.dims)) <= set(dims):
            continue
        words = str(name).replace("_", " ")
        everywhere = values.broadcast_like(grid).transpose(*dims).to_numpy().ravel().tolist()
        for own, number in zip(lines, everywhere, strict=True):
            if name == "outcome":
                own.append(f"{words}: {'not computed' if number == NOT_COMPUTED else Outcome(number).label}")
            elif not isinstance(number, float):
                own.append(f"{words}: {number}")
            elif np.isfinite(number):
                own.append(f"{words}: {number:.4g}")
    return np.array(["<br>".join(own) for own in lines]).reshape(shape)


def _plain(label: str) -> str:
    """Return a label without TeX."""
    text = re.sub(r"\\([a-zA-Z]+)", lambda found: _LETTERS.get(found.group(1), found.group(1)), label.replace("$", ""))
    return re.sub(r"_(\w)", lambda found: found.group(1).translate(_SUBSCRIPTS), text).replace("\n", " ")
