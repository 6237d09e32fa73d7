"""Describe the processing of a record: methods of `Record`, by their names and arguments."""

from collections.abc import Iterable
from typing import Annotated, Literal, cast

from pydantic import Field

from stylobate.base_motions import Record
from stylobate.config.description import Config, Hertz, MetresPerSquareSecond, Radians, Seconds


class _Step(Config):
    def apply(self, record: Record) -> Record:
        """Apply the method of `Record` with the name of this step."""
        values = self.model_dump(exclude_none=True)
        return cast("Record", getattr(record, values.pop("method"))(**values))


class ScaledStep(_Step):
    """Scale by `factor`; the vertical component by `vertical`, if given."""

    method: Literal["scaled"] = "scaled"
    factor: float
    vertical: float | None = None


class ScaledToStep(_Step):
    """Scale to the peak horizontal acceleration `peak` [m/s²]."""

    method: Literal["scaled_to"]
    peak: MetresPerSquareSecond


class RotatedStep(_Step):
    """Rotate by `angle` [rad] about the vertical, anticlockwise seen from above."""

    method: Literal["rotated"] = "rotated"
    angle: Radians


class DelayedStep(_Step):
    """Delay by `delay` [s]."""

    method: Literal["delayed"] = "delayed"
    delay: Seconds


class InvertedStep(_Step):
    """Reverse the horizontal components."""

    method: Literal["inverted"] = "inverted"


class TrimmedStep(_Step):
    """Keep the samples from `begin` to `end` [s]."""

    method: Literal["trimmed"] = "trimmed"
    begin: Seconds | None = None
    end: Seconds | None = None


class PaddedStep(_Step):
    """Add zeros `before` and `after` [s]."""

    method: Literal["padded"] = "padded"
    before: Seconds = 0.0
    after: Seconds = 0.0


class TailStep(_Step):
    """Add a tail of zeros of this `length` [s]."""

    method: Literal["with_tail"] = "with_tail"
    length: Seconds


class ResampledStep(_Step):
    """Resample to another time `step` [s]."""

    method: Literal["resampled"] = "resampled"
    step: Seconds


class FilteredStep(_Step):
    """Apply a Butterworth filter with corners `highpass` and `lowpass` [Hz]."""

    method: Literal["filtered"] = "filtered"
    highpass: Hertz | None = None
    lowpass: Hertz | None = None
    order: int = 4
    causal: bool = False


class BaselineStep(_Step):
    """Subtract the derivative of a polynomial of this `degree` fitted to the velocity."""

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
    """Apply these steps to the record in order."""
    for step in steps:
        record = step.apply(record)
    return record
