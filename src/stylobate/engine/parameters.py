"""Changes of parameters of column, model and base motion by name."""

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar

from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.base_motions.combined import BASE_AT_REST, Sum, Transformed, number_of, with_choice
from stylobate.base_motions.declared import motion_quantities, numbers_of_motion, stated_numbers, value_of, with_numbers
from stylobate.column import Column
from stylobate.engine.ensembles.runs import QUANTITIES
from stylobate.errors import ParameterError, UnsupportedError, as_numbers, require_finite
from stylobate.models import Model
from stylobate.parameter_quantities import quantity_of
from stylobate.quantities import Parameter, parameters_of
from stylobate.text import did_you_mean

_T = TypeVar("_T")

# Units of the numbers of a path: lengths and rates of turns.
_RATES = ("Hz", "1/min")
_OF_A_PATH = ("m", *_RATES)

COLUMN_NAMES = (
    "radius",
    "mass_height",
    "mass",
    "transverse_inertia",
    "axial_inertia",
    "gravity",
    "slenderness",
    "size",
)
"""Parameters of the column; `slenderness` changes the radius, `size` all lengths at the same density."""

OFFSETS = ("offset_x", "offset_y")
"""Constant horizontal accelerations added to the motion, the last of its changes."""

MOTION_NAMES = ("motion", "angular_frequency", "start_phase", "acceleration", "scale", "rotation", "delay", *OFFSETS)
"""Changes of the motion in the order of application; `angular_frequency` and `start_phase` are declared parameters."""

ELLIPSE_NAMES = ("amplitude_x", "amplitude_y", "amplitude_z", "phase_difference")
"""Parameters of one harmonic motion, applied before all others; ensembles do not vary them."""

_CHANGES = {"rotation": 0.0, "delay": 0.0, "offset_x": 0.0, "offset_y": 0.0, "scale": 1.0, "size": 1.0}
"""Changes that apply to any motion or column, with the value that changes nothing."""

_OWN = "motion."
"""Prefix of a parameter of the motion whose name is ambiguous, see `motion_names`."""

# Parameters that a name changes too: both together would contradict each other.
_CONTRADICTING = {"slenderness": ("radius",), "size": ("radius", "mass_height")}


def model_names(model: Model) -> tuple[str, ...]:
    """Return the names of the parameters of `model` itself, the fields of its dataclass."""
    if not is_dataclass(model):
        return ()
    return tuple(field.name for field in fields(model) if field.name != "column" and field.init)


def motion_names(model: Model, motion: BaseMotion | None) -> tuple[str, ...]:
    """Return the names of the declared parameters of `motion`; of all motions of the package for None.

    The prefix "motion." marks a name that the column, the model, a change of the motion or a result also has.
    """
    taken = {*COLUMN_NAMES, *model_names(model), "motion", "acceleration", *_CHANGES, *QUANTITIES}
    names = motion_quantities() if motion is None else numbers_of_motion(motion)
    return tuple(_OWN + name if name in taken else name for name in names)


def split(model: Model, values: Mapping[str, _T]) -> tuple[dict[str, _T], dict[str, _T]]:
    """Split the `values` into changes of the column and its `model`, and changes of the motion."""
    own = {*COLUMN_NAMES, *model_names(model)} - {*MOTION_NAMES, *ELLIPSE_NAMES}
    of_model = {name: value for name, value in values.items() if name in own}
    return of_model, {name: value for name, value in values.items() if name not in own}


def own_numbers(model: object, motion: object) -> Mapping[str, Parameter]:
    """Return the declared numbers of a model and a base motion, by name; none of an object that is neither."""
    of_model = parameters_of(type(model)) if isinstance(model, Model) else {}
    return {**of_model, **(numbers_of_motion(motion) if isinstance(motion, BaseMotion) else {})}


def in_declared_units(values: Mapping[str, Any], own: Mapping[str, Parameter]) -> dict[str, Any]:
    """Convert quantities of pint or astropy among the `values`, by name; raise ParameterError for a wrong dimension."""
    return {name: as_numbers(name, value, quantity_of(name, own).unit) for name, value in values.items()}


def declared_names(motion: BaseMotion, values: Mapping[str, object]) -> dict[str, str]:
    """Return the names in `values` of declared parameters of `motion`, each with its name in the motion.

    Raises
    ------
    ParameterError
        If two names contradict each other, such as the stroke and the acceleration that follows from it.
    UnsupportedError
        If the motion has no such number.
    """
    changes = {*MOTION_NAMES, *ELLIPSE_NAMES} - {"angular_frequency", "start_phase"}
    names = {name: name.removeprefix(_OWN) for name in values if name not in changes}
    for name, own in names.items():
        if own not in numbers_of_motion(motion):
            raise UnsupportedError(f"{name}: the base motion has no such number {_own_numbers(motion)}")
    _check_path(motion, values, names)
    return names


