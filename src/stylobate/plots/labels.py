"""Labels: name, symbol and unit of a quantity, ratios such as a/g without units, and what varies between runs."""

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, TypeVar

import xarray as xr

from stylobate.base_motions.declared import motion_quantities
from stylobate.models.declared import column_quantities, model_quantities
from stylobate.quantities import Quantity
from stylobate.results import Run
from stylobate.run_arguments import run_numbers
from stylobate.text import printable, unit_in_text

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
    if isinstance(found, Run) and is_dimensionless(found.provenance):
        found = replace(found, data=_relabelled(found.data))
    elif isinstance(found, xr.Dataset) and is_dimensionless(json.loads(found.attrs.get("provenance", "{}"))):
        found = _relabelled(found)
    elif isinstance(found, Sequence) and any(isinstance(one, Run | xr.Dataset) for one in found):
        found = [in_own_units(one) for one in found]
    return found  # type: ignore[no-any-return]


def literal(name: str) -> str:
    """Return a name that Matplotlib prints as it is; it typesets the text between two dollar signs as TeX."""
    return _DOLLAR.sub(r"\\$", printable(name))


def with_literal_names(data: xr.Dataset) -> xr.Dataset:
    """Return the Dataset of a study with literal names of records, columns and the like."""
    named = {name: one for name, one in data.coords.items() if one.ndim == 1 and one.dtype.kind in "OU"}
    names = {name: [str(each) for each in one.to_numpy()] for name, one in named.items()}
    return data.assign_coords(
        {name: named[name].copy(data=own) for name, some in names.items() if (own := list(map(literal, some))) != some}
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


_MOST_NAMES = 2
# Inputs that follow from changes of a motion.
_OF_CHANGES = ("motion.digest", "motion.repr")
# Inputs that follow from others, or that no reader would name a run by.
_SILENT = (
    "version",
    "processor",
    "column.transverse_inertia",
    "column.axial_inertia",
    "column.mass",
    "rules",
    "recheck",
    "samples",
    "atol",
)


def what_varies(runs: Sequence[Run]) -> list[str]:
    """Return a name for each of several runs: the values of up to two inputs that differ; else the outcome.

    Inputs are compared as the provenance of the runs states them.
    """
    outcomes = [run.outcome.label for run in runs]
    inputs = [dict(_flat(one)) for one in _with_named_motions([run.provenance for run in runs])]
    names = [name for name in inputs[0] if all(name in one for one in inputs) and not name.startswith(_SILENT)]
    varied = [name for name in names if len({repr(one.get(name)) for one in inputs}) > 1]
    if "motion.changes" in varied:
        varied = [name for name in varied if name not in _OF_CHANGES]
    # Without a duration of its own, a run's duration follows from the other inputs.
    varied = [name for name in varied if name != "duration"] or varied
    if any(name.startswith("column.") for name in varied):
        sizes = [run.data.attrs["slenderness"] for run in runs]
        own = [name for name in varied if not name.startswith("column.")]
        if len(set(sizes)) > 1:
            for one, c in zip(inputs, sizes, strict=True):
                one["slenderness"] = float(c)
            varied = ["slenderness", *own]
    # What decides differs between all runs; of two such inputs, the first stated is the cause.
    varied.sort(key=lambda name: -len({repr(one.get(name)) for one in inputs}))
    shown = varied[:_MOST_NAMES]
    texts = [", ".join(_written(name, one.get(name)) for name in shown if one.get(name) is not None) for one in inputs]
    return [text or outcome for text, outcome in zip(texts, outcomes, strict=True)] if shown else outcomes


def _flat(values: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    for name, value in values.items():
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield f"{prefix}{name}", value


def _with_named_motions(inputs: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return the inputs with base motions as their origin and, in words, the changes that not all runs share."""
    motions = [_origin(one.get("motion") or {}) for one in inputs]
    steps = [changes for _, changes in motions]
    shared = 0
    while all(len(one) > shared and one[shared] == steps[0][shared] for one in steps):
        shared += 1
    changed = any(len(one) > shared for one in steps)
    return [
        {**one, "motion": {**origin, "changes": _in_words(origin, changes[shared:]) if changed else ""}}
        for one, (origin, changes) in zip(inputs, motions, strict=True)
    ]


def _origin(motion: Mapping[str, Any]) -> tuple[dict[str, Any], list[Any]]:
    """Return the motion that was changed, and the changes in their order."""
    changes: list[Any] = []
    while "motion" in motion:
        own = {name: value for name, value in motion.items() if name not in ("kind", "motion")}
        changes.insert(0, {"method": motion["kind"], **own})
        motion = motion["motion"]
    origin = {name: value for name, value in motion.items() if name != "processing"}
    return origin, [*motion.get("processing", ()), *changes]


def _in_words(origin: Mapping[str, Any], changes: Sequence[Any]) -> str:
    """Write changes of a motion, such as "0.5 × El Centro 1940" or "rotated by 0.3 rad"."""
    factors = [one for one in changes if isinstance(one, Mapping) and one["method"] == "scaled"]
    words = [_change(one) for one in changes if one not in factors]
    if factors or not words:
        path = origin.get("path") or ""
        file = Path(path if isinstance(path, str) else path[0]).stem
        name = origin.get("record") or str(origin.get("sample") or "").title() or file
        name = name or str(origin.get("kind", "")).replace("_", " ")
        factor = math.prod(one["factor"] for one in factors)
        vertical = math.prod(one["factor"] if one.get("vertical") is None else one["vertical"] for one in factors)
        words.insert(0, f"{factor:.4g} × {name}" if factors else name)
        if vertical != factor:
            words.insert(1, f"vertical {vertical:.4g} ×")
    return ", ".join(words)


def _change(step: Any) -> str:
    """Write a change other than a factor, such as "rotated by 0.3 rad"; records of samples state theirs in words."""
    if not isinstance(step, Mapping):
        return str(step)
    values = {name: value for name, value in step.items() if name != "method" and value is not None}
    written = [_written(f"motion.{name}", value) for name, value in values.items()]
    if len(values) == 1:
        (name,) = values
        written = [f"by {motion_quantities()[name].shown(values[name])}"] if name in motion_quantities() else written
    return " ".join([str(step["method"]).replace("_", " "), ", ".join(written)]).rstrip()


def _written(name: str, value: Any) -> str:
    room, _, last = name.rpartition(".")
    if name == "motion.changes":
        return str(value)
    if last == "kind":
        return str(value).replace("_", " ")
    quantity = _declared(room).get(last)
    label = quantity.symbol if quantity is not None and quantity.symbol else last.replace("_", " ")
    if isinstance(value, list | tuple):
        value = next((one for one in value if one), 0.0) if sum(map(bool, value)) <= 1 else tuple(value)
    number = f"{value:.4g}" if isinstance(value, int | float) and not isinstance(value, bool) else str(value)
    unit = "" if quantity is None or not quantity.unit else f" {quantity.unit}"
    return f"{label} {'= ' if quantity is not None and quantity.symbol else ''}{number}{unit}"


def _declared(room: str) -> Mapping[str, Quantity]:
    """Return the declared quantities of a part of the inputs: column, model, motion, or else the run."""
    parts = {"motion": motion_quantities, "column": column_quantities, "model": model_quantities}
    if (read := parts.get(room.partition(".")[0])) is not None:
        return read()
    return {**{name: one.quantity for name, one in run_numbers().items()}, **column_quantities()}
