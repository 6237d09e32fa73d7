"""Steady rolling in closed form as a known orbit, in the frame that turns with one circular component of the motion."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Self, TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate import theory
from stylobate.base_motions import BaseMotion, Harmonic
from stylobate.base_motions.harmonic import as_harmonic
from stylobate.engine.parameters import changed_model, split
from stylobate.errors import ParameterError, UnsupportedError
from stylobate.models import Model
from stylobate.models.model import RollingLaw, closed_form_of
from stylobate.orbits import PeriodicOrbit
from stylobate.orbits.finding import rolling_form_of
from stylobate.results import KnownOrbit
from stylobate.theory.averaging import circular_components

Vector = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class RollingFrame:
    """A frame that turns with the base: the azimuth of the lean is β = sense (ντ + ψ) + offset.

    Parameters
    ----------
    nu
        Dimensionless frequency ν.
    drive
        Amplitude a0 of the circular component that drives rolling in this sense [g].
    sense
        +1 anticlockwise, −1 clockwise.
    offset
        Azimuth of the frame at t = 0 [rad].
    time_scale
        Unit of dimensionless time, 1/ω0 [s].
    """

    nu: float
    drive: float
    sense: int
    offset: float
    time_scale: float

    @classmethod
    def of(cls, model: Model, motion: Harmonic, sense: int | None = None) -> Self:
        """Return the frame of `motion`; by default in the sense of its larger circular component.

        Raises
        ------
        ParameterError
            If the motion is not a horizontal harmonic motion, or the sense neither +1 nor −1.
        """
        if not isinstance(motion, Harmonic) or motion.amplitude[2] != 0.0:
            raise ParameterError(f"motion must be a horizontal Harmonic motion, got {motion!r}")
        if sense not in (None, 1, -1):
            raise ParameterError(f"sense must be +1 (anticlockwise) or -1 (clockwise), got {sense!r}")
        (a1, a2, _), (phi1, phi2, _) = motion.amplitude, motion.phase
        p, q = (complex(part) for part in circular_components(a1, a2, phi2 - phi1))
        turning = (1 if abs(p) >= abs(q) else -1) if sense is None else sense
        part = p if turning == 1 else q
        return cls(
            nu=motion.angular_frequency * model.time_scale,
            drive=abs(part) / model.column.gravity,
            sense=turning,
            # The components are given at the phase of axis 1.
            offset=math.atan2(part.imag, part.real) + turning * (motion.start_phase + phi1),
            time_scale=model.time_scale,
        )

    def azimuth(self, tau: float, psi: float) -> float:
        """Return β [rad] at dimensionless time τ for the phase ψ."""
        return self.sense * (self.nu * tau + psi) + self.offset

    def to_tilt(self, tilt: float, psi: float, tilt_rate: float, rolling_rate: float) -> tuple[Vector, Vector]:
        """Return tilt vector [rad] and rate [rad/s] at t = 0 of A, ψ, μ = Ȧ and ω (dimensionless)."""
        beta = self.azimuth(0.0, psi)
        x, y = math.cos(beta), math.sin(beta)
        radial, across = tilt_rate / self.time_scale, self.sense * rolling_rate * tilt / self.time_scale
        return (tilt * x, tilt * y), (radial * x - across * y, radial * y + across * x)

    def from_tilt(self, tilt: Vector, tilt_rate: Vector) -> tuple[float, float, float, float]:
        """Return (μ, ω, A, ψ) of a tilt vector [rad] and its rate [rad/s] at t = 0."""
        (x, y), (vx, vy) = tilt, tilt_rate
        size = math.hypot(x, y)
        if size == 0.0:
            raise ParameterError(f"tilt must differ from zero in the frame of rolling, got {tilt!r} rad")
        psi = self.sense * (math.atan2(y, x) - self.offset)
        mu = (x * vx + y * vy) / size * self.time_scale
        omega = self.sense * (x * vy - y * vx) / size**2 * self.time_scale
        return mu, omega, size, math.remainder(psi, 2.0 * math.pi)


Floats = npt.NDArray[np.float64]
Steady: TypeAlias = tuple[Floats, Floats, Floats, Floats]
"""Tilt [rad], phase [rad], spin [ω0], and the rate [ω0] at which the slowest disturbance grows; NaN where unstable."""

# A harmonic motion is circular if its smaller circular component is below this fraction of the larger one.
_CIRCULAR = 1e-12
# Numbers of a circular motion that may vary between runs.
_OF_CIRCLES = ("angular_frequency", "start_phase", "acceleration", "scale", "rotation", "delay")


def require_closed_form(model: Model, motion: BaseMotion, names: Sequence[str]) -> None:
    """Raise UnsupportedError unless steady rolling has a closed form while numbers of these `names` vary."""
    form = rolling_form_of(model)
    harmonic = as_harmonic(motion)
    remedy = "Leave out end_converged, or pass `orbits` to stylobate.studies.maps.basins."
    if form is None or form.requires is not None:
        raise UnsupportedError(
            f"end_converged: the model must state a closed form of steady rolling (got {model!r}). {remedy}"
        )
    if harmonic is None or harmonic.ramp or not _is_circular(harmonic):
        raise UnsupportedError(
            f"end_converged: the base motion must be circular, without ramp (got {motion!r}). {remedy}"
        )
    _, of_motion = split(model, dict.fromkeys(names, 0.0))
    unknown = [name for name in of_motion if name not in _OF_CIRCLES]
    if unknown:
        raise UnsupportedError(f"end_converged: {unknown[0]} must not vary (got it among {', '.join(names)}). {remedy}")


def known_rolling(model: Model, motion: BaseMotion, values: Mapping[str, Floats], count: int) -> KnownOrbit:
    """Compute stable steady rolling of each run of a sweep in closed form.

    Parameters
    ----------
    model, motion
        Model and base motion of all runs; see `require_closed_form`.
    values
        Numbers of column, model and motion that differ between the runs, by name, shape (n,).
    count
        Number n of runs, 1 or more.
    """
    of_model, of_motion = split(model, values)
    bodies = _Bodies.of(model, of_model)
    harmonic = as_harmonic(motion)
    assert harmonic is not None  # ensured by `require_closed_form`
    frame = RollingFrame.of(model, replace(harmonic, start_phase=0.0))
    scale = of_motion.get("scale", np.ones(1))
    drive = of_motion.get("acceleration", frame.drive * model.column.gravity) * np.abs(scale) / bodies.gravity
    nu = of_motion.get("angular_frequency", np.array(harmonic.angular_frequency)) * bodies.time_scale
    offset = frame.offset + of_motion.get("rotation", np.zeros(1)) + np.where(scale < 0.0, np.pi, 0.0)
    nu, drive, time_scale = np.broadcast_arrays(nu, drive, bodies.time_scale)  # numbers that do not vary have one value
    tilt, psi, spin, growth = _steady(bodies, nu, drive)
    azimuth = frame.sense * psi + offset
    vector = tilt[:, np.newaxis] * np.stack([np.cos(azimuth), np.sin(azimuth)], axis=-1)
    turning = (frame.sense * nu / time_scale)[:, np.newaxis]
    multiplier = np.exp(growth * 2.0 * np.pi / nu)
    return KnownOrbit(
        tilt=np.broadcast_to(vector, (count, 2)),
        tilt_rate=np.broadcast_to(turning * np.stack([-vector[:, 1], vector[:, 0]], axis=-1), (count, 2)),
        spin=np.broadcast_to(frame.sense * spin / time_scale, count),
        multiplier=np.broadcast_to(np.where((multiplier > 0.0) & (multiplier < 1.0), multiplier, np.nan), count),
        turns=float(frame.sense),
        mean_tilt=np.broadcast_to(np.where(tilt > 0.0, tilt, np.nan), count),
    )


def _is_circular(motion: Harmonic) -> bool:
    (a1, a2, a3), (phi1, phi2, _) = motion.amplitude, motion.phase
    sizes = sorted(abs(complex(part)) for part in circular_components(a1, a2, phi2 - phi1))
    return a3 == 0.0 and sizes[0] <= _CIRCULAR * sizes[1]


@dataclass(frozen=True, slots=True)
class _Bodies:
    """Numbers of the models of runs, shape (n,), or (1,) if all runs have the same model."""

    law: RollingLaw
    eta: Floats
    zeta: Floats
    slenderness: Floats
    inertia_ratio: Floats
    axial_ratio: Floats
    gravity: Floats
    time_scale: Floats

    @classmethod
    def of(cls, model: Model, values: Mapping[str, Floats]) -> "_Bodies":
        """Return the numbers of `model` with these `values`; each combination of values is built once."""
        rows = np.stack(list(values.values()), axis=-1) if values else np.zeros((1, 0))
        different, place = np.unique(rows, axis=0, return_inverse=True)
        models = [changed_model(model, dict(zip(values, row.tolist(), strict=True))) for row in different]
        forms = [closed_form_of(one) for one in models]
        form = closed_form_of(model)
        assert form is not None  # ensured by `require_closed_form`
        numbers = [
            (
                one.eta,
                one.zeta,
                body.slenderness,
                body.inertia_ratio,
                body.axial_ratio,
                body.gravity,
                changed.time_scale,
            )
            for one, changed in zip(forms, models, strict=True)
            if one is not None
            for body in (changed.column,)
        ]
        return cls(form.law, *np.array(numbers).reshape(-1, 7)[place.ravel()].T)


def _steady(bodies: _Bodies, nu: Floats, a0: Floats) -> Steady:
    """Return steady rolling of each run; of several stable branches, the branch with the smallest tilt."""
    c, eta, zeta = bodies.slenderness, bodies.eta, bodies.zeta
    shape = {"inertia_ratio": bodies.inertia_ratio, "axial_ratio": bodies.axial_ratio}
    if bodies.law is RollingLaw.SLENDER:
        upper = theory.steady_rolling(nu, a0, c=c, eta=eta).upper
        return _where_stable(upper.amplitude, upper.phase, np.zeros_like(nu), upper.stable, upper.eigenvalues)
    if bodies.law is RollingLaw.FREE_TWIST:
        free = theory.free_twist_rolling(nu, a0, c=c, eta=eta, zeta=zeta, **shape)
        return _where_stable(free.amplitude, free.phase, free.spin, free.stable, free.eigenvalues)
    if bodies.law is RollingLaw.WOBBLING:
        found = theory.wobbling_rolling(nu, a0, c=c, eta=eta, **shape)
    else:
        found = theory.full_rolling(nu, a0, c=c, eta=eta, zeta=zeta, **shape)
    runs, branch = np.arange(nu.size), np.argmax(found.stable, axis=-1)
    one = (runs, branch)
    return _where_stable(
        found.amplitude[one], found.phase[one], found.spin[one], found.stable[one], found.eigenvalues[one]
    )


def _where_stable(
    tilt: Floats, phase: Floats, spin: Floats, stable: npt.NDArray[np.bool_], eigenvalues: npt.NDArray[np.complex128]
) -> Steady:
    growth = np.max(eigenvalues.real, axis=-1)
    return tuple(np.where(stable, array, np.nan) for array in (tilt, phase, spin, growth))  # type: ignore[return-value]


def known_orbit_of(orbit: PeriodicOrbit, model: Model, motion: BaseMotion) -> KnownOrbit:
    """Convert a periodic orbit of `model` under `motion` to the form with which runs of a study are compared.

    Raises
    ------
    ParameterError
        If the orbit has another model or base motion, or is unstable, longer than one period or planar.
    """
    if not isinstance(orbit, PeriodicOrbit):
        raise ParameterError(f"orbits must be periodic orbits, as of stylobate.orbits.periodic_orbit (got {orbit!r})")
    if orbit.model != model or _without_phase(orbit.motion) != _without_phase(motion):
        raise ParameterError(f"orbits: each must be one of the model and base motion of the study (got {orbit!r})")
    modulus = float(np.abs(orbit.multipliers[0]))
    if orbit.planar or orbit.periods != 1 or not 0.0 < modulus < 1.0:
        raise ParameterError(
            f"orbits: each must be stable, of one period and not planar (got {orbit!r}). Leave it out."
        )
    start_phase = getattr(as_harmonic(orbit.motion), "start_phase", 0.0)
    until = -start_phase / (2.0 * math.pi) % 1.0
    state = orbit.system.carry(orbit.state, 0.0, until).end if until > 0.0 else orbit.state
    scale = model.time_scale
    x, y, vx, vy = (float(value) for value in model.tilt_of(*state, *model.parameters))
    return KnownOrbit(
        tilt=(x, y),
        tilt_rate=(vx / scale, vy / scale),
        spin=0.0 if model.spin_state is None else float(state[model.spin_state]) / scale,
        multiplier=modulus,
        turns=orbit.turns,
        mean_tilt=orbit.mean_tilt,
    )


def _without_phase(motion: BaseMotion) -> BaseMotion:
    """Return a harmonic motion with phase zero at t = 0; its orbits, sampled at phase zero, do not change."""
    return replace(motion, start_phase=0.0) if isinstance(motion, Harmonic) else motion
