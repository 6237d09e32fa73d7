"""Coefficients of Radau IIA with three stages: an implicit method of order 5 that damps stiff components.

E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", 2nd ed., section IV.8. A step is the cubic that
satisfies the equations at three nodes, the last of which is the end of the step.
"""

import math

import numpy as np

_ROOT = math.sqrt(6.0)

STAGES = 3

NODES = np.array([(4.0 - _ROOT) / 10.0, (4.0 + _ROOT) / 10.0, 1.0])
"""Fractions of a step at which the equations hold."""


def _slopes() -> tuple[tuple[float, ...], ...]:
    """Return the slopes at the nodes of cubics that are 0 at the start and 1 at one node (barycentric formula)."""
    places = [0.0, *NODES.tolist()]
    weights = [1.0 / math.prod(x - other for other in places if other != x) for x in places]
    return tuple(
        tuple(
            sum(1.0 / (x - other) for other in places if other != x) if j == i else weights[j] / weights[i] / (x - y)
            for j, y in enumerate(places[1:], 1)
        )
        for i, x in enumerate(places[1:], 1)
    )


SLOPES = np.array(_slopes())
"""A⁻¹: maps the changes from the start to the nodes to the slopes of their cubic at the nodes, in units of 1/h."""

EIGENVECTOR = np.array([0.09443876248897524, 0.25021312296533332, 1.0])
"""Eigenvector of A⁻¹ for its real eigenvalue γ₀⁻¹ = 3 + 3^⅔ − 3^⅓."""

ERROR = np.array([-(13.0 + 7.0 * _ROOT) / 3.0, -(13.0 - 7.0 * _ROOT) / 3.0, -1.0 / 3.0])
"""Weights of the changes at the nodes in the error estimate of order 3."""
