"""Results as tables: of text, as the command line prints them, and in pandas."""

import json
import math
from collections.abc import Hashable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from stylobate.errors import ParameterError
from stylobate.files import csv_text, write_whole, write_workbook
from stylobate.text import did_you_mean, plural, unit_in_text

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr

# Dimensions of the components of one quantity.
_COMPONENTS = ("axis", "component", "direction", "part")


class ResultTable(NamedTuple):
    """A result as a table: its title, the names of its columns, its rows, and remarks below it."""

    title: str
    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    remarks: Sequence[str] = ()


def number_of_runs(data: "xr.Dataset", over: str = "", word: str = "run") -> str:
    """Describe in words the number of runs of a study, and the number of computed runs."""
    done, total = int(data["computed"]), data["outcome"].size
    return f"{plural(total, word)}{over}" + (f", {done} of them done" if done < total else "")


def model_named(data: "xr.Dataset") -> str:
    """Return the model of the runs in `data` in words, with its damping unless the damping varies."""
    model = json.loads(data.attrs["provenance"]).get("model", {})
    damping = "" if "damping" not in model or "damping" in data.dims else f", damping {model['damping']:g}"
    return f"model {model.get('kind', 'unknown')}{damping}"


class Practical(NamedTuple):
    """A unit of a column of a table: its name, and the factor of numbers in SI units."""

    factor: float
    name: str

    @property
    def bracketed(self) -> str:
        """The unit in brackets; empty without unit."""
        return f"[{self.name}]" if self.name else ""


DEGREES = Practical(180.0 / math.pi, "°")


def practical(values: Iterable[float], units: str) -> Practical:
    """Choose the unit of a table: millimetres if all lengths or speeds are below one metre, and degrees.

    Parameters
    ----------
    values
        The numbers in SI units; those that are not finite do not count.
    units
        Their units as in netCDF files, such as "m s-1".
    """
    unit = unit_in_text(units)
    if unit == "rad":
        return DEGREES
    if unit in ("m", "m/s") and max((abs(one) for one in values if math.isfinite(one)), default=0.0) < 1.0:
        return Practical(1000.0, f"m{unit}")
    return Practical(1.0, unit)


def to_dataframe(data: "xr.Dataset", over: str | Sequence[str] | None = None) -> "pd.DataFrame":
    """Convert the Dataset of a run, an ensemble or a study to a table in pandas.

    Parameters
    ----------
    data
        The Dataset.
    over
        Dimensions whose combinations are the rows: by default those of `outcome`, one row per run, or else those of the
        first variable.

    Returns
    -------
    pandas.DataFrame
        Its index has the coordinates of the rows. Each variable over all of `over` is a column; with components, or
        another dimension that names its entries, a column per name, such as `tilt_x` and `tilt_y`. Codes such as those
        of outcomes are categories with the names of the codes. Variables over other dimensions, such as the samples of
        a history, are left out. `attrs["units"]` has the units of columns and index by name.

    Raises
    ------
    ParameterError
        If the Dataset lacks a dimension of `over`.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.15, angular_frequency=0.5)
    >>> runs = sb.simulate_ensemble(model, motion, duration=50.0, parameters={"acceleration": [0.05, 0.15]})
    >>> sb.results.to_dataframe(runs)[["acceleration", "outcome", "peak_tilt"]].round(3)
         acceleration     outcome  peak_tilt
    run
    0            0.05     AT_REST       0.00
    1            0.15  OVERTURNED       0.25
    """
    import pandas as pd

    rows = _rows_of(data, over)
    columns = dict[str, Any]()
    units = {str(name): str(one.attrs["units"]) for name, one in data.coords.items() if "units" in one.attrs}
    for name, variable in data.data_vars.items():
        if set(rows) <= set(variable.dims):
            parts = list(_parts_of(str(name), variable.transpose(*rows, ...), rows))
            columns |= {label: _coded(part) for label, part in parts}
            units |= {label: str(part.attrs["units"]) for label, part in parts if "units" in part.attrs}
    for name, variable in data.coords.items():  # such as the intensity of each run
        if name not in data.indexes and set(variable.dims) == set(rows):
            columns[str(name)] = variable.transpose(*rows).to_numpy().ravel()
    index = [data.indexes[dim] if dim in data.indexes else pd.RangeIndex(data.sizes[dim], name=dim) for dim in rows]
    index = index or [pd.RangeIndex(1)]  # one run
    table = pd.DataFrame(columns, index=index[0] if len(index) == 1 else pd.MultiIndex.from_product(index))
    known = {*columns, *table.index.names}
    table.attrs["units"] = {name: unit for name, unit in units.items() if name in known}
    return table


