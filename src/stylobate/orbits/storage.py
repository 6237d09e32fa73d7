"""Orbits and branches as netCDF files: their states, from which they are shot again when they are read."""

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from stylobate.base_motions import BaseMotion
from stylobate.config import config_of, provenance_of_run
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.engine.flow.tableau import Status
from stylobate.errors import FileError, ParameterError, UnsupportedError
from stylobate.models import Model
from stylobate.orbits.arclength import Family, Point
from stylobate.orbits.bifurcations import Bifurcation, Kind, orbit_at
from stylobate.orbits.branch import Branch
from stylobate.orbits.curves import BifurcationCurve, CurvePoint, Plane
from stylobate.orbits.orbit import PeriodicOrbit
from stylobate.orbits.shooting import shots
from stylobate.orbits.tracing import End
from stylobate.results.storage import read_dataset, write_netcdf

_ORBIT, _BRANCH, _CURVE = "stylobate orbit 1", "stylobate branch 1", "stylobate bifurcation curve 1"
_SUFFIX = ".nc"
_SOFT = {True: 1, False: 0, None: -1}


def save(found: PeriodicOrbit | Branch | BifurcationCurve, path: str | Path) -> Path:
    """Write an orbit, a branch or a curve to the netCDF file `path`, with its provenance; `load` reads it again.

    Raises
    ------
    ParameterError
        If the path does not end in .nc.
    FileError
        If the file cannot be written.
    UnsupportedError
        If model or motion is of a class of your own, which a file cannot hold.
    """
    path = _path(path)
    if path.suffix != _SUFFIX:
        message = f"path must end in {_SUFFIX}, which is what is written; got {str(path)!r}"
        raise ParameterError(message)
    if not path.parent.is_dir():
        message = f"cannot write {path}: there is no folder {path.parent}"
        raise FileError(message)
    if isinstance(found, PeriodicOrbit):
        data = _orbit_data(found)
    else:
        data = _branch_data(found) if isinstance(found, Branch) else _curve_data(found)
    return write_netcdf(data, path)


def load_orbits(path: str | Path) -> PeriodicOrbit | Branch | BifurcationCurve:
    """Return the orbit, branch or curve saved in the netCDF file `path`.

    Raises
    ------
    FileError
        If the file cannot be read or holds none of them.
    """
    path = _path(path)
    data = read_dataset(path)
    read = _READERS.get(str(data.attrs.get("format")))
    if read is None:
        message = f"{path} holds no orbit, branch or curve saved by stylobate, but {_content(data)}"
        raise FileError(message)
    try:
        return read(data)
    except (KeyError, TypeError, ValueError) as error:
        message = f"{path} is damaged: {error}"
        raise FileError(message) from error


def _path(path: str | Path) -> Path:
    try:
        return Path(path)
    except TypeError:
        message = f"path must be the name of a file, got {path!r}"
        raise ParameterError(message) from None


def _content(data: xr.Dataset) -> str:
    written, kind = data.attrs.get("format"), data.attrs.get("kind")
    if written is not None and str(written).startswith("stylobate response"):
        return "a run; stylobate.load reads it"
    if kind is not None:
        return f"a table of kind {kind!r}; xarray.open_dataset reads it"
    return "other data; xarray.open_dataset reads them"


def _attributes(system: PeriodicSystem, format_name: str, periods: int) -> dict[str, Any]:
    provenance = provenance_of_run(system.model, system.motion)
    for name in ("model", "motion"):
        if provenance[name].get("kind") == "other":
            message = f"an orbit of a {name} of your own cannot be saved: {provenance[name]['repr']}"
            raise UnsupportedError(message)
    return {
        "format": format_name,
        "periods": periods,
        "line": np.array(system.line if system.line is not None else (math.nan, math.nan)),
        "rtol": system.rtol,
        "provenance": json.dumps(provenance),
    }


def _system(data: xr.Dataset) -> PeriodicSystem:
    model, motion = _parts(json.loads(data.attrs["provenance"]))
    x, y = (float(number) for number in data.attrs["line"])
    return PeriodicSystem(model, motion, None if math.isnan(x) else (x, y), float(data.attrs["rtol"]))


def _parts(provenance: dict[str, Any]) -> tuple[Model, BaseMotion]:
    setup = config_of({**provenance, "duration": 1.0}).build()
    return setup.model, setup.motion


def _orbit_data(orbit: PeriodicOrbit) -> xr.Dataset:
    states = (("arc", "state"), orbit.chain.states)
    return xr.Dataset({"states": states}, attrs=_attributes(orbit.system, _ORBIT, orbit.periods))


def _read_orbit(data: xr.Dataset) -> PeriodicOrbit:
    system, periods = _system(data), int(data.attrs["periods"])
    chain = shots(system, np.ascontiguousarray(data["states"].to_numpy()), periods)
    if chain.status is not Status.DONE:
        message = "its orbit cannot be shot again"
        raise ValueError(message)
    return PeriodicOrbit(system.model, system.motion, periods, chain, system.line, system.rtol)


