"""
How do I resume a long computation after an interruption?
=========================================================

Compute a sweep into a store on disk. If the computation stops, the same call with
``resume=True`` computes only what is missing.
"""

import tempfile
from pathlib import Path

import numpy as np

import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
circle = sb.Harmonic.circular(acceleration=0.1, angular_frequency=1.0)
sweep = sb.studies.Sweep.grid(
    model,
    circle,
    over={
        "angular_frequency": np.linspace(0.5, 6.0, 40),  # Ω/ω₀
        "acceleration": np.linspace(0.05, 0.6, 40),  # g
    },
    periods=30.0,
)


def stop_early(done, total):
    if done >= 0.75 * total:
        raise KeyboardInterrupt  # as if you pressed Ctrl-C


with tempfile.TemporaryDirectory() as folder:
    store = Path(folder) / "map.zarr"
    try:
        sb.studies.run_sweep(sweep, store=store, chunk_size=400, progress=stop_early)
    except KeyboardInterrupt:
        print("interrupted")
    unfinished = sb.load(store).load()
    print(f"runs in the store: {unfinished.attrs['runs_done']} of 1600")

    whole = sb.studies.run_sweep(sweep, store=store, resume=True).load()
    print(f"runs after resuming: {whole.attrs['runs_done']}")

sb.plot(unfinished)

# %%
# The store after the interruption: cells without a colour are not computed yet.
sb.plot(whole)

# %%
# The same store after it was resumed. See :doc:`/how-to/sweeps`.
