"""Base motions as sums of harmonic terms, with parameters that vary between runs."""

import cmath
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from stylobate.base_motions import BaseMotion, Delayed, Harmonic, Rotated, Scaled, Sum

Floats = npt.NDArray[np.float64]

_COPIES = (Scaled, Rotated, Delayed)


@dataclass(frozen=True, slots=True)
class Term:
    """Acceleration Re(amplitude e^{i(ω(t − shift) + start_phase)}) after `onset`, with a rise over `ramp` from `shift`.

    Parameters
    ----------
    angular_frequency
        ω [rad/s].
    amplitude
        Complex amplitudes along x, y, z [m/s²].
    start_phase
        [rad].
    shift, onset, ramp
        [s].
    """

    angular_frequency: float
    amplitude: tuple[complex, complex, complex]
    start_phase: float
    shift: float
    onset: float
    ramp: float


def terms_of(motion: BaseMotion) -> tuple[Term, ...] | None:
    """Return the harmonic terms of `motion`, or None if it is not a sum of harmonic motions."""
    if type(motion) is Harmonic:
        amplitudes = tuple(cmath.rect(a, phase) for a, phase in zip(motion.amplitude, motion.phase, strict=True))
        x, y, z = amplitudes
        return (Term(motion.angular_frequency, (x, y, z), motion.start_phase, 0.0, -math.inf, motion.ramp),)
    if type(motion) is Sum:
        parts = [terms_of(part) for part in motion.motions]
        return None if None in parts else tuple(term for part in parts for term in part or ())
    if not isinstance(motion, _COPIES) or type(motion) not in _COPIES:  # a subclass can differ
        return None
    inner = terms_of(motion.motion)
    return None if inner is None else tuple(_transformed(motion, term) for term in inner)


def _transformed(motion: Scaled | Rotated | Delayed, term: Term) -> Term:
    if isinstance(motion, Delayed):
        begins = motion.delay if motion.delay > 0.0 else -math.inf
        return replace(term, shift=term.shift + motion.delay, onset=max(begins, term.onset + motion.delay))
    return replace(term, amplitude=motion.changed(*term.amplitude))


@dataclass(frozen=True, slots=True)
class Terms:
    """Terms of the motions of n runs: arrays of shape (n, terms), amplitudes (n, terms, 3), in SI units."""

    angular_frequency: Floats
    amplitude: npt.NDArray[np.complex128]
    start_phase: Floats
    shift: Floats
    onset: Floats
    ramp: Floats

    @classmethod
    def of(
        cls,
        terms: Sequence[tuple[Term, ...]],
        which: npt.NDArray[np.intp],
        values: Mapping[str, Floats],
        base_acceleration: Floats,
    ) -> "Terms":
        """Return the terms of each run, with the parameters of `values` changed.

        Parameters
        ----------
        terms
            Terms of each of some motions, all of the same number.
        which
            Index of the motion of each run, shape (n,).
        values
            Parameters that change, each of shape (n,).
        base_acceleration
            Peak horizontal acceleration of each run before the change [m/s²].
        """
        shape = (len(terms), len(terms[0]))

        def of_runs(get: Callable[[Term], float]) -> Floats:
            numbers = [get(term) for motion in terms for term in motion]
            return np.array(numbers, dtype=float).reshape(shape)[which]

        amplitudes = [term.amplitude for motion in terms for term in motion]
        made = cls(
            of_runs(lambda term: term.angular_frequency),
            np.array(amplitudes, dtype=complex).reshape(*shape, 3)[which],
            of_runs(lambda term: term.start_phase),
            of_runs(lambda term: term.shift),
            of_runs(lambda term: term.onset),
            of_runs(lambda term: term.ramp),
        )
        return made._with(values, base_acceleration)

    def _with(self, values: Mapping[str, Floats], base_acceleration: Floats) -> "Terms":
        frequency, amplitude, start_phase = self.angular_frequency, self.amplitude, self.start_phase
        shift, onset = self.shift, self.onset
        if "angular_frequency" in values:
            frequency = np.broadcast_to(values["angular_frequency"][:, np.newaxis], frequency.shape)
        if "start_phase" in values:
            start_phase = np.broadcast_to(values["start_phase"][:, np.newaxis], frequency.shape)
        ramp = np.broadcast_to(values["ramp"][:, np.newaxis], frequency.shape) if "ramp" in values else self.ramp
        factor = factors(values, base_acceleration)
        if factor is not None:
            amplitude = amplitude * factor[:, np.newaxis, np.newaxis]
        if "rotation" in values:
            cos, sin = (part(values["rotation"])[:, np.newaxis] for part in (np.cos, np.sin))
            x, y, z = np.moveaxis(amplitude, -1, 0)
            amplitude = np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1)
        if "delay" in values:
            delay = values["delay"][:, np.newaxis]
            shift = shift + delay
            onset = np.maximum(np.where(delay > 0.0, delay, -np.inf), onset + delay)
        return Terms(frequency, amplitude, start_phase, shift, onset, ramp)

    @property
    def phase_at_start(self) -> Floats:
        """Phase of each term at t = 0 [rad], shape (n, terms)."""
        return self.start_phase - self.angular_frequency * self.shift

    def breaks(self) -> Floats:
        """Return the increasing times of non-smooth acceleration [s], shape (n, breaks), padded with inf."""
        ramped = np.where(self.ramp > 0.0, self.shift + self.ramp, np.inf)
        times = np.concatenate([self.onset, ramped], axis=1)
        times = np.sort(np.where(times > 0.0, times, np.inf), axis=1)
        return times[:, np.any(np.isfinite(times), axis=0)]

    def columns(self, time_scale: Floats, gravity: Floats, *, windowed: bool) -> Floats:
        """Return the columns of a kernel, those of `Wave` for each term."""
        scale = time_scale[:, np.newaxis]
        phase = np.angle(self.amplitude) + self.phase_at_start[..., np.newaxis]
        parts = [self.angular_frequency * scale / (2.0 * math.pi)]
        for axis in range(3):
            parts += [np.abs(self.amplitude[..., axis]) / gravity[:, np.newaxis], _turns(phase[..., axis])]
        if windowed:
            # The end of the rise is exactly the break at which the kernel begins the next leg.
            parts += [self.onset / scale, self.shift / scale, (self.shift + self.ramp) / scale]
        return np.stack(parts, axis=-1).reshape(len(scale), -1)


def factors(values: Mapping[str, Floats], base_acceleration: Floats) -> Floats | None:
    """Return the factor of the motion of each run from `acceleration` and `scale`, or None for 1."""
    factor = None
    if "acceleration" in values:
        factor = values["acceleration"] / base_acceleration
    if "scale" in values:
        factor = values["scale"] if factor is None else factor * values["scale"]
    return factor


def _turns(angle: Floats) -> Floats:
    turns = angle / (2.0 * math.pi)
    return turns - np.floor(turns + 0.5)