def _check_path(motion: BaseMotion, values: Mapping[str, object], names: Mapping[str, str]) -> None:
    """Raise ParameterError if a number of the path of `motion` varies together with what replaces the path."""
    stated = stated_numbers(motion)
    for name, own in names.items():
        unit = stated[own].quantity.unit if own in stated else ""
        if unit in _OF_A_PATH and "angular_frequency" in values:
            remedy = next(one for one, declared in stated.items() if declared.quantity.unit in _RATES)
            raise ParameterError(
                f"{name}: angular_frequency keeps the acceleration, not the path (got both). "
                f"Vary {remedy} in place of angular_frequency."
            )
        if unit == "m" and "acceleration" in values:
            raise ParameterError(f"{name}: acceleration sets the amplitude too (got both). Leave one of them out.")


def check_names(
    model: Model,
    motion: BaseMotion | None,
    names: Iterable[str],
    *,
    where: str = "parameters",
    others: Iterable[str] = (),
    ellipse: bool = False,
) -> None:
    """Raise ParameterError if one of the `names` is not a parameter, or two contradict each other.

    Parameters
    ----------
    model, motion
        Model and motion whose parameters change; None if the motion is not known.
    names
        Names of the parameters to change.
    where
        Argument that contains the names.
    others
        Other valid names, such as components of the start.
    ellipse
        Whether the parameters of one harmonic motion are valid.
    """
    names = tuple(names)
    known = (*others, *COLUMN_NAMES, *model_names(model), *MOTION_NAMES, *(ELLIPSE_NAMES if ellipse else ()))
    known = tuple(dict.fromkeys((*known, *motion_names(model, motion))))
    for name in names:
        if name not in known:
            remedy = did_you_mean(name, known) or f"known are {', '.join(known)}"
            raise ParameterError(f"{where}: {name} is not known here; {remedy}")
    for name, changed in _CONTRADICTING.items():
        for other in changed:
            if name in names and other in names:
                raise ParameterError(f"{where}: {name} changes the {other}, which is given too; leave one of them out")


def with_parameters(model: Model, motion: BaseMotion, /, **values: float) -> tuple[Model, BaseMotion]:
    """Change parameters of `model` and `motion` by name: the objects of one run of an ensemble.

    Parameters
    ----------
    model, motion
        Model and motion, which are not modified.
    **values
        Column: radius, mass_height [m], mass [kg], transverse_inertia, axial_inertia [kg m²], gravity [m/s²],
        slenderness (changes the radius), size (factor of all lengths). Model: its own fields, such as damping. Motion,
        in this order: motion (index in a `OneOf`); for a harmonic motion amplitude_x, amplitude_y, amplitude_z [m/s²]
        and phase_difference (phase of y minus phase of x) [rad]; the parameters that its class declares, such as
        angular_frequency [rad/s], start_phase [rad], or the cycles of a pulse; acceleration [m/s²] (peak horizontal
        acceleration; for a sum, the sum of the peaks of its parts), scale (a factor), rotation [rad] about the
        vertical, delay [s], offset_x and offset_y (constant accelerations, see `BaseMotion.offset`) [m/s²]. A name that
        the column or the model also has means theirs; the prefix "motion." selects the motion.

    Raises
    ------
    ParameterError
        If a name is not known, a value is out of range, or two names contradict each other: slenderness changes the
        radius, size the lengths.
    UnsupportedError
        If the motion has no such number.

    Examples
    --------
    >>> import stylobate as sb
    >>> model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    >>> motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    >>> changed, faster = sb.with_parameters(model, motion, damping=0.2, angular_frequency=3.0)
    >>> changed.damping, faster.angular_frequency
    (0.2, 3.0)
    """
    check_names(model, motion, values, where="with_parameters", ellipse=True)
    values = in_declared_units(values, own_numbers(model, motion))
    of_model, of_motion = split(model, values)
    return changed_model(model, of_model), changed_motion(motion, of_motion)


def changed_model(model: Model, values: Mapping[str, float]) -> Model:
    """Return `model` with these parameters of the column and the model."""
    if not values:
        return model
    own = {name: value for name, value in values.items() if name not in COLUMN_NAMES}
    of_column = {name: value for name, value in values.items() if name in COLUMN_NAMES}
    changed: Model = replace(model, column=_changed_column(model.column, of_column), **own)  # type: ignore[type-var]
    return changed


def _changed_column(column: Column, values: Mapping[str, float]) -> Column:
    own: dict[str, Any] = {name: value for name, value in values.items() if name not in ("slenderness", "size")}
    column = replace(column, **own)
    if "slenderness" in values:
        column = column.with_slenderness(values["slenderness"])
    return column.resized(values["size"]) if "size" in values else column


