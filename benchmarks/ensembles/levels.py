"""Speed of the models of the hierarchy, as tables: `python -m benchmarks.ensembles.levels`, part of `make bench`.

Each model has its own steady rolling, mix, events, outcomes and summaries. All trials alternate in one process on one
core; the fastest round counts.
"""

import argparse
import json
import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from functools import partial
from pathlib import Path

from . import ours, tables
from .answers import Answer
from .level_loads import Level, all_levels
from .level_trials import COUNT, Trial, all_trials
from .one_core import use_one_core
from .threads import gain
from .timing import Timing, in_turns, timing_of
from .workloads import MIX_DISTINCT, Workload

_FOLDER = Path(__file__).parents[2] / "docs" / "_static" / "benchmarks"
_TIGHT = 1e-12


def main() -> None:
    arguments = _arguments()
    one_core = use_one_core()
    shorter, repetitions = (16, 1) if arguments.quick else (1, arguments.repetitions)
    levels = all_levels()
    trials = all_trials(levels, shorter)
    print(f"load of the machine before: {os.getloadavg()[0]:.2f}; {one_core}")
    found = []
    for workload in ("rolling", "mix"):
        found += _timings(workload, trials, levels, repetitions)
    rolling = levels["rolling"]
    follow = partial(ours.solve, rolling.loads["rolling"](COUNT // shorter), model=rolling.model)
    two_threads = gain(follow, 2 * repetitions) if (os.cpu_count() or 1) > 1 else None
    _write(arguments.into, trials, found, two_threads)


def _timings(workload: str, trials: Sequence[Trial], levels: Mapping[str, Level], repetitions: int) -> list[Timing]:
    present = [trial for trial in trials if workload in trial.counts]
    runs = {trial.key: levels[trial.level].loads[workload](trial.counts[workload]) for trial in present}
    for trial in present:
        trial.solve(runs[trial.key].take(slice(0, 4)))  # compiles
    tasks = {trial.key: partial(trial.solve, runs[trial.key]) for trial in present}
    seconds, answers = in_turns(tasks, repetitions)
    found = []
    for trial in present:
        key, level = trial.key, levels[trial.level]
        checked, truth = runs[key], None
        if workload == "mix":
            truth = _tight(level, level.loads[workload](MIX_DISTINCT))
        elif checked.exact is None:  # rocking with loss
            checked = replace(checked, exact=_tight(level, checked).end)
        timing = timing_of(key, checked, seconds[key], answers[key], truth)
        found.append(timing)
        print(f"{workload}: {key}: {timing.fastest:.5g} trajectories/s, error {timing.error:.1e}")
    return found


def _tight(level: Level, runs: Workload) -> Answer:
    return ours.solve(runs, threads=1, model=level.model, rtol=_TIGHT, atol=1e-2 * _TIGHT)


def _write(folder: Path, trials: Sequence[Trial], found: Sequence[Timing], two_threads: float | None) -> None:
    texts = {f"levels-{workload}.txt": tables.levels_table(trials, found, workload) for workload in ("rolling", "mix")}
    if two_threads is not None:
        texts["levels-rolling.txt"] += f"\nTwo threads follow `Rolling` {two_threads:.3g} times as fast as one.\n"
    timings = [asdict(timing) | {"fastest": timing.fastest} for timing in found]
    texts["levels.json"] = json.dumps({"timings": timings, "two threads": two_threads}, indent=1) + "\n"
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    print(*(text for name, text in texts.items() if name.endswith(".txt")), sep="\n")
    print(f"written to {folder}")


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ensembles.levels", description=__doc__)
    parser.add_argument("--into", type=Path, default=_FOLDER, help="folder for the tables")
    parser.add_argument("--repetitions", type=int, default=5, help="rounds, of which the fastest counts")
    parser.add_argument("--quick", action="store_true", help="a sixteenth of the runs, once, as a check")
    return parser.parse_args()


if __name__ == "__main__":
    main()
