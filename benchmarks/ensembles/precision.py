"""Error against processor time over tolerances: `python -m benchmarks.ensembles.precision`, part of `make bench`."""

import argparse
import json
import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from importlib.metadata import version
from pathlib import Path

from .one_core import use_one_core

_FOLDER = Path(__file__).parents[2] / "docs" / "_static" / "benchmarks"
_DPI = 200
TOLERANCES = tuple(float(f"1e-{power}") for power in range(4, 13))
_QUICK_TOLERANCES = (1e-5, 1e-9)
# Runs of the mix of all engines; tolerance of the reference end states by SciPy.
_COMPARED, _REFERENCE = 128, 3e-14


@dataclass(frozen=True, slots=True)
class Point:
    """Processor time [s] and error of a run for one engine and tolerance."""

    engine: str
    workload: str
    rtol: float
    seconds: float
    error: float


def main() -> None:
    arguments = _arguments()
    one_core = use_one_core()  # before the libraries are imported
    from . import figures, peak, tables
    from .engines import engines_by_tolerance

    engines = engines_by_tolerance()
    present = [engine for engine in engines if not engine.missing]
    print(f"load of the machine before: {os.getloadavg()[0]:.2f}; {one_core}")
    tolerances, shorter = (_QUICK_TOLERANCES, 64) if arguments.quick else (TOLERANCES, 4)
    rounds = 1 if arguments.quick else arguments.repetitions
    found = [
        point for workload in ("rolling", "mix") for point in _points(present, workload, tolerances, rounds, shorter)
    ]
    packages = ("numpy", "scipy", *sorted({name for engine in present for name in engine.needs}))
    versions = ", ".join(f"{name} {version(name)}" for name in packages)
    note = f"\n{peak.in_words(peak.measured_peak())}. {versions}.\n"
    texts = {
        f"precision-{workload}.txt": tables.precision_table(engines, found, workload) + note
        for workload in ("rolling", "mix")
    }
    texts["precision.json"] = json.dumps([asdict(point) for point in found], indent=1) + "\n"
    arguments.into.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        (arguments.into / name).write_text(text, encoding="utf-8")
    names = {engine.key: engine.name for engine in present}
    figures.precision_figure(names, found).savefig(arguments.into / "precision.png", dpi=_DPI)
    print(*(text for name, text in texts.items() if name.endswith(".txt")), sep="\n")


def _points(engines: Sequence, workload: str, tolerances: Sequence[float], rounds: int, shorter: int) -> list[Point]:
    from .timing import timings

    able = [engine for engine in engines if workload in engine.counts]
    variants = {f"{engine.key} {rtol:.0e}": (engine, rtol) for engine in able for rtol in tolerances}
    measured = timings(
        [
            replace(engine, key=key, prepare=partial(engine.prepare, rtol=rtol, atol=1e-2 * rtol))
            for key, (engine, rtol) in variants.items()
        ],
        workload,
        repetitions=rounds,
        shorter=shorter,
        compared=_COMPARED,
        reference=_REFERENCE,
    )
    found = []
    for timing in measured:
        engine, rtol = variants[timing.engine]
        found.append(Point(engine.key, workload, rtol, 1.0 / timing.rate, timing.error))
        print(f"{workload}: {timing.engine}: {1e6 / timing.rate:.4g} µs a run, error {timing.error:.1e}")
    return found


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ensembles.precision", description=__doc__)
    parser.add_argument("--into", type=Path, default=_FOLDER, help="folder for tables and figure")
    parser.add_argument("--repetitions", type=int, default=3, help="rounds, of which the median counts")
    parser.add_argument("--quick", action="store_true", help="two tolerances, few runs, once, as a check")
    return parser.parse_args()


if __name__ == "__main__":
    main()
