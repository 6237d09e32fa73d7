"""Markdown tables of the documentation's page on speed."""

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from .engines import Engine
from .level_trials import Trial
from .ours import NAMES
from .scaling import Cost
from .timing import Timing
from .workloads import MIX_DISTINCT

if TYPE_CHECKING:
    from .precision import Point
    from .shares import Shares


def engines_table(
    engines: Sequence[Engine], found: Sequence[Timing], limits: Mapping[str, float], workload: str
) -> str:
    """Format one row per engine: speed, ratio to SciPy's speed, share of the arithmetic peak, error."""
    titles = {
        "rolling": ["trajectories/s", "× SciPy", "share of peak", "largest error"],
        "mix": ["trajectories/s", "× SciPy", "share of peak", "median error", "other outcome"],
    }[workload]
    lines = [f"| {workload}, one core | {' | '.join(titles)} |", "|" + "---|" * (len(titles) + 1)]
    for engine in engines:
        if engine.missing:
            lines.append(
                f"| {engine.name} | not measured: {', '.join(engine.missing)} not installed |"
                + " |" * (len(titles) - 1)
            )
            continue
        timing = _of(found, engine.key, workload)
        cells = [engine.name, number(timing.rate), number(timing.rate / _of(found, "scipy", workload).rate)]
        cells.append(_share(timing.rate / limits[workload]) if engine.dop853 else "–")
        cells.append(_power(timing.error))
        if timing.other_outcomes is not None:
            cells.append(f"{timing.other_outcomes} of {MIX_DISTINCT}")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def targets_table(found: Sequence[Timing], two_threads: Mapping[str, float] | None) -> str:
    """Format targets of "rolling" on one core with AVX-512, and results of stylobate's methods."""
    scipy = _of(found, "scipy", "rolling")
    heyoka = next((t for t in found if (t.engine, t.workload) == ("heyoka8", "rolling")), None)
    own = [_of(found, method, "rolling") for method in NAMES]
    over_scipy = [timing.rate / scipy.rate for timing in own]
    over_heyoka = [None if heyoka is None else timing.rate / heyoka.rate for timing in own]
    threads = None if two_threads is None else two_threads["rolling"]
    lines = ["| rolling | aim | DOP853 | Taylor |", "|---|---|---|---|"]
    for what, aim, values in (
        ("speed over SciPy's DOP853 loop", "≥ 1500", over_scipy),
        ("speed over heyoka's batch of 8", "≥ 2", over_heyoka),
        ("speed of two threads over one", "≥ 1.8", (threads, "")),
        ("error of the end state", f"SciPy's: {_power(scipy.error)}", [_power(timing.error) for timing in own]),
    ):
        cells = ["not measured" if v is None else v if isinstance(v, str) else number(v) for v in values]
        lines.append(f"| {what} | {aim} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def levels_table(trials: Sequence[Trial], found: Sequence[Timing], workload: str) -> str:
    """Format one row per model: speed, ratio to the slender model, speed with demands, steps and error."""
    titles = ["trajectories/s", "× `Slender`", "with demands", "steps a run", "µs a step"]
    titles += {"rolling": ["largest error"], "mix": ["median error", "other outcome"]}[workload]
    lines = [f"| {workload}, one core | {' | '.join(titles)} |", "|" + "---|" * (len(titles) + 1)]
    for trial in trials:
        if not trial.in_table or workload not in trial.counts:
            continue
        timing, beside = _of(found, trial.key, workload), _of(found, trial.beside, workload)
        demanding = None if trial.demanding is None else _of(found, trial.demanding, workload)
        rate = timing.fastest
        cells = [trial.name, number(rate), f"{rate / beside.fastest:.2g}"]
        cells.append("–" if demanding is None else number(demanding.fastest))
        cells += [number(timing.steps), f"{1e6 / (rate * timing.steps):.2g}", _power(timing.error)]
        if timing.other_outcomes is not None:
            cells.append(f"{timing.other_outcomes} of {MIX_DISTINCT}")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def precision_table(engines: Sequence[Engine], found: Sequence["Point"], workload: str) -> str:
    """Format one row per engine: minimum processor time of a run for each error."""
    heads = [f"error 1e{math.log10(error):.0f}" for error in _ERRORS]
    lines = [f"| {workload}, µs a run | {' | '.join(heads)} |", "|" + "---|" * (len(heads) + 1)]
    for engine in engines:
        points = [point for point in found if (point.engine, point.workload) == (engine.key, workload)]
        cells = [engine.name]
        if engine.missing:
            cells += [f"not measured: {', '.join(engine.missing)} not installed", *[""] * (len(heads) - 1)]
        elif not points:
            continue
        else:
            times = (_time_of_error(points, error) for error in _ERRORS)
            cells += ["–" if math.isnan(seconds) else number(1e6 * seconds) for seconds in times]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


_ERRORS = (1e-4, 1e-6, 1e-8, 1e-10, 1e-12)


def _time_of_error(points: Sequence["Point"], error: float) -> float:
    """Return the minimum time of a run [s] with this error, interpolated between tolerances; NaN if never reached."""
    times = [point.seconds for point in points if point.error <= error]
    by_tolerance = sorted(points, key=lambda point: -point.rtol)
    for loose, tight in itertools.pairwise(by_tolerance):
        if tight.error <= error < loose.error:
            share = math.log(loose.error / error) / math.log(loose.error / tight.error)
            times.append(loose.seconds ** (1.0 - share) * tight.seconds**share)
    return min(times, default=math.nan)


_NOISE = 0.01


def shares_table(found: Sequence["Shares"]) -> str:
    """Format one row per method and workload: shares of the processor time of a call."""
    lines = [
        "| 512 runs, one core | a call [ms] | steps | events, driver | observation | Python | lanes occupied "
        "| steps alone: share of peak |",
        "|" + "---|" * 8,
    ]
    for one in found:
        shares = [part / one.call for part in (one.steps, one.events, one.observation, one.python)]
        parts = ["< 1 %" if share < _NOISE else _share(share) for share in shares]
        of_peak = "–" if one.of_peak is None else _share(one.of_peak)
        cells = [
            f"{one.workload}: {NAMES[one.method]}",
            number(1e3 * one.call),
            *parts,
            f"{100.0 * one.occupied:.0f} %",
            of_peak,
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def scaling_table(found: Sequence[Cost]) -> str:
    """Format one row per number of trajectories."""
    lines = [
        "| trajectories | rolling: time [s] | µs each | memory [MB] | mix: time [s] | µs each | memory [MB] |",
        "|" + "---|" * 7,
    ]
    for count in sorted({cost.count for cost in found}):
        cells = [number(count)]
        for workload in ("rolling", "mix"):
            cost = next(c for c in found if (c.workload, c.count) == (workload, count))
            cells += [f"{cost.seconds:.3g}", f"{1e6 * cost.seconds / count:.3g}", f"{cost.peak / 1e6:.0f}"]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _of(found: Sequence[Timing], engine: str, workload: str) -> Timing:
    return next(timing for timing in found if (timing.engine, timing.workload) == (engine, workload))


def number(value: float) -> str:
    """Format three digits or the whole integer part, in groups of three."""
    return f"{value:.3g}" if value < 100.0 else f"{value:,.0f}".replace(",", " ")


def _share(value: float) -> str:
    return f"{100.0 * value:.2g} %"


def _power(value: float) -> str:
    return f"{value:.1e}".replace("e-0", "e-")
