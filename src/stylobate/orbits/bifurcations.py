"""Bifurcations of a family: detected between two points, located on the family, classified."""

import math
from dataclasses import dataclass
from enum import Enum

import numpy as np
from scipy.optimize import brentq

from stylobate.cards import Row, Section, card
from stylobate.engine.flow.integration import Status
from stylobate.equality import ByContent
from stylobate.errors import Named
from stylobate.orbits.arclength import Floats, Point, corrected
from stylobate.orbits.conditions import Condition, conditions_between
from stylobate.orbits.multipliers import without_damping
from stylobate.orbits.normal_forms import (
    PeriodMap,
    critical_vectors,
    neimark_sacker_coefficient,
    period_doubling_coefficient,
)
from stylobate.orbits.orbit import PeriodicOrbit, system_sections
from stylobate.orbits.shooting import shots
from stylobate.parameter_quantities import quantity_of
from stylobate.text import four_digits, unit_in_text

# Accuracy of the location along the family, in its units; for the parameter, times the width of its bounds.
_LOCATED = 1e-13
# A multiplier within this distance of the unit circle is critical.
_CRITICAL = 1e-4


class Kind(Named, Enum):
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

    kind: Kind
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
        return card("Bifurcation", [Section("", rows), *system_sections(self.orbit.system)])


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
            if isinstance(found, Status):
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
        kind = Kind.PITCHFORK if family.sense < 0.0 else kind
        if not without_damping(point.multipliers):
            coefficient = period_doubling_coefficient(period_map)
            supercritical = coefficient > 0.0
    if np.sum(np.abs(values) > 1.0 + _CRITICAL) > 0:
        supercritical = None  # the orbit is unstable on both sides
    vector: Floats = critical_vectors(point.map_derivative, nearest)[0].real
    multiplier = nearest**2 if family.sense < 0.0 else nearest
    return Bifurcation(kind, point.value, orbit, multiplier, coefficient, supercritical, vector, point, sense)


_KINDS = {
    "fold": Kind.FOLD,
    "branch point": Kind.BRANCH_POINT,
    "period doubling": Kind.PERIOD_DOUBLING,
    "Neimark-Sacker": Kind.NEIMARK_SACKER,
}
_CRITICAL_VALUES = {
    "fold": 1.0 + 0.0j,
    "branch point": 1.0 + 0.0j,
    "period doubling": -1.0 + 0.0j,
    "Neimark-Sacker": 0j,
}
