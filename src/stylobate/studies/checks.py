"""Checks of what a study varies: initial conditions, parameters, ranges."""

import math
import warnings
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.engine.history import EQUAL
from stylobate.errors import ParameterError, UnlikelyInputWarning, as_numbers, require_positive, require_size
from stylobate.models import Model, Sliding
from stylobate.parameter_quantities import quantity_of
from stylobate.quantities import parameters_of
from stylobate.run_arguments import RunOptions, arguments_of
from stylobate.studies.sweeps.designs import STARTS, Floats, Own, check_quantities, checked_values

SYSTEM_STARTS = (*STARTS, "start_phase")
"""Quantities that can differ between runs of one column under one base motion."""


def require_starts(where: str, over: Mapping[str, object]) -> None:
    """Raise ParameterError unless `over` names only initial conditions, which do not change column and base motion."""
    if not isinstance(over, Mapping) or not over:
        raise ParameterError(
            f'{where} must name starts, such as {where}={{"tilt_x": …, "tilt_rate_x": …}}; got {over!r}'
        )
    for name in over:
        if name not in SYSTEM_STARTS:
            raise ParameterError(f"{where} must name starts of one system, {', '.join(SYSTEM_STARTS)}; got {name!r}")


def require_values(where: str, over: Mapping[str, npt.ArrayLike], own: Own = None) -> None:
    """Raise ParameterError if a name in `over` has no values: a study needs at least one run."""
    for name, values in over.items():
        _require_some(where, name, checked_values(where, name, values, own))


def one_parameter(model: Model, along: Mapping[str, npt.ArrayLike], over: Mapping[str, object]) -> tuple[str, Floats]:
    """Return the one name in `along` and its values.

    Raises
    ------
    ParameterError
        If there are more names, no values, or the name is also in `over` or cannot vary.
    """
    if not isinstance(along, Mapping) or len(along) != 1:
        raise ParameterError(
            f'along must name one parameter with its values, such as {{"acceleration": […]}}; got {along!r}'
        )
    ((name, given),) = along.items()
    if name in over:
        raise ParameterError(f"along and over must differ, got {name!r} in both")
    if name not in SYSTEM_STARTS:
        check_quantities("along", model, [name])
    values = checked_values("along", name, given)
    _require_some("along", name, values)
    return name, values


def remark_on_lengths(where: str, names: Iterable[str]) -> None:
    """Warn if one length of a column varies without its mass and inertia: the result is not a scaled column."""
    given = set(names)
    alone = [name for name in _LENGTHS if name in given]
    if alone and given.isdisjoint(_OF_THE_BODY):
        message = (
            f"{where}: {alone[0]} varies without mass and moments of inertia, so the runs have different bodies. Vary "
            "size to scale a column at constant shape and density, or slenderness to vary its radius and axial inertia"
        )
        warnings.warn(message, UnlikelyInputWarning, stacklevel=3)


_LENGTHS, _OF_THE_BODY = (
    tuple(name for name, one in parameters_of(Column).items() if one.required and one.quantity.unit.startswith(unit))
    for unit in ("m", "kg")
)


def _require_some(where: str, name: str, values: Floats) -> None:
    if not values.size:
        raise ParameterError(f"{where}[{name!r}] must have at least one value, got none")


def require_no_limits(options: Mapping[str, object]) -> None:
    """Raise ParameterError if `options` name a limit that ends runs: whether a stopped run overturns is undecided."""
    for name, one in arguments_of(RunOptions).items():
        if one.ends_runs and options.get(name) is not None:
            unit = one.number.quantity.unit if one.number is not None else ""
            raise ParameterError(
                f"{name} must be left out: a run stopped at it is not known to overturn or not; got "
                f"{options[name]!r} {unit}".rstrip()
            )


