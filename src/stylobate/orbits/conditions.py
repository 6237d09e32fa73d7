"""What changes sign where the family of an orbit bifurcates; μ are the eigenvalues of the map over what is shot."""

from collections.abc import Callable
from itertools import combinations

import numpy as np

from stylobate.orbits.arclength import Floats, Point


def fold(point: Point, direction: Floats) -> float:
    """Return the part of the tangent along the parameter: the family turns back where it is zero."""
    return float(point.along(direction)[-1])


def branching(point: Point, direction: Floats) -> float:
    """Return the determinant of the equations with the tangent: other families cross this one where it is zero.

    It is that of the map over the whole period, whatever the number of arcs.
    """
    order = point.chain.states.shape[1]
    unit = point.family.system.scale
    rows = np.column_stack(
        [point.map_derivative - np.eye(order), point.chain.map_sensitivity * point.family.span / unit]
    )
    # The tangent of the map's family: the same family seen at the first state.
    tangent = point.along(direction)
    first = np.append(tangent[:order], tangent[-1])
    return float(np.linalg.det(np.vstack([rows, first])))


def period_doubling(point: Point, _: Floats) -> float:
    """Return Π(μ + 1): at zero an orbit of double length is born; of a half orbit, one without its symmetry."""
    order = point.chain.states.shape[1]
    return float(np.linalg.det(point.map_derivative + np.eye(order)))


def neimark_sacker(point: Point, _: Floats) -> float:
    """Return Π(μ_i μ_j − 1) over pairs, zero where a complex pair is on the unit circle, or a real one reciprocal."""
    pairs = combinations(point.map_multipliers, 2)
    return float(np.prod([first * second - 1.0 for first, second in pairs]).real)


Condition = Callable[[Point, Floats], float]

CONDITIONS: dict[str, Condition] = {
    "fold": fold,
    "branch point": branching,
    "period doubling": period_doubling,
    "Neimark-Sacker": neimark_sacker,
}
