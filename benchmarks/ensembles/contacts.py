"""Speed of variable against permanent contact: `python -m benchmarks.ensembles.contacts`, part of `make bench`.

`Rolling` and `Sliding` compute the same columns under the same base motions in lanes on one core. Single runs of some
columns check the outcomes. All cases alternate in one process; the fastest round counts.
"""

import argparse
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

import stylobate as sb

from . import peak
from .one_core import use_one_core
from .tables import number

_FOLDER = Path(__file__).parents[2] / "docs" / "_static" / "benchmarks"
_PERIODS, _SINGLE = 20.0, 24
_COLUMN = sb.Column.dimensionless(slenderness=0.1)
_FRICTION = {"damping": 0.1, "spin_damping": 0.1}


@dataclass(frozen=True, slots=True)
class Case:
    """Columns under circular motion, one per row: friction coefficient, acceleration, frequency, initial tilt."""

    name: str
    numbers: np.ndarray
    switches: bool

    def lanes(self) -> xr.Dataset:
        """Integrate all columns in lanes."""
        names = ("friction_coefficient", "acceleration", "angular_frequency")
        parameters = dict(zip(names, self.numbers.T[:3], strict=True))
        if not self.switches:
            del parameters["friction_coefficient"]
        return sb.simulate_ensemble(
            self.model(),
            _circle(1.0, 1.0),
            tilt=np.column_stack([self.numbers[:, 3], np.zeros(len(self.numbers))]),
            duration=_durations(self.numbers),
            parameters=parameters,
            threads=1,
        )

    def model(self, friction: float = 0.5) -> sb.Model:
        """Create the model, with this friction coefficient if it has one."""
        return (
            sb.Sliding(_COLUMN, friction_coefficient=friction, **_FRICTION)
            if self.switches
            else sb.Rolling(_COLUMN, **_FRICTION)
        )

    def alone(self) -> list[sb.Run]:
        """Integrate the first columns as single runs."""
        return [
            sb.simulate(
                self.model(friction), _circle(acceleration, frequency), tilt=(tilt, 0.0), duration=float(duration)
            )
            for (friction, acceleration, frequency, tilt), duration in zip(
                self.numbers[:_SINGLE].tolist(), _durations(self.numbers[:_SINGLE]), strict=True
            )
        ]


def main() -> None:
    """Time the cases and write the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ensembles.contacts", description=__doc__)
    parser.add_argument("--into", type=Path, default=_FOLDER, help="folder for the table")
    parser.add_argument("--count", type=int, default=4000, help="columns")
    parser.add_argument("--rounds", type=int, default=3, help="number of rounds; the fastest counts")
    arguments = parser.parse_args()
    print(use_one_core())
    held, slips = (Case(name, _numbers(arguments.count, low), switches) for name, low, switches in _CASES)
    slippery = Case("`Sliding`, μ from 0.03 to 0.6", _numbers(arguments.count, 0.03), switches=True)
    cases = (held, slips, slippery)
    for case in cases:
        case.lanes()  # compiles
    seconds: dict[str, list[float]] = {case.name: [] for case in cases}
    found = {}
    for _ in range(arguments.rounds):
        for case in cases:
            found[case.name] = _timed(case.lanes, seconds[case.name])
    rows = [_row(case, min(seconds[case.name]), found[case.name], min(seconds[held.name])) for case in cases]
    head = "| one core | trajectories/s | × `Rolling` | steps a run | µs a step | × single runs | other outcome |"
    note = f"\n{peak.in_words(peak.measured_peak())}.\n"
    text = "\n".join([head, "|---|---|---|---|---|---|---|", *rows]) + "\n" + note
    arguments.into.mkdir(parents=True, exist_ok=True)
    (arguments.into / "contacts.txt").write_text(text, encoding="utf-8")
    print(text)


_CASES = (("`Rolling`", 10.0, False), ("`Sliding`, μ = 10, which never slips", 10.0, True))


def _numbers(count: int, least_friction: float) -> np.ndarray:
    rng = np.random.default_rng(7)
    friction = np.exp(rng.uniform(np.log(least_friction), np.log(max(0.6, least_friction)), count))
    acceleration, frequency = rng.uniform(0.02, 0.3, count), rng.uniform(0.8, 4.0, count)
    return np.column_stack([friction, acceleration, frequency, rng.uniform(0.005, 0.06, count)])


def _circle(acceleration: float, frequency: float) -> sb.Harmonic:
    return sb.Harmonic.circular(acceleration=acceleration, angular_frequency=frequency)


def _durations(numbers: np.ndarray) -> np.ndarray:
    return np.asarray(_PERIODS * 2.0 * np.pi / numbers[:, 2])


def _timed(follow: Callable[[], xr.Dataset], seconds: list[float]) -> xr.Dataset:
    begun = time.process_time()
    runs = follow()
    seconds.append(time.process_time() - begun)
    return runs


def _row(case: Case, seconds: float, runs: xr.Dataset, of_rolling: float) -> str:
    begun = time.process_time()
    alone = case.alone()
    each = (time.process_time() - begun) / _SINGLE
    steps, count = float(runs["steps"].mean()), runs.sizes["run"]
    codes = runs["outcome"].to_numpy()[:_SINGLE]
    others = sum(sb.Outcome(code) is not run.outcome for code, run in zip(codes, alone, strict=True))
    return (
        f"| {case.name} | {number(count / seconds)} | {of_rolling / seconds:.2g} | {number(steps)} "
        f"| {1e6 * seconds / (count * steps):.2g} | {number(each * count / seconds)} | {others} of {_SINGLE} |"
    )


if __name__ == "__main__":
    main()
