"""Column, model and base motion with some of their numbers changed by name."""

from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass, replace
from types import SimpleNamespace

from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.base_motions.combined import Sum, Transformed
from stylobate.base_motions.frequency import frequency_of, has_frequency_of_its_own, is_pulse, with_frequency
from stylobate.base_motions.one_of import number_of, with_choice
from stylobate.column import Column
from stylobate.errors import ParameterError, UnsupportedError, require_finite
from stylobate.models import Model

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
"""Its fields; `slenderness` changes the radius, `size` all lengths at the same density."""

MOTION_NAMES = ("motion", "angular_frequency", "start_phase", "acceleration", "scale", "rotation", "delay")
"""In the order in which they are applied."""

ELLIPSE_NAMES = ("amplitude_x", "amplitude_y", "amplitude_z", "phase_difference")
"""Of one harmonic motion, before all others; ensembles do not vary them."""

_OF_HARMONICS = ("angular_frequency", "start_phase")
"""Of which a pulse has the first."""

# What a name changes besides itself: with the other it would be said twice, and differently.
_CONTRARY = {"slenderness": ("radius",), "size": ("radius", "mass_height")}


def model_names(model: Model) -> tuple[str, ...]:
    """Return the names of the numbers of `model` itself, the fields of its dataclass."""
    if not is_dataclass(model):
        return ()
    return tuple(field.name for field in fields(model) if field.name != "column" and field.init)


def check_names(
    model: Model, names: Iterable[str], *, where: str = "parameters", others: Iterable[str] = (), ellipse: bool = False
) -> None:
    """Raise ParameterError if one of the `names` is none that can be changed, or two say contrary things.

    Parameters
    ----------
    model
        The model whose numbers are changed.
    names
        What is to be changed.
    where
        The argument that names them.
    others
        What it may name besides parameters, such as components of the start.
    ellipse
        Whether it may name those of one harmonic motion.
    """
    names = tuple(names)
    known = (*others, *COLUMN_NAMES, *model_names(model), *MOTION_NAMES, *(ELLIPSE_NAMES if ellipse else ()))
    for name in names:
        if name not in known:
            message = f"{where}: {name} is not known here; known are {', '.join(known)}"
            raise ParameterError(message)
    for name, changed in _CONTRARY.items():
        for other in changed:
            if name in names and other in names:
                message = f"{where}: {name} changes the {other}, which is given too; leave one of them out"
                raise ParameterError(message)


