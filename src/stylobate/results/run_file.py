"""A run as a netCDF file: the samples as variables, everything else in the attributes."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stylobate.errors import FileError, Outcome
from stylobate.results.storage import OWN_FORMATS, read_dataset, require_this_version

_FORMAT = f"{OWN_FORMATS}run 1"
_OF_ORBITS = ("orbit", "branch", "bifurcation")
_WORDS, _FLAGS = ("reason", "decided_at"), ("uncertain", "planar")
_AS_JSON = ("thresholds", "measures", "provenance", "warnings")
_OWN_ATTRIBUTES = ("format", "outcome", *_WORDS, *_FLAGS, "events", *_AS_JSON)


def as_dataset(run: Any) -> xr.Dataset:
    """Return the samples of a `Run` as a Dataset, with its other fields as attributes."""
    attributes = {
        "format": _FORMAT,
        "outcome": run.outcome.name,
        **{name: getattr(run, name) for name in _WORDS},
        **{name: int(getattr(run, name)) for name in _FLAGS},
        "events": json.dumps([[event.kind, event.time] for event in run.events]),
        **{name: json.dumps(getattr(run, name)) for name in _AS_JSON},
    }
    data: xr.Dataset = run.data.assign_attrs(attributes)
    data["resting"] = data["resting"].astype(np.int8)
    return data


def fields_of(path: str | Path) -> dict[str, Any]:
    """Return the fields of the `Run` saved in the netCDF file `path`; events are lists of kind and time.

    Raises
    ------
    FileError
        If the file cannot be read or holds no saved run.
    """
    data = read_dataset(path)
    attributes: dict[str, Any] = dict(data.attrs)
    if "format" not in attributes and "kind" in attributes:
        raise FileError(
            f"{path} holds the result of a study of kind {attributes['kind']!r}, not a run; stylobate.load reads it"
        )
    kind = str(attributes.get("format", "")).removeprefix(OWN_FORMATS).partition(" ")[0]
    if kind in _OF_ORBITS:
        raise FileError(
            f"{path} holds an object of stylobate.orbits of kind {kind!r}, not a run; stylobate.load reads it"
        )
    require_this_version(path, attributes.get("format"), _FORMAT)
    if attributes.get("format") != _FORMAT:
        raise FileError(
            f"{path} is not a run saved by stylobate: its format is {attributes.get('format')!r}, not {_FORMAT!r}"
        )
    try:
        return _fields(data, attributes)
    except (KeyError, TypeError, ValueError) as error:
        raise FileError(f"{path} is damaged: {error}. Compute it again") from error


def _fields(data: xr.Dataset, attributes: dict[str, Any]) -> dict[str, Any]:
    data.attrs = {name: value for name, value in attributes.items() if name not in _OWN_ATTRIBUTES}
    data["resting"] = data["resting"].astype(bool)
    return {
        "outcome": Outcome[attributes["outcome"]],
        "reason": str(attributes["reason"]),
        "decided_at": float(attributes["decided_at"]),
        **{name: bool(attributes[name]) for name in _FLAGS},
        "data": data,
        "events": [(str(kind), float(time)) for kind, time in json.loads(attributes["events"])],
        **{name: json.loads(attributes[name]) for name in _AS_JSON if name in attributes or name != "warnings"},
    }
