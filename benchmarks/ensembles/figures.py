"""Figures of the documentation's page on speed."""

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from stylobate.plots.style import BLACK, BLUE, DASHES, GREEN, ORANGE, PURPLE, VERMILION, new_figure, styled

from .ours import NAMES
from .precision import Point
from .scaling import Cost
from .timing import Timing

_TITLES = {"rolling": "rolling: steady motion, 200 periods", "mix": "mix: random starts, most overturn"}


@styled
def engines_figure(names: Mapping[str, str], found: Sequence[Timing], limits: Mapping[str, float]) -> Figure:
    """Draw trajectories per second as bars on a logarithmic scale, one panel per workload.

    `limits` are the trajectories per second of DOP853 at the arithmetic peak.
    """
    figure = new_figure(2.6)
    panels = figure.subplots(1, 2, sharey=True, sharex=True)
    keys = [key for key in names if any(timing.engine == key for timing in found)]
    for axes, (workload, title) in zip(panels, _TITLES.items(), strict=True):
        rates = {timing.engine: timing.rate for timing in found if timing.workload == workload}
        for place, key in enumerate(keys):
            own = key in NAMES
            axes.barh(place, rates[key], color=VERMILION if own else BLUE, height=0.62)
            axes.annotate(
                f"{rates[key]:,.0f}".replace(",", "\u2009"), (rates[key], place), (-4, 0),
                textcoords="offset points", va="center", ha="right", fontsize=8.5, color="white", fontweight="bold",
            )  # fmt: skip
        axes.axvline(
            limits[workload], color=BLACK, linestyle="--", linewidth=1.1, label="DOP853 at the arithmetic peak"
        )
        axes.set_xscale("log")
        axes.set_xlim(1.0, 3e6)
        axes.set_title(title)
        axes.set_xlabel("trajectories per second, one core")
        axes.grid(visible=False, axis="y")
        axes.set_axisbelow(True)
        axes.tick_params(axis="y", length=0)
    panels[0].set_yticks(range(len(keys)), [names[key] for key in keys])
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower right")
    return figure


@styled
def precision_figure(names: Mapping[str, str], found: Sequence[Point]) -> Figure:
    """Draw the processor time of a run against its error, one curve per engine, one panel per workload."""
    figure = new_figure(3.9)
    panels = figure.subplots(1, 2, sharex=True)
    looks = zip(names, (BLACK, PURPLE, GREEN, BLUE, VERMILION, ORANGE), "^vDsoP", DASHES[::-1], strict=True)
    for key, color, marker, dashes in looks:
        own = key in NAMES
        for axes, workload in zip(panels, _TITLES, strict=True):
            points = [point for point in found if (point.engine, point.workload) == (key, workload)]
            axes.plot(
                [point.error for point in points],
                [1e6 * point.seconds for point in points],
                color=color,
                marker=marker,
                markersize=5 if own else 4,
                linestyle="-" if own else dashes,
                linewidth=2.0 if own else 1.2,
                label=names[key] if workload == "rolling" else None,
            )
    for axes, (workload, title) in zip(panels, _TITLES.items(), strict=True):
        axes.set_xscale("log")
        axes.set_yscale("log")
        axes.set_title(title)
        axes.set_xlabel(f"{_ERRORS[workload]} error of tilt and rate at the end [1]")
    panels[0].set_ylabel("processor time of a run [µs], one core")
    panels[0].invert_xaxis()
    figure.legend(loc="outside lower center", ncols=3)
    return figure


_ERRORS = {"rolling": "largest", "mix": "median"}


@styled
def scaling_figure(found: Sequence[Cost]) -> Figure:
    """Draw processor time and memory against the number of trajectories on a logarithmic scale."""
    figure = new_figure(2.8)
    time_axes, memory_axes = figure.subplots(1, 2)
    for workload, color, marker in (("rolling", VERMILION, "o"), ("mix", BLUE, "s")):
        rows = [cost for cost in found if cost.workload == workload]
        counts = [cost.count for cost in rows]
        look = {"color": color, "marker": marker, "markersize": 4.5, "label": workload}
        time_axes.plot(counts, [1e6 * cost.seconds / cost.count for cost in rows], **look)
        memory_axes.plot(counts, [cost.peak / 1e6 for cost in rows], **look)
    for axes, title in ((time_axes, "processor time per trajectory, one core"), (memory_axes, "memory of the process")):
        axes.set_xscale("log")
        axes.set_xlabel("trajectories")
        axes.set_title(title)
        axes.set_ylim(bottom=0.0)
    time_axes.set_ylabel("µs")
    memory_axes.set_ylabel("MB, largest")
    time_axes.legend()
    return figure
