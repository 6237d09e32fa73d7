"""Families of orbits for diagrams: each is continued once and split at its bifurcations."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from stylobate.engine.flow.integration import Status
from stylobate.errors import NoOrbitError
from stylobate.orbits import Bifurcation, Branch, End, Kind, StepControl, switch_branch
from stylobate.orbits.arclength import Family, Point, corrected
from stylobate.orbits.bifurcations import orbit_at
from stylobate.orbits.shooting import arcs_of, shots
from stylobate.progress import Progress

_BORN = (Kind.PITCHFORK, Kind.PERIOD_DOUBLING, Kind.BRANCH_POINT)
# Two orbits are related by symmetry if their tilts agree to this fraction of c, and the sums of their multipliers to
# this relative tolerance. Orbits are known much better, and different orbits differ by much more.
_ALIKE, _ALIKE_MULTIPLIERS = 1e-6, 1e-3
# Number of points of a known family that starts at a bifurcation.
_PROBED = 8


@dataclass(frozen=True, slots=True)
class Followed:
    """A family with its name."""

    name: str
    branch: Branch


def born(
    branch: Branch,
    bounds: tuple[float, float],
    generations: int,
    control: StepControl | None,
    progress: Progress = None,
) -> Iterator[Followed]:
    """Continue the bifurcating branches of a branch; a pair related by symmetry, or by both ends, is continued once."""
    if generations <= 0:
        return
    siblings: list[Branch] = []
    for one in branch.bifurcations:
        if one.kind not in _BORN:
            continue
        try:
            probe = switch_branch(one, bounds=bounds, control=replace(control or StepControl(), most=_PROBED))
            if any(_meet(probe, other) for other in siblings):
                continue
            whole = switch_branch(one, bounds=bounds, control=control, progress=progress)
        except NoOrbitError:
            continue
        siblings.append(whole)
        family = _from_birth_to_death(whole, one, branch.bifurcations)
        name = "asymmetric" if one.kind is Kind.PITCHFORK else f"period {family.path[0].family.periods}"
        yield Followed(f"{name}, from {one.parameter:.6g} rad/s", family)
        yield from born(family, bounds, generations - 1, control, progress)


def between_bifurcations(branch: Branch) -> Branch:
    """Return the branch with an additional orbit between any two bifurcations without one.

    Stability changes only at bifurcations: an orbit between each two shows the stability everywhere.
    """
    located = {id(one.point) for one in branch.bifurcations}
    path = list(branch.path[:1])
    for first, second in pairwise(branch.path):
        if id(first) in located and id(second) in located:
            middle = _middle(first, second)
            path += [] if middle is None else [middle]
        path.append(second)
    return replace(branch, path=tuple(path))


def _middle(first: Point, second: Point) -> Point | None:
    chord = second.u - first.u
    length = float(np.linalg.norm(chord))
    if length == 0.0:
        return None
    found = corrected(first.family, first.u + 0.5 * chord, chord / length)
    return None if isinstance(found, Status) else found[0]


def _meet(probe: Branch, other: Branch) -> bool:
    """Return whether an orbit of one family is in the other, up to a shift in time by half periods or a mirror image.

    Orbits related by such symmetries have the same tilts and multipliers.
    """
    if probe.path[0].family.periods != other.path[0].family.periods:
        return False
    for index, point in enumerate(probe.path):
        orbit = probe.orbit(index)
        scale = orbit.system.scale
        for candidate in other.orbits_at(point.value):
            tilts = (candidate.minimum_tilt - orbit.minimum_tilt, candidate.peak_tilt - orbit.peak_tilt)
            traces = complex(candidate.multipliers.sum()), complex(orbit.multipliers.sum())
            same = abs(traces[0] - traces[1]) <= _ALIKE_MULTIPLIERS * max(1.0, abs(traces[1]))
            if same and max(map(abs, tilts)) <= _ALIKE * scale:
                return True
    return False


def _from_birth_to_death(family: Branch, birth: Bifurcation, known: tuple[Bifurcation, ...]) -> Branch:
    """Return a family from the orbit of its parent branch up to the orbit at which it ends, if it ends.

    Beyond an orbit of half its length, a family repeats the same orbits, shifted by half their length.
    """
    path, found, ends = list(family.path), family.bifurcations, family.ends
    death: tuple[Point, ...] = ()
    gaps = [_halves_apart(point) for point in path] if birth.kind is Kind.PERIOD_DOUBLING else []
    last = next((k for k, (one, after) in enumerate(pairwise(gaps)) if float(one @ after) < 0.0), None)
    if last is not None:
        path = path[: last + 1]
        inside = {id(point) for point in path}
        found = tuple(one for one in found if id(one.point) in inside)
        ends = (End.BEGUN, End.MERGED)
    if ends[1] is End.MERGED:
        death = _at(_nearest(path[-1], [one for one in known if one.kind is birth.kind]), family)
    return replace(family, path=(*_at(birth, family), *path, *death), bifurcations=found, ends=ends)


def _nearest(point: Point, known: list[Bifurcation]) -> Bifurcation:
    family = point.family

    def distance(one: Bifurcation) -> float:
        states = np.abs(one.state - point.chain.states[0]).max() / family.system.scale
        return float(states + abs(one.parameter - point.value) / family.span)

    return min(known, key=distance)


def _halves_apart(point: Point) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """Return the difference of an orbit from itself half its length later; zero for an orbit of half the length."""
    states = point.chain.states
    return np.asarray(states[0] - states[len(states) // 2])


def _at(bifurcation: Bifurcation, of: Branch) -> tuple[Point, ...]:
    """Return the orbit of a bifurcation as a point of the bifurcating branch; empty if that is impossible."""
    family: Family = of.path[0].family
    system = family.at(bifurcation.parameter)
    states = arcs_of(system, orbit_at(bifurcation.point).state, family.periods, len(of.path[0].chain.states))
    change = family.system.derivative(family.name, bifurcation.parameter)
    chain = shots(system, states, family.covered, sense=family.sense, change=change)
    return (Point(family, bifurcation.parameter, chain),) if chain.status is Status.DONE else ()
