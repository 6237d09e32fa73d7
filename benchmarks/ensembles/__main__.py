"""Measure all engines and write tables and figures: `python -m benchmarks.ensembles`."""

import argparse
import json
import os
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from statistics import median

from .one_core import use_one_core

_FOLDER = Path(__file__).parents[2] / "docs" / "_static" / "benchmarks"
_DPI = 200


def main() -> None:
    arguments = _arguments()
    cores = os.cpu_count() or 1
    one_core = use_one_core()  # before the libraries are imported
    from . import peak, scaling, threads
    from .engines import all_engines
    from .timing import timings

    shorter, repetitions = (16, 1) if arguments.quick else (1, arguments.repetitions)
    engines = all_engines()
    present = [engine for engine in engines if not engine.missing]
    for engine in engines:
        if engine.missing:
            print(f"skipped: {engine.name}, for {', '.join(engine.missing)} is not installed")
    print(f"load of the machine before: {os.getloadavg()[0]:.2f}; {one_core}")
    peaks = [peak.measured_peak()]
    found = []
    for workload in ("rolling", "mix"):
        found += timings(present, workload, repetitions=repetitions, shorter=shorter)
        peaks.append(peak.measured_peak())
        for timing in found:
            if timing.workload == workload:
                print(f"{workload}: {timing.engine}: {timing.rate:.5g} trajectories/s, error {timing.error:.1e}")
    two_threads = threads.speed_up(repetitions=2 * repetitions, shorter=shorter)
    costs = [
        cost
        for workload in ("rolling", "mix")
        for cost in scaling.costs(workload, largest=1_000 if arguments.quick else scaling.COUNTS[-1])
    ]
    packages = ("numpy", "scipy", "llvmlite", *sorted({name for engine in present for name in engine.needs}))
    results = {
        "machine": {"cores": cores, "instructions": peak.instruction_set(), "one core": one_core},
        "versions": {name: version(name) for name in ("stylobate", *packages)},
        "peak": median(peaks),
        "flops of a step": peak.flops_of_a_step(),
        "timings": [asdict(timing) | {"rate": timing.rate} for timing in found],
        "two threads": two_threads,
        "scaling": [asdict(cost) for cost in costs],
    }
    _write(arguments.into, engines, found, two_threads, costs, results)
    rates = {timing.engine: timing.rate for timing in found if timing.workload == "rolling"}
    if rates["taylor"] < rates["dop853"]:
        raise SystemExit("Taylor series are slower than DOP853 in rolling")


def _write(folder, engines, found, two_threads, costs, results) -> None:
    from . import figures, tables

    # Accepted steps of stylobate's runs, without events and summaries, at the arithmetic peak.
    per_second = results["peak"] / results["flops of a step"]
    limits = {timing.workload: per_second / timing.steps for timing in found if timing.engine == "dop853"}
    machine, versions = results["machine"], results["versions"]
    about = (
        f"{machine['cores']} cores, {machine['instructions']}; arithmetic peak of one core, measured: "
        f"{results['peak'] / 1e9:.0f} GFlop/s. "
        + ", ".join(f"{name} {number}" for name, number in versions.items() if name != "stylobate")
        + ".\n"
    )
    folder.mkdir(parents=True, exist_ok=True)
    texts = {
        "machine.txt": about,
        "rolling.txt": tables.engines_table(engines, found, limits, "rolling"),
        "mix.txt": tables.engines_table(engines, found, limits, "mix"),
        "targets.txt": tables.targets_table(found, two_threads),
        "scaling.txt": tables.scaling_table(costs),
        "results.json": json.dumps(results, indent=1) + "\n",
    }
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    names = {engine.key: engine.name for engine in engines}
    figures.engines_figure(names, found, limits).savefig(folder / "engines.png", dpi=_DPI)
    figures.scaling_figure(costs).savefig(folder / "scaling.png", dpi=_DPI)
    print(*(text for name, text in texts.items() if name.endswith(".txt")), sep="\n")
    print(f"written to {folder}")


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ensembles", description=__doc__)
    parser.add_argument("--into", type=Path, default=_FOLDER, help="folder for tables and figures")
    parser.add_argument("--repetitions", type=int, default=5, help="rounds, of which the median counts")
    parser.add_argument("--quick", action="store_true", help="a sixteenth of the runs, once, as a check")
    return parser.parse_args()


if __name__ == "__main__":
    main()
