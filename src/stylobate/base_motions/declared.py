"""The base motions that are described by numbers alone, by their kind in files and on the command line."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

from stylobate.base_motions.base import BaseMotion
from stylobate.base_motions.harmonic import Harmonic
from stylobate.base_motions.pulses import Pulse
from stylobate.quantities import Quantity, parameters_of

HARMONIC_KINDS: Mapping[str, Callable[..., BaseMotion]] = {
    "circular": Harmonic.circular,
    "straight": Harmonic.straight,
    "elliptic": Harmonic.elliptic,
    "vertical": Harmonic.vertical,
    "oblique": Harmonic.oblique,
    "displacement_amplitude": Harmonic.displacement_amplitude,
    "stroke": Harmonic.stroke,
    "orbit": Harmonic.orbit,
    "harmonic": Harmonic,
}

PULSE_KINDS: Mapping[str, Callable[..., BaseMotion]] = {
    "half_sine": Pulse.half_sine,
    "half_cosine": Pulse.half_cosine,
    "one_sine": Pulse.one_sine,
    "one_cosine": Pulse.one_cosine,
    "ricker": Pulse.ricker,
    "antisymmetric_ricker": Pulse.antisymmetric_ricker,
    "sinusoidal": Pulse.sinusoidal,
    "type_a": Pulse.type_a,
    "type_b": Pulse.type_b,
    "type_c": Pulse.type_c,
    "gabor": Pulse.gabor,
    "mavroeidis_papageorgiou": Pulse.mavroeidis_papageorgiou,
}


@cache
def motion_quantities() -> Mapping[str, Quantity]:
    """Return the quantity of each number by which these base motions can be described.

    A name that has different units in different kinds has none here.
    """
    found: dict[str, Quantity] = {}
    for make in {**HARMONIC_KINDS, **PULSE_KINDS}.values():
        for name, one in parameters_of(make).items():
            known = found.setdefault(name, one.quantity)
            if known.unit != one.quantity.unit:
                found[name] = replace(known, unit="")
    return found
