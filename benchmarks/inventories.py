"""Time and memory of inventories: `python -m benchmarks.inventories`.

Each number of objects is computed in a process of its own, under 100 synthetic records of three components, with 20
samples of each object; then once more from the store. The last row continues the first two on a line.
"""

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import stylobate as sb

TARGET = Path("docs/_static/benchmarks/inventories.txt")
SIZES, WHOLE = (25, 100), 1000
RECORDS, SAMPLES = 100, 20


def quakes() -> dict[str, sb.Record]:
    """Return synthetic records of 20 s."""
    noise = sb.records.EvolvingNoise(arias=1.2, duration_5_95=8.0, middle_time=5.0, frequency=2.5, bandwidth=0.3)
    made = (noise.record(np.random.default_rng(seed), components=3, step=0.01) for seed in range(RECORDS))
    return {f"motion {place:03d}": record.trimmed(0.0, 20.0) for place, record in enumerate(made)}


def vessels(number: int) -> list[sb.earthquakes.InventoryObject]:
    """Return objects of 0.16 to 4 m, of which some slide before they rock."""
    rng = np.random.default_rng(5)
    spreads = {name: sb.earthquakes.LognormalSpread(one) for name, one in (("radius", 0.02), ("damping", 0.4))}
    found = []
    for place in range(number):
        radius = rng.uniform(0.04, 0.3)
        column = {"radius": radius, "height": radius * rng.uniform(4.0, 12.0), "density": rng.uniform(1500.0, 2700.0)}
        one = sb.earthquakes.InventoryObject(
            name=f"vessel {place:04d}",
            column=column,
            model={"damping": "housner"},
            friction_coefficient=rng.uniform(0.15, 0.7),
            spreads=spreads,
        )
        found.append(one)
    return found


def measure(number: int) -> None:
    """Compute an inventory of so many objects, and print its runs, times [s] and peak memory [MB] as JSON."""
    records, objects = quakes(), vessels(number)
    sb.earthquakes.inventory(objects[:1], records, samples=1, progress=False)  # compiles
    with tempfile.TemporaryDirectory() as store:
        since, used = time.perf_counter(), time.process_time()
        found = sb.earthquakes.inventory(objects, records, samples=SAMPLES, store=store, progress=False)
        took, used = time.perf_counter() - since, time.process_time() - used
        since = time.perf_counter()
        again = sb.earthquakes.inventory(objects, records, samples=SAMPLES, store=store, progress=False)
        kept = time.perf_counter() - since
    assert again.identical(found)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    print(json.dumps([int(found["runs"].sum()), took, used, kept, peak]))


def main() -> None:
    """Measure all sizes and write the table."""
    found = {}
    for number in SIZES:
        command = [sys.executable, "-m", "benchmarks.inventories", str(number)]
        answer = subprocess.run(command, check=True, capture_output=True, text=True)  # noqa: S603  this program
        found[number] = np.array(json.loads(answer.stdout.splitlines()[-1]))
    few, many = SIZES
    slope = (found[many] - found[few]) / (many - few)
    found[WHOLE] = found[many] + (WHOLE - many) * np.maximum(slope, 0.0)
    head = "| objects | runs | elapsed | processor time | from the store | peak memory |\n|---|---|---|---|---|---|\n"
    rows = []
    for number, (runs, took, used, kept, peak) in found.items():
        name, unit, seconds = (f"{number}, extrapolated", "min", 60.0) if number == WHOLE else (str(number), "s", 1.0)
        times = " | ".join(f"{one / seconds:.{digits}f} {unit}" for one, digits in ((took, 0), (used, 0), (kept, 1)))
        rows.append(f"| {name} | {f'{round(runs):,}'.replace(',', ' ')} | {times} | {peak:.0f} MB |")
    TARGET.write_text(head + "\n".join(rows) + "\n", encoding="utf-8")
    print(TARGET.read_text(encoding="utf-8"))


if __name__ == "__main__":
    if len(sys.argv) > 1:
        measure(int(sys.argv[1]))
    else:
        main()
