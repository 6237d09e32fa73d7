"""Registry of figures: the function that draws each kind of result."""

import pkgutil
from collections.abc import Callable, Sequence
from functools import cache
from importlib import import_module
from typing import Protocol, TypeAlias, TypeVar, runtime_checkable

import xarray as xr
from matplotlib.figure import Figure

from stylobate.errors import ParameterError
from stylobate.results import Run

Draw: TypeAlias = Callable[[xr.Dataset], Figure]
_Draw = TypeVar("_Draw", bound=Draw)

# Packages with figures; each is imported once, when the first result is drawn.
_FOLDERS = ("stylobate.plots", "stylobate.earthquakes.figures", "stylobate.conveying.figures")

_FIGURES: dict[str, Draw] = {}


@runtime_checkable
class HasPoints(Protocol):
    """A branch of orbits or a curve of bifurcations: its `points` are a Dataset."""

    @property
    def points(self) -> xr.Dataset:
        """Its points as data."""


def check_sequence(results: Sequence[object]) -> None:
    """Raise ParameterError unless there are results, and all are runs, or all have points."""
    if not results:
        raise ParameterError(
            f"result: nothing is in it (got {results!r}). Pass one run, branch or curve, or several of a kind."
        )
    kind = next((kind for kind in (Run, HasPoints) if isinstance(results[0], kind)), None)
    for place, one in enumerate(results):
        if kind is None or not isinstance(one, kind):
            raise ParameterError(
                f"result[{place}]: only runs, or only branches or curves, are drawn together (got "
                f"{type(one).__name__}). Remove it, or draw it alone."
            )


def figure_of(*kinds: str) -> Callable[[_Draw], _Draw]:
    """Register a function that draws results of these kinds, for use by `stylobate.plot`.

    Parameters
    ----------
    kinds
        Values of the attribute `kind` of Datasets.

    Examples
    --------
    A figure for a study of your own:

    >>> from matplotlib.figure import Figure
    >>> from stylobate.plots.kinds import figure_of
    >>> @figure_of("peak displacements")
    ... def plot_peak_displacements(data):
    ...     return Figure()
    """

    def registered(draw: _Draw) -> _Draw:
        _FIGURES.update(dict.fromkeys(kinds, draw))
        return draw

    return registered


def figure_for(kind: str) -> Draw | None:
    """Return the function that draws results of this `kind`, or None."""
    _import_figures()
    return _FIGURES.get(kind)


@cache
def _import_figures() -> None:
    for folder in _FOLDERS:
        for module in pkgutil.iter_modules(import_module(folder).__path__, f"{folder}."):
            if not module.ispkg:
                import_module(module.name)
