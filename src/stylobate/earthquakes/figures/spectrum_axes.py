"""Horizontal axes of spectra: size, frequency over p, period, or the parameter itself."""

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
# Maximum number of names of motions with horizontal text; more are vertical.
_SHORT = 3


class Horizontal(NamedTuple):
    """Values along the horizontal axis, their label, and names in place of numbers, if any."""

    values: Floats
    label: str
    names: tuple[str, ...] = ()


def split(found: xr.Dataset, dims: list[str], most: int, what: str) -> tuple[str | None, str | None]:
    """Return the dimension along the axis (the longest) and the dimension of the panels or curves.

    Raises
    ------
    ParameterError
        If there are more than two dimensions, or more than `most` values along the second.
    """
    ordered = sorted(dims, key=lambda dim: -found.sizes[dim])
    if len(ordered) > _PLANE or (len(ordered) == _PLANE and found.sizes[ordered[1]] > most):
        raise ParameterError(
            f"a figure of {what} has one dimension, or two with up to {most} values along one of them; got "
            f"{ {dim: found.sizes[dim] for dim in dims} }: choose some by found.sel(...) or found.isel(...)"
        )
    return (ordered[0] if ordered else None), (ordered[1] if len(ordered) == _PLANE else None)


def named(found: xr.Dataset, dim: str, place: int) -> str:
    """Return the name of one value along a dimension, such as "slenderness 0.1"."""
    if dim == "motion":
        return str(found["motion_name"][place].item())
    return f"{axis_label(found[dim]).partition(' [')[0]} {found[dim][place].item():.4g}"


def motion_names(found: xr.Dataset) -> Horizontal:
    """Return the positions of several motions with their names."""
    names = tuple(str(name) for name in found["motion_name"].to_numpy())
    return Horizontal(np.arange(float(len(names))), "base motion", names)


def finish(axes: Axes, along: Horizontal) -> None:
    """Set scale, ticks and label of the horizontal axis."""
    if along.names:
        rotation = 0 if len(along.names) <= _SHORT else 90
        axes.set_xticks(along.values, along.names, rotation=rotation)
    else:
        set_scale(axes, "x", along.values)
    axes.set_xlabel(along.label)
