"""Descriptions of base motions, told apart by their `kind`."""

from collections.abc import Callable, Iterable, Mapping
from typing import Annotated, Any, Literal, get_args

from pydantic import Field

from stylobate.errors import UnsupportedError
from stylobate.motions import BaseMotion, Delayed, Harmonic, OneOf, Pulse, Record, Rotated, Scaled, Sum, Sweep
from stylobate.motions.pulses import AntisymmetricRicker, Gabor, MavroeidisPapageorgiou, Ricker, Sinusoid
from stylobate.spec.description import Description
from stylobate.spec.records import DescribedRecord, RecordMotion


class RestMotion(Description):
    """A base at rest."""

    kind: Literal["rest"]

    def build(self) -> BaseMotion:
        """Return the motion."""
        return Sum()


class _HarmonicMotion(Description):
    start_phase: float = 0.0
    ramp: float = 0.0

    def build(self) -> BaseMotion:
        """Return the motion, by the constructor of Harmonic that has the name of the kind."""
        values = self.model_dump()
        motion = getattr(Harmonic, values.pop("kind"))(**values)
        assert isinstance(motion, BaseMotion)
        return motion


class CircularMotion(_HarmonicMotion):
    """On a circle; acceleration in m/s², angular_frequency in rad/s."""

    kind: Literal["circular"]
    acceleration: float
    angular_frequency: float
    sense: int = 1


class StraightMotion(_HarmonicMotion):
    """Along a horizontal line at `direction` [rad]; acceleration in m/s², angular_frequency in rad/s."""

    kind: Literal["straight"]
    acceleration: float
    angular_frequency: float
    direction: float = 0.0


class EllipticMotion(_HarmonicMotion):
    """On an ellipse; amplitudes in m/s², phase of the second axis in rad."""

    kind: Literal["elliptic"]
    amplitude: tuple[float, float]
    phase: float
    angular_frequency: float


class VerticalMotion(_HarmonicMotion):
    """Up and down; acceleration in m/s², angular_frequency in rad/s."""

    kind: Literal["vertical"]
    acceleration: float
    angular_frequency: float


class ObliqueMotion(_HarmonicMotion):
    """Along a line that rises at `angle` towards `direction` [rad]; horizontal acceleration in m/s²."""

    kind: Literal["oblique"]
    acceleration: float
    angular_frequency: float
    angle: float
    direction: float = 0.0


class DisplacementMotion(_HarmonicMotion):
    """By the displacement amplitudes along x, y and z [m]."""

    kind: Literal["displacement_amplitude"]
    amplitude: tuple[float, float, float]
    phase: tuple[float, float, float] = (0.0, 0.0, 0.0)
    angular_frequency: float


class StrokeMotion(_HarmonicMotion):
    """Along a line, by the stroke from peak to peak [m] and the frequency [Hz]."""

    kind: Literal["stroke"]
    stroke: float
    frequency: float
    direction: float = 0.0


class OrbitMotion(_HarmonicMotion):
    """On a circle, by its diameter [m] and turns a minute."""

    kind: Literal["orbit"]
    diameter: float
    rpm: float
    sense: int = 1


class GeneralHarmonicMotion(_HarmonicMotion):
    """Three components of one frequency, by acceleration [m/s²] and phase [rad]."""

    kind: Literal["harmonic"]
    amplitude: tuple[float, float, float]
    phase: tuple[float, float, float] = (0.0, 0.0, 0.0)
    angular_frequency: float

    def build(self) -> BaseMotion:
        """Return the motion."""
        return Harmonic(**self.model_dump(exclude={"kind"}))


class _LineMotion(Description):
    """A pulse or a sine sweep, which ends."""

    direction: float = 0.0
    start: float = 0.0
    vertical: float = 0.0


class _PulseMotion(_LineMotion):
    def build(self) -> BaseMotion:
        """Return the motion, by the constructor of Pulse that has the name of the kind."""
        values = self.model_dump()
        motion = getattr(Pulse, values.pop("kind"))(**values)
        assert isinstance(motion, BaseMotion)
        return motion


