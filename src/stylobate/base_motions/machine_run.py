"""Run of a vibratory machine: run-up from rest through its resonance, steady vibration, and run-down to rest."""

import itertools
import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Annotated, ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.base_motions.base import (
    ACCELERATION,
    DISPLACEMENT,
    Components,
    Direction,
    Frequency,
    RiseOfPath,
    StartPhase,
    Stroke,
    along_azimuth,
)
from stylobate.base_motions.combined import BaseMotion
from stylobate.errors import ParameterError
from stylobate.quantities import Quantity

Floats = npt.NDArray[np.float64]

RunUp = Annotated[float, Quantity(unit="s", text="time of the run-up", gt=0.0)]
RunDown = Annotated[float, Quantity(unit="s", text="time of the run-down", gt=0.0)]
Steady = Annotated[float, Quantity(unit="s", text="time of steady vibration", ge=0.0)]
Resonance = Annotated[float, Quantity(unit="Hz", text="resonance of the machine on its springs; 0 for none", ge=0.0)]
ResonanceDamping = Annotated[float, Quantity(text="damping ratio of the machine", ge=0.005, le=0.9)]

# The free oscillation after the run-down ends when its amplitude is this share of half the stroke.
_STILL = 1e-4
# Nodes of the quadrature over at most half a cycle: its error is below 1e-13 of the largest force.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(10)
# Samples of the acceleration per cycle, and the margin of its bound over their maximum, 1/cos(π/40) - 1 at least.
_SAMPLES, _MARGIN = 40, 1.005
_MOST_CYCLES = 100_000.0
# Times that are evaluated at once.
_CHUNK = 20_000


