"""Small changes of record, column and integration that should not alter a verdict."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

from stylobate.base_motions import BaseMotion, Record
from stylobate.earthquakes.incremental import without_vertical
from stylobate.errors import ParameterError, require_finite, require_not_negative, require_positive
from stylobate.models import Model
from stylobate.models.declared import dissipation_of


class PerturbationOf(Enum):
    """Object of a perturbation."""

    RECORD = "record"
    DISSIPATION = "dissipation"
    GEOMETRY = "geometry"
    INTEGRATION = "integration"


class Perturbation(ABC):
    """A small change of record, column or integration; a subclass overrides the members that it changes."""

    __slots__ = ()

    of: ClassVar[PerturbationOf]

    @property
    @abstractmethod
    def name(self) -> str:
        """Name in tables and figures."""

    def changed_motion(self, motion: BaseMotion) -> BaseMotion | None:
        """Return the base motion after the change; None if this change does not apply."""
        return motion

    def changed_values(self, model: Model) -> dict[str, float] | None:
        """Return the parameters of column and model after the change; None if there is nothing to change."""
        del model
        return {}

    @property
    def scale_factor(self) -> float:
        """Factor on the scale of the record."""
        return 1.0

    @property
    def turn(self) -> float:
        """Rotation of the record about the vertical [rad]."""
        return 0.0

    def delay(self, motion: BaseMotion) -> float:
        """Return the delay of the base motion [s]."""
        del motion
        return 0.0

    @property
    def tolerance_factor(self) -> float:
        """Factor on the tolerances of the integration."""
        return 1.0

    @property
    def rest_threshold(self) -> float | None:
        """Energy below which a column comes to rest, as `rest_energy` of `simulate`; None keeps that of the run."""
        return None


@dataclass(frozen=True, slots=True)
class _Scaled(Perturbation):
    factor: float

    def __post_init__(self) -> None:
        require_positive("factor", self.factor)


@dataclass(frozen=True, slots=True)
class ScaledRecord(_Scaled):
    """Multiply all components of the record by `factor`."""

    of: ClassVar[PerturbationOf] = PerturbationOf.RECORD

    @property
    def name(self) -> str:
        """Such as scale +2 %."""
        return f"scale {_percent(self.factor)}"

    @property
    def scale_factor(self) -> float:
        """The factor."""
        return self.factor


@dataclass(frozen=True, slots=True)
class TurnedRecord(Perturbation):
    """Rotate the record by `angle` [rad] about the vertical; this does not affect a round column on level ground."""

    angle: float
    of: ClassVar[PerturbationOf] = PerturbationOf.RECORD

    def __post_init__(self) -> None:
        require_finite("angle", self.angle, "rad")

    @property
    def name(self) -> str:
        """Such as turned +3°."""
        return f"turned {math.degrees(self.angle):+.3g}°"

    @property
    def turn(self) -> float:
        """The angle [rad]."""
        return self.angle


@dataclass(frozen=True, slots=True)
class Polarity(Perturbation):
    """Reverse the horizontal components, which is half a turn; this does not affect a round column."""

    of: ClassVar[PerturbationOf] = PerturbationOf.RECORD

    @property
    def name(self) -> str:
        """Polarity."""
        return "polarity"

    @property
    def turn(self) -> float:
        """Half a turn [rad]."""
        return math.pi


@dataclass(frozen=True, slots=True)
class ComponentScaled(Perturbation):
    """Multiply one component of a record by `factor`: an error of one channel. `axis` is "x", "y" or "z"."""

    axis: str
    factor: float
    of: ClassVar[PerturbationOf] = PerturbationOf.RECORD

    def __post_init__(self) -> None:
        require_finite("factor", self.factor)
        if self.axis not in ("x", "y", "z"):
            message = f'axis must be "x", "y" or "z", got {self.axis!r}'
            raise ParameterError(message)

    @property
    def name(self) -> str:
        """Such as x component +5 %."""
        return f"{self.axis} component {_percent(self.factor)}"

    def changed_motion(self, motion: BaseMotion) -> BaseMotion | None:
        """Return the changed record; None for other motions, or a record without this component."""
        if self.axis == "z":
            return motion.scaled(1.0, vertical=self.factor) if any(motion.vertical_range(0.0)) else None
        if not isinstance(motion, Record) or self.axis not in motion.axes:
            return None
        factors = [self.factor if axis == self.axis else 1.0 for axis in ("x", "y", "z")]
        return motion.changed(f"{self.axis} component scaled by {self.factor!r}", samples=motion.samples * factors)


@dataclass(frozen=True, slots=True)
class WithoutVertical(Perturbation):
    """Remove the vertical component of the record."""

    of: ClassVar[PerturbationOf] = PerturbationOf.RECORD

    @property
    def name(self) -> str:
        """No vertical."""
        return "no vertical"

    def changed_motion(self, motion: BaseMotion) -> BaseMotion | None:
        """Return the motion without its vertical component; None if it has none."""
        return without_vertical(motion) if any(motion.vertical_range(0.0)) else None


@dataclass(frozen=True, slots=True)
class Shifted(Perturbation):
    """Delay the record by a fraction of its step, so that the integration uses other times."""

    part: float = 0.5
    of: ClassVar[PerturbationOf] = PerturbationOf.RECORD

    def __post_init__(self) -> None:
        require_positive("part", self.part)

    @property
    def name(self) -> str:
        """Such as 0.5 steps later."""
        return f"{self.part:g} steps later"

    def delay(self, motion: BaseMotion) -> float:
        """Return the fraction of a step [s]; the step of a motion without steps is 2/ω of its highest frequency."""
        return self.part * (motion.step if isinstance(motion, Record) else 2.0 / motion.highest_frequency)


@dataclass(frozen=True, slots=True)
class Resampled(Perturbation):
    """Resample the record at `factor` times its step, band-limited."""

    factor: float = 0.5
    of: ClassVar[PerturbationOf] = PerturbationOf.RECORD

    def __post_init__(self) -> None:
        require_positive("factor", self.factor)

    @property
    def name(self) -> str:
        """Such as step × 0.5."""
        return f"step × {self.factor:g}"

    def changed_motion(self, motion: BaseMotion) -> BaseMotion | None:
        """Return the resampled record; None for other motions."""
        return motion.resampled(self.factor * motion.step) if isinstance(motion, Record) else None


@dataclass(frozen=True, slots=True)
class Filtered(Perturbation):
    """Filter the record by a Butterworth filter, corners in Hz, forwards and backwards."""

    highpass: float | None = None
    lowpass: float | None = None
    of: ClassVar[PerturbationOf] = PerturbationOf.RECORD

    @property
    def name(self) -> str:
        """Such as lowpass 20 Hz."""
        corners = (("highpass", self.highpass), ("lowpass", self.lowpass))
        return ", ".join(f"{name} {corner:g} Hz" for name, corner in corners if corner is not None)

    def changed_motion(self, motion: BaseMotion) -> BaseMotion | None:
        """Return the filtered record; None for other motions, or if the corner exceeds the Nyquist frequency."""
        if not isinstance(motion, Record):
            return None
        if self.lowpass is not None and self.lowpass >= 0.5 / motion.step:
            return None
        return motion.filtered(highpass=self.highpass, lowpass=self.lowpass)


@dataclass(frozen=True, slots=True)
class DissipationScaled(_Scaled):
    """Multiply every dissipation of the model by `factor`: damping, and the loss at impacts, 1 − restitution."""

    of: ClassVar[PerturbationOf] = PerturbationOf.DISSIPATION

    @property
    def name(self) -> str:
        """Such as dissipation × 0.8."""
        return f"dissipation × {self.factor:g}"

    def changed_values(self, model: Model) -> dict[str, float] | None:
        """Return the changed dissipation parameters; None for a model without dissipation."""
        values = {}
        for name, quantity in dissipation_of(type(model)).items():
            value, lossless = getattr(model, name), quantity.lossless
            # Without a stated restitution the model uses that of the impact.
            value = getattr(model, f"impact_{name}", lossless) if value is None else value
            if value != lossless:
                values[name] = max(0.0, lossless - self.factor * (lossless - float(value)))
        return values or None


@dataclass(frozen=True, slots=True)
class SlendernessScaled(_Scaled):
    """Multiply the base radius, and with it the slenderness, by `factor`."""

    of: ClassVar[PerturbationOf] = PerturbationOf.GEOMETRY

    @property
    def name(self) -> str:
        """Such as slenderness +1 %."""
        return f"slenderness {_percent(self.factor)}"

    def changed_values(self, model: Model) -> dict[str, float]:
        """Return the changed slenderness."""
        return {"slenderness": self.factor * model.column.slenderness}


@dataclass(frozen=True, slots=True)
class SizeScaled(_Scaled):
    """Multiply all lengths of the column by `factor`."""

    of: ClassVar[PerturbationOf] = PerturbationOf.GEOMETRY

    @property
    def name(self) -> str:
        """Such as size +2 %."""
        return f"size {_percent(self.factor)}"

    def changed_values(self, model: Model) -> dict[str, float]:
        """Return the size."""
        del model
        return {"size": self.factor}


@dataclass(frozen=True, slots=True)
class ToleranceScaled(_Scaled):
    """Multiply the tolerances of the integration by `factor`."""

    of: ClassVar[PerturbationOf] = PerturbationOf.INTEGRATION

    @property
    def name(self) -> str:
        """Such as tolerance × 0.01."""
        return f"tolerance × {self.factor:g}"

    @property
    def tolerance_factor(self) -> float:
        """The factor."""
        return self.factor


@dataclass(frozen=True, slots=True)
class RestEnergy(Perturbation):
    """Set the energy below which a column comes to rest, `rest_energy` of `simulate`, to another `value`.

    At rest the residual motion is lost; with a lower threshold it continues, and later shaking meets another state. The
    threshold of a real floor is unknown, so no value is correct.
    """

    value: float
    of: ClassVar[PerturbationOf] = PerturbationOf.INTEGRATION

    def __post_init__(self) -> None:
        require_not_negative("value", self.value)

    @property
    def name(self) -> str:
        """Such as rest energy 1e-06."""
        return f"rest energy {self.value:g}"

    @property
    def rest_threshold(self) -> float:
        """The value."""
        return self.value


def _percent(factor: float) -> str:
    return f"{100.0 * (factor - 1.0):+.3g} %"


SMALL_PERTURBATIONS: tuple[Perturbation, ...] = (
    *(ScaledRecord(factor) for factor in (0.95, 0.98, 1.02, 1.05)),
    *(TurnedRecord(math.radians(angle)) for angle in (-3.0, 3.0)),
    Polarity(),
    *(ComponentScaled(axis, factor) for axis in ("x", "y") for factor in (0.95, 1.05)),
    Shifted(),
    Resampled(),
    Filtered(lowpass=20.0),
    Filtered(highpass=0.1),
    *(DissipationScaled(factor) for factor in (0.8, 1.25)),
    *(SlendernessScaled(factor) for factor in (0.99, 1.01)),
    *(SizeScaled(factor) for factor in (0.98, 1.02)),
    *(ToleranceScaled(factor) for factor in (0.01, 100.0)),
    *(RestEnergy(value) for value in (1e-6, 1e-7)),
)
"""The default changes of `robustness`."""
