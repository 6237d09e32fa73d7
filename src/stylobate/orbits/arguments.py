"""Checks of the arguments for orbits, branches and curves."""

import math
from collections.abc import Sequence

from stylobate.base_motions import BASE_AT_REST, BaseMotion
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.errors import ParameterError, require_not_negative
from stylobate.models import Model
from stylobate.models.consistency import check_once
from stylobate.orbits.bifurcations import Bifurcation
from stylobate.orbits.orbit import PeriodicOrbit
from stylobate.orbits.tracing import StepControl


def require_subject(model: Model, motion: BaseMotion) -> None:
    """Raise ParameterError unless these are a model and a base motion, ModelError if the model contradicts itself."""
    if isinstance(model, BaseMotion) and isinstance(motion, Model):
        message = (
            f"model must come before motion: got {type(model).__name__} as model, {type(motion).__name__} as motion"
        )
        raise ParameterError(message)
    if not isinstance(model, Model):
        message = f"model must be a model such as Slender(column), got {model!r}"
        raise ParameterError(message)
    if not isinstance(motion, BaseMotion) or motion == BASE_AT_REST:
        message = f"motion must be a periodic base motion such as Harmonic.circular(...), got {motion!r}"
        raise ParameterError(message)
    check_once(model)


def require_orbit(orbit: PeriodicOrbit) -> None:
    """Raise ParameterError unless `orbit` is a periodic orbit."""
    if not isinstance(orbit, PeriodicOrbit):
        message = f"orbit must be a PeriodicOrbit such as periodic_orbit(model, motion), got {orbit!r}"
        raise ParameterError(message)


def require_bifurcation(bifurcation: Bifurcation) -> None:
    """Raise ParameterError unless `bifurcation` is a Bifurcation."""
    if not isinstance(bifurcation, Bifurcation):
        message = f"bifurcation must be one of a branch, such as branch.bifurcations[0]; got {bifurcation!r}"
        raise ParameterError(message)


def control_of(control: StepControl | None) -> StepControl:
    """Return the control of the steps; the default control for None."""
    if control is None:
        return StepControl()
    if not isinstance(control, StepControl):
        message = f"control must be a StepControl(...) or None, got {control!r}"
        raise ParameterError(message)
    return control


def require_followed(parameter: str) -> None:
    """Raise ParameterError if `parameter` does not change orbits."""
    if parameter == "delay":
        message = (
            "parameter must be a number that changes the orbit, got 'delay': a delay shifts the base motion in time, "
            "and each orbit with it"
        )
        raise ParameterError(message)


def enclosing(system: PeriodicSystem, bounds: Sequence[float], parameter: str, value: float) -> tuple[float, float]:
    """Return the bounds, or raise ParameterError unless they are two valid numbers that enclose `value`."""
    try:
        low, high = (float(bound) for bound in bounds)
    except (TypeError, ValueError):
        low = high = math.nan
    if not (-math.inf < low <= value <= high < math.inf and low < high):
        message = f"bounds must be two numbers that enclose the present {parameter} {value!r}, got {bounds!r}"
        raise ParameterError(message)
    for bound in (low, high):
        try:
            # A negative acceleration is the same motion at another phase.
            if parameter == "acceleration":
                require_not_negative(parameter, bound)
            system.changed(**{parameter: bound})
        except ParameterError as error:
            message = f"bounds: {error}"
            raise ParameterError(message) from None
    return low, high
