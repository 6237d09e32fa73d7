"""The engines that are compared: how each is prepared, and how many runs of each workload make a fair sample."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from importlib.util import find_spec

from . import diffrax_lanes, heyoka_batch, ours, scipy_loop
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
        In tables.
    key
        In files.
    prepare
        Compiles for a workload; returns what computes it.
    counts
        Runs timed of each workload, about one second of them.
    needs
        Packages without which it is skipped.
    dop853
        Whether a step of it is one of DOP853, whose arithmetic is known.
    """

    name: str
    key: str
    prepare: Callable[[Workload], Solve]
    counts: Mapping[str, int]
    needs: tuple[str, ...] = ()
    dop853: bool = False

    @property
    def missing(self) -> tuple[str, ...]:
        """The packages that are not installed."""
        return tuple(package for package in self.needs if find_spec(package) is None)


def all_engines() -> list[Engine]:
    """Return the engines, the slowest first."""
    return [
        Engine(scipy_loop.NAME, "scipy", scipy_loop.prepare, {"rolling": 32, "mix": MIX_DISTINCT}, dop853=True),
        Engine(
            diffrax_lanes.NAME,
            "diffrax",
            diffrax_lanes.prepare,
            {"rolling": diffrax_lanes.LANES, "mix": 2 * MIX_DISTINCT},
            needs=("diffrax", "jax"),
        ),
        *(
            Engine(
                heyoka_batch.name(width),
                f"heyoka{width}",
                partial(heyoka_batch.prepare, width=width),
                {"rolling": 8192, "mix": 32 * MIX_DISTINCT},
                needs=("heyoka",),
            )
            for width in (8, 16)
        ),
        *(
            Engine(name, method, partial(ours.prepare, method=method), _OWN_COUNTS, dop853=method == "dop853")
            for method, name in ours.NAMES.items()
        ),
    ]
