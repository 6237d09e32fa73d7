"""Base motions of the package by kind, and their declared numbers by name."""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache
from inspect import signature
from typing import Any

from stylobate.base_motions.base import AngularFrequency
from stylobate.base_motions.combined import BaseMotion, Delayed, Following, Offset, OneOf, Rotated, Scaled, Transformed
from stylobate.base_motions.pulses import Pulse
from stylobate.errors import UnsupportedError
from stylobate.kinds import Kinds
from stylobate.quantities import Parameter, Quantity, parameters_of, states

_HARMONIC = "stylobate.base_motions.harmonic:Harmonic"
_PULSE = "stylobate.base_motions.pulses:Pulse"
_SWEEP = "stylobate.base_motions.sweeps:SineSweep"

MOTIONS = Kinds(
    "motion",
    "stylobate.base_motions.combined:BaseMotion",
    {
        "rest": "stylobate.base_motions.combined:Sum.at_rest",
        "circular": f"{_HARMONIC}.circular",
        "straight": f"{_HARMONIC}.straight",
        "elliptic": f"{_HARMONIC}.elliptic",
        "vertical": f"{_HARMONIC}.vertical",
        "oblique": f"{_HARMONIC}.oblique",
        "displacement_amplitude": f"{_HARMONIC}.displacement_amplitude",
        "stroke": f"{_HARMONIC}.stroke",
        "orbit": f"{_HARMONIC}.orbit",
        "harmonic": _HARMONIC,
        "half_sine": f"{_PULSE}.half_sine",
        "half_cosine": f"{_PULSE}.half_cosine",
        "one_sine": f"{_PULSE}.one_sine",
        "one_cosine": f"{_PULSE}.one_cosine",
        "ricker": f"{_PULSE}.ricker",
        "antisymmetric_ricker": f"{_PULSE}.antisymmetric_ricker",
        "sinusoidal": f"{_PULSE}.sinusoidal",
        "type_a": f"{_PULSE}.type_a",
        "type_b": f"{_PULSE}.type_b",
        "type_c": f"{_PULSE}.type_c",
        "gabor": f"{_PULSE}.gabor",
        "mavroeidis_papageorgiou": f"{_PULSE}.mavroeidis_papageorgiou",
        "linear_sweep": f"{_SWEEP}.linear",
        "logarithmic_sweep": f"{_SWEEP}.logarithmic",
        "machine_run": "stylobate.base_motions.machine_run:MachineRun",
        "record": "stylobate.base_motions.record:Record",
        "one_of": "stylobate.base_motions.combined:OneOf",
        "sum": "stylobate.base_motions.combined:Sum",
        "scaled": "stylobate.base_motions.combined:BaseMotion.scaled",
        "rotated": "stylobate.base_motions.combined:BaseMotion.rotated",
        "delayed": "stylobate.base_motions.combined:BaseMotion.delayed",
        "offset": "stylobate.base_motions.combined:BaseMotion.offset",
    },
)


@cache
def motion_quantities() -> Mapping[str, Quantity]:
    """Return the quantity of each number that describes these base motions.

    A name with different units in different kinds is omitted.
    """
    found: dict[str, Quantity] = {}
    for make in MOTIONS.values():
        for name, one in parameters_of(make).items():
            known = found.setdefault(name, one.quantity)
            if known.unit != one.quantity.unit:
                found[name] = replace(known, unit="")
    return found


@cache
def composite_kinds() -> tuple[str, ...]:
    """Return the kinds of motions made of other motions."""
    others = {"self", "motion", "motions"}
    return tuple(kind for kind, make in MOTIONS.items() if others & signature(make).parameters.keys())


@cache
def kinds_with_response() -> tuple[str, ...]:
    """Return the kinds of motions for which response curves can be computed."""
    return tuple(kind for kind, make in MOTIONS.items() if states(make, "responds"))


@cache
def kinds_by_acceleration() -> tuple[str, ...]:
    """Return the horizontal kinds with response whose acceleration does not follow from a path."""

    def fits(quantity: Quantity) -> bool:
        return quantity.unit != "m" and quantity.components <= len("xy")

    numbers = {kind: parameters_of(MOTIONS[kind]).values() for kind in kinds_with_response()}
    return tuple(kind for kind, declared in numbers.items() if all(fits(one.quantity) for one in declared))


_FREQUENCY = Parameter("angular_frequency", AngularFrequency.__metadata__[0], float)  # type: ignore[attr-defined]


def numbers_of_motion(motion: BaseMotion) -> Mapping[str, Parameter]:
    """Return the declared numbers of `motion`, of its original if it is a copy, and of its waveform, by name.

    A motion with a `frequency` [Hz] also has an `angular_frequency` [rad/s]. `Scaled`, `Rotated`, `Delayed` and
    `Offset` have no numbers of their own, since they apply to every motion. A number of the class comes before one of
    its constructor of the same name.
    """
    found = {name: one for part in _parts(motion) for name, one in _own_numbers(part).items()}
    return {"angular_frequency": _FREQUENCY, **found} if "frequency" in found else found