class AccelerationPulseMotion(_PulseMotion):
    """A pulse by its largest acceleration [m/s²] and angular_frequency [rad/s]."""

    kind: Literal["half_sine", "half_cosine", "one_sine", "one_cosine", "ricker", "antisymmetric_ricker"]
    acceleration: float
    angular_frequency: float


class SinusoidalPulseMotion(_PulseMotion):
    """A part of a sinusoid of acceleration [m/s²], its phase in rad, its length in cycles."""

    kind: Literal["sinusoidal"]
    acceleration: float
    angular_frequency: float
    phase: float = 0.0
    cycles: float = 1.0


class VelocityPulseMotion(_PulseMotion):
    """A forward, or forward-and-back, pulse by its velocity [m/s] and angular_frequency [rad/s]."""

    kind: Literal["type_a", "type_b"]
    velocity: float
    angular_frequency: float


class CyclicPulseMotion(_PulseMotion):
    """A pulse of several cycles that ends where it began, by its velocity [m/s]."""

    kind: Literal["type_c"]
    velocity: float
    angular_frequency: float
    cycles: int = 1


class VelocityWaveletMotion(_PulseMotion):
    """A harmonic velocity [m/s] under a bell; frequency in Hz, phase in rad."""

    kind: Literal["gabor", "mavroeidis_papageorgiou"]
    velocity: float
    frequency: float
    phase: float = 0.0
    oscillations: float


class SweepMotion(_LineMotion):
    """A sine sweep of constant acceleration [m/s²] or displacement [m] between two frequencies [Hz] in `length` [s]."""

    kind: Literal["linear_sweep", "logarithmic_sweep"]
    acceleration: float | None = None
    displacement: float | None = None
    frequencies: tuple[float, float]
    length: float
    start_phase: float = 0.0

    def build(self) -> BaseMotion:
        """Return the motion."""
        make = Sweep.linear if self.kind == "linear_sweep" else Sweep.logarithmic
        return make(**self.model_dump(exclude={"kind"}))


class SumMotion(Description):
    """The sum of several motions."""

    kind: Literal["sum"]
    motions: tuple["MotionDescription", ...]

    def build(self) -> BaseMotion:
        """Return the motion."""
        return Sum(motions=tuple(motion.build() for motion in self.motions))


class OneOfMotion(Description):
    """One of several motions, the one of the number `chosen`, counted from 0."""

    kind: Literal["one_of"]
    motions: tuple["MotionDescription", ...]
    chosen: int = 0

    def build(self) -> BaseMotion:
        """Return the motion."""
        return OneOf(motions=tuple(motion.build() for motion in self.motions), chosen=self.chosen)


class ScaledMotion(Description):
    """A motion times `factor`, its vertical component times `vertical`."""

    kind: Literal["scaled"]
    motion: "MotionDescription"
    factor: float
    vertical: float | None = None

    def build(self) -> BaseMotion:
        """Return the motion."""
        return self.motion.build().scaled(self.factor, vertical=self.vertical)


class RotatedMotion(Description):
    """A motion turned by `angle` [rad]."""

    kind: Literal["rotated"]
    motion: "MotionDescription"
    angle: float

    def build(self) -> BaseMotion:
        """Return the motion."""
        return self.motion.build().rotated(self.angle)


class DelayedMotion(Description):
    """A motion begun `delay` [s] later."""

    kind: Literal["delayed"]
    motion: "MotionDescription"
    delay: float

    def build(self) -> BaseMotion:
        """Return the motion."""
        return self.motion.build().delayed(self.delay)


MotionDescription = Annotated[
    RestMotion
    | CircularMotion
    | StraightMotion
    | EllipticMotion
    | VerticalMotion
    | ObliqueMotion
    | DisplacementMotion
    | StrokeMotion
    | OrbitMotion
    | GeneralHarmonicMotion
    | AccelerationPulseMotion
    | SinusoidalPulseMotion
    | VelocityPulseMotion
    | CyclicPulseMotion
    | VelocityWaveletMotion
    | SweepMotion
    | RecordMotion
    | OneOfMotion
    | SumMotion
    | ScaledMotion
    | RotatedMotion
    | DelayedMotion,
    Field(discriminator="kind"),
]

_MEMBERS: tuple[type[Description], ...] = get_args(get_args(MotionDescription)[0])


