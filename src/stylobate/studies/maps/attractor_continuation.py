"""Continuation of attractors along a parameter: matching between successive values."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from stylobate.studies.maps.attractor_search import KINDS, Attractor
from stylobate.studies.maps.stroboscopic import cycle_distance


@dataclass(frozen=True, slots=True)
class Branches:
    """Branches of attractors along a parameter: the `last` attractor of each branch, and the branches by attractor.

    `places` holds, for each value of the parameter, the index of the branch of each attractor.
    """

    last: tuple[Attractor, ...]
    places: tuple[tuple[int, ...], ...]


def follow_branches(along: Sequence[Sequence[Attractor]], tolerance: float) -> Branches:
    """Match the attractors at successive values of a parameter to branches.

    Attractors are matched to the last attractors of branches of the same kind and period, so that the sum of the
    distances of their dimensionless stroboscopic samples is minimal. An attractor that is farther from every branch
    than the `tolerance`, or left over, begins a branch; a branch that reappears keeps its index. Attractors without a
    period are matched by their kind alone: one sample of many does not locate them.

    Parameters
    ----------
    along
        The attractors at each value, in the order of the parameter.
    tolerance
        Maximum distance between the dimensionless stroboscopic samples of an orbit and of its branch.

    Returns
    -------
    Branches
        Branches by kind and period, then in the order of their appearance.
    """
    last: list[Attractor] = []
    places = [_matched(attractors, last, tolerance) for attractors in along]
    order = sorted(range(len(last)), key=lambda branch: (KINDS.index(last[branch].kind), last[branch].period, branch))
    place = {branch: new for new, branch in enumerate(order)}
    return Branches(
        tuple(last[branch] for branch in order), tuple(tuple(place[branch] for branch in row) for row in places)
    )


def _matched(attractors: Sequence[Attractor], last: list[Attractor], tolerance: float) -> list[int]:
    """Return the branch of each of `attractors`, and record the attractors in `last`."""
    chosen = [-1] * len(attractors)
    distances = np.array([[_distance(found, branch, tolerance) for branch in last] for found in attractors])
    if distances.size:
        for place, branch in zip(*linear_sum_assignment(distances), strict=True):
            if distances[place, branch] < _APART:
                chosen[int(place)] = int(branch)
    for i, found in enumerate(attractors):
        if chosen[i] < 0:
            chosen[i] = len(last)
            last.append(found)
        else:
            last[chosen[i]] = found
    return chosen


# Replaces an infinite distance, which the assignment does not accept; states are of order one.
_APART = 1e9


def _distance(found: Attractor, branch: Attractor, tolerance: float) -> float:
    if (found.kind, found.period) != (branch.kind, branch.period):
        return _APART
    if not found.period:
        return 0.0
    distance = float(cycle_distance(found.states[np.newaxis], branch.states)[0])
    return distance if distance < tolerance else _APART
