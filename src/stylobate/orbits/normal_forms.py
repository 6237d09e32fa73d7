"""Normal-form coefficients of the map over one period: supercritical or subcritical loss of stability.

Yu. A. Kuznetsov, "Elements of Applied Bifurcation Theory", 3rd ed., sections 5.4 and 8.7: coefficients of maps on the
critical manifold. The first derivative of the map is exact; the second and third derivatives are its differences, with
relative errors of about 1e-8 and 1e-6.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from stylobate.engine.flow.integration import Status
from stylobate.engine.flow.periodic import PeriodicSystem

Floats = npt.NDArray[Any]
Complexes = npt.NDArray[Any]

# Steps of the differences, as fractions of the size of the state.
_SECOND, _THIRD = 2e-3, 5e-3


@dataclass(frozen=True, slots=True)
class PeriodMap:
    """The map of a state over some periods, about a fixed point, with states in units of c."""

    system: PeriodicSystem
    state: Floats
    periods: float
    sense: float = 1.0

    def derivative(self, offset: Floats) -> Floats:
        """Return the derivative at the fixed point plus `offset` [c]."""
        start = self.state + self.system.scale * offset
        flow = self.system.carry(start, 0.0, float(self.periods), peak_tilt=np.pi)
        if flow.status is not Status.DONE:
            return np.full((self.system.order, self.system.order), np.nan)
        return self.system.image(self.sense)[:, np.newaxis] * flow.by_start

    def _step(self, direction: Floats, share: float) -> float:
        size = np.abs(self.state).max() / self.system.scale
        return float(share * size / np.abs(direction).max())

    def second(self, direction: Floats) -> Floats:
        """Return the matrix B(direction, ·) by differences of five points."""
        step = self._step(direction, _SECOND)
        weights = {-2.0: 1.0, -1.0: -8.0, 1.0: 8.0, 2.0: -1.0}
        total = sum(weight * self.derivative(k * step * direction) for k, weight in weights.items())
        return np.asarray(total) / (12.0 * step)

    def third(self, direction: Floats) -> Floats:
        """Return the matrix C(direction, direction, ·) by differences of five points."""
        step = self._step(direction, _THIRD)
        weights = {-2.0: -1.0, -1.0: 16.0, 0.0: -30.0, 1.0: 16.0, 2.0: -1.0}
        total = sum(weight * self.derivative(k * step * direction) for k, weight in weights.items())
        return np.asarray(total) / (12.0 * step**2)

    def b(self, u: Complexes, v: Complexes) -> Complexes:
        """Return B(u, v)."""
        parts = np.zeros((len(u), len(u)), dtype=complex)
        for factor, direction in ((1.0, u.real), (1j, u.imag)):
            if np.any(direction):
                parts = parts + factor * self.second(direction)
        return np.asarray(parts @ v)

    def c(self, u: Complexes, v: Complexes) -> Complexes:
        """Return C(u, u, v)."""
        a, b = u.real, u.imag
        if not np.any(b):
            return np.asarray(self.third(a) @ v)
        # C(a + ib, a + ib) = C(a, a) − C(b, b) + 2i C(a, b), the last by polarisation
        both = 0.25 * (self.third(a + b) - self.third(a - b))
        return np.asarray((self.third(a) - self.third(b) + 2j * both) @ v)


def critical_vectors(matrix: Floats, multiplier: complex) -> tuple[Complexes, Complexes]:
    """Return the right and left eigenvectors q, p of the multiplier nearest to this one, ⟨q, q⟩ = ⟨p, q⟩ = 1."""
    values, vectors = np.linalg.eig(matrix)
    q = vectors[:, np.argmin(np.abs(values - multiplier))].astype(complex)
    left_values, left = np.linalg.eig(matrix.T)
    p = left[:, np.argmin(np.abs(left_values - np.conj(multiplier)))].astype(complex)
    # A vector that is real up to a phase becomes real.
    if abs(multiplier.imag) == 0.0:
        q, p = q.real.astype(complex), p.real.astype(complex)
    q = q / np.linalg.norm(q)
    return q, p / np.conj(np.vdot(p, q))


def neimark_sacker_coefficient(period_map: PeriodMap, multiplier: complex) -> float:
    """Return d, the first Lyapunov coefficient of the map: below zero a stable torus branches off (supercritical)."""
    matrix = period_map.derivative(np.zeros_like(period_map.state))
    q, p = critical_vectors(matrix, multiplier)
    unit = multiplier / abs(multiplier)
    one = np.eye(len(matrix))
    bar = q.conj()
    first = np.linalg.solve(one - matrix, period_map.b(q, bar))
    second = np.linalg.solve(unit**2 * one - matrix, period_map.b(q, q))
    total = period_map.c(q, bar) + 2.0 * period_map.b(q, first) + period_map.b(bar, second)
    return float(0.5 * (np.conj(unit) * np.vdot(p, total)).real)


def period_doubling_coefficient(period_map: PeriodMap) -> float:
    """Return the cubic coefficient of the flip: above zero a stable orbit of double period branches off."""
    matrix = period_map.derivative(np.zeros_like(period_map.state))
    q, p = critical_vectors(matrix, -1.0 + 0.0j)
    inner = np.linalg.solve(np.eye(len(matrix)) - matrix, period_map.b(q, q))
    total = period_map.c(q, q) / 6.0 + 0.5 * period_map.b(q, inner)
    return float(np.vdot(p, total).real)
