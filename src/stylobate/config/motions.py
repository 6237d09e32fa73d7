"""Descriptions of base motions, told apart by their `kind`."""

from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal, get_args

from stylobate.base_motions import BaseMotion, Delayed, Harmonic, OneOf, Pulse, Record, Rotated, Scaled, SineSweep, Sum
from stylobate.base_motions.declared import HARMONIC_KINDS, PULSE_KINDS
from stylobate.base_motions.pulses import AntisymmetricRicker, Gabor, MavroeidisPapageorgiou, Ricker, Sinusoid
from stylobate.config.declared import configs_of, one_of
from stylobate.config.description import Config
from stylobate.config.records import DescribedRecord, RecordMotion
from stylobate.errors import UnsupportedError
from stylobate.quantities import parameters_of


class DescribedMotion(Config):
    """A base motion by the numbers of its kind."""

    kind: str

    def build(self) -> BaseMotion:
        """Return the motion."""
        make: Callable[..., BaseMotion] = {**HARMONIC_KINDS, **PULSE_KINDS}[self.kind]
        return make(**self.model_dump(exclude={"kind"}))


class RestMotion(DescribedMotion):
    """A base at rest."""

    kind: Literal["rest"]

    def build(self) -> BaseMotion:
        """Return the motion."""
        return Sum()


class PulseMotion(DescribedMotion):
    """A pulse by the numbers of its kind."""


HARMONICS = configs_of(DescribedMotion, "kind", HARMONIC_KINDS)
_PULSES = configs_of(PulseMotion, "kind", PULSE_KINDS)


class SweepMotion(Config):
    """A sine sweep of constant acceleration [m/s²] or displacement [m] between two frequencies [Hz] in `length` [s]."""

    kind: Literal["linear_sweep", "logarithmic_sweep"]
    acceleration: float | None = None
    displacement: float | None = None
    frequencies: tuple[float, float]
    length: float
    start_phase: float = 0.0
    direction: float = 0.0
    start: float = 0.0
    vertical: float = 0.0

    def build(self) -> BaseMotion:
        """Return the motion."""
        make = SineSweep.linear if self.kind == "linear_sweep" else SineSweep.logarithmic
        return make(**self.model_dump(exclude={"kind"}))


class SumMotion(Config):
    """The sum of several motions."""

    kind: Literal["sum"]
    motions: tuple["MotionConfig", ...]

    def build(self) -> BaseMotion:
        """Return the motion."""
        return Sum(motions=tuple(motion.build() for motion in self.motions))


class OneOfMotion(Config):
    """One of several motions, the one of the number `chosen`, counted from 0."""

    kind: Literal["one_of"]
    motions: tuple["MotionConfig", ...]
    chosen: int = 0

    def build(self) -> BaseMotion:
        """Return the motion."""
        return OneOf(motions=tuple(motion.build() for motion in self.motions), chosen=self.chosen)


class ScaledMotion(Config):
    """A motion times `factor`, its vertical component times `vertical`."""

    kind: Literal["scaled"]
    motion: "MotionConfig"
    factor: float
    vertical: float | None = None

    def build(self) -> BaseMotion:
        """Return the motion."""
        return self.motion.build().scaled(self.factor, vertical=self.vertical)


class RotatedMotion(Config):
    """A motion turned by `angle` [rad]."""

    kind: Literal["rotated"]
    motion: "MotionConfig"
    angle: float

    def build(self) -> BaseMotion:
        """Return the motion."""
        return self.motion.build().rotated(self.angle)


class DelayedMotion(Config):
    """A motion begun `delay` [s] later."""

    kind: Literal["delayed"]
    motion: "MotionConfig"
    delay: float

    def build(self) -> BaseMotion:
        """Return the motion."""
        return self.motion.build().delayed(self.delay)


if TYPE_CHECKING:
    MotionConfig = DescribedMotion
else:
    MotionConfig = one_of(
        (
            RestMotion,
            *HARMONICS.values(),
            *_PULSES.values(),
            SweepMotion,
            RecordMotion,
            OneOfMotion,
            SumMotion,
            ScaledMotion,
            RotatedMotion,
            DelayedMotion,
        ),
        "kind",
    )

_MEMBERS: tuple[type[Config], ...] = get_args(get_args(MotionConfig)[0])


def _kinds(members: Iterable[type[Config]]) -> tuple[str, ...]:
    return tuple(kind for one in members for kind in get_args(one.model_fields["kind"].annotation))


