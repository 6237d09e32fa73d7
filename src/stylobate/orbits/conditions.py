"""Test functions of bifurcations, which change sign there; μ are the eigenvalues of the shooting map."""

from collections.abc import Callable
from itertools import combinations

import numpy as np

from stylobate.orbits.arclength import Floats, Point
from stylobate.orbits.multipliers import least_are_rounding, without_damping


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
