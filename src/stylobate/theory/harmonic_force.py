"""Constant force plus one harmonic: sign changes, and velocity and distance that it gives a unit mass."""

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass

_TURN = 2.0 * math.pi
# Instants closer than this [rad] to the previous one count as the same.
_INSTANT = 1e-14
# A zero this close before τ, by rounding, counts as a zero at τ.
_BEHIND = 1e-12
# Limit of the steps to a root: Newton needs about ten, bisection to rounding fewer than this limit.
_STEPS = 120
_ROUNDING = 4.0 * 2.0**-52


@dataclass(frozen=True, slots=True)
class HarmonicForce:
    """The force constant + Re(swing exp iτ) on a unit mass.

    Parameters
    ----------
    constant
        Mean of the force.
    swing
        Complex amplitude of the harmonic part.
    """

    constant: float
    swing: complex

    @property
    def angle(self) -> float:
        """Phase of the harmonic part."""
        return math.atan2(self.swing.imag, self.swing.real)

    def at(self, tau: float) -> float:
        """Evaluate the force at τ."""
        return self.constant + (self.swing * cmath.exp(1j * tau)).real

    def slope(self, tau: float) -> float:
        """Evaluate the rate of change at τ."""
        return -(self.swing * cmath.exp(1j * tau)).imag

    def gain(self, tau: float, span: float) -> float:
        """Compute the velocity gained between τ and τ + span."""
        turned = self.swing * cmath.exp(1j * tau)
        half = math.sin(0.5 * span)
        return self.constant * span + turned.real * math.sin(span) - turned.imag * 2.0 * half * half

    def travel(self, tau: float, span: float) -> float:
        """Compute the distance gained between τ and τ + span, accurate to rounding of span² for short spans."""
        turned = self.swing * cmath.exp(1j * tau)
        half = math.sin(0.5 * span)
        return (
            0.5 * self.constant * span * span + turned.real * 2.0 * half * half - turned.imag * (span - math.sin(span))
        )

    def next_fall(self, tau: float) -> float:
        """Compute the phase from τ to the next fall below zero: 0 if it falls now, infinite if it never falls."""
        size = abs(self.swing)
        if size <= abs(self.constant):
            return math.inf
        span = (math.acos(-self.constant / size) - self.angle - tau) % _TURN
        return 0.0 if span > _TURN - _BEHIND else span

    def zeros(self, tau: float, span: float) -> list[float]:
        """Compute the phases from τ to the zeros within `span`, at most a period, in increasing order."""
        size = abs(self.swing)
        if size <= abs(self.constant):
            return []
        angle = math.acos(-self.constant / size)
        places = ((sign * angle - self.angle - tau) % _TURN for sign in (-1.0, 1.0))
        return sorted(place for place in places if _INSTANT < place < span)


def root(value: Callable[[float], float], slope: Callable[[float], float], low: float, high: float) -> float:
    """Find the zero of a function that is monotone between `low` and `high` and changes its sign.

    Newton steps while they stay in the bracket, bisection otherwise; accurate to rounding.
    """
    rises = value(high) > 0.0
    x = 0.5 * (low + high)
    for _ in range(_STEPS):
        y, rate = value(x), slope(x)
        if (y > 0.0) == rises:
            high = x
        else:
            low = x
        step = y / rate if rate != 0.0 else math.inf
        newer = x - step
        if not low < newer < high:
            newer = 0.5 * (low + high)
        if abs(newer - x) <= _ROUNDING * abs(newer):
            return newer
        x = newer
    return x
