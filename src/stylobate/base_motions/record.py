"""Ground-motion record: accelerations at equal steps with linear interpolation."""

import hashlib
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.base import ACCELERATION, VELOCITY, Components
from stylobate.base_motions.combined import BaseMotion
from stylobate.base_motions.oscillator import floor_motion
from stylobate.base_motions.signal_processing import (
    Floats,
    baseline_corrected,
    filtered,
    integrals,
    resampled,
    samples_within_limit,
)
from stylobate.cards import CardSection, Row
from stylobate.errors import (
    MOST_NUMBERS,
    ParameterError,
    as_numbers,
    require_finite,
    require_not_negative,
    require_positive,
)
from stylobate.files import file_of, sha256_of
from stylobate.text import four_digits, printable

if TYPE_CHECKING:
    import pandas as pd


AXES = ("x", "y", "z")
# Distance from a line, in ulp of the largest, at which horizontal accelerations count as on the line.
_ON_LINE_ULP = 8.0
# Distance from a knot, as a fraction of a step, at which a time counts as the knot.
_KNOT_SLACK = 1e-6


@dataclass(frozen=True, slots=True)
class RecordOrigin:
    """The files or the sample of a record, and the methods of `Record` applied to it.

    Parameters
    ----------
    reading
        Arguments of the reading as plain values: `path` or `sample`, `units`, `directions` and others.
    processing
        Name (`method`) and arguments of each method, in order.
    """

    reading: Mapping[str, Any]
    processing: tuple[Mapping[str, Any], ...] = ()

    @classmethod
    def of_files(cls, paths: Path | Iterable[Path], **arguments: Any) -> Self:
        """Create the origin of a record read from one file or from the files of one event.

        Parameters
        ----------
        paths
            The file or the files; a file in an archive by its path below that of the archive.
        **arguments
            Arguments of the reading as plain values; None for arguments not given.
        """
        one = isinstance(paths, Path)
        files = [paths] if isinstance(paths, Path) else list(paths)
        names = [str(path.absolute()) for path in files]
        digests = {str(one): sha256_of(one) for one in map(file_of, names)}
        given = {name: value for name, value in arguments.items() if value is not None}
        return cls({"path": names[0] if one else tuple(names), **given, "file_sha256": digests})

    def then(self, method: str, **arguments: Any) -> Self:
        """Append a method of `Record` and its arguments; None for an argument not given."""
        given = {name: value for name, value in arguments.items() if value is not None}
        return replace(self, processing=(*self.processing, {"method": method, **given}))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False, repr=False)