@dataclass(frozen=True, slots=True, kw_only=True)
class MachineRun(BaseMotion):
    """A vibratory machine with an unbalance drive: run-up from rest, work at its frequency, run-down to rest.

    The path is a line, as of `Harmonic.stroke`. During run-up and run-down the frequency changes along half a cosine
    wave. The machine on its springs is driven by the inertia of its unbalance: its stroke grows where the frequency
    passes the resonance, less the faster it passes, and it oscillates freely afterwards.

    Parameters
    ----------
    stroke
        Stroke from peak to peak at the working frequency [m].
    frequency
        Working frequency [Hz].
    angle
        Angle of the line above the horizontal [rad].
    direction
        Azimuth towards which the line rises [rad].
    run_up, steady, run_down
        Durations of run-up, steady vibration and run-down [s].
    resonance
        Natural frequency f_n of the machine on its springs [Hz]. 0 keeps the stroke constant, as of a crank drive.
    resonance_damping
        Damping ratio ζ of this oscillation.
    start_phase
        Phase Φ of the unbalance at t = 0 [rad].

    Notes
    -----
    The displacement along the line is ½ stroke cos Φ of a crank drive. On springs it is the solution from rest of

        ẍ + 2ζω_n ẋ + ω_n² x = −s d²(cos Φ)/dt²,    s = ½ stroke |f_n² − f² + 2iζ f_n f|/f²,

    with the working frequency f and ω_n = 2πf_n: the steady stroke is `stroke`. It is integrated by quadrature of the
    convolution with the free oscillation, to a relative error of about 1e-12. The motion ends when the free oscillation
    after the run-down has an amplitude below 1e-4 of half the stroke.

    Raises
    ------
    ParameterError
        If a number is out of range, or the run has more than 100 000 cycles.

    Examples
    --------
    >>> run = MachineRun(stroke=0.001, frequency=50.0, angle=0.4, run_up=2.0, steady=1.0, run_down=4.0, resonance=8.0)
    >>> run.drive_frequency([0.0, 1.0, 2.5]).round(6).tolist()
    [0.0, 25.0, 50.0]
    >>> round(run.duration, 1)
    10.4
    """

    ends: ClassVar[bool] = True

    stroke: Stroke
    frequency: Frequency
    angle: RiseOfPath = 0.0
    direction: Direction = 0.0
    run_up: RunUp
    steady: Steady = 0.0
    run_down: RunDown
    resonance: Resonance = 0.0
    resonance_damping: ResonanceDamping = 0.05
    start_phase: StartPhase = 0.0

    def validate(self) -> None:
        """Raise ParameterError for a run of too many cycles."""
        cycles = (self.run_up + self.steady + self.run_down) * max(self.frequency, self.resonance)
        if cycles > _MOST_CYCLES:
            message = (
                f"steady: a run has at most {_MOST_CYCLES:.0f} cycles (got {self.steady!r} s, {cycles:.3g} cycles). "
                "Use Harmonic.stroke for long steady vibration."
            )
            raise ParameterError(message)

    def drive_frequency(self, time: npt.ArrayLike) -> Floats:
        """Compute the frequency of the drive at `time` [Hz]."""
        return self._turning(np.asarray(time, dtype=float))[1] / (2.0 * math.pi)

    def derivative(self, time: npt.ArrayLike, order: int) -> Components:
        """Return the displacement (`order` 0), velocity (1) or acceleration (2) along x, y and z."""
        along = self._along(np.asarray(time, dtype=float), order)
        level, up = math.cos(self.angle), math.sin(self.angle)
        return level * math.cos(self.direction) * along, level * math.sin(self.direction) * along, up * along

    def peak_horizontal(self, since: float = 0.0) -> float:
        """Return a bound of |a_h| from `since` on [m/s²]."""
        return abs(math.cos(self.angle)) * self._peak(since)

    def vertical_range(self, since: float = 0.0) -> tuple[float, float]:
        """Return bounds of a_z from `since` on [m/s²]."""
        largest = abs(math.sin(self.angle)) * self._peak(since)
        return -largest, largest

    def directions(self) -> tuple[tuple[float, float], ...]:
        """Return the peak acceleration along the line [m/s²]."""
        return along_azimuth(self.direction, self.peak_horizontal())

    @property
    def duration(self) -> float:
        """Time at which the machine stands still [s]."""
        return self._stops + (_free_oscillation(self).decay if self.resonance else 0.0)

    @property
    def highest_frequency(self) -> float:
        """The larger one of working frequency and resonance [rad/s]."""
        return 2.0 * math.pi * max(self.frequency, self.resonance)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Ends of run-up, steady vibration, run-down and free oscillation [s]."""
        return tuple(dict.fromkeys((self.run_up, self.run_up + self.steady, self._stops, self.duration)))

    @property
    def _stops(self) -> float:
        return self.run_up + self.steady + self.run_down

    def _turning(self, t: Floats) -> tuple[Floats, Floats, Floats]:
        """Return the phase Φ of the drive, Φ̇ and Φ̈."""
        full, up, down = 2.0 * math.pi * self.frequency, self.run_up, self.run_down
        works = up + self.steady
        rising, falling = np.clip(t, 0.0, up), np.clip(t - works, 0.0, down)
        a, b = math.pi * rising / up, math.pi * falling / down
        # Φ̇ = ½Ω(1 − cos a) up and ½Ω(1 + cos b) down.
        phase = 0.5 * full * (rising - up / math.pi * np.sin(a)) + full * np.clip(t - up, 0.0, self.steady)
        phase = phase + 0.5 * full * (falling + down / math.pi * np.sin(b)) + self.start_phase
        rate = np.where(t < works, 0.5 * full * (1.0 - np.cos(a)), 0.5 * full * (1.0 + np.cos(b)))
        change = 0.5 * full * math.pi * (np.sin(a) / up - np.sin(b) / down)
        return phase, rate, change

    def _unbalance(self, t: Floats, order: int) -> Floats:
        """Return cos Φ, or its first or second derivative [1/s, 1/s²]."""
        phase, rate, change = self._turning(t)
        if order == DISPLACEMENT:
            return np.cos(phase)
        if order == ACCELERATION:
            return np.asarray(-(rate**2) * np.cos(phase) - change * np.sin(phase))
        return np.asarray(-rate * np.sin(phase))

    def _along(self, t: Floats, order: int) -> Floats:
        """Return displacement, velocity or acceleration along the line; before and after the motion the base stands."""
        if self.resonance == 0.0:
            return 0.5 * self.stroke * self._unbalance(t, order)
        free = _free_oscillation(self)
        flat = np.ravel(t)
        along = np.concatenate(
            [self._on_springs(free, flat[first : first + _CHUNK], order) for first in range(0, flat.size, _CHUNK)]
            or [flat]
        )
        return np.where((flat > 0.0) & (flat < self.duration), along, 0.0).reshape(np.shape(t))

    def _on_springs(self, free: "_FreeOscillation", t: Floats, order: int) -> Floats:
        """Return x = Im J/ω_d or a derivative of it, with J̇ = λJ + force."""
        turned = free.at(self, np.clip(t, 0.0, None)) * free.pole**order
        along = turned.imag / free.pole.imag
        return np.asarray(along + self._force(t) if order == ACCELERATION else along)

    def _force(self, t: Floats) -> Floats:
        """Return the force of the unbalance per mass of the machine, with the stroke that it causes [m/s²]."""
        f, natural = self.frequency, self.resonance
        size = 0.5 * self.stroke * abs(natural**2 - f**2 + 2j * self.resonance_damping * natural * f) / f**2
        return -size * self._unbalance(t, ACCELERATION)

    def _peak(self, since: float) -> float:
        """Return a bound of the acceleration along the line from a time on [m/s²]."""
        if since >= self.duration:
            return 0.0
        later = _later_peaks(self)
        return float(later[int(max(since, 0.0) / self.duration * (later.size - 1))])


@dataclass(frozen=True, slots=True, eq=False)
class _FreeOscillation:
    """The response of the machine on its springs at the edges of short panels, from which it is continued.

    J = ∫ e^{λ(t−s)} force(s) ds with λ = ω_n (−ζ + i√(1−ζ²)).
    """

    pole: complex
    edges: Floats
    at_edges: npt.NDArray[np.complex128]
    decay: float
    """Time from the end of the run-down until the machine stands still [s]."""

    def at(self, machine: MachineRun, t: Floats) -> npt.NDArray[np.complex128]:
        """Return J at times from 0 on, by Gauss-Legendre quadrature from the edge before."""
        panel = np.clip(np.searchsorted(self.edges, t, side="right") - 1, 0, self.edges.size - 1)
        begun = self.edges[panel]
        forced = _quadrature(machine, self.pole, begun, np.minimum(t, self.edges[-1]), t)
        return np.asarray(np.exp(self.pole * (t - begun)) * self.at_edges[panel] + forced)


def _quadrature(
    machine: MachineRun, pole: complex, first: Floats, last: Floats, t: Floats
) -> npt.NDArray[np.complex128]:
    """Return ∫ e^{λ(t−s)} force(s) ds from `first` to `last` for each t."""
    half = 0.5 * (last - first)
    s = first[:, None] + half[:, None] * (1.0 + _NODES)
    return np.asarray(half * ((np.exp(pole * (t[:, None] - s)) * machine._force(s)) @ _WEIGHTS))  # noqa: SLF001


@lru_cache(maxsize=16)
def _free_oscillation(machine: MachineRun) -> _FreeOscillation:
    natural, zeta = 2.0 * math.pi * machine.resonance, machine.resonance_damping
    pole = natural * complex(-zeta, math.sqrt(1.0 - zeta**2))
    works = machine.run_up + machine.steady
    stages = np.array([0.0, machine.run_up, works, works + machine.run_down])
    fastest = 2.0 * max(machine.frequency, machine.resonance)
    parts = [
        np.linspace(first, last, 1 + math.ceil(fastest * (last - first)), endpoint=False)
        for first, last in itertools.pairwise(stages)
        if last > first
    ]
    edges = np.concatenate([*parts, stages[-1:]])
    added = _quadrature(machine, pole, edges[:-1], edges[1:], edges[1:])
    carried = np.exp(pole * np.diff(edges))
    found = np.zeros(edges.size, dtype=complex)
    for panel in range(added.size):
        found[panel + 1] = carried[panel] * found[panel] + added[panel]
    left = abs(found[-1]) / pole.imag / (0.5 * _STILL * machine.stroke)
    decay = math.log(left) / (zeta * natural) if left > 1.0 else 0.0
    return _FreeOscillation(pole=pole, edges=edges, at_edges=found, decay=decay)


@lru_cache(maxsize=16)
def _later_peaks(machine: MachineRun) -> Floats:
    """Return a bound of the acceleration from each of many times to the end [m/s²]: tables ask for it at each piece."""
    count = math.ceil(_SAMPLES * max(machine.frequency, machine.resonance) * machine.duration)
    sampled = np.abs(machine._along(np.linspace(0.0, machine.duration, count + 1), ACCELERATION))  # noqa: SLF001
    return np.asarray(_MARGIN * np.maximum.accumulate(sampled[::-1])[::-1])
