"""Attractors followed along a parameter: which of one value is which of the next."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from stylobate.studies.maps.attractor_search import KINDS, Attractor
from stylobate.studies.maps.stroboscopic import cycle_distance


@dataclass(frozen=True, slots=True)
class Branches:
    """Attractors along a parameter: each branch as it was `last` seen, and the branch of each attractor in `places`.

    `places` has for each value of the parameter one number for each of its attractors.
    """

    last: tuple[Attractor, ...]
    places: tuple[tuple[int, ...], ...]


def follow_branches(along: Sequence[Sequence[Attractor]], tolerance: float) -> Branches:
    """Return the branches of the attractors found at successive values of a parameter.

    Attractors are matched to branches of the same kind and period as these were last seen, so that the distances of
    their dimensionless strobed states have the least sum. What is farther from every branch than the `tolerance`, or
    left over, begins a branch; a branch that is lost and found again keeps its place. Attractors without a period are
    matched by their kind alone: one strobed state of many does not locate them.

    Parameters
    ----------
    along
        The attractors at each value, in the order of the parameter.
    tolerance
        Largest distance of the dimensionless strobed states of an orbit from those of its branch.

    Returns
    -------
    Branches
        By kind and period, then in the order of their appearance.
    """
    last: list[Attractor] = []
    places = [_matched(attractors, last, tolerance) for attractors in along]
    order = sorted(range(len(last)), key=lambda branch: (KINDS.index(last[branch].kind), last[branch].period, branch))
    place = {branch: new for new, branch in enumerate(order)}
    return Branches(
        tuple(last[branch] for branch in order), tuple(tuple(place[branch] for branch in row) for row in places)
    )


def _matched(attractors: Sequence[Attractor], last: list[Attractor], tolerance: float) -> list[int]:
    """Return the branch of each of `attractors`, and note them in `last`."""
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


# Stands for an infinite distance, which the assignment cannot take; states are of order one.
_APART = 1e9


def _distance(found: Attractor, branch: Attractor, tolerance: float) -> float:
    if (found.kind, found.period) != (branch.kind, branch.period):
        return _APART
    if not found.period:
        return 0.0
    distance = float(cycle_distance(found.states[np.newaxis], branch.states)[0])
    return distance if distance < tolerance else _APART