class Record(BaseMotion):
    """A ground-motion record: accelerations at equal time steps, linear between samples, zero outside them.

    Parameters
    ----------
    samples
        Accelerations [m/s²]: shape (n,) along x, or (n, 1), (n, 2), (n, 3) along x, y (horizontal) and z (up); at least
        two. Stored as (n, 3).
    step
        Time between samples [s].
    start
        Time of the first sample [s]; samples before t = 0 have no effect.
    name
        Name of the record.
    provenance
        Source and processing steps, one line each, in order.
    origin
        Instructions that reproduce the record; None if it was created from samples. Reading a file sets the origin, and
        each processing method extends it.

    Raises
    ------
    ParameterError
        If samples are missing or not finite, or the step is not positive.

    Notes
    -----
    Velocity and displacement are the exact integrals of the acceleration from rest. After the last sample the
    acceleration is zero: the base keeps its velocity, which has no effect on the column. If `residual_velocity` is
    large, use `baseline_corrected` or `filtered`.

    Examples
    --------
    >>> record = Record(samples=[0.0, 2.0, 0.0], step=0.5, name="triangle")
    >>> record.velocity([0.0, 0.5, 1.0, 9.0])[:, 0]
    array([0. , 0.5, 1. , 1. ])
    >>> record.scaled(2.0).provenance
    ('scaled by 2.0',)
    """

    ends: ClassVar[bool] = True

    samples: Floats
    step: float
    start: float = 0.0
    name: str = ""
    provenance: tuple[str, ...] = ()
    origin: RecordOrigin | None = None
    _velocity: Floats = field(init=False)
    _displacement: Floats = field(init=False)
    _slope: Floats = field(init=False)
    _largest: Floats = field(init=False)
    _lowest: Floats = field(init=False)
    _highest: Floats = field(init=False)

    def __post_init__(self) -> None:
        samples = _checked(self.samples)
        samples.flags.writeable = False
        object.__setattr__(self, "samples", samples)
        object.__setattr__(self, "step", require_positive("step", self.step, "s"))
        object.__setattr__(self, "start", require_finite("start", self.start, "s"))
        object.__setattr__(self, "name", printable(self.name))  # as a file of another program may state it
        object.__setattr__(self, "provenance", tuple(self.provenance))
        velocity, displacement = integrals(samples, self.step)
        object.__setattr__(self, "_velocity", velocity)
        object.__setattr__(self, "_displacement", displacement)
        object.__setattr__(self, "_slope", np.diff(samples, axis=0) / self.step)
        object.__setattr__(self, "_largest", _largest_from_each(np.hypot(samples[:, 0], samples[:, 1])))
        # the acceleration ends at zero, so zero is always among the later values
        object.__setattr__(self, "_lowest", -_largest_from_each(np.maximum(-samples[:, 2], 0.0)))
        object.__setattr__(self, "_highest", _largest_from_each(np.maximum(samples[:, 2], 0.0)))

    @classmethod
    def from_components(
        cls,
        *,
        x: npt.ArrayLike | None = None,
        y: npt.ArrayLike | None = None,
        z: npt.ArrayLike | None = None,
        step: float,
        **more: Any,
    ) -> Self:
        """Create a record from accelerations along x, y and z, shape (n,) each [m/s²]; missing components are zero.

        Raises
        ------
        ParameterError
            If none is given, or their lengths differ.
        """
        given = {
            name: np.asarray(as_numbers(name, values, "m/s²"), dtype=float)
            for name, values in zip(AXES, (x, y, z), strict=True)
            if values is not None
        }
        if not given or len({values.shape for values in given.values()}) > 1:
            shapes = {name: values.shape for name, values in given.items()}
            raise ParameterError(
                f"x, y and z must be arrays of one length, one of them at least, got the shapes {shapes}"
            )
        shape = next(iter(given.values())).shape
        samples = np.stack([given.get(name, np.zeros(shape)) for name in AXES], axis=-1)
        return cls(samples=samples, step=step, **more)

    @property
    def times(self) -> Floats:
        """Times of the samples, shape (n,) [s]."""
        return np.asarray(self.start + self.step * np.arange(len(self.samples)))

    @property
    def end(self) -> float:
        """Time of the last sample [s]."""
        return self.start + self.step * (len(self.samples) - 1)

    @property
    def axes(self) -> tuple[str, ...]:
        """Names of the axes with acceleration."""
        return tuple(name for name, moves in zip(AXES, np.any(self.samples != 0.0, axis=0), strict=True) if moves)

    @property
    def residual_velocity(self) -> Floats:
        """Velocity after the last sample along x, y and z, shape (3,) [m/s]."""
        return np.array(self._velocity[-1])

    @property
    def digest(self) -> str:
        """SHA-256 of samples, step and start, in hexadecimal digits."""
        numbers = np.array([self.step, self.start]).tobytes()
        return hashlib.sha256(self.samples.tobytes() + numbers).hexdigest()

    def to_dataframe(self) -> "pd.DataFrame":
        """Convert the record to a table in pandas: accelerations x, y, z [m/s²] over `time` [s]."""
        import pandas as pd

        table = pd.DataFrame(self.samples, columns=list(AXES), index=pd.Index(self.times, name="time"))
        table.attrs["units"] = {"time": "s", **dict.fromkeys(AXES, "m s-2")}
        return table

    def __eq__(self, other: object) -> bool:
        return self.digest == other.digest if isinstance(other, Record) else NotImplemented

    def __hash__(self) -> int:
        return hash(self.digest)

    def __repr__(self) -> str:
        peak, axes = float(np.abs(self.samples).max()), " ".join(self.axes) or "at rest"
        begun = f" from {self.start:g} s" if self.start else ""
        return (
            f"Record({self.name!r}, {len(self.samples)} samples every {self.step:g} s{begun}, {axes}, "
            f"peak {peak:.4g} m/s², {self.digest[:12]})"
        )

    def _sections(self, *, derived: bool = True) -> list[CardSection]:
        """Return the rows of the card: the samples, the peak of each axis, and the processing steps."""
        del derived
        peaks = dict(zip(AXES, np.abs(self.samples).max(axis=0), strict=True))
        rows = [
            Row("name", self.name),
            Row("samples", f"{len(self.samples)} every {four_digits(self.step)} s"),
            Row("time", f"{four_digits(self.start)} to {four_digits(self.end)} s"),
            *(Row(f"peak along {axis}", f"{four_digits(peaks[axis])} m/s²") for axis in self.axes),
            Row("digest", self.digest[:12], meaning="SHA-256 of samples, step and start"),
        ]
        steps = [Row(str(number), step) for number, step in enumerate(self.provenance, 1)]
        return [CardSection("", rows), CardSection("source and processing", steps)]

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Compute the displacement (`order` 0), velocity (1) or acceleration (2), exact for linear interpolation."""
        t = np.asarray(time, dtype=float)
        length = self.step * (len(self.samples) - 1)
        since = np.minimum(np.maximum(t - self.start, 0.0), length)
        knot = np.minimum((since / self.step).astype(int), len(self.samples) - 2)
        s = (since - self.step * knot)[..., np.newaxis]
        a, slope = np.take(self.samples, knot, axis=0), np.take(self._slope, knot, axis=0)
        if order == ACCELERATION:
            moving = (t >= self.start) & (t <= self.end)
            values = np.where(moving[..., np.newaxis], a + slope * s, 0.0)
        elif order == VELOCITY:
            values = np.take(self._velocity, knot, axis=0) + s * (a + slope * s / 2.0)
        else:
            velocity, displacement = np.take(self._velocity, knot, axis=0), np.take(self._displacement, knot, axis=0)
            values = displacement + s * (velocity + s * (a / 2.0 + slope * s / 6.0))
            values = values + self._velocity[-1] * np.maximum(t - self.start - length, 0.0)[..., np.newaxis]
        return values[..., 0], values[..., 1], values[..., 2]

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Compute sup |a_h| from the time `since` [s] on, exactly [m/s²]: |a_h| is convex on a step."""
        if since > self.end:
            return 0.0
        x, y, _ = self.derivative(since, ACCELERATION)
        return max(math.hypot(x, y), float(self._largest[self._knot_after(since)]))

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Compute inf a_z and sup a_z from the time `since` [s] on, exactly [m/s²]; the acceleration ends at zero."""
        if since > self.end:
            return 0.0, 0.0
        knot, now = self._knot_after(since), float(self.derivative(since, ACCELERATION)[2])
        return min(now, float(self._lowest[knot])), max(now, float(self._highest[knot]))

    def _knot_after(self, time: float) -> int:
        return min(max(0, math.ceil((time - self.start) / self.step)), len(self.samples) - 1)

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return one horizontal sample if all lie on one line, else two independent samples; none if all are zero."""
        x, y = self.samples[:, 0], self.samples[:, 1]
        longest = int(np.argmax(np.hypot(x, y)))
        size = float(np.hypot(x[longest], y[longest]))
        if size == 0.0:
            return ()
        first = (float(x[longest]), float(y[longest]))
        aside = np.abs(first[0] * y - first[1] * x)
        other = int(np.argmax(aside))
        if aside[other] <= _ON_LINE_ULP * np.finfo(float).eps * size**2:
            return (first,)
        return first, (float(x[other]), float(y[other]))

    @property
    def duration(self) -> float:
        """Time of the last sample [s], 0 if it lies before t = 0."""
        return max(0.0, self.end)

    @property
    def highest_frequency(self) -> float:
        """2/step [rad/s]: then |ȧ| ≤ ω sup |a|, as in a harmonic motion; half a period is longer than a step."""
        return 2.0 / self.step if np.any(self.samples) else 0.0

    @property
    def mean_frequency(self) -> float:
        """Ratio of root mean squares of ȧ and a over all components [rad/s]; a crosses zero at this rate over π.

        S. O. Rice, "Mathematical analysis of random noise", Bell Syst. Tech. J. 23 (1944).
        """
        left, right = self.samples[:-1], self.samples[1:]
        square = np.sum(left * left + left * right + right * right) / 3.0
        return float(np.sqrt(np.sum((right - left) ** 2) / square) / self.step) if square > 0.0 else 0.0

    @property
    def degree(self) -> int:
        """1: linear between the samples."""
        return 1

    @property
    def breaks(self) -> tuple[float, ...]:
        """Times of the samples with a change of slope or a jump from or to the zero acceleration outside [s]."""
        slopes = np.diff(self.samples, axis=0, prepend=self.samples[:1], append=self.samples[-1:])
        bent = np.any(np.diff(slopes, axis=0) != 0.0, axis=1)
        bent[[0, -1]] |= np.any(self.samples[[0, -1]] != 0.0, axis=1)
        return tuple(self.times[bent].tolist())

    # A scaled, rotated or delayed record remains a record, which can be filtered and measured.

    def scaled(self, factor: float, *, vertical: float | None = None) -> "Record":  # type: ignore[override]
        """Scale this record by `factor`; the vertical component by `vertical`, if given."""
        factor = require_finite("factor", factor)
        vertical = None if vertical is None else require_finite("vertical", vertical)
        origin = self._then("scaled", factor=factor, vertical=vertical)
        vertical = factor if vertical is None else vertical
        note = f"scaled by {factor!r}" + (f", vertical by {vertical!r}" if vertical != factor else "")
        return self.changed(note, samples=self.samples * [factor, factor, vertical], origin=origin)

    def scaled_to(self, peak: float) -> "Record":
        """Scale all components of this record by one factor, so that sup |a_h| = `peak` [m/s²].

        Raises
        ------
        ParameterError
            If the record has no horizontal acceleration, or the peak is not positive.
        """
        largest = float(self._largest[0])
        if largest == 0.0:
            raise ParameterError("a record to scale must have a horizontal acceleration, got none")
        return self.scaled(require_positive("peak", peak, "m/s²") / largest)

    def rotated(self, angle: float) -> "Record":  # type: ignore[override]
        """Rotate this record by `angle` [rad] about the vertical, anticlockwise seen from above."""
        angle = require_finite("angle", angle, "rad")
        x, y, z = self.samples.T
        cos, sin = math.cos(angle), math.sin(angle)
        samples = np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1)
        return self.changed(f"turned by {angle!r} rad", samples=samples, origin=self._then("rotated", angle=angle))

    def delayed(self, delay: float) -> "Record":  # type: ignore[override]
        """Delay this record by `delay` [s]."""
        delay = require_finite("delay", delay, "s")
        origin = self._then("delayed", delay=delay)
        return self.changed(f"delayed by {delay!r} s", start=self.start + delay, origin=origin)

    def inverted(self) -> "Record":
        """Reverse the horizontal components of this record; the vertical component stays."""
        samples = self.samples * [-1.0, -1.0, 1.0]
        return self.changed("polarity reversed", samples=samples, origin=self._then("inverted"))

    def trimmed(self, begin: float | None = None, end: float | None = None) -> "Record":
        """Keep the samples from time `begin` to `end` [s]; the first sample is at `start`.

        Raises
        ------
        ParameterError
            If fewer than two samples lie between.
        """
        begin = None if begin is None else require_finite("begin", begin, "s")
        end = None if end is None else require_finite("end", end, "s")
        origin = self._then("trimmed", begin=begin, end=end)
        begin, end = self.start if begin is None else begin, self.end if end is None else end
        slack = _KNOT_SLACK * self.step
        kept = (self.times >= begin - slack) & (self.times <= end + slack)
        if np.count_nonzero(kept) < 2:  # noqa: PLR2004  a step has two ends
            raise ParameterError(f"begin and end must leave two samples of {self!r}, got {begin!r} s and {end!r} s")
        return self.changed(f"trimmed to {begin!r} s … {end!r} s", samples=self.samples[kept], origin=origin)

    def padded(self, *, before: float = 0.0, after: float = 0.0) -> "Record":
        """Add `before` and `after` [s] of zeros to this record, rounded up to whole steps."""
        before, after = require_not_negative("before", before, "s"), require_not_negative("after", after, "s")
        counts = [self._steps("before", before), self._steps("after", after)]
        samples = np.pad(self.samples, (counts, (0, 0)))
        note = f"padded with {counts[0]} zeros before and {counts[1]} after"
        return self.changed(note, samples=samples, origin=self._then("padded", before=before, after=after))

    def with_tail(self, length: float) -> "Record":
        """Append `length` [s] of zeros: a free-vibration tail in which the column may overturn or come to rest.

        Run to the `duration` of the result: survival is known after the tail, not at the last original sample.
        """
        length = require_not_negative("length", length, "s")
        count = self._steps("length", length)
        samples = np.pad(self.samples, ((0, count), (0, 0)))
        return self.changed(f"tail of {count} zeros", samples=samples, origin=self._then("with_tail", length=length))

    def _steps(self, name: str, length: float) -> int:
        count = length / self.step - _KNOT_SLACK
        return samples_within_limit(name, f"{length!r} s", count, f"Use at most {MOST_NUMBERS.number * self.step:g} s")

    def resampled(self, step: float) -> "Record":
        """Resample this record to another `step` [s], band-limited (see `signal_processing`)."""
        step = require_positive("step", step, "s")
        samples, note = resampled(self.samples, self.step, step)
        if not note:
            return self
        return self.changed(note, samples=samples, step=step, origin=self._then("resampled", step=step))

    def filtered(
        self, *, highpass: float | None = None, lowpass: float | None = None, order: int = 4, causal: bool = False
    ) -> "Record":
        """Filter this record by a Butterworth filter with corners in Hz (see `signal_processing`)."""
        highpass = None if highpass is None else require_positive("highpass", highpass, "Hz")
        lowpass = None if lowpass is None else require_positive("lowpass", lowpass, "Hz")
        arguments: dict[str, Any] = {"highpass": highpass, "lowpass": lowpass, "order": order, "causal": causal}
        samples, note = filtered(self.samples, self.step, **arguments)
        return self.changed(note, samples=samples, origin=self._then("filtered", **arguments))

    def floor_motion(self, *, period: float, damping: float = 0.05) -> "Record":
        """Compute the motion of a floor or a pedestal: that of an oscillator on this ground (see `oscillator`).

        The horizontal components pass through it, the vertical component stays. The result goes on until the floor is
        at rest.
        """
        flat, step, note = floor_motion(self.samples[:, :2], self.step, period, damping)
        fine, coarse = np.arange(len(flat)) * step, np.arange(len(self.samples)) * self.step
        vertical = np.interp(fine, coarse, self.samples[:, 2], right=0.0)
        samples = np.column_stack([flat, vertical])
        origin = self._then("floor_motion", period=period, damping=damping)
        return self.changed(note, samples=samples, step=step, origin=origin)

    def baseline_corrected(self, degree: int = 1) -> "Record":
        """Subtract the derivative of a polynomial fitted to the velocity (see `signal_processing`)."""
        samples, note = baseline_corrected(self.samples, self.step, degree)
        return self.changed(note, samples=samples, origin=self._then("baseline_corrected", degree=degree))

    def changed(self, note: str, *, origin: RecordOrigin | None = None, **changes: Any) -> "Record":
        """Replace fields of this record and add a `note` to its provenance; without `origin` the result has none."""
        return replace(self, provenance=(*self.provenance, note), origin=origin, **changes)

    def _then(self, method: str, **arguments: Any) -> RecordOrigin | None:
        """Return the origin of this record extended by one method."""
        return None if self.origin is None else self.origin.then(method, **arguments)


def _largest_from_each(values: Floats) -> Floats:
    """Return the maximum of each value and all later values."""
    return np.asarray(np.maximum.accumulate(values[::-1])[::-1])


def _checked(samples: npt.ArrayLike) -> Floats:
    samples = as_numbers("samples", samples, "m/s²")
    try:
        array = np.array(samples, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.ndim == 1:
        array = array[:, np.newaxis]
    if array.ndim != 2 or len(array) < 2 or not 1 <= array.shape[1] <= len(AXES):  # noqa: PLR2004
        raise ParameterError(
            f"samples must be numbers of shape (n,) or (n, 1 to 3) with n of at least 2, got {np.shape(samples)}"
        )
    if not np.all(np.isfinite(array)):
        row = int(np.argmax(~np.all(np.isfinite(array), axis=1)))
        raise ParameterError(f"samples must be finite, got {array[row].tolist()} at index {row}")
    return np.ascontiguousarray(np.pad(array, ((0, 0), (0, len(AXES) - array.shape[1]))))
