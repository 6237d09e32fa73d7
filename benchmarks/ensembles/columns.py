"""Ensembles whose columns and models differ: `python -m benchmarks.ensembles.columns`, part of `make bench`.

The numbers of all runs are evaluated at once on arrays, or for comparison by one object for each run, with one thread
and with two. All alternate in one process; the fastest wall time of the rounds counts. It fails if arrays are slower.
"""

import argparse
import os
import time
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import numpy as np

import stylobate as sb
from stylobate.engine.ensembles.model_columns import RunModels

from .quiet import wait_for_quiet

_FOLDER = Path(__file__).parents[2] / "docs" / "_static" / "benchmarks"
_DURATION = 60.0


@dataclass(frozen=True, slots=True)
class Case:
    """A model under a base motion, and the numbers that differ between its runs."""

    name: str
    model: sb.Model
    motion: sb.BaseMotion
    values: dict[str, np.ndarray]

    def seconds(self, threads: int, *, objects: bool = False) -> float:
        """Return the wall time of all runs [s]."""
        begun = time.perf_counter()
        with patch.object(RunModels, "_together", lambda *_: None) if objects else nullcontext():
            sb.simulate_ensemble(self.model, self.motion, duration=_DURATION, parameters=self.values, threads=threads)
        return time.perf_counter() - begun


def main() -> None:
    """Time the cases and write the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ensembles.columns", description=__doc__)
    parser.add_argument("--into", type=Path, default=_FOLDER, help="folder for the table")
    parser.add_argument("--count", type=int, default=8192, help="runs")
    parser.add_argument("--rounds", type=int, default=5, help="number of rounds; the fastest counts")
    arguments = parser.parse_args()
    rows, slower = [], []
    for case in cases(arguments.count):
        wait_for_quiet()
        case.seconds(1)  # compiles
        ways = [(threads, objects) for threads in _threads() for objects in (False, True)]
        found: dict[tuple[int, bool], list[float]] = {way: [] for way in ways}
        for _ in range(arguments.rounds):
            for threads, objects in ways:
                found[threads, objects].append(case.seconds(threads, objects=objects))
        best = {way: min(seconds) / arguments.count * 1e6 for way, seconds in found.items()}
        if best[1, False] > best[1, True]:
            slower.append(case.name)
        rows.append(_row(case.name, best))
    head = "| runs that differ in | arrays, one thread [µs a run] | two | gain | objects, one thread | two | gain |"
    text = "\n".join([head, "|---|---|---|---|---|---|---|", *rows]) + "\n"
    arguments.into.mkdir(parents=True, exist_ok=True)
    (arguments.into / "columns.txt").write_text(text, encoding="utf-8")
    print(text)
    if slower:
        raise SystemExit(f"slower on arrays than with objects: {', '.join(slower)}")


def cases(count: int) -> list[Case]:
    """Return the cases, from a number of the model alone to columns and records."""
    rng = np.random.default_rng(1)
    damping = {"damping": rng.uniform(0.05, 0.3, count)}
    column = {"slenderness": rng.uniform(0.08, 0.15, count), "size": rng.uniform(0.7, 1.4, count)}
    scale = {"scale": rng.uniform(0.3, 1.5, count)}
    slender = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    circle = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.8)
    stone = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
    record = sb.sample_record("el centro 1940")
    return [
        Case("`Slender`, circular motion: damping", slender, circle, damping),
        Case("… slenderness and size too", slender, circle, damping | column),
        Case("`Slender`, El Centro: slenderness, size, scale", sb.Slender(stone, damping=0.05), record, column | scale),
        Case("`Wobbling`, El Centro: damping too", sb.Wobbling(stone, damping=0.05), record, damping | column | scale),
    ]


def _threads() -> tuple[int, ...]:
    return (1, 2) if (os.cpu_count() or 1) > 1 else (1,)


def _row(name: str, best: dict[tuple[int, bool], float]) -> str:
    cells = []
    for objects in (False, True):
        one, two = best[1, objects], best.get((2, objects))
        cells += [f"{one:.1f}", *(("–", "–") if two is None else (f"{two:.1f}", f"{one / two:.2f}"))]
    return f"| {name} | {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
