"""Speed of rolling and slipping columns in an earthquake: `python -m benchmarks.ensembles.sliding`, in `make bench`.

`Wobbling`, `Rolling` and `Sliding` compute the same columns under the same scales of the three components of El Centro
1940, in lanes on one core. They alternate in one process; the median processor time of the rounds counts.
"""

import argparse
import math
import time
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median

import numpy as np
import xarray as xr

import stylobate as sb
from stylobate.records import sample_record

from . import peak
from .one_core import use_one_core
from .tables import number

_FOLDER = Path(__file__).parents[2] / "docs" / "_static" / "benchmarks"
_RECORD = sample_record("el centro 1940")
_TAIL = 10.0
_COLUMN = sb.Column.solid(radius=0.5, height=5.0, density=2700.0)
_DAMPING = {"damping": 0.05, "spin_damping": 0.05}


@dataclass(frozen=True, slots=True)
class Case:
    """A model, and the parameters that vary between its runs."""

    name: str
    model: sb.Model
    parameters: dict[str, np.ndarray]

    def follow(self) -> xr.Dataset:
        """Integrate all columns."""
        return sb.simulate_ensemble(
            self.model, _RECORD, duration=_RECORD.duration + _TAIL, parameters=self.parameters, threads=1
        )

    def take(self, count: int) -> "Case":
        """Return the first `count` columns."""
        return replace(self, parameters={name: values[:count] for name, values in self.parameters.items()})


def main() -> None:
    """Time the models and write the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ensembles.sliding", description=__doc__)
    parser.add_argument("--into", type=Path, default=_FOLDER, help="folder for the table")
    parser.add_argument("--count", type=int, default=1000, help="columns")
    parser.add_argument("--rounds", type=int, default=3, help="number of rounds; the median counts")
    arguments = parser.parse_args()
    print(use_one_core())
    cases = _cases(arguments.count)
    seconds: dict[str, list[float]] = {case.name: [] for case in cases}
    runs = {case.name: case.take(2).follow() for case in cases}  # compiles
    for _ in range(arguments.rounds):
        for case in cases:
            begun = time.process_time()
            runs[case.name] = case.follow()
            seconds[case.name].append(time.process_time() - begun)
    head = "| El Centro 1940, one core | runs/s | steps a run | µs a step | uplifted | slipped | overturned |"
    rows = [_row(name, median(seconds[name]), runs[name]) for name in runs]
    note = f"\n{peak.in_words(peak.measured_peak())}.\n"
    text = "\n".join([head, "|---|---|---|---|---|---|---|", *rows]) + "\n" + note
    arguments.into.mkdir(parents=True, exist_ok=True)
    (arguments.into / "sliding.txt").write_text(text, encoding="utf-8")
    print(text)


def _cases(count: int) -> list[Case]:
    rng = np.random.default_rng(1940)
    columns = {
        "size": np.exp(rng.uniform(math.log(0.3), math.log(3.0), count)),
        "slenderness": rng.uniform(0.08, 0.25, count),
        "scale": rng.uniform(0.03, 3.0, count),
    }
    friction = {"friction_coefficient": rng.uniform(0.2, 0.8, count)}
    return [
        Case("`Wobbling`", sb.Wobbling(_COLUMN, damping=0.05), columns),
        Case("`Rolling`", sb.Rolling(_COLUMN, **_DAMPING), columns),
        Case(
            "`Sliding`, μ from 0.2 to 0.8",
            sb.Sliding(_COLUMN, friction_coefficient=0.5, **_DAMPING),
            columns | friction,
        ),
    ]


def _row(name: str, seconds: float, runs: xr.Dataset) -> str:
    count, steps = runs.sizes["run"], float(runs["steps"].mean())
    overturned = runs["outcome"] == sb.Outcome.OVERTURNED
    shares = [runs["uplifts"] > 0, runs["slips"] > 0 if "slips" in runs else None, overturned]
    cells = ["–" if share is None else f"{100.0 * float(share.mean()):.0f} %" for share in shares]
    per_step = f"{1e6 * seconds / (count * steps):.2g}"
    return f"| {name} | {number(count / seconds)} | {number(steps)} | {per_step} | {' | '.join(cells)} |"


if __name__ == "__main__":
    main()
