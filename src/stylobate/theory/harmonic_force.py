"""A force that is a constant and one harmonic: when it changes sign, and what it does to a mass until then."""

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass

_TURN = 2.0 * math.pi
# Instants nearer than this [rad] to the last one are the last one.
_INSTANT = 1e-14
# A zero a rounding ago counts as now.
_BEHIND = 1e-12
# Steps of a root: Newton's need some ten, halving a bracket to rounding fewer than these.
_STEPS = 120
_ROUNDING = 4.0 * 2.0**-52


@dataclass(frozen=True, slots=True)
class HarmonicForce:
    """The force constant + Re(swing exp iτ) on a unit mass.

    Parameters
    ----------
    constant
        Its mean.
    swing
        Complex amplitude of its harmonic part.
    """

    constant: float
    swing: complex

    @property
    def angle(self) -> float:
        """Phase of its harmonic part."""
        return math.atan2(self.swing.imag, self.swing.real)

    def at(self, tau: float) -> float:
        """Value at τ."""
        return self.constant + (self.swing * cmath.exp(1j * tau)).real

    def slope(self, tau: float) -> float:
        """Rate of change at τ."""
        return -(self.swing * cmath.exp(1j * tau)).imag

    def gain(self, tau: float, span: float) -> float:
        """Velocity it gives between τ and τ + span."""
        turned = self.swing * cmath.exp(1j * tau)
        half = math.sin(0.5 * span)
        return self.constant * span + turned.real * math.sin(span) - turned.imag * 2.0 * half * half

    def travel(self, tau: float, span: float) -> float:
        """Distance it gives between τ and τ + span, right to rounding of span² for short ones."""
        turned = self.swing * cmath.exp(1j * tau)
        half = math.sin(0.5 * span)
        return (
            0.5 * self.constant * span * span + turned.real * 2.0 * half * half - turned.imag * (span - math.sin(span))
        )

    def next_fall(self, tau: float) -> float:
        """Phase from τ to where it next falls below zero: 0 if it does so now, infinite if it never does."""
        size = abs(self.swing)
        if size <= abs(self.constant):
            return math.inf
        span = (math.acos(-self.constant / size) - self.angle - tau) % _TURN
        return 0.0 if span > _TURN - _BEHIND else span

    def zeros(self, tau: float, span: float) -> list[float]:
        """Phases from τ to its zeros, rising, between now and `span`, at most a period."""
        size = abs(self.swing)
        if size <= abs(self.constant):
            return []
        angle = math.acos(-self.constant / size)
        places = ((sign * angle - self.angle - tau) % _TURN for sign in (-1.0, 1.0))
        return sorted(place for place in places if _INSTANT < place < span)


def root(value: Callable[[float], float], slope: Callable[[float], float], low: float, high: float) -> float:
    """Find the zero of a function that is monotone between `low` and `high` and changes its sign.

    Newton's steps while they stay in the bracket, halving it otherwise; to rounding.
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
