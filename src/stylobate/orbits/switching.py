"""Switch from a bifurcation to the branch that begins there."""

import numpy as np

from stylobate.engine.flow.integration import Status
from stylobate.errors import NoOrbitError, ParameterError
from stylobate.orbits.arclength import Family, Point, corrected
from stylobate.orbits.arguments import control_of, enclosing, require_bifurcation
from stylobate.orbits.bifurcations import Bifurcation, Kind
from stylobate.orbits.branch import Branch, branch_through, seen_by
from stylobate.orbits.shooting import arcs_of
from stylobate.orbits.tracing import StepControl
from stylobate.progress import Progress, at_value, shows_progress

# First step off the old family, in units of c, and maximum number of doublings if Newton's method falls back.
_OFF, _DOUBLINGS = 2e-3, 5


@shows_progress("branch", at_value)
def switch_branch(
    bifurcation: Bifurcation,
    *,
    bounds: tuple[float, float],
    opposite: bool = False,
    control: StepControl | None = None,
    progress: Progress = None,
) -> Branch:
    """Continue the branch that begins at, or crosses, a bifurcation.

    Parameters
    ----------
    bifurcation
        A pitchfork, a period doubling or a branch point of a branch.
    bounds
        Minimum and maximum of the parameter.
    opposite
        At a pitchfork: continue the symmetry-related branch instead.
    control, progress
        As in `continue_branch`.

    Raises
    ------
    ParameterError
        If no branch of periodic orbits begins here: at a fold or a Neimark-Sacker point.
    NoOrbitError
        If no orbit of the new branch was reached.
    Interrupted
        On Ctrl-C; `partial` is the branch so far.
    """
    require_bifurcation(bifurcation)
    control = control_of(control)
    point, old = bifurcation.point, bifurcation.point.family
    if bifurcation.kind in (Kind.FOLD, Kind.NEIMARK_SACKER):
        message = (
            f"bifurcation must be a pitchfork, a period doubling or a branch point, got {bifurcation.kind.value}: "
            "no other family of periodic orbits begins there"
        )
        raise ParameterError(message)
    bounds = enclosing(old.system, bounds, old.name, point.value)
    periods = 2 * old.periods if bifurcation.kind is Kind.PERIOD_DOUBLING else old.periods
    family = Family(old.at(point.value), periods, old.name, bounds[1] - bounds[0])
    states = arcs_of(family.system, point.chain.states[0], periods, periods)
    units = family.units(states.size)
    sign = -1.0 if opposite else 1.0
    disturbance = arcs_of_disturbance(family, states, sign * bifurcation.critical_vector)
    normal = np.append(disturbance.ravel(), 0.0) / units
    normal /= np.linalg.norm(normal)
    here = np.append(states.ravel(), point.value) / units
    off = _OFF
    for _ in range(_DOUBLINGS):
        found = corrected(family, here + off * normal, normal)
        # The old family meets the plane across the disturbance at zero distance.
        if not isinstance(found, Status) and _apart(found[0], here, normal) > 0.5 * off:
            start = found[0]
            return branch_through(start, normal, bounds, control, seen_by(progress), both_ways=False)
        off *= 2.0
    message = f"no orbit of the branch from {old.name} = {point.value!r} was reached; give another bifurcation"
    raise NoOrbitError(message)


def _apart(point: Point, here: np.ndarray, normal: np.ndarray) -> float:
    return float(abs((point.u - here) @ normal))


def arcs_of_disturbance(family: Family, states: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """Return a disturbance of the first state, carried to the beginning of each arc."""
    carried = [vector]
    for arc in range(len(states) - 1):
        begin, end = (family.periods * k / len(states) for k in (arc, arc + 1))
        carried.append(family.system.carry(states[arc], begin, end).by_start @ carried[-1])
    return np.stack(carried)
