"""What becomes of a column when a kind of contact ends."""

from stylobate.models.sliding.landing import land
from stylobate.models.sliding.lift_off import lifted
from stylobate.models.sliding.on_base import released, set_down, set_sliding, settle_flat, tripping
from stylobate.models.sliding.on_rim import held, jammed, leaving, settle_rim
from stylobate.models.sliding.onset import giving_way
from stylobate.models.sliding.phases import FLYING, RESTING, ROLLING, SLIDING, SLIPPING, Numbers, State
from stylobate.models.sliding.posture import Triple, lean_with_rate, moving, placed
from stylobate.models.sliding.strokes import stroke

_LIFT, _FRICTION, _SUPPORT, _REST, _JAM, _STROKE = 0, 1, 2, 3, 4, 6

# A weight that counts as none [m g]: there a sliding base lifts off, and friction vanishes with it.
_WEIGHTLESS = 1e-12


def reaction(
    state: State, event: int, now: Triple, later: Triple, ahead: float, rest: float, numbers: Numbers
) -> tuple[float, State]:
    """Return how much later, and in which state, a column goes on whose margin of this number fell below nought.

    Parameters
    ----------
    state
        State at the event.
    event
        Place of the margin in MARGINS; any other number asks how a column in this state goes on.
    now, later, ahead
        Base accelerations [g] at the event, and so much `ahead` of it, from which a release goes.
    rest
        ε.
    numbers
        Parameters of the model.
    """
    rim = state.contact == ROLLING or state.contact == SLIPPING  # noqa: PLR1714  this is what Numba knows
    flies = state.contact == FLYING
    if rim and event == _STROKE:
        return stroke(state, now, later, ahead, rest, numbers)
    if rim and event == _REST:
        return set_down(state, now, later, ahead, numbers)
    if rim and event == _JAM:
        return settle_rim(jammed(state, numbers), now, later, ahead, numbers)
    if rim and event == _LIFT:
        return leaving(state, now, later, ahead, numbers)
    if rim and event == _FRICTION and state.contact == SLIPPING:
        return stopped(state, now, later, ahead, numbers)
    if rim and event == _FRICTION:
        return giving_way(state, now, later, ahead, numbers)
    if rim:
        return settle_rim(state, now, later, ahead, numbers)
    if flies:
        return land(state, now, later, ahead, rest, numbers)
    if event == _LIFT:
        return 0.0, lifted(state, numbers)
    if state.contact == SLIDING:
        if event == _FRICTION:
            return stopped(state, now, later, ahead, numbers)
        if event == _SUPPORT and 1.0 + now[2] - numbers.relief > _WEIGHTLESS:
            return tripping(state, now, later, ahead, numbers)
        if event == _SUPPORT:
            return 0.0, lifted(state, numbers)
        return settle_flat(state, now, later, ahead, numbers)
    if event == _FRICTION:
        return set_sliding(state, now, later, ahead, numbers)
    if event == _SUPPORT:
        return released(state, now, later, ahead, numbers)
    return settle_flat(state, now, later, ahead, numbers)


def stopped(state: State, now: Triple, later: Triple, ahead: float, n: Numbers) -> tuple[float, State]:
    """Return how a column goes on whose slip has all but ended."""
    if state.contact == SLIDING:
        still = moving(placed(state, lean_with_rate(state), 0.0, RESTING), (0.0, 0.0), 0.0, 0.0, RESTING)
        return settle_flat(still, now, later, ahead, n)
    return settle_rim(held(state, n), now, later, ahead, n)
