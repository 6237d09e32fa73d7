"""What spectra are drawn against: size, frequency over p, period, or the parameter itself."""

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
import xarray as xr
from matplotlib.axes import Axes

from stylobate.errors import ParameterError
from stylobate.plots.cells import set_scale
from stylobate.plots.labels import axis_label

Floats = npt.NDArray[np.float64]

_PLANE = 2
# Beyond so many names of motions in a row they are written upright.
_SHORT = 3


class Horizontal(NamedTuple):
    """Values along the horizontal axis, what they are called, and the names that stand for them, if any do."""

    values: Floats
    label: str
    names: tuple[str, ...] = ()


def split(found: xr.Dataset, dims: list[str], most: int, what: str) -> tuple[str | None, str | None]:
    """Return the dimension along the axis and that of the panels or curves; the one of most values comes first.

    Raises
    ------
    ParameterError
        If there are more than two, or more than so many values along the second.
    """
    ordered = sorted(dims, key=lambda dim: -found.sizes[dim])
    if len(ordered) > _PLANE or (len(ordered) == _PLANE and found.sizes[ordered[1]] > most):
        message = (
            f"a figure of {what} is over one name, or two with up to {most} values of one of them; got "
            f"{ {dim: found.sizes[dim] for dim in dims} }: choose some by found.sel(...) or found.isel(...)"
        )
        raise ParameterError(message)
    return (ordered[0] if ordered else None), (ordered[1] if len(ordered) == _PLANE else None)


def named(found: xr.Dataset, dim: str, place: int) -> str:
    """Return the name of one value along a dimension, such as "slenderness 0.1"."""
    if dim == "motion":
        return str(found["motion_name"][place].item())
    return f"{axis_label(found[dim]).partition(' [')[0]} {found[dim][place].item():.4g}"


def motion_names(found: xr.Dataset) -> Horizontal:
    """Return the places of several motions with their names."""
    names = tuple(str(name) for name in found["motion_name"].to_numpy())
    return Horizontal(np.arange(float(len(names))), "base motion", names)


def finish(axes: Axes, along: Horizontal) -> None:
    """Scale, mark and name the horizontal axis."""
    if along.names:
        rotation = 0 if len(along.names) <= _SHORT else 90
        axes.set_xticks(along.values, along.names, rotation=rotation)
    else:
        set_scale(axes, "x", along.values)
    axes.set_xlabel(along.label)