ENDING = _kinds(one for one in _MEMBERS if issubclass(one, (PulseMotion, SweepMotion, RecordMotion)))
"""Kinds of motions that end, so that a run needs no duration: pulses, sine sweeps and records."""

PULSES = _kinds(one for one in _MEMBERS if issubclass(one, PulseMotion) and "angular_frequency" in one.model_fields)
"""Kinds of pulses that have an angular frequency."""

for _composite in (SumMotion, OneOfMotion, ScaledMotion, RotatedMotion, DelayedMotion):
    _composite.model_rebuild()


def describe_motion(motion: BaseMotion) -> Config:
    """Return the description of `motion`.

    Raises
    ------
    UnsupportedError
        If the motion is of a class that descriptions do not know, or a record that was read in Python.
    """
    describe = _DESCRIBERS.get(type(motion))  # a subclass is another motion
    if describe is not None:
        return describe(motion)
    if type(motion) is Record:
        message = f"the record {motion.name!r} has no description that tells of which files; results keep its repr only"
        raise UnsupportedError(message)
    message = f"a motion of class {type(motion).__name__} has no description; results keep its repr only"
    raise UnsupportedError(message)


def _described_harmonic(motion: Harmonic) -> Config:
    numbers = {name: getattr(motion, name) for name in parameters_of(Harmonic)}
    return HARMONICS["harmonic"](**{"kind": "harmonic", **numbers})


def _described_record(motion: DescribedRecord) -> Config:
    return motion.description


def _described_sum(motion: Sum) -> Config:
    if not motion.motions:
        return RestMotion(kind="rest")
    return SumMotion.parse({"kind": "sum", "motions": _described_members(motion)})


def _described_one_of(motion: OneOf) -> Config:
    return OneOfMotion.parse({"kind": "one_of", "motions": _described_members(motion), "chosen": motion.chosen})


def _described_members(motion: Sum | OneOf) -> list[dict[str, Any]]:
    return [describe_motion(member).values() for member in motion.motions]


def _described_copy(motion: Scaled | Rotated | Delayed) -> Config:
    copied = {"motion": describe_motion(motion.motion).values()}
    match motion:
        case Scaled():
            changed = {"kind": "scaled", "factor": motion.factor, "vertical": motion.vertical}
            return ScaledMotion.parse({**changed, **copied})
        case Rotated():
            return RotatedMotion.parse({"kind": "rotated", "angle": motion.angle, **copied})
        case Delayed():
            return DelayedMotion.parse({"kind": "delayed", "delay": motion.delay, **copied})


_WAVEFORMS: Mapping[type, str] = {
    Sinusoid: "sinusoidal",
    Ricker: "ricker",
    AntisymmetricRicker: "antisymmetric_ricker",
    Gabor: "gabor",
    MavroeidisPapageorgiou: "mavroeidis_papageorgiou",
}


def _described_pulse(pulse: Pulse) -> Config:
    waveform = pulse.waveform
    if type(waveform) not in _WAVEFORMS:
        message = f"a waveform of class {type(waveform).__name__} has no description; results keep its repr only"
        raise UnsupportedError(message)
    kind = _WAVEFORMS[type(waveform)]
    line = _line(pulse)
    numbers = {name: getattr(waveform, name) for name in parameters_of(PULSE_KINDS[kind]) if name not in line}
    return _PULSES[kind].parse({"kind": kind, **numbers, **line})


def _described_sweep(sweep: SineSweep) -> Config:
    own = {"frequencies": sweep.frequencies, "length": sweep.length, "start_phase": sweep.start_phase}
    kind, amplitude = f"{sweep.law.value}_sweep", {sweep.quantity.value: sweep.amplitude}
    return SweepMotion.parse({"kind": kind, **amplitude, **own, **_line(sweep)})


def _line(motion: Pulse | SineSweep) -> dict[str, float]:
    return {"direction": motion.direction, "start": motion.start, "vertical": motion.vertical}


_DESCRIBERS: Mapping[type[BaseMotion], Callable[[Any], Config]] = {
    Harmonic: _described_harmonic,
    Pulse: _described_pulse,
    SineSweep: _described_sweep,
    DescribedRecord: _described_record,
    Sum: _described_sum,
    OneOf: _described_one_of,
    Scaled: _described_copy,
    Rotated: _described_copy,
    Delayed: _described_copy,
}
