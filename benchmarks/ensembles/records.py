"""Ensemble under a recorded earthquake at many scales: `python -m benchmarks.ensembles.records`, in `make bench`.

A thousand columns of `Wobbling`, each under a hundred scales of the three components of El Centro 1940, in lanes on all
cores. A loop over SciPy's DOP853 in plain Python, restarted at every knot, computes some of the runs on one core.
"""

import argparse
import math
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate.engine.ensemble import usual_threads
from stylobate.records import sample_record

_FOLDER = Path(__file__).parents[2] / "docs" / "_static" / "benchmarks"
_RECORD = sample_record("el centro 1940")
_TAIL = 10.0
_MODEL = sb.Wobbling(sb.Column.solid(radius=0.5, height=5.0, density=2700.0), damping=0.05)
_RTOL = 1e-8


@dataclass(frozen=True, slots=True)
class Answer:
    """Outcome of one run by the loop over SciPy."""

    overturned: bool
    seconds: float


def main() -> None:
    """Time both methods and write the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ensembles.records", description=__doc__)
    parser.add_argument("--into", type=Path, default=_FOLDER, help="folder for the table")
    parser.add_argument("--columns", type=int, default=1000)
    parser.add_argument("--scales", type=int, default=100)
    parser.add_argument("--scipy", type=int, default=24, help="number of random runs by the loop over SciPy")
    arguments = parser.parse_args()
    over = _columns(arguments.columns, arguments.scales)
    _lanes({name: values[:2] for name, values in over.items()})  # compiles
    begun = time.perf_counter()
    runs = _lanes(over)
    seconds = time.perf_counter() - begun
    text = _table(runs, seconds, _drawn(runs, over, arguments.scipy))
    arguments.into.mkdir(parents=True, exist_ok=True)
    (arguments.into / "records.txt").write_text(text, encoding="utf-8")
    print(text)


def _columns(columns: int, scales: int) -> dict[str, xr.DataArray]:
    rng = np.random.default_rng(1940)
    size = xr.DataArray(np.exp(rng.uniform(math.log(0.3), math.log(3.0), columns)), dims="column")
    slenderness = xr.DataArray(rng.uniform(0.08, 0.25, columns), dims="column")
    return {
        "size": size,
        "slenderness": slenderness,
        "scale": xr.DataArray(np.linspace(0.03, 3.0, scales), dims="scale"),
    }


def _lanes(over: dict[str, xr.DataArray]) -> xr.Dataset:
    return sb.simulate_ensemble(_MODEL, _RECORD, duration=_RECORD.duration + _TAIL, rtol=_RTOL, parameters=over)


def _drawn(runs: xr.Dataset, over: dict[str, xr.DataArray], count: int) -> list[tuple[bool, Answer]]:
    """Return for some moving runs whether they overturned in lanes, and the result of the loop over SciPy."""
    rng = np.random.default_rng(12)
    moved = np.argwhere(runs["uplifts"].values > 0)
    chosen = moved[rng.choice(len(moved), min(count, len(moved)), replace=False)]
    overturned = runs["outcome"].values == sb.Outcome.OVERTURNED
    pairs = []
    for column, scale in chosen.tolist():
        values = {"size": over["size"].values[column], "slenderness": over["slenderness"].values[column]}
        model, _ = sb.with_parameters(_MODEL, _RECORD, **values)
        answer = by_scipy(model, float(over["scale"].values[scale]))
        pairs.append((bool(overturned[column, scale]), answer))
    return pairs


def by_scipy(model: sb.Model, scale: float) -> Answer:
    """Integrate a column from rest, with one call of `solve_ivp` from knot to knot while it moves."""
    begun = time.process_time()
    samples = (scale / model.column.gravity) * _RECORD.samples
    times = _RECORD.times / model.time_scale
    c, state = model.column.slenderness, None
    no_return = _no_return(model, float(np.hypot(*samples.T[:2]).max()), float(samples[:, 2].min()))
    spans = zip(times[:-1], times[1:], samples[:-1], samples[1:], strict=True)
    tail = (times[-1], times[-1] + _TAIL / model.time_scale, np.zeros(3), np.zeros(3))
    for start, end, left, right in [*spans, tail]:
        if state is None or _rests(model, state, left, c):
            if math.hypot(*right[:2]) <= c * (1.0 + right[2]):
                state = None
                continue
            lean = -1e-9 * c * right[:2] / math.hypot(*right[:2])
            state = np.array(model.start((float(lean[0]), float(lean[1])), (0.0, 0.0)))
        flow = solve_ivp(
            _rates(model, start, end, left, right),
            (start, end),
            state,
            method="DOP853",
            rtol=_RTOL,
            atol=_RTOL * 1e-2 * c,
            events=no_return,
        )
        state = flow.y[:, -1]
        if flow.status == 1:
            return Answer(True, time.process_time() - begun)
    return Answer(False, time.process_time() - begun)


def _rates(model, start, end, left, right):
    right_hand_side, parameters = model.rates, model.parameters
    (ax, ay, az), (bx, by, bz), per = left.tolist(), (right - left).tolist(), 1.0 / (end - start)

    def rates(tau, state):
        share = (tau - start) * per
        return right_hand_side(*state.tolist(), ax + share * bx, ay + share * by, az + share * bz, *parameters)

    return rates


def _rests(model: sb.Model, state: np.ndarray, push: np.ndarray, c: float) -> bool:
    """Return whether the column is at rest by the criterion of the lanes: little energy, and no uplift."""
    tilt, speed = np.hypot(*model.tilt(state)), np.hypot(*model.tilt_rate(state))
    small = 0.5 * speed**2 + c * (1.0 + push[2]) * tilt < 1e-5 * c**2
    return bool(small and math.hypot(*push[:2]) < c * (1.0 + push[2]))


def _no_return(model: sb.Model, largest: float, least: float):
    bound = model.least_safe_tilt(largest, least)

    def event(tau, state):
        del tau
        return float(np.hypot(*model.tilt(state))) - bound

    event.terminal = True  # type: ignore[attr-defined]
    event.direction = 1.0  # type: ignore[attr-defined]
    return event


def _table(runs: xr.Dataset, seconds: float, pairs: list[tuple[bool, Answer]]) -> str:
    count, threads = runs["outcome"].size, usual_threads()
    per_core = count / seconds / threads
    moved = float((runs["uplifts"] > 0).mean())
    loop = sum(answer.seconds for _, answer in pairs) / len(pairs)
    same = sum(ours == answer.overturned for ours, answer in pairs)
    moving_rate = per_core * moved  # runs that never move cost little in both methods
    rows = [
        f"| lanes, {threads} cores | {count} | {seconds:.1f} | {count / seconds:.0f} | |",
        f"| SciPy, a loop, one core | {len(pairs)} that move | {loop * len(pairs):.1f} | {1.0 / loop:.3f} "
        f"| {same} of {len(pairs)} |",
    ]
    notes = (
        f"\nUplifted {100.0 * moved:.0f} %, uncertain {100.0 * float(runs['uncertain'].mean()):.1f} %; "
        f"{float(runs['steps'].mean()):.0f} steps a run. Of runs that move a core follows "
        f"{moving_rate * loop:.0f} times as many as the loop.\n"
    )
    return "\n".join(["| | runs | s | runs/s | same outcome |", "|---|---|---|---|---|", *rows, notes])


if __name__ == "__main__":
    main()
