"""Compared engines: preparation, and number of timed runs of each workload."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec

from . import diffrax_lanes, heyoka_batch, numba_loops, ours, scipy_loop
from .answers import Answer
from .workloads import MIX_DISTINCT, Workload

Solve = Callable[[Workload], Answer]

_OWN_COUNTS = {"rolling": 16384, "mix": 128 * MIX_DISTINCT}


@dataclass(frozen=True, slots=True)
class Engine:
    """One engine.

    Parameters
    ----------
    name
        Name in tables.
    key
        Name in files.
    prepare
        Function that compiles for a workload and returns a solver.
    counts
        Number of timed runs of each supported workload, about one second each.
    lanes
        Minimum number of simultaneous runs.
    warm_up
        Number of runs of the first call, which is not timed; by default all.
    needs
        Required packages; without them the engine is skipped.
    dop853
        Whether its steps are DOP853 steps, whose arithmetic is known.
    """

    name: str
    key: str
    prepare: Callable[..., Solve]
    counts: Mapping[str, int]
    needs: tuple[str, ...] = ()
    lanes: int = 1
    warm_up: int | None = None
    dop853: bool = False

    @property
    def missing(self) -> tuple[str, ...]:
        """The packages that are not installed."""
        return tuple(package for package in self.needs if find_spec(package) is None)


def all_engines() -> list[Engine]:
    """Return the engines, the slowest first."""
    return [
        Engine(
            scipy_loop.NAME,
            "scipy",
            scipy_loop.prepare,
            {"rolling": 32, "mix": MIX_DISTINCT},
            warm_up=4,
            dop853=True,
        ),
        _diffrax(),
        *(_heyoka(width) for width in (8, 16)),
        *_ours(),
    ]


def engines_by_tolerance() -> list[Engine]:
    """Return the engines whose `prepare` also takes tolerances, the slowest first."""
    return [
        Engine(
            numba_loops.SCIPY_NAME,
            "scipy-numba",
            numba_loops.prepare_scipy,
            {"rolling": 64, "mix": 1024},
            needs=("numba",),
            warm_up=4,
        ),
        Engine(
            numba_loops.CYRK_NAME,
            "cyrk",
            numba_loops.prepare_cyrk,
            {"rolling": 1024},
            needs=("CyRK", "numba"),
            warm_up=4,
        ),
        _diffrax(),
        _heyoka(8),
        *_ours(),
    ]


def _diffrax() -> Engine:
    return Engine(
        diffrax_lanes.NAME,
        "diffrax",
        diffrax_lanes.prepare,
        {"rolling": diffrax_lanes.LANES, "mix": 2 * MIX_DISTINCT},
        needs=("diffrax", "jax"),
        lanes=diffrax_lanes.LANES,
    )


def _heyoka(width: int) -> Engine:
    return Engine(
        heyoka_batch.name(width),
        f"heyoka{width}",
        partial(heyoka_batch.prepare, width=width),
        {"rolling": 8192, "mix": 32 * MIX_DISTINCT},
        needs=("heyoka",),
    )


def _ours() -> list[Engine]:
    return [
        Engine(name, method, partial(ours.prepare, method=method), _OWN_COUNTS, dop853=method == "dop853")
        for method, name in ours.NAMES.items()
    ]