def _branch_data(branch: Branch) -> xr.Dataset:
    family, found = branch.path[0].family, branch.bifurcations
    located = [one.point for one in found]
    shape = (len(found), *branch.path[0].chain.states.shape)
    values = {
        "kind": np.array([one.kind.name for one in found], dtype=str),
        "value": np.array([one.parameter for one in found], dtype=float),
        "multiplier_real": np.array([one.multiplier.real for one in found], dtype=float),
        "multiplier_imaginary": np.array([one.multiplier.imag for one in found], dtype=float),
        "coefficient": np.array([one.coefficient for one in found], dtype=float),
        "soft": np.array([_SOFT[one.soft] for one in found], dtype=np.int8),
    }
    vectors = {
        "critical_vector": (family.system.order, [one.critical_vector for one in found]),
        "direction": (located[0].u.size if located else 0, [one.direction for one in found]),
    }
    return xr.Dataset(
        {
            "states": (("point", "arc", "state"), np.stack([point.chain.states for point in branch.path])),
            "value": ("point", [point.value for point in branch.path]),
            "bifurcation_states": (
                ("bifurcation", "arc", "state"),
                np.array([point.chain.states for point in located]).reshape(shape),
            ),
            **{f"bifurcation_{name}": ("bifurcation", column) for name, column in values.items()},
            **{
                f"bifurcation_{name}": (("bifurcation", f"{name}_entry"), np.array(rows).reshape(len(found), width))
                for name, (width, rows) in vectors.items()
            },
        },
        attrs={
            **_attributes(family.system, _BRANCH, family.periods),
            "parameter": branch.parameter,
            "span": family.span,
            "sense": family.sense,
            "ends": json.dumps([end.name for end in branch.ends]),
        },
    )


def _read_branch(data: xr.Dataset) -> Branch:
    name = str(data.attrs["parameter"])
    family = Family(
        _system(data), int(data.attrs["periods"]), name, float(data.attrs["span"]), float(data.attrs["sense"])
    )
    path = tuple(
        _shot(family, states, float(value))
        for states, value in zip(data["states"].to_numpy(), data["value"].to_numpy(), strict=True)
    )
    soft = {code: label for label, code in _SOFT.items()}
    found = []
    for index in range(data.sizes["bifurcation"]):
        one = {str(key): data[key][index].to_numpy() for key in data.data_vars if str(key).startswith("bifurcation_")}
        point = _shot(family, one["bifurcation_states"], float(one["bifurcation_value"]))
        found.append(
            Bifurcation(
                Kind[str(one["bifurcation_kind"])],
                point.value,
                orbit_at(point),
                complex(float(one["bifurcation_multiplier_real"]), float(one["bifurcation_multiplier_imaginary"])),
                float(one["bifurcation_coefficient"]),
                soft[int(one["bifurcation_soft"])],
                one["bifurcation_critical_vector"],
                point,
                one["bifurcation_direction"],
            )
        )
    first, last = (End[end] for end in json.loads(data.attrs["ends"]))
    return Branch(name, path, tuple(found), (first, last))


def _shot(family: Family, states: Any, value: float) -> Point:
    system = family.at(value)
    change = family.system.derivative(family.name, value)
    chain = shots(system, np.ascontiguousarray(states), family.covered, sense=family.sense, change=change)
    if chain.status is not Status.DONE:
        message = f"its orbit at {family.name} = {value!r} cannot be shot again"
        raise ValueError(message)
    return Point(family, value, chain)


def _curve_data(curve: BifurcationCurve) -> xr.Dataset:
    plane, critical = curve.plane, np.array([point.multiplier for point in curve.path])
    return xr.Dataset(
        {
            "states": (("point", "arc", "state"), np.stack([point.chain.states for point in curve.path])),
            "values": (("point", "parameter"), np.array([point.values for point in curve.path])),
            "multiplier": (("point", "part"), np.stack([critical.real, critical.imag], axis=-1)),
        },
        attrs={
            **_attributes(plane.system, _CURVE, 1),
            "bifurcation": curve.kind.name,
            "parameters": json.dumps(curve.parameters),
            "spans": np.array(plane.spans),
            "covered": plane.covered,
            "sense": plane.sense,
            "ends": json.dumps([end.name for end in curve.ends]),
        },
    )


def _read_curve(data: xr.Dataset) -> BifurcationCurve:
    kind = Kind[str(data.attrs["bifurcation"])]
    first, second = (str(name) for name in json.loads(data.attrs["parameters"]))
    spans = tuple(float(span) for span in data.attrs["spans"])
    covered, sense = (float(data.attrs[name]) for name in ("covered", "sense"))
    plane = Plane(_system(data), (first, second), covered, sense, kind, spans)
    path = []
    columns = (data[name].to_numpy() for name in ("states", "values", "multiplier"))
    for states, values, (real, imaginary) in zip(*columns, strict=True):
        chain = shots(plane.at(values), np.ascontiguousarray(states), covered, sense=sense)
        if chain.status is not Status.DONE:
            message = f"its orbit at {first} = {values[0]!r}, {second} = {values[1]!r} cannot be shot again"
            raise ValueError(message)
        path.append(CurvePoint((float(values[0]), float(values[1])), chain, complex(real, imaginary)))
    begin, end = (End[name] for name in json.loads(data.attrs["ends"]))
    return BifurcationCurve(kind, (first, second), tuple(path), (begin, end), plane)


_READERS: dict[str, Callable[[xr.Dataset], PeriodicOrbit | Branch | BifurcationCurve]] = {
    _ORBIT: _read_orbit,
    _BRANCH: _read_branch,
    _CURVE: _read_curve,
}
