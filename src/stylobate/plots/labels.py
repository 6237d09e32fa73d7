"""Labels of axes: name, symbol and unit of a quantity; ratios such as a/g for a dimensionless column."""

import json
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import xarray as xr

from stylobate.results import Response
from stylobate.text import unit_in_text

# SI units in units of a column with m = g = ω0 = 1, as TeX.
_OWN_UNITS = {
    "rad s-1": r"$\omega_0$",
    "s-1": r"$\omega_0$",
    "m s-2": "$g$",
    "s": r"$1/\omega_0$",
    "m": r"$g/\omega_0^2$",
    "m s-1": r"$g/\omega_0$",
}
# Quantities whose label states the ratio itself.
_OWN_LABELS = {
    "angular_frequency": r"base frequency $\Omega/\omega_0$",
    "acceleration": "base acceleration $a/g$",
    "amplitude_x": "base acceleration along x, $a_x/g$",
    "amplitude_y": "base acceleration along y, $a_y/g$",
    "base_acceleration": "base acceleration $a/g$",
    "time": r"time $\omega_0 t$",
    "spin": r"spin $\sigma/\omega_0$",
}
_LABEL, _UNIT = "axis_label", "axis_unit"
# A symbol with an index in a name, such as α_c.
_INDEXED = re.compile(r"\b([^\W\d_])_([^\W_])\b")
_DOLLAR = re.compile(r"(?<!\\)\$")
# Relative tolerance for rounding.
_ROUNDING = 1e-9

_Result = TypeVar("_Result")


def axis_label(quantity: xr.DataArray, name: str | None = None) -> str:
    """Return the label of an axis, such as "angular frequency [rad/s]" or, for a dimensionless column, a ratio.

    Parameters
    ----------
    quantity
        The quantity on the axis, with the attributes `units` and `long_name`.
    name
        A name in place of `long_name`; the unit is added.
    """
    if name is None and _LABEL in quantity.attrs:
        return str(quantity.attrs[_LABEL])
    named = str(quantity.attrs.get("long_name") or str(quantity.name).replace("_", " "))
    shown = name or _INDEXED.sub(r"$\1_\2$", named)
    unit = unit_label(quantity)
    return f"{shown} [{unit}]" if unit else shown


def unit_label(quantity: xr.DataArray) -> str:
    """Return the unit of a quantity in print, such as m/s² for "m s-2"; empty for a number without unit."""
    if _UNIT in quantity.attrs:
        return str(quantity.attrs[_UNIT])
    unit = str(quantity.attrs.get("units", ""))
    return unit_in_text(unit)


def in_own_units(result: _Result) -> _Result:
    """Return a result that labels its quantities in units of its column, if that column is dimensionless.

    The values do not change: for a column with m = g = ω0 = 1 they are the values of the dimensionless equations. Other
    results are returned unchanged. The provenance, which files contain, states whether a column is dimensionless.

    Parameters
    ----------
    result
        A run, the Dataset of a study, or a sequence of either.
    """
    found: Any = result
    if isinstance(found, Response) and is_dimensionless(found.provenance):
        found = replace(found, data=_relabelled(found.data))
    elif isinstance(found, xr.Dataset) and is_dimensionless(json.loads(found.attrs.get("provenance", "{}"))):
        found = _relabelled(found)
    elif isinstance(found, Sequence) and any(isinstance(one, Response | xr.Dataset) for one in found):
        found = [in_own_units(one) for one in found]
    return found  # type: ignore[no-any-return]


def literal(name: str) -> str:
    """Return a name that Matplotlib prints as it is; it typesets the text between two dollar signs as TeX."""
    return _DOLLAR.sub(r"\\$", name)


def with_literal_names(data: xr.Dataset) -> xr.Dataset:
    """Return the Dataset of a study with literal names of records, columns and the like."""
    named = {name: one for name, one in data.coords.items() if one.ndim == 1 and one.dtype.kind in "OU"}
    names = {name: [str(each) for each in one.to_numpy()] for name, one in named.items()}
    return data.assign_coords(
        {name: named[name].copy(data=list(map(literal, some))) for name, some in names.items() if "$" in "".join(some)}
    )


def is_dimensionless(provenance: Mapping[str, Any]) -> bool:
    """Return whether a result has a column with m = g = ω0 = 1; two compared models have the same column."""
    column = provenance.get("column") or provenance.get("first", {}).get("column") or {}
    try:
        mass, gravity, height = (float(column[name]) for name in ("mass", "gravity", "mass_height"))
        inertia = float(column["transverse_inertia"]) + mass * height**2
    except KeyError:
        return False
    return mass == gravity == 1.0 and math.isclose(height, inertia, rel_tol=_ROUNDING)


def _relabelled(data: xr.Dataset) -> xr.Dataset:
    data = data.copy(deep=False)
    for name, variable in data.variables.items():
        unit = _OWN_UNITS.get(str(variable.attrs.get("units", "")))
        if unit is not None:
            label = _OWN_LABELS.get(str(name))
            variable.attrs = {**variable.attrs, _UNIT: unit} | ({} if label is None else {_LABEL: label})
    return data
