"""Descriptions of base motions, told apart by their `kind`."""

from typing import Annotated, Literal

from pydantic import Field

from stylobate.errors import UnsupportedError
from stylobate.motions import BaseMotion, Delayed, Harmonic, Rotated, Scaled, Sum
from stylobate.spec.description import Description


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
    """Along a line that rises at `angle` towards `direction` [rad]; acceleration in m/s²."""

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


class SumMotion(Description):
    """The sum of several motions."""

    kind: Literal["sum"]
    motions: tuple["MotionDescription", ...]

    def build(self) -> BaseMotion:
        """Return the motion."""
        return Sum(motions=tuple(motion.build() for motion in self.motions))


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
    | SumMotion
    | ScaledMotion
    | RotatedMotion
    | DelayedMotion,
    Field(discriminator="kind"),
]

for _composite in (SumMotion, ScaledMotion, RotatedMotion, DelayedMotion):
    _composite.model_rebuild()


def describe_motion(motion: BaseMotion) -> Description:
    """Return the description of `motion`.

    Raises
    ------
    UnsupportedError
        If the motion is of a class that descriptions do not know.
    """
    if type(motion) not in (Harmonic, Sum, Scaled, Rotated, Delayed):  # a subclass is another motion
        message = f"a motion of class {type(motion).__name__} has no description; results keep its repr only"
        raise UnsupportedError(message)
    match motion:
        case Harmonic():
            return GeneralHarmonicMotion(
                kind="harmonic",
                amplitude=motion.amplitude,
                phase=motion.phase,
                angular_frequency=motion.angular_frequency,
                start_phase=motion.start_phase,
                ramp=motion.ramp,
            )
        case Sum(motions=()):
            return RestMotion(kind="rest")
        case Sum():
            return SumMotion.parse(
                {"kind": "sum", "motions": [describe_motion(part).values() for part in motion.motions]}
            )
        case Scaled():
            changed = {"kind": "scaled", "factor": motion.factor, "vertical": motion.vertical}
            return ScaledMotion.parse({**changed, "motion": describe_motion(motion.motion).values()})
        case Rotated():
            changed = {"kind": "rotated", "angle": motion.angle}
            return RotatedMotion.parse({**changed, "motion": describe_motion(motion.motion).values()})
        case Delayed():
            changed = {"kind": "delayed", "delay": motion.delay}
            return DelayedMotion.parse({**changed, "motion": describe_motion(motion.motion).values()})
    raise AssertionError