def with_parameters(model: Model, motion: BaseMotion, /, **values: float) -> tuple[Model, BaseMotion]:
    """Return `model` and `motion` with these numbers changed: the objects behind one run of an ensemble.

    Parameters
    ----------
    model, motion
        What is changed; both stay as they are.
    **values
        Of the column: radius, mass_height [m], mass [kg], transverse_inertia, axial_inertia [kg m²], gravity [m/s²],
        slenderness (by its radius), size (all lengths times it). Of the model: its own fields, such as damping. Of the
        motion, applied in this order: motion (which of those in a `OneOf`); of a harmonic motion amplitude_x,
        amplitude_y, amplitude_z [m/s²] and phase_difference (phase of y less that of x) [rad]; angular_frequency
        [rad/s], of a pulse too; start_phase [rad], acceleration [m/s²] (its largest horizontal one; of a sum, the sum
        of those of its parts), scale (a factor), rotation [rad] about the vertical, delay [s].

    Raises
    ------
    ParameterError
        If a name is not known, a value out of range, or two names say contrary things: slenderness changes the radius,
        size the lengths.
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
    check_names(model, values, where="with_parameters", ellipse=True)
    of_motion = {name: values[name] for name in (*ELLIPSE_NAMES, *MOTION_NAMES) if name in values}
    of_model = {name: value for name, value in values.items() if name not in of_motion}
    return changed_model(model, of_model), changed_motion(motion, of_motion)


def changed_model(model: Model, values: Mapping[str, float]) -> Model:
    """Return `model` with these numbers of its column and its own."""
    if not values:
        return model
    own = {name: value for name, value in values.items() if name not in COLUMN_NAMES}
    of_column = {name: value for name, value in values.items() if name in COLUMN_NAMES}
    changed: Model = replace(model, column=_changed_column(model.column, of_column), **own)  # type: ignore[type-var]
    return changed


def _changed_column(column: Column, values: Mapping[str, float]) -> Column:
    own = {name: value for name, value in values.items() if name not in ("slenderness", "size")}
    column = replace(column, **own)
    if "slenderness" in values:
        column = column.with_slenderness(values["slenderness"])
    return column.resized(values["size"]) if "size" in values else column


def changed_motion(motion: BaseMotion, values: Mapping[str, float]) -> BaseMotion:
    """Return `motion` with these numbers: those of the ellipse, then in the order of MOTION_NAMES."""
    if "motion" in values:
        motion = _one_of(motion, values["motion"])
    harmonic = {name: values[name] for name in (*ELLIPSE_NAMES, *_OF_HARMONICS) if name in values}
    if "angular_frequency" in harmonic and is_pulse(motion):
        motion = with_frequency(motion, harmonic.pop("angular_frequency"))
    if harmonic:
        motion = _changed_harmonic(motion, harmonic)
    if "acceleration" in values:
        value = require_finite("acceleration", values["acceleration"], "m/s²")
        motion = motion.scaled(value / largest_acceleration(motion))
    if "scale" in values:
        motion = motion.scaled(values["scale"])
    if "rotation" in values:
        motion = motion.rotated(values["rotation"])
    return motion.delayed(values["delay"]) if "delay" in values else motion


def _one_of(motion: BaseMotion, number: float) -> BaseMotion:
    chosen = with_choice(motion, number)
    if chosen is None:
        message = f"motion can be chosen in a OneOf only; {_said(motion)}"
        raise UnsupportedError(message)
    return chosen


def largest_acceleration(motion: BaseMotion) -> float:
    """Return sup |a_h| of `motion`, by which an `acceleration` scales it [m/s²].

    Raises
    ------
    UnsupportedError
        If it has no horizontal acceleration.
    """
    largest = motion.largest_horizontal(0.0)
    if not largest > 0.0:
        message = f"acceleration cannot be changed: the motion has no horizontal acceleration; {_said(motion)}"
        raise UnsupportedError(message)
    return largest


def harmonic_part(motion: BaseMotion, name: str) -> Harmonic:
    """Return the one harmonic motion of which `motion` is made.

    Raises
    ------
    UnsupportedError
        If there is none, or more than one; `name` is what needs it.
    """
    if isinstance(motion, Transformed):
        return harmonic_part(motion.motion, name)
    if type(motion) is not Harmonic:
        where = "a Harmonic motion or a pulse" if name == "angular_frequency" else "a Harmonic motion"
        message = f"{name} can be changed in {where} only; {_said(motion)}"
        raise UnsupportedError(message)
    return motion


def _said(motion: BaseMotion) -> str:
    """Return what was got; where that is a base at rest, with the remedy."""
    if isinstance(motion, Sum) and not motion.motions:
        return "got a base at rest; give a base motion, such as a circular one"
    return f"got {motion!r}"


def _changed_harmonic(motion: BaseMotion, values: Mapping[str, float]) -> BaseMotion:
    harmonic_part(motion, next(iter(values)))
    if isinstance(motion, Transformed):
        return replace(motion, motion=_changed_harmonic(motion.motion, values))
    assert isinstance(motion, Harmonic)
    own = {name: value for name, value in values.items() if name in _OF_HARMONICS}
    x, y, z = (values.get(name, usual) for name, usual in zip(ELLIPSE_NAMES[:3], motion.amplitude, strict=True))
    first, second, third = motion.phase
    second = first + values.get("phase_difference", second - first)
    return replace(motion, amplitude=(x, y, z), phase=(first, second, third), **own)


def present_value(model: Model, motion: BaseMotion, name: str) -> float:
    """Return the number called `name` as it is; of a change, such as `rotation` or `scale`, what changes nothing.

    Raises
    ------
    ParameterError
        If the name is not known.
    UnsupportedError
        If the motion has no such number.
    """
    check_names(model, [name], where="parameter", ellipse=True)
    if name in _CHANGES:
        return _CHANGES[name]
    if name == "acceleration":
        return largest_acceleration(motion)
    if name == "motion":
        return float(number_of(motion))
    value = getattr(*_holder(model, motion, name))
    if value is None:
        message = f"parameter {name} has no value in model {model.name}; give it one"
        raise ParameterError(message)
    return float(value)


_CHANGES = {"rotation": 0.0, "delay": 0.0, "scale": 1.0, "size": 1.0}


def _holder(model: Model, motion: BaseMotion, name: str) -> tuple[object, str]:
    """Return the object that holds a number, and what it is called there."""
    if name in COLUMN_NAMES:
        return model.column, name
    if name in model_names(model):
        return model, name
    if name == "angular_frequency" and has_frequency_of_its_own(motion):
        return SimpleNamespace(angular_frequency=frequency_of(motion)), name
    harmonic = harmonic_part(motion, name)
    if name in _OF_HARMONICS:
        return harmonic, name
    x, y, z = harmonic.amplitude
    first, second, _ = harmonic.phase
    return SimpleNamespace(**dict(zip(ELLIPSE_NAMES, (x, y, z, second - first), strict=True))), name
