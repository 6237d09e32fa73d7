"""Implicit steps of a lane whose slip is stiff, as long as they pay and the kind of contact lasts."""

import math

import numpy as np

from stylobate.engine.kernel.bound import CHANGES, FRICTION, ORDER, R
from stylobate.engine.kernel.columns import Status
from stylobate.engine.kernel.driver.contact_changes import go_through
from stylobate.engine.kernel.driver.contact_ends import broken_now, first_end
from stylobate.engine.kernel.driver.contact_steps import (
    come_to,
    end_at_limit,
    end_contact,
    meet_reached_stop,
    turns,
)
from stylobate.engine.kernel.driver.contact_stiffness import LOOK_AGAIN, LOOK_EVERY, NEAR_BOUNDARY
from stylobate.engine.kernel.driver.equations import row_state
from stylobate.engine.kernel.driver.guards import model_project
from stylobate.engine.kernel.driver.implicit_step import (
    MOST_ITERATIONS,
    damped_error,
    error_of_changes,
    fastest_rate,
    guess_changes,
    set_cubic,
    set_jacobian,
    solve_step,
)
from stylobate.engine.kernel.driver.moving import set_rates, set_state
from stylobate.engine.kernel.driver.stops import go_on
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.linear_equations import NewtonRoom
from stylobate.engine.tolerances import SLIP_SHORTER

# An implicit step takes as long as explicit ones over hλ of this size: shorter ones do not pay. So many of them in turn
# end a stretch, and the next look is as far off as in a run that has not been stiff.
PAYS, MOST_UNPAID = 20.0, 5
# So many steps at most before the other lanes, and a signal to halt, have their turn.
STRETCH = 1000
# Step control of the reference: safety, by how much a step changes, and by how much one whose equations are not solved.
SAFETY, LEAST_FACTOR, LARGEST_FACTOR, UNSOLVED_FACTOR = 0.9, 0.2, 8.0, 0.5


def follow_implicitly(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Go on by implicit steps while they pay; return the status of a run that ends, or WAITING."""
    room = NewtonRoom(
        np.zeros((ORDER, ORDER)), np.zeros((CHANGES, CHANGES)), np.zeros(CHANGES), np.zeros(CHANGES), np.zeros(CHANGES)
    )
    buf[R.STIFF_LOOKS, i] = 0.0
    buf[R.STIFF_WAIT, i] = LOOK_AGAIN
    before, unpaid, rate, begins, pays = 0.0, 0, 0.0, True, True
    for _ in range(STRETCH):
        if begins:
            set_jacobian(buf, i, room.jacobian)
            rate = fastest_rate(room.jacobian)
        h = attempt(buf, i, before, rate, room)
        unpaid = 0 if h * rate > PAYS else unpaid + 1
        pays = h > 0.0 and unpaid <= MOST_UNPAID
        if not pays:
            break
        elapsed, number = first_end(buf, i)
        begins = number != FRICTION or not turns(buf, i, elapsed)
        if not begins:  # made again, shorter
            buf[R.WANTED, i] = SLIP_SHORTER * elapsed
            before = 0.0
            continue
        if number >= 0:
            return end_contact(buf, i, table, pieces, elapsed, number)
        before = h
        status, number = take(buf, i, table, pieces)
        if status != Status.WAITING:
            return status
        if number >= 0:
            return go_through(buf, i, table, pieces, number)
    return go_on_explicitly(buf, i, table, pieces, rate, pays=pays)


def attempt(buf: Table, i: int, before: float, rate: float, room: NewtonRoom) -> float:
    """Make a step ready to be taken, as long as its error allows; return its length, or 0 where none pays.

    `before` is the length of the step of which the dense output is kept, or 0; `rate` is the fastest of the equations.
    """
    h = min(buf[R.WANTED, i], buf[R.LONGEST_STEP, i], buf[R.STOP, i] - buf[R.TIME, i])
    slopes = row_state(buf, i, R.SLOPE)
    rejected = False
    while True:
        guess_changes(buf, i, h / before if before > 0.0 else 0.0, room.change)
        iterations = solve_step(buf, i, h, room)
        error = error_of_changes(buf, i, h, slopes, room) if iterations > 0 else math.inf
        if rejected and 1.0 < error < math.inf:
            error = damped_error(buf, i, h, room)
        factor = factor_of(error, iterations)
        if error <= 1.0:
            break
        h *= factor
        rejected = True
        if not h * rate > NEAR_BOUNDARY:
            return 0.0
    buf[R.WANTED, i] = h * (min(factor, 1.0) if rejected else factor)
    buf[R.TRIED, i] = h
    set_cubic(buf, i, room.change)
    return h


def factor_of(error: float, iterations: int) -> float:
    """Return by how much the next step is longer than one of this error, in tolerances."""
    if not error < math.inf:
        return UNSOLVED_FACTOR
    safety = SAFETY * (2 * MOST_ITERATIONS + 1) / (2 * MOST_ITERATIONS + iterations)
    return min(max(safety / math.sqrt(math.sqrt(max(error, 1e-12))), LEAST_FACTOR), LARGEST_FACTOR)


def take(buf: Table, i: int, table: Table, pieces: Table) -> tuple[int, int]:
    """Take the step that is ready; return WAITING and the margin that its end breaks, or −1, or the final status."""
    h, stop = buf[R.TRIED, i], buf[R.STOP, i]
    reached = h >= stop - buf[R.TIME, i]
    beyond = come_to(buf, i, table, h)
    if beyond > 0.0:
        return end_at_limit(buf, i, beyond), -1
    if reached:
        buf[R.TIME, i] = stop
    set_state(buf, i, model_project(buf, i))
    set_rates(buf, i, buf[R.TIME, i])
    if buf[R.STEPS, i] >= buf[R.MOST_STEPS, i]:
        return Status.STEP_LIMIT, -1
    return meet_reached_stop(buf, i, table, pieces)


def go_on_explicitly(buf: Table, i: int, table: Table, pieces: Table, rate: float, *, pays: bool) -> int:
    """Leave the lane to explicit steps; look soon whether implicit ones pay, or later if they did not."""
    buf[R.STIFF_LOOK_AT, i] = buf[R.STEPS, i] + (1.0 if pays else LOOK_EVERY)
    buf[R.REJECTED, i] = 0.0
    buf[R.AIMED, i] = 0.0
    if 0.0 < rate < math.inf:
        buf[R.WANTED, i] = min(buf[R.WANTED, i], NEAR_BOUNDARY / rate)
    number = broken_now(buf, i)
    if number >= 0:
        return go_through(buf, i, table, pieces, number)
    go_on(buf, i)
    return Status.WAITING
