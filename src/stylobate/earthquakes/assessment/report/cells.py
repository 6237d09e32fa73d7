"""Iteration over the cells of a Dataset, with their labels as text."""

from collections.abc import Iterator
from itertools import product

import xarray as xr


def cells(data: xr.Dataset, *dims: str) -> Iterator[tuple[tuple[str, ...], xr.Dataset]]:
    """Yield the labels of each cell over `dims` as text, and its data; the last dimension varies fastest."""
    for values in product(*(data[dim].to_numpy() for dim in dims)):
        labels = tuple(f"{value:g}" if dim == "scale" else str(value) for dim, value in zip(dims, values, strict=True))
        yield labels, data.sel(dict(zip(dims, values, strict=True)))
