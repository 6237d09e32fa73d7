"""Models at finite tilt: tilt equation, its trigonometry, and all that does not depend on the axial rotation.

Everything is divided by J0: m h² becomes κ, I_t becomes 1 − κ, I_a becomes κ i_a c², K becomes 1 + κc², weight times h
becomes 1; lengths are in units of h, accelerations of the base in g. u is the direction in which the tilt θ grows, n
horizontal across it, e3 the axis; d is the horizontal direction of the lean. ρ' = cos θ + c sin θ is the height of the
centre of mass, z' = c cos θ − sin θ its derivative by θ.
"""

import math
from collections.abc import Callable
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from stylobate.column import Column
from stylobate.models.model import Balance, Push, TiltVectorModel
from stylobate.models.vertical import departing_lean

Floats = npt.NDArray[np.float64]

# Keeps the direction of the lean finite at the vertical, far below any resolved tilt.
TINY = 1e-300

# Angular rate below which rolling resistance fades out [ω0]; rolling resistance cannot hold a column in place.
FADING = 1e-3

# Default tilt below which a minimum of the tilt counts as a passage of the vertical [c].
_PASSAGE = 0.01


def sine_over_angle(p: float) -> float:
    """Return sin θ/θ for p = θ², accurate to 2e-16 up to θ = π/2 and to 3e-15 at θ = 2.3."""
    series = 1.0 / 51090942171709440000.0
    series = -1.0 / 121645100408832000.0 + p * series
    series = 1.0 / 355687428096000.0 + p * series
    series = -1.0 / 1307674368000.0 + p * series
    series = 1.0 / 6227020800.0 + p * series
    series = -1.0 / 39916800.0 + p * series
    series = 1.0 / 362880.0 + p * series
    series = -1.0 / 5040.0 + p * series
    series = 1.0 / 120.0 + p * series
    series = -1.0 / 6.0 + p * series
    return 1.0 + p * series


def cosine(p: float) -> float:
    """Return cos θ for p = θ², accurate to 2e-16 up to θ = π/2."""
    series = 1.0 / 2432902008176640000.0
    series = -1.0 / 6402373705728000.0 + p * series
    series = 1.0 / 20922789888000.0 + p * series
    series = -1.0 / 87178291200.0 + p * series
    series = 1.0 / 479001600.0 + p * series
    series = -1.0 / 3628800.0 + p * series
    series = 1.0 / 40320.0 + p * series
    series = -1.0 / 720.0 + p * series
    series = 1.0 / 24.0 + p * series
    series = -0.5 + p * series
    return 1.0 + p * series


def tilt_acceleration(
    moment: float,
    rate: float,
    across: float,
    sine: float,
    cos: float,
    weight: float,
    c: float,
    kappa: float,
    resistance: float,
) -> tuple[float, float, float]:
    """Return θ̈, the normal force over m g, and the rolling resistance per unit of angular rate.

    K θ̈ = `moment` − δN θ̇/|ω_h| and N = 1 + a_z + κ(z'θ̈ − ρ'θ̇²), solved together.

    Parameters
    ----------
    moment
        Sum of all other moments about n through the contact point.
    rate, across
        Angular rates about the horizontal directions n, which is θ̇, and d.
    sine, cos
        Sine and cosine of the tilt.
    weight
        1 + a_z.
    c, kappa, resistance
        c, κ, and the lever arm δ/r of rolling resistance in units of the radius.
    """
    height, slope = cos + c * sine, c * cos - sine
    # M = −δN ω_h/√(|ω_h|² + ε²)
    lever = c * resistance / math.sqrt(rate * rate + across * across + FADING * FADING)
    carried = weight - kappa * height * rate * rate
    arm = lever * rate
    acceleration = (moment - arm * carried) / (1.0 + kappa * c * c + arm * kappa * slope)
    normal = carried + kappa * slope * acceleration
    return acceleration, normal, lever * normal


def planar_acceleration(
    tilt: float,
    rate: float,
    side: float,
    horizontal: float,
    vertical: float,
    c: float,
    eta: float,
    kappa: float,
    resistance: float,
) -> tuple[float, float, float]:
    """Return the tilt acceleration of planar motion, and N and the component of T along the lean, over m g.

    K θ̈ = −(1 + a_z) z' − ρ' a_d − ηθ̇ − δN θ̇/|θ̇|, θ being `side` (±1) times the tilt. η may depend on the state.
    """
    square = tilt * tilt
    sine, cos = side * tilt * sine_over_angle(square), cosine(square)
    height, slope = cos + c * sine, c * cos - sine
    falling, outward, weight = side * rate, side * horizontal, 1.0 + vertical
    moment = -weight * slope - height * outward - eta * falling
    acceleration, normal, _ = tilt_acceleration(moment, falling, 0.0, sine, cos, weight, c, kappa, resistance)
    swept = outward + kappa * (height * acceleration + slope * falling * falling)
    return side * acceleration, normal, swept


