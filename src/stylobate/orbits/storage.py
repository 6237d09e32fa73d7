"""Reading of orbits, branches and curves from netCDF files: shooting recovers them from their states."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stylobate.config import config_of
from stylobate.engine.flow.integration import FlowStatus
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.errors import FileError
from stylobate.orbits.arclength import BranchEnd, Family, Point
from stylobate.orbits.bifurcations import Bifurcation, BifurcationKind, orbit_at
from stylobate.orbits.branch import Branch
from stylobate.orbits.curves import BifurcationCurve, CurvePoint, Plane
from stylobate.orbits.orbit import BRANCH, CURVE, ORBIT, SUPERCRITICAL_OF, PeriodicOrbit, path_of
from stylobate.orbits.shooting import shots
from stylobate.results.storage import read_dataset, require_this_version


def load_orbits(path: str | Path) -> PeriodicOrbit | Branch | BifurcationCurve:
    """Return the orbit, branch or curve saved in the netCDF file `path`.

    Raises
    ------
    FileError
        If the file cannot be read, or holds no orbit, branch or curve.
    """
    path = path_of(path)
    data = read_dataset(path)
    written = data.attrs.get("format")
    for known in _READERS:
        require_this_version(path, written, known)
    read = _READERS.get(str(written))
    if read is None:
        raise FileError(f"{path} holds no orbit, branch or curve saved by stylobate, but {_content(data)}")
    try:
        return read(data)
    except (KeyError, TypeError, ValueError) as error:
        raise FileError(f"{path} is damaged: {error}. Compute it again") from error


def _content(data: xr.Dataset) -> str:
    written, kind = data.attrs.get("format"), data.attrs.get("kind")
    if written is not None and str(written).startswith("stylobate run"):
        return "a run; stylobate.load reads it"
    if kind is not None:
        return f"a table of kind {kind!r}; xarray.open_dataset reads it"
    return "other data; xarray.open_dataset reads them"


def _system(data: xr.Dataset) -> PeriodicSystem:
    setup = config_of({**json.loads(data.attrs["provenance"]), "duration": 1.0}).build()
    x, y = (float(number) for number in data.attrs["line"])
    return PeriodicSystem(setup.model, setup.motion, None if math.isnan(x) else (x, y), float(data.attrs["rtol"]))


def _read_orbit(data: xr.Dataset) -> PeriodicOrbit:
    system, periods = _system(data), int(data.attrs["periods"])
    chain = shots(system, np.ascontiguousarray(data["states"].to_numpy()), periods)
    if chain.status is not FlowStatus.DONE:
        raise ValueError("its orbit cannot be recovered")
    return PeriodicOrbit(system.model, system.motion, periods, chain, system.line, system.rtol)


def _read_branch(data: xr.Dataset) -> Branch:
    name = str(data.attrs["parameter"])
    family = Family(
        _system(data), int(data.attrs["periods"]), name, float(data.attrs["span"]), float(data.attrs["sense"])
    )
    path = tuple(
        _shot(family, states, float(value))
        for states, value in zip(data["states"].to_numpy(), data["value"].to_numpy(), strict=True)
    )
    found = []
    for index in range(data.sizes["bifurcation"]):
        one = {str(key): data[key][index].to_numpy() for key in data.data_vars if str(key).startswith("bifurcation_")}
        point = _shot(family, one["bifurcation_states"], float(one["bifurcation_value"]))
        found.append(
            Bifurcation(
                BifurcationKind[str(one["bifurcation_kind"])],
                point.value,
                orbit_at(point),
                complex(float(one["bifurcation_multiplier_real"]), float(one["bifurcation_multiplier_imaginary"])),
                float(one["bifurcation_coefficient"]),
                SUPERCRITICAL_OF[int(one["bifurcation_supercritical"])],
                one["bifurcation_critical_vector"],
                point,
                one["bifurcation_direction"],
            )
        )
    first, last = (BranchEnd[end] for end in json.loads(data.attrs["ends"]))
    return Branch(name, path, tuple(found), (first, last))


def _shot(family: Family, states: Any, value: float) -> Point:
    system = family.at(value)
    change = family.system.derivative(family.name, value)
    chain = shots(system, np.ascontiguousarray(states), family.covered, sense=family.sense, change=change)
    if chain.status is not FlowStatus.DONE:
        raise ValueError(f"its orbit at {family.name} = {value!r} cannot be recovered")
    return Point(family, value, chain)


def _read_curve(data: xr.Dataset) -> BifurcationCurve:
    kind = BifurcationKind[str(data.attrs["bifurcation"])]
    first, second = (str(name) for name in json.loads(data.attrs["parameters"]))
    spans = tuple(float(span) for span in data.attrs["spans"])
    covered, sense = (float(data.attrs[name]) for name in ("covered", "sense"))
    plane = Plane(_system(data), (first, second), covered, sense, kind, spans)
    path = []
    columns = (data[name].to_numpy() for name in ("states", "values", "multiplier"))
    for states, values, (real, imaginary) in zip(*columns, strict=True):
        chain = shots(plane.at(values), np.ascontiguousarray(states), covered, sense=sense)
        if chain.status is not FlowStatus.DONE:
            raise ValueError(f"its orbit at {first} = {values[0]!r}, {second} = {values[1]!r} cannot be recovered")
        path.append(CurvePoint((float(values[0]), float(values[1])), chain, complex(real, imaginary)))
    begin, end = (BranchEnd[name] for name in json.loads(data.attrs["ends"]))
    return BifurcationCurve(kind, (first, second), tuple(path), (begin, end), plane)


_READERS: dict[str, Callable[[xr.Dataset], PeriodicOrbit | Branch | BifurcationCurve]] = {
    ORBIT: _read_orbit,
    BRANCH: _read_branch,
    CURVE: _read_curve,
}