def value_of(motion: BaseMotion, name: str) -> float:
    """Return the declared number of this `name`; NaN if the motion has none."""
    for part in _parts(motion):
        declared = _declared(part)
        if name in _stated(part):
            return float(part.stated.arguments.get(name, declared[name].default))
        if name in declared:
            return float(getattr(part, name))
    return 2.0 * math.pi * value_of(motion, "frequency") if name == "angular_frequency" else math.nan


def with_numbers(motion: BaseMotion, values: Mapping[str, float]) -> BaseMotion:
    """Return `motion` with some of its declared numbers changed; the others, such as the acceleration, stay.

    An `angular_frequency` keeps the acceleration of a motion that was stated by its path; its `frequency` or `rpm`
    keeps the path.

    Raises
    ------
    ParameterError
        If a value is out of range.
    UnsupportedError
        If the motion has no number of this name.
    """
    known = numbers_of_motion(motion)
    for name in values:
        if name not in known:
            numbers = f"Its numbers are {', '.join(known)}." if known else "It has none."
            raise UnsupportedError(f"{name}: the base motion has no such number (got {motion!r}). {numbers}")
    if "angular_frequency" in values and "frequency" in known and "frequency" not in stated_numbers(motion):
        values = {**values, "frequency": values["angular_frequency"] / (2.0 * math.pi)}
    changed: BaseMotion = _changed(motion, values)
    return changed


def stated_numbers(motion: BaseMotion) -> Mapping[str, Parameter]:
    """Return the numbers of `motion` that only its named constructor has, such as the stroke, by name."""
    return {name: one for part in _parts(motion) for name, one in _stated(part).items()}


def frequency_of(motion: BaseMotion) -> float:
    """Return the angular frequency of a motion, also of a rotated or chosen one [rad/s], or NaN."""
    return frequency_of(motion.followed) if isinstance(motion, Following) else value_of(motion, "angular_frequency")


def is_pulse(motion: BaseMotion) -> bool:
    """Return whether `motion` is one pulse, also scaled or rotated."""
    return is_pulse(motion.motion) if isinstance(motion, Transformed) else isinstance(motion, Pulse)


def _changed(part: Any, values: Mapping[str, float]) -> Any:
    changes = {name: values[name] for name in _declared(part) if name in values and _is_own(part)}
    inner = {name: _changed(getattr(part, name), values) for name in ("motion", "waveform") if hasattr(part, name)}
    if changes and getattr(part, "stated", None) is not None:
        return _restated(part, changes)
    return replace(part, **changes, **inner) if changes or inner else part


def _restated(part: Any, changes: Mapping[str, float]) -> Any:
    """Return a motion with other numbers, made by its named constructor if that gives the same motion."""
    make = getattr(type(part), part.stated.constructor)
    only_stated = {name: value for name, value in changes.items() if name in _stated(part)}
    of_class = {name: value for name, value in changes.items() if name not in only_stated}
    arguments = {**part.stated.arguments, **only_stated}
    changed = replace(make(**arguments), **of_class)
    again = make(**{**arguments, **{name: of_class[name] for name in of_class if name in parameters_of(make)}})
    return again if again == changed else changed


def _parts(motion: BaseMotion) -> tuple[Any, ...]:
    """Return the objects with numbers of a motion: its waveform, the motion, and its original."""
    inner = _parts(motion.motion) if isinstance(motion, Transformed) else ()
    waveform = (motion.waveform,) if isinstance(motion, Pulse) else ()
    return (*inner, *waveform, *([motion] if _is_own(motion) else []))


def _declared(part: object) -> Mapping[str, Parameter]:
    make: Callable[..., Any] = type(part)
    return {**parameters_of(make), **_stated(part)}


def _own_numbers(part: object) -> Mapping[str, Parameter]:
    make: Callable[..., Any] = type(part)
    return {**_numbers(make), **_stated(part)}


def _stated(part: Any) -> Mapping[str, Parameter]:
    """Return the numbers that the named constructor of an object has, and its class has not."""
    stated = getattr(part, "stated", None)
    make: Callable[..., Any] = type(part)
    return {} if stated is None else _stated_by(make, stated.constructor)


@cache
def _stated_by(kind: Callable[..., Any], constructor: str) -> Mapping[str, Parameter]:
    of_class = _numbers(kind)
    return {name: one for name, one in _numbers(getattr(kind, constructor)).items() if name not in of_class}


@cache
def _numbers(make: Callable[..., Any]) -> Mapping[str, Parameter]:
    """Return the declared arguments that are single numbers without choices."""
    return {
        name: one
        for name, one in parameters_of(make).items()
        if one.annotation in (float, int) and one.quantity.components == 1 and not one.choices
    }


def _is_own(part: object) -> bool:
    return type(part) not in (Scaled, Rotated, Delayed, Offset, OneOf)