def no_return_tilt(peak_horizontal: float, minimum_vertical: float, c: float, *_: float) -> float:
    """Return the point of no return without spin, atan c + atan(sup|a_h|/(1 + inf a_z)) [rad].

    Beyond this tilt (1 + a_z)(sin θ − c cos θ) exceeds |a_h|(cos θ + c sin θ). The result is at most π/2, where the
    column lies, and infinite if 1 + inf a_z ≤ 0.
    """
    weight = 1.0 + minimum_vertical
    if weight <= 0.0:
        return math.inf
    return min(math.atan(c) + math.atan(peak_horizontal / weight), 0.5 * math.pi)


def planar_rates(
    tilt: float,
    rate: float,
    side: float,
    horizontal: float,
    vertical: float,
    c: float,
    eta: float,
    kappa: float,
    resistance: float,
    *_: float,
) -> tuple[float, float]:
    """Return the right-hand side of planar motion, which has no spin."""
    return rate, planar_acceleration(tilt, rate, side, horizontal, vertical, c, eta, kappa, resistance)[0]


def rest_energy(tilt: float, speed: float, vertical: float, c: float, _eta: float, kappa: float, *_: float) -> float:
    """Return ½K|α̇|² + c(1 + a_z)|α|, the energy above rest near the vertical without that of a spin."""
    return 0.5 * (1.0 + kappa * c * c) * speed * speed + c * (1.0 + vertical) * tilt


def uplift_terms(push: Push, c: float, eta: float, kappa: float, resistance: float) -> tuple[float, float, float]:
    """Return damping, moment of inertia K and gain of K θ̈ = F − damping θ̇ + gain θ, linear about uplift.

    The gain is 1 + a_z + c|a_h|; rolling resistance acts below its fading rate, with the normal force 1 + a_z + κcθ̈.
    """
    inertia, weight = 1.0 + kappa * c * c, (push.acceleration - push.excess) / c
    normal = weight + kappa * c * push.excess / inertia
    return eta + c * resistance / FADING * normal, inertia, weight + c * push.acceleration


def departure(
    push: Push, elapsed: float, c: float, eta: float, kappa: float, resistance: float, *_: float
) -> tuple[float, float, float, float]:
    """Return the state a short time after uplift."""
    damping, inertia, gain = uplift_terms(push, c, eta, kappa, resistance)
    return departing_lean(push, elapsed, damping, inertia, gain, 1.0)[:4]


def impact_map(
    x: float,
    y: float,
    vx: float,
    vy: float,
    _c: float,
    _eta: float,
    _kappa: float,
    _resistance: float,
    restitution: float,
    *_: float,
) -> tuple[float, float, float, float]:
    """Return the state after a passage of the vertical with loss: the tilt rate times the restitution."""
    return x, y, restitution * vx, restitution * vy


def potential(tilt: Floats, c: float) -> Floats:
    """Return the height of the centre of mass above its height at rest, over h: c sin θ − (1 − cos θ)."""
    return c * np.sin(tilt) - 2.0 * np.sin(0.5 * tilt) ** 2


def balance(column: Column) -> Balance:
    """Return the balance on the rim: at the tilt atan c, with the energy m g (R − h)."""
    height = column.rim_distance - column.mass_height
    return Balance(tilt=column.tipping_angle, energy=column.mass * column.gravity * height)


def loss_tilt(column: Column, restitution: float, passage_tilt: float | None) -> float:
    """Return the tilt below which a passage of the vertical loses energy [rad]; 0 without loss."""
    tilt = _PASSAGE * column.slenderness if passage_tilt is None else passage_tilt
    return (restitution < 1.0) * tilt


class FiniteTiltModel(TiltVectorModel):
    """A model at finite tilt whose `parameters` begin with c, η, κ, δ/r and e.

    A subclass with further couples in its plane states `planar_rates` again, its couples in the η that it passes to
    `planar_acceleration`.
    """

    __slots__ = ()

    planar_rates = staticmethod(planar_rates)
    rest_energy = staticmethod(rest_energy)
    departure: ClassVar[Callable[..., tuple[float, ...]]] = staticmethod(departure)
    impact_map: ClassVar[Callable[..., tuple[float, ...]]] = staticmethod(impact_map)

    @property
    def comes_to_rest(self) -> bool:
        """Whether there is damping, rolling resistance or loss."""
        _, eta, _, resistance, restitution, *_ = self.parameters
        return (eta > 0.0) | (resistance > 0.0) | (restitution < 1.0)