def _kinds(members: Iterable[type[Description]]) -> tuple[str, ...]:
    return tuple(kind for one in members for kind in get_args(one.model_fields["kind"].annotation))


ENDING = _kinds(one for one in _MEMBERS if issubclass(one, (_LineMotion, RecordMotion)))
"""Kinds of motions that end, so that a run needs no duration: pulses, sine sweeps and records."""

PULSES = _kinds(one for one in _MEMBERS if issubclass(one, _LineMotion) and "angular_frequency" in one.model_fields)
"""Kinds of pulses that have an angular frequency."""

for _composite in (SumMotion, OneOfMotion, ScaledMotion, RotatedMotion, DelayedMotion):
    _composite.model_rebuild()


def describe_motion(motion: BaseMotion) -> Description:
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


def _described_harmonic(motion: Harmonic) -> Description:
    return GeneralHarmonicMotion(
        kind="harmonic",
        amplitude=motion.amplitude,
        phase=motion.phase,
        angular_frequency=motion.angular_frequency,
        start_phase=motion.start_phase,
        ramp=motion.ramp,
    )


def _described_record(motion: DescribedRecord) -> Description:
    return motion.description


def _described_sum(motion: Sum) -> Description:
    if not motion.motions:
        return RestMotion(kind="rest")
    return SumMotion.parse({"kind": "sum", "motions": _described_members(motion)})


def _described_one_of(motion: OneOf) -> Description:
    return OneOfMotion.parse({"kind": "one_of", "motions": _described_members(motion), "chosen": motion.chosen})


def _described_members(motion: Sum | OneOf) -> list[dict[str, Any]]:
    return [describe_motion(member).values() for member in motion.motions]


def _described_copy(motion: Scaled | Rotated | Delayed) -> Description:
    copied = {"motion": describe_motion(motion.motion).values()}
    match motion:
        case Scaled():
            changed = {"kind": "scaled", "factor": motion.factor, "vertical": motion.vertical}
            return ScaledMotion.parse({**changed, **copied})
        case Rotated():
            return RotatedMotion.parse({"kind": "rotated", "angle": motion.angle, **copied})
        case Delayed():
            return DelayedMotion.parse({"kind": "delayed", "delay": motion.delay, **copied})


_WAVEFORMS: dict[type, tuple[str, type[_PulseMotion]]] = {
    Sinusoid: ("sinusoidal", SinusoidalPulseMotion),
    Ricker: ("ricker", AccelerationPulseMotion),
    AntisymmetricRicker: ("antisymmetric_ricker", AccelerationPulseMotion),
    Gabor: ("gabor", VelocityWaveletMotion),
    MavroeidisPapageorgiou: ("mavroeidis_papageorgiou", VelocityWaveletMotion),
}


def _described_pulse(pulse: Pulse) -> Description:
    waveform = pulse.waveform
    if type(waveform) not in _WAVEFORMS:
        message = f"a waveform of class {type(waveform).__name__} has no description; results keep its repr only"
        raise UnsupportedError(message)
    kind, description = _WAVEFORMS[type(waveform)]
    own = [name for name in description.model_fields if name not in {"kind", *_LineMotion.model_fields}]
    numbers = {name: getattr(waveform, name) for name in own}
    return description.parse({"kind": kind, **numbers, **_line(pulse)})


def _described_sweep(sweep: Sweep) -> Description:
    own = {"frequencies": sweep.frequencies, "length": sweep.length, "start_phase": sweep.start_phase}
    kind, amplitude = f"{sweep.law.value}_sweep", {sweep.quantity.value: sweep.amplitude}
    return SweepMotion.parse({"kind": kind, **amplitude, **own, **_line(sweep)})


def _line(motion: Pulse | Sweep) -> dict[str, float]:
    return {"direction": motion.direction, "start": motion.start, "vertical": motion.vertical}


_DESCRIBERS: Mapping[type[BaseMotion], Callable[[Any], Description]] = {
    Harmonic: _described_harmonic,
    Pulse: _described_pulse,
    Sweep: _described_sweep,
    DescribedRecord: _described_record,
    Sum: _described_sum,
    OneOf: _described_one_of,
    Scaled: _described_copy,
    Rotated: _described_copy,
    Delayed: _described_copy,
}
