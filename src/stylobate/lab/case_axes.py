"""Maps over numbers of a description that sweeps do not support, such as revolutions per minute or a height."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from stylobate import config
from stylobate.engine.parameters import COLUMN_NAMES, present_value
from stylobate.errors import UnsupportedError
from stylobate.lab.parameter_info import CASE_NUMBERS
from stylobate.models import Model
from stylobate.progress import Progress
from stylobate.studies.maps.overturning import labelled
from stylobate.studies.sweeps import Executor, Sweep
from stylobate.studies.sweeps.labelled import labelled_sweep

Floats = npt.NDArray[np.float64]

_BODY = tuple(name for name in COLUMN_NAMES if name not in ("slenderness", "size"))
_MOVED = ("angular_frequency", "acceleration")


def units_of(name: str) -> str:
    """Return the unit of a number of a description; empty for a name that the study refuses."""
    return next((part[name].cf_units for part in CASE_NUMBERS.values() if name in part), "")


def case_numbers(values: Mapping[str, Any], over: Mapping[str, Floats]) -> dict[str, tuple[str, ...]]:
    """Return the axes that are numbers of the described column or motion, by part; empty if sweeps support them all.

    Sweeps can vary the radius of a body with given mass and inertia; for other bodies mass and inertia depend on it.
    """
    given = values["column"].get("shape") == "given"
    found = {
        part: tuple(name for name in over if name in values.get(part, {}))
        for part, names in CASE_NUMBERS.items()
        if any(name in values.get(part, {}) for name in over if name in names)
    }
    return {part: names for part, names in found.items() if not (part == "column" and given)}


def case_map(
    setup: config.Setup, values: Mapping[str, Any], *, executor: Executor, progress: Progress = None
) -> xr.Dataset:
    """Compute a map whose axes are numbers of the described case.

    Each run has the column and motion of the case with the numbers of its cell.

    Parameters
    ----------
    setup, values
        Model, motion and options of the map, and the plain values that describe it.
    executor, progress
        As in `run_sweep`. The runs form one row, with the second axis varying fastest.

    Returns
    -------
    xarray.Dataset
        An overturning map, or a contact map if the model slides, over `run`.

    Raises
    ------
    ConfigError, ParameterError
        If an axis has an impossible value.
    """
    options = {name: value for name, value in setup.options.items() if name != "over"}
    sweep = Sweep.points(_without_height(setup.model), setup.motion, at=_at(values, setup.options["over"]), **options)
    return labelled_sweep(sweep, labelled, executor=executor, progress=progress)


def _without_height(model: Model) -> Model:
    """Return `model` without the height of its body, which differs between runs."""
    bare: Model = replace(model, column=replace(model.column, height=None))  # type: ignore[type-var]  # a dataclass
    return bare


def _at(values: Mapping[str, Any], over: Mapping[str, Floats]) -> dict[str, Floats]:
    """Return the quantities of sweeps for each cell, with the second axis varying fastest."""
    cells = dict(zip(over, (grid.ravel() for grid in np.meshgrid(*over.values(), indexing="ij")), strict=True))
    found: dict[str, Floats] = {}
    for part, names in case_numbers(values, over).items():
        own = np.stack([cells.pop(name) for name in names], axis=1)
        different, which = np.unique(own, axis=0, return_inverse=True)
        read = [_READ[part](_with(values, part, dict(zip(names, row, strict=True)))) for row in different.tolist()]
        found |= {name: np.array([one[name] for one in read])[which.ravel()] for name in read[0]}
    return found | cells


def _with(values: Mapping[str, Any], part: str, numbers: Mapping[str, float]) -> config.Setup:
    """Return the setup of the case with other numbers of one part."""
    case = {name: values[name] for name in ("column", "model", "motion") if name in values}
    changed = {**case, part: {**case[part], **numbers}, "duration": 1.0}
    return config.SimulationConfig.parse(changed).build()


def _body(setup: config.Setup) -> dict[str, float]:
    return {name: float(getattr(setup.model.column, name)) for name in _BODY}


def _moved(setup: config.Setup) -> dict[str, float]:
    found: dict[str, float] = {}
    for name in _MOVED:
        try:
            found[name] = present_value(setup.model, setup.motion, name)
        except UnsupportedError:
            continue  # a motion without a frequency of its own
    return found


_READ: Mapping[str, Callable[[config.Setup], dict[str, float]]] = {"column": _body, "motion": _moved}
