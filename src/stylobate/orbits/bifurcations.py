"""Bifurcations of a family: detected between two points by test functions, located, classified by normal forms.

Yu. A. Kuznetsov, "Elements of Applied Bifurcation Theory", 3rd ed., sections 5.4 and 8.7: coefficients of maps on the
critical manifold. The first derivative of the map is exact; the second and third derivatives are its differences, with
relative errors of about 1e-8 and 1e-6.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from itertools import combinations
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from stylobate.cards import CardSection, Row, card
from stylobate.engine.flow.integration import FlowStatus
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.equality import ByContent
from stylobate.errors import Named, ParameterError
from stylobate.orbits.arclength import Floats, Point, corrected
from stylobate.orbits.orbit import PeriodicOrbit, system_sections
from stylobate.orbits.shooting import least_are_rounding, shots, without_damping
from stylobate.parameter_quantities import quantity_of
from stylobate.text import four_digits, unit_in_text

Complexes = npt.NDArray[Any]


def fold(point: Point, direction: Floats) -> float:
    """Return the component of the tangent along the parameter: the family turns back at a zero."""
    return float(point.along(direction)[-1])


def branching(point: Point, direction: Floats) -> float:
    """Return the determinant of the equations with the tangent: another family crosses this family at a zero.

    The determinant is that of the map over the whole period, for any number of arcs.
    """
    order = point.chain.states.shape[1]
    unit = point.family.system.scale
    rows = np.column_stack(
        [point.map_derivative - np.eye(order), point.chain.map_sensitivity * point.family.span / unit]
    )
    # The tangent of the family at the first state.
    tangent = point.along(direction)
    first = np.append(tangent[:order], tangent[-1])
    return float(np.linalg.det(np.vstack([rows, first])))


def period_doubling(point: Point, _: Floats) -> float:
    """Return Π(μ + 1): at a zero an orbit of double length branches off; for a half orbit, one without its symmetry."""
    order = point.chain.states.shape[1]
    return float(np.linalg.det(point.map_derivative + np.eye(order)))


def neimark_sacker(point: Point, _: Floats) -> float:
    """Return Π(μ_i μ_j − 1) over pairs: zero if a complex pair is on the unit circle, or a real pair is reciprocal."""
    pairs = combinations(point.map_multipliers, 2)
    return float(np.prod([first * second - 1.0 for first, second in pairs]).real)


def complex_pairs(point: Point, _: Floats) -> float:
    """Return Π(|μ|² − 1) over complex pairs, zero if a pair is on the unit circle."""
    return float(np.prod([abs(one) ** 2 - 1.0 for one in _upper(point)]))


def _upper(point: Point) -> list[complex]:
    return [complex(one) for one in point.map_multipliers if one.imag > 0.0]


Condition = Callable[[Point, Floats], float]

CONDITIONS: dict[str, Condition] = {
    "fold": fold,
    "branch point": branching,
    "period doubling": period_doubling,
    "Neimark-Sacker": neimark_sacker,
}


def conditions_between(first: Point, second: Point) -> dict[str, Condition]:
    """Return the conditions whose signs show bifurcations between two consecutive points."""
    found = dict(CONDITIONS)
    ends = (first, second)
    if any(without_damping(point.multipliers) for point in ends):
        # Without damping 1/μ is a multiplier too: Π(μ_i μ_j − 1) is zero, and rounding decides its sign.
        del found["Neimark-Sacker"]
    elif any(least_are_rounding(point.multipliers) for point in ends):
        # Rounding also decides the sign for the largest and the smallest multiplier, but not for a complex pair.
        del found["Neimark-Sacker"]
        if len(_upper(first)) == len(_upper(second)) > 0:
            found["Neimark-Sacker"] = complex_pairs
    return found


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
        if flow.status is not FlowStatus.DONE:
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


# Accuracy of the location along the family, in its units; for the parameter, times the width of its bounds.
_LOCATED = 1e-13
# A multiplier within this distance of the unit circle is critical.
_CRITICAL = 1e-4


class BifurcationKind(Named, Enum):
    """Kind of a bifurcation."""

    FOLD = "fold"
    """Two orbits meet and vanish."""
    PITCHFORK = "pitchfork"
    """Two orbits without the symmetry branch off, symmetry-related to each other."""
    BRANCH_POINT = "branch point"
    """Another branch crosses this one."""
    PERIOD_DOUBLING = "period doubling"
    NEIMARK_SACKER = "Neimark-Sacker"
    """A modulated motion branches off; not located without damping, because pairs then stay on the unit circle."""


@dataclass(frozen=True, eq=False)
class Bifurcation(ByContent):
    """A bifurcation of a periodic orbit.

    Attributes
    ----------
    kind
        Kind of the bifurcation.
    parameter
        Value of the branch's parameter.
    orbit
        The orbit at the bifurcation.
    multiplier
        The critical multiplier.
    coefficient
        Coefficient of the normal form; NaN if it decides nothing. The bifurcation is supercritical if it is negative
        (Neimark-Sacker) or positive (pitchfork, period doubling).
    supercritical
        Whether the loss of stability is supercritical: stable motions branch off. None if the orbit is unstable
        on both sides, at folds and branch points, and without damping: there the coefficient decides nothing.
    critical_vector
        Disturbance of the state that neither grows nor decays (real part), of length 1.
    point, direction
        Point of the branch, and the direction in which it was passed.
    """

    kind: BifurcationKind
    parameter: float
    orbit: PeriodicOrbit
    multiplier: complex
    coefficient: float
    supercritical: bool | None
    critical_vector: Floats
    point: Point
    direction: Floats

    @property
    def state(self) -> Floats:
        """State of the orbit at t = 0, in units of the model."""
        return self.orbit.state

    def __repr__(self) -> str:
        """Describe the bifurcation in one line."""
        how = {True: ", supercritical", False: ", subcritical", None: ""}[self.supercritical]
        return f"Bifurcation({self.kind.value} at {self.point.family.name} = {self.parameter:.10g}{how})"

    def _repr_html_(self) -> str:
        """Render the card that notebooks show."""
        name = self.point.family.name
        unit = unit_in_text(quantity_of(name).unit)
        how = {True: "supercritical", False: "subcritical", None: "not decided"}[self.supercritical]
        rows = [
            Row("kind", self.kind.value),
            Row(name.replace("_", " "), f"{four_digits(self.parameter)} {unit}".rstrip()),
            Row("loss of stability", how),
            Row("critical multiplier", f"{self.multiplier:.4g}"),
            Row("orbit", repr(self.orbit)),
        ]
        return card("Bifurcation", [CardSection("", rows), *system_sections(self.orbit.system)])


def between(first: Point, second: Point, sense: Floats) -> tuple[Bifurcation, ...]:
    """Return the bifurcations between two consecutive points, in their order."""
    found = []
    for name, condition in conditions_between(first, second).items():
        if not condition(first, sense) * condition(second, sense) < 0.0:
            continue
        located = _located(first, second, sense, condition)
        if located is not None:
            bifurcation = _classified(located, sense, name)
            if bifurcation is not None:
                found.append(bifurcation)
    return tuple(sorted(found, key=lambda one: float((one.point.u - first.u) @ sense)))


def _located(first: Point, second: Point, sense: Floats, condition: Condition) -> Point | None:
    length = float((second.u - first.u) @ sense)
    points: dict[float, Point] = {0.0: first, length: second}

    def value(at: float) -> float:
        if at not in points:
            # Between the two points the first guess lies on the chord.
            guess = first.u + (second.u - first.u) * (at / length)
            guess = guess + sense * (at - float((guess - first.u) @ sense))
            found = corrected(first.family, guess, sense)
            if isinstance(found, FlowStatus):
                raise ArithmeticError
            points[at] = found[0]
        return condition(points[at], sense)

    try:
        root = brentq(value, 0.0, length, xtol=_LOCATED, rtol=8.9e-16)
        value(root)
    except (ArithmeticError, ValueError):
        return None
    return points[root]


def orbit_at(point: Point) -> PeriodicOrbit:
    """Return the orbit of a point of a family."""
    family, chain = point.family, point.chain
    system = family.at(point.value)
    if family.sense < 0.0:
        chain = shots(system, np.concatenate([chain.states, system.image(-1.0) * chain.states]), family.periods)
    return PeriodicOrbit(system.model, system.motion, family.periods, chain, system.line, system.rtol)


def _classified(point: Point, sense: Floats, name: str) -> Bifurcation | None:
    """Return the bifurcation at a zero of this condition; None if the zero is not a bifurcation."""
    orbit, family = orbit_at(point), point.family
    values = point.map_multipliers
    period_map = PeriodMap(orbit.system, orbit.state, family.covered, family.sense)
    kind, critical, coefficient, supercritical = _KINDS[name], _CRITICAL_VALUES[name], math.nan, None
    if name == "Neimark-Sacker":
        pairs = [m for m in values if m.imag > 0.0 and abs(abs(m) - 1.0) < _CRITICAL]
        if not pairs:
            return None  # two reciprocal real multipliers
        critical = complex(pairs[0])
        coefficient = neimark_sacker_coefficient(period_map, critical)
        supercritical = coefficient < 0.0
    nearest = complex(values[np.argmin(np.abs(values - critical))])
    if abs(nearest - critical) > _CRITICAL:
        return None
    if name == "period doubling":
        # A period doubling of the half orbit is a loss of symmetry of the whole orbit.
        kind = BifurcationKind.PITCHFORK if family.sense < 0.0 else kind
        if not without_damping(point.multipliers):
            coefficient = period_doubling_coefficient(period_map)
            supercritical = coefficient > 0.0
    if np.sum(np.abs(values) > 1.0 + _CRITICAL) > 0:
        supercritical = None  # the orbit is unstable on both sides
    vector: Floats = critical_vectors(point.map_derivative, nearest)[0].real
    multiplier = nearest**2 if family.sense < 0.0 else nearest
    return Bifurcation(kind, point.value, orbit, multiplier, coefficient, supercritical, vector, point, sense)


_KINDS = {
    "fold": BifurcationKind.FOLD,
    "branch point": BifurcationKind.BRANCH_POINT,
    "period doubling": BifurcationKind.PERIOD_DOUBLING,
    "Neimark-Sacker": BifurcationKind.NEIMARK_SACKER,
}
_CRITICAL_VALUES = {
    "fold": 1.0 + 0.0j,
    "branch point": 1.0 + 0.0j,
    "period doubling": -1.0 + 0.0j,
    "Neimark-Sacker": 0j,
}


def require_bifurcation(bifurcation: Bifurcation) -> None:
    """Raise ParameterError unless `bifurcation` is a Bifurcation."""
    if not isinstance(bifurcation, Bifurcation):
        raise ParameterError(
            f"bifurcation must be one of a branch, such as branch.bifurcations[0]; got {bifurcation!r}"
        )