TABLES = (".csv", ".xlsx")
"""Endings of files of a table."""


def write_table(data: "xr.Dataset", path: str | Path) -> Path:
    """Write the table of a run, an ensemble or a study, as of `to_dataframe`, into a CSV file or an Excel workbook.

    The first row has the names, with units in brackets; numbers that are not finite are empty cells of a workbook.

    Parameters
    ----------
    data
        The Dataset.
    path
        File that ends with `.csv` or `.xlsx`.

    Raises
    ------
    ParameterError
        If the path has another ending.
    UnsupportedError
        If openpyxl is not installed and the path ends with `.xlsx`.
    FileError
        If the file cannot be written.
    """
    target = Path(path)
    if target.suffix not in TABLES:
        raise ParameterError(f"path: must end with {' or '.join(TABLES)} (got {str(path)!r}). Change the ending.")
    table = to_dataframe(data)
    units = {name: unit_in_text(unit) for name, unit in table.attrs["units"].items()}
    table = table.reset_index() if None not in table.index.names else table
    header = [f"{name} [{units[name]}]" if units.get(name) else str(name) for name in table.columns]
    rows = table.astype(object).to_numpy().tolist()
    if target.suffix == ".xlsx":
        return write_workbook(target, {str(data.attrs.get("kind", "run"))[:_SHEET]: [header, *rows]})
    return write_whole(target, csv_text(header, rows))


# Largest number of characters in the name of a sheet.
_SHEET = 31


def _rows_of(data: "xr.Dataset", over: str | Sequence[str] | None) -> tuple[Hashable, ...]:
    if over is None:
        first = data["outcome"] if "outcome" in data else next(iter(data.data_vars.values()))
        return tuple(dim for dim in first.dims if dim not in _COMPONENTS)
    dims = (over,) if isinstance(over, str) else tuple(over)
    for dim in dims:
        if dim not in data.sizes:
            remedy = did_you_mean(dim, map(str, data.sizes)) or f"Its dimensions are {', '.join(map(str, data.sizes))}."
            raise ParameterError(f"over: the Dataset has no such dimension (got {dim!r}). {remedy}")
    return dims


def _parts_of(name: str, variable: "xr.DataArray", rows: Sequence[Hashable]) -> "Iterator[tuple[str, xr.DataArray]]":
    """Yield a variable, or its parts along dimensions that name their entries, with their names."""
    others = [dim for dim in variable.dims if dim not in rows]
    if not others:
        yield name, variable
    elif others[0] in variable.coords and variable[others[0]].dtype.kind in "OUT":
        for place, label in enumerate(variable[others[0]].to_numpy()):
            yield from _parts_of(f"{name}_{label}", variable.isel({others[0]: place}, drop=True), rows)


def _coded(variable: "xr.DataArray") -> Any:
    """Return the values of a variable, shape (rows,); codes as categories."""
    values = variable.to_numpy().ravel()
    if "flag_meanings" not in variable.attrs:
        return values
    import pandas as pd

    codes, names = np.atleast_1d(variable.attrs["flag_values"]), str(variable.attrs["flag_meanings"]).split()
    return pd.Categorical.from_codes(np.searchsorted(codes, values).tolist(), categories=names)