def remark_on_knife_edge(where: str, model: Model, over: Mapping[str, npt.ArrayLike]) -> None:
    """Warn if a friction coefficient equals the slenderness: rounding then decides between sliding and rocking."""
    if not isinstance(model, Sliding) or {"radius", "mass_height"} & set(over):
        return
    varied = over.get("static_friction_coefficient", over.get("friction_coefficient"))
    known = model.static_friction_coefficient is not None and "static_friction_coefficient" not in over
    ratios = (
        model.numbers.static if known or varied is None else varied,
        over.get("slenderness", model.column.slenderness),
    )
    frictions, slender = (np.atleast_1d(np.asarray(as_numbers(where, one), dtype=float)) for one in ratios)
    equal = (np.abs(frictions[:, np.newaxis] - slender) <= EQUAL * slender).any(axis=1)
    if equal.any():
        message = (
            f"{where}: a friction coefficient equals the slenderness c (got {float(frictions[equal][0]):g}). Sliding "
            "and rocking begin together there, and rounding decides. Choose values below and above c."
        )
        warnings.warn(message, UnlikelyInputWarning, stacklevel=3)


def require_frequencies(ends: Sequence[float]) -> tuple[float, float]:
    """Return the lowest and highest frequency [rad/s]; raise ParameterError unless positive and increasing."""
    low, high = _two("angular_frequency", as_numbers("angular_frequency", ends, "rad/s"), "rad/s")
    if not 0.0 < low < high < math.inf:
        raise ParameterError(f"angular_frequency must rise from above zero, got {low!r} to {high!r} rad/s")
    require_positive("angular_frequency", low, "rad/s")
    require_positive("angular_frequency", high, "rad/s")
    return low, high


def require_bounds(ends: Sequence[float], parameter: str) -> tuple[float, float]:
    """Return the lowest and highest value of a parameter; raise ParameterError unless they are valid and increasing."""
    low, high = _two("bounds", as_numbers("bounds", ends, quantity_of(parameter).unit), parameter)
    if not -math.inf < low < high < math.inf:
        raise ParameterError(f"bounds must rise from one number to another, got {low!r} to {high!r}")
    require_size(f"bounds of {parameter}", low)
    require_size(f"bounds of {parameter}", high)
    _require_inside("bounds", (low, high), parameter)
    return low, high


def require_parameters(values: Sequence[float], parameter: str) -> npt.NDArray[np.float64]:
    """Return the values of a parameter as an array; raise ParameterError unless the parameter can have these values."""
    found = _numbers("values", values, quantity_of(parameter).unit)
    if found.size == 0:
        raise ParameterError(f"values must hold a value of {parameter} at least, got {values!r}")
    _require_inside("values", found, parameter)
    return found


def _require_inside(name: str, values: Sequence[float] | npt.NDArray[np.float64], parameter: str) -> None:
    known = quantity_of(parameter)
    outside = [float(value) for value in values if not known.accepts(value)]
    if outside:
        raise ParameterError(f"{name}: values of {parameter} must {known.demand} (got {outside[0]!r}). Leave them out.")


def require_rising_frequencies(frequencies: Sequence[float]) -> npt.NDArray[np.float64]:
    """Return frequencies [rad/s] as an array; raise ParameterError unless two or more, positive and increasing."""
    found = _numbers("angular_frequency", frequencies, "rad/s")
    if found.size < _LEAST or found[0] <= 0.0 or np.any(np.diff(found) <= 0.0):
        raise ParameterError(
            f"angular_frequency must be two or more frequencies that rise from above zero [rad/s], got {frequencies!r}"
        )
    return found


_LEAST = 2


def _numbers(name: str, values: Sequence[float], unit: str) -> npt.NDArray[np.float64]:
    values = as_numbers(name, values, unit)
    try:
        found = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        found = np.full(1, np.nan)
    if found.ndim != 1 or not np.all(np.isfinite(found)):
        raise ParameterError(f"{name} must be a list of finite numbers, got {values!r}")
    return found


def _two(name: str, ends: Sequence[float], of: str) -> tuple[float, float]:
    try:
        low, high = (float(end) for end in ends)
    except (TypeError, ValueError):
        shown = f"{len(ends)} values" if isinstance(ends, np.ndarray) else repr(ends)
        raise ParameterError(f"{name} must be two numbers, the lowest and the highest ({of}), got {shown}") from None
    return low, high
