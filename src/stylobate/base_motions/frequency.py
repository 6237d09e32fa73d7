"""The one frequency of a base motion: of a pulse, or of a harmonic motion."""

import math
from dataclasses import fields, is_dataclass, replace

from stylobate.base_motions.base import BaseMotion
from stylobate.base_motions.combined import Following, Transformed
from stylobate.base_motions.harmonic import Harmonic
from stylobate.base_motions.pulses.pulse import Pulse
from stylobate.errors import UnsupportedError


def frequency_of(motion: BaseMotion) -> float:
    """Return the angular frequency of a pulse or a harmonic motion [rad/s], scaled or turned or not; else NaN."""
    if isinstance(motion, Following):
        return frequency_of(motion.followed)
    if isinstance(motion, Harmonic):
        return motion.angular_frequency
    if not isinstance(motion, Pulse):
        return math.nan
    names = _numbers(motion)
    if "angular_frequency" in names:
        return float(motion.waveform.angular_frequency)  # type: ignore[attr-defined]  # told by its fields
    return 2.0 * math.pi * float(motion.waveform.frequency) if "frequency" in names else math.nan  # type: ignore[attr-defined]


def is_pulse(motion: BaseMotion) -> bool:
    """Return whether `motion` is one pulse, scaled or turned or not."""
    return is_pulse(motion.motion) if isinstance(motion, Transformed) else isinstance(motion, Pulse)


def has_frequency_of_its_own(motion: BaseMotion) -> bool:
    """Return whether `motion` is one pulse with a frequency that can be changed: not all are told by theirs."""
    return is_pulse(motion) and not math.isnan(frequency_of(motion))


def with_frequency(motion: BaseMotion, angular_frequency: float) -> BaseMotion:
    """Return the same pulse of another frequency [rad/s]: its other numbers, such as the acceleration, stay.

    Raises
    ------
    ParameterError
        If the frequency is not positive.
    UnsupportedError
        If it has none.
    """
    if isinstance(motion, Transformed):
        return replace(motion, motion=with_frequency(motion.motion, angular_frequency))
    names = _numbers(motion) if isinstance(motion, Pulse) else ()
    if "angular_frequency" in names:
        changed = {"angular_frequency": angular_frequency}
    elif "frequency" in names:
        changed = {"frequency": angular_frequency / (2.0 * math.pi)}
    else:
        message = f"angular_frequency can be changed in a pulse that is told by its frequency only; got {motion!r}"
        raise UnsupportedError(message)
    assert isinstance(motion, Pulse)
    return replace(motion, waveform=replace(motion.waveform, **changed))  # type: ignore[type-var]  # a dataclass


def _numbers(pulse: Pulse) -> tuple[str, ...]:
    waveform = pulse.waveform
    return tuple(field.name for field in fields(waveform)) if is_dataclass(waveform) else ()
