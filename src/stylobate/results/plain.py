"""Plain values of results, which JSON can hold: numbers for arrays and NumPy scalars, and values by name."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Never, TypeVar

import numpy as np
import numpy.typing as npt

from stylobate.errors import UnknownNameError
from stylobate.text import did_you_mean

if TYPE_CHECKING:
    import xarray as xr

_T = TypeVar("_T")


class ByName(dict[str, _T]):
    """Values of a result by name; an unknown name raises a KeyError that suggests the most similar one.

    >>> ByName(peak_tilt=0.1, turns=0.0)["peak_tlit"]
    Traceback (most recent call last):
    ...
    stylobate.errors.UnknownNameError: the result has no such name (got 'peak_tlit'); did you mean peak_tilt?
    """

    def __missing__(self, name: object) -> Never:
        remedy = did_you_mean(str(name), self) or f"its names are {', '.join(self) or 'none'}"
        raise UnknownNameError(f"the result has no such name (got {name!r}); {remedy}")


def plain_numbers(values: npt.ArrayLike, digits: int) -> list[Any]:
    """Return an array as lists of numbers with `digits` significant digits; None replaces NaN and infinities.

    Examples
    --------
    >>> plain_numbers([0.123456, float("nan"), 5e-324], 3)
    [0.123, None, 0.0]
    """
    array = np.asarray(values)
    if array.dtype.kind != "f":
        return list(array.tolist())
    finite = np.isfinite(array)
    known = np.where(finite & (array != 0.0), array, 1.0)
    places = digits - 1 - np.floor(np.log10(np.abs(known)))
    # Powers of ten up to 10²² are exact, so that the quotient is the double nearest to the short decimal.
    scale = 10.0 ** np.clip(places, 0, 22)
    rounded = np.where(array == 0.0, 0.0, np.rint(known * scale) / scale)
    if finite.all():
        return list(rounded.tolist())
    values = rounded.astype(object)
    values[~finite] = None
    return list(values.tolist())


def plain_value(value: Any) -> Any:
    """Replace NumPy scalars by plain Python numbers, at any depth of mappings, lists and tuples.

    Examples
    --------
    >>> plain_value({"uncertain": np.bool_(True), "ends": (np.float64(0.5), 1)})
    {'uncertain': True, 'ends': (0.5, 1)}
    """
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, Mapping):
        return ByName({name: plain_value(one) for name, one in value.items()})
    if type(value) in (list, tuple):
        return type(value)(plain_value(one) for one in value)
    return value


def plain_variables(data: "xr.Dataset") -> dict[str, Any]:
    """Return the values of a Dataset as plain values by name, and the names of the dimensions of its variables."""
    dims = {str(name): [str(dim) for dim in one.dims] for name, one in data.data_vars.items()}
    return {"dims": dims} | {str(name): data[name].to_numpy().tolist() for name in (*data.coords, *data.data_vars)}
