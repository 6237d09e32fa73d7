"""Imports of every process that computes for the laboratory: a fork server imports this module before it forks them."""

import gc

from stylobate.processes import ending_with_parent

with ending_with_parent():  # a fork server does not notice the end of its parent while it imports
    import xarray

    from stylobate.engine import single
    from stylobate.lab import pool, tasks

    # The first dataset imports the array libraries that xarray finds.
    xarray.Dataset({"time": ("time", [0.0])})

# No process searches these objects again; a search at the end of one takes longer than all else.
gc.freeze()

__all__ = ["pool", "single", "tasks"]
