"""A map into a store and into memory: `python -m benchmarks.ensembles.stores`, part of `make bench`.

Both alternate in one process for each size of chunks; the fastest wall time of the rounds counts. It fails if a store
takes more than half as long again as memory.
"""

import argparse
import time
from itertools import product
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import stylobate as sb
from stylobate.studies.sweeps import Sweep, run_sweep

from .quiet import wait_for_quiet

_FOLDER = Path(__file__).parents[2] / "docs" / "_static" / "benchmarks"
_DURATION = 60.0
_CHUNKS = (None, 256, 64)
_MOST = 1.5


def main() -> None:
    """Time the map and write the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.ensembles.stores", description=__doc__)
    parser.add_argument("--into", type=Path, default=_FOLDER, help="folder for the table")
    parser.add_argument("--disk", type=Path, help="folder for the stores, by default that of temporary files")
    parser.add_argument("--edge", type=int, default=200, help="values along each axis of the map")
    parser.add_argument("--rounds", type=int, default=3, help="number of rounds; the fastest counts")
    arguments = parser.parse_args()
    sweep = _map(arguments.edge)
    run_sweep(sweep, progress=False)  # compiles
    found: dict[tuple[int | None, bool], list[float]] = {way: [] for way in product(_CHUNKS, (False, True))}
    files = dict.fromkeys(_CHUNKS, 0)
    wait_for_quiet()
    for _ in range(arguments.rounds):
        for (size, stored), seconds in found.items():
            with TemporaryDirectory(dir=arguments.disk) as folder:
                path = Path(folder) / "map.zarr"
                begun = time.perf_counter()
                run_sweep(sweep, store=path if stored else None, chunk_size=size, progress=False)
                seconds.append(time.perf_counter() - begun)
                files[size] = sum(file.is_file() for file in path.rglob("*"))
    best = {way: min(seconds) for way, seconds in found.items()}
    rows = ["| runs in a chunk | memory [s] | store [s] | ratio | files |", "|---|---|---|---|---|"]
    for size in _CHUNKS:
        memory, store = best[size, False], best[size, True]
        name = "usual" if size is None else f"{size}"
        rows.append(f"| {name} | {memory:.2f} | {store:.2f} | {store / memory:.2f} | {files[size]} |")
    text = "\n".join(rows) + "\n"
    arguments.into.mkdir(parents=True, exist_ok=True)
    (arguments.into / "stores.txt").write_text(text, encoding="utf-8")
    print(text)
    if any(best[size, True] > _MOST * best[size, False] for size in _CHUNKS):
        raise SystemExit(f"a store takes more than {_MOST} times as long as memory")


def _map(edge: int) -> Sweep:
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=1.8)
    over = {"angular_frequency": np.linspace(0.5, 6.0, edge), "damping": np.linspace(0.05, 0.3, edge)}
    return Sweep.grid(model, motion, over=over, duration=_DURATION)


if __name__ == "__main__":
    main()