def changed_motion(motion: BaseMotion, values: Mapping[str, float]) -> BaseMotion:
    """Return `motion` with these parameters: of the ellipse, declared ones, then in the order of MOTION_NAMES."""
    if "motion" in values:
        motion = _one_of(motion, values["motion"])
    ellipse = {name: values[name] for name in ELLIPSE_NAMES if name in values}
    if ellipse:
        motion = _changed_harmonic(motion, ellipse)
    numbers = {own: values[name] for name, own in declared_names(motion, values).items()}
    if numbers:
        motion = with_numbers(motion, numbers)
    if "acceleration" in values:
        value = require_finite("acceleration", values["acceleration"], "m/s²")
        motion = motion.scaled(value / peak_acceleration(motion))
    if "scale" in values:
        motion = motion.scaled(values["scale"])
    if "rotation" in values:
        motion = motion.rotated(values["rotation"])
    if "delay" in values:
        motion = motion.delayed(values["delay"])
    offset = {name: values[name] for name in OFFSETS if name in values}
    return motion.offset(**offset) if offset else motion


def _one_of(motion: BaseMotion, number: float) -> BaseMotion:
    chosen = with_choice(motion, number)
    if chosen is None:
        raise UnsupportedError(f"motion can be chosen in a OneOf only; {_got(motion)}")
    return chosen


def peak_acceleration(motion: BaseMotion) -> float:
    """Return sup |a_h| of `motion`, the reference of the parameter `acceleration` [m/s²].

    Raises
    ------
    UnsupportedError
        If the motion has no horizontal acceleration.
    """
    largest = motion.peak_horizontal(0.0)
    if not largest > 0.0:
        raise UnsupportedError(
            f"acceleration cannot be changed: the motion has no horizontal acceleration; {_got(motion)}"
        )
    return largest


def harmonic_part(motion: BaseMotion, name: str) -> Harmonic:
    """Return the harmonic motion inside `motion`.

    Raises
    ------
    UnsupportedError
        If `motion` is not one harmonic motion, which the parameter `name` needs.
    """
    if isinstance(motion, Transformed):
        return harmonic_part(motion.motion, name)
    if type(motion) is not Harmonic:
        raise UnsupportedError(f"{name} can be changed in a Harmonic motion only; {_got(motion)}")
    return motion


def _got(motion: BaseMotion) -> str:
    """Return the motion in words; for a base at rest with a remedy."""
    if isinstance(motion, Sum) and not motion.motions:
        return "got a base at rest; give a base motion, such as a circular one"
    return f"got {motion!r}"


def _changed_harmonic(motion: BaseMotion, values: Mapping[str, float]) -> BaseMotion:
    harmonic = harmonic_part(motion, next(iter(values)))
    if isinstance(motion, Transformed):
        return replace(motion, motion=_changed_harmonic(motion.motion, values))
    numbers = {**_ellipse(harmonic), **values}
    x, y, z = (numbers[name] for name in ELLIPSE_NAMES[:3])
    first, second, third = harmonic.phase
    if "phase_difference" in values:
        second = first + values["phase_difference"]
    return replace(harmonic, amplitude=(x, y, z), phase=(first, second, third))


def present_value(model: Model, motion: BaseMotion, name: str) -> float:
    """Return the present value of the parameter `name`; for a change, such as `rotation`, the value without effect.

    Raises
    ------
    ParameterError
        If the name is not known.
    UnsupportedError
        If the motion has no such number.
    """
    check_names(model, motion, [name], where="parameter", ellipse=True)
    if name in _CHANGES:
        return _CHANGES[name]
    if name == "acceleration":
        return peak_acceleration(motion)
    if name == "motion":
        return float(number_of(motion))
    if name in ELLIPSE_NAMES:
        return _ellipse(harmonic_part(motion, name))[name]
    of_model, _ = split(model, {name: None})
    if not of_model:
        return value_of(motion, declared_names(motion, {name: None})[name])
    value = getattr(model.column if name in COLUMN_NAMES else model, name)
    if value is None:
        raise ParameterError(f"parameter {name} has no value in model {model.name}; give it one")
    return float(value)


def _ellipse(motion: Harmonic) -> Mapping[str, float]:
    """Return the parameters ELLIPSE_NAMES of a harmonic motion."""
    x, y, z = motion.amplitude
    first, second, _ = motion.phase
    return dict(zip(ELLIPSE_NAMES, (x, y, z, second - first), strict=True))


def _own_numbers(motion: BaseMotion) -> str:
    if motion == BASE_AT_REST:
        return (
            "(got a base at rest). Give a base motion, such as a circular one; on the command line --motion circular."
        )
    names = ", ".join(numbers_of_motion(motion))
    return f"(got {motion!r}). {f'Its numbers are {names}.' if names else 'It has none.'}"
