"""Base motions of the package by kind, for description files and the command line."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from inspect import signature

from stylobate.kinds import Kinds
from stylobate.quantities import Quantity, parameters_of, states

_HARMONIC = "stylobate.base_motions.harmonic:Harmonic"
_PULSE = "stylobate.base_motions.pulses.pulse:Pulse"
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
        "one_of": "stylobate.base_motions.one_of:OneOf",
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
