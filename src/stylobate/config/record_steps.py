"""Descriptions of what is done to a record after it is read: the methods of `Record`, by their names and arguments."""

from collections.abc import Iterable
from typing import Annotated, Literal, cast

from pydantic import Field

from stylobate.base_motions import Record
from stylobate.config.description import Config


class _Step(Config):
    def apply(self, record: Record) -> Record:
        """Return the record after the method that has the name of this step."""
        values = self.model_dump(exclude_none=True)
        return cast("Record", getattr(record, values.pop("method"))(**values))


class ScaledStep(_Step):
    """Times `factor`, the vertical component times `vertical` where that is given."""

    method: Literal["scaled"] = "scaled"
    factor: float
    vertical: float | None = None


class ScaledToStep(_Step):
    """Scaled to a largest horizontal acceleration `peak` [m/s²]."""

    method: Literal["scaled_to"]
    peak: float


class RotatedStep(_Step):
    """Turned by `angle` [rad] about the vertical, anticlockwise seen from above."""

    method: Literal["rotated"] = "rotated"
    angle: float


class DelayedStep(_Step):
    """Begun `delay` [s] later."""

    method: Literal["delayed"] = "delayed"
    delay: float


class InvertedStep(_Step):
    """The opposite polarity of the horizontal components."""

    method: Literal["inverted"] = "inverted"


class TrimmedStep(_Step):
    """The samples from `begin` to `end` [s]."""

    method: Literal["trimmed"] = "trimmed"
    begin: float | None = None
    end: float | None = None


class PaddedStep(_Step):
    """Zeros `before` and `after` [s]."""

    method: Literal["padded"] = "padded"
    before: float = 0.0
    after: float = 0.0


class TailStep(_Step):
    """Rest of this `length` [s] at the end."""

    method: Literal["with_tail"] = "with_tail"
    length: float


class ResampledStep(_Step):
    """Another `step` [s]."""

    method: Literal["resampled"] = "resampled"
    step: float


class FilteredStep(_Step):
    """A Butterworth filter with corners in Hz."""

    method: Literal["filtered"] = "filtered"
    highpass: float | None = None
    lowpass: float | None = None
    order: int = 4
    causal: bool = False


class BaselineStep(_Step):
    """Less the derivative of a polynomial of this `degree` fitted to the velocity."""

    method: Literal["baseline_corrected"] = "baseline_corrected"
    degree: int = 1


AnyStep = (
    ScaledStep
    | ScaledToStep
    | RotatedStep
    | DelayedStep
    | InvertedStep
    | TrimmedStep
    | PaddedStep
    | TailStep
    | ResampledStep
    | FilteredStep
    | BaselineStep
)

RecordStep = Annotated[AnyStep, Field(discriminator="method")]


def processed(record: Record, steps: Iterable[AnyStep]) -> Record:
    """Return the record after these steps, in their order."""
    for step in steps:
        record = step.apply(record)
    return record
