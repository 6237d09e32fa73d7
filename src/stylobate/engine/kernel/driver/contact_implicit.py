"""Implicit steps for stiff slip, while they are efficient and the kind of contact lasts."""

import math

import numpy as np

from stylobate.engine.kernel.bound import CHANGES, FRICTION, ORDER, R
from stylobate.engine.kernel.driver.contact_changes import apply_resets
from stylobate.engine.kernel.driver.contact_ends import broken_now, first_broken_guard
from stylobate.engine.kernel.driver.contact_steps import (
    end_at_limit,
    end_contact,
    meet_reached_stop,
    slip_turns,
    step_to,
)
from stylobate.engine.kernel.driver.contact_stiffness import LOOK_AGAIN, LOOK_EVERY, NEAR_BOUNDARY
from stylobate.engine.kernel.driver.equations import row_state
from stylobate.engine.kernel.driver.events import Status
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
from stylobate.engine.kernel.driver.stops import set_next_stop
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.linear_equations import NewtonRoom
from stylobate.engine.tolerances import SLIP_SHORTER

# An implicit step costs as much as explicit steps over this hλ; a shorter one does not pay. After so many such steps in
# sequence the explicit method continues, with the interval between stiffness checks of a run that has not been stiff.
PAYS, MOST_UNPAID = 20.0, 5
# Maximum number of implicit steps in one call, so that other lanes and a halt signal are served.
STRETCH = 1000
# Step control of Hairer and Wanner: safety factor, bounds of step changes, and the factor after a failed solution.
SAFETY, LEAST_FACTOR, LARGEST_FACTOR, UNSOLVED_FACTOR = 0.9, 0.2, 8.0, 0.5


def follow_implicitly(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Make implicit steps while they pay; return the final status if the run ends, else WAITING."""
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
        elapsed, number = first_broken_guard(buf, i)
        begins = number != FRICTION or not slip_turns(buf, i, elapsed)
        if not begins:  # repeated with a shorter step
            buf[R.WANTED, i] = SLIP_SHORTER * elapsed
            before = 0.0
            continue
        if number >= 0:
            return end_contact(buf, i, table, pieces, elapsed, number)
        before = h
        status, number = take_step(buf, i, table, pieces)
        if status != Status.WAITING:
            return status
        if number >= 0:
            return apply_resets(buf, i, table, pieces, number)
    return go_on_explicitly(buf, i, table, pieces, rate, pays=pays)


def attempt(buf: Table, i: int, before: float, rate: float, room: NewtonRoom) -> float:
    """Compute a step whose error is acceptable; return its length, or 0 if no step pays.

    `before` is the length of the step whose dense output is stored, or 0; `rate` is the fastest rate of the equations.
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
    """Return the ratio of the next step to one with this error in tolerances."""
    if not error < math.inf:
        return UNSOLVED_FACTOR
    safety = SAFETY * (2 * MOST_ITERATIONS + 1) / (2 * MOST_ITERATIONS + iterations)
    return min(max(safety / math.sqrt(math.sqrt(max(error, 1e-12))), LEAST_FACTOR), LARGEST_FACTOR)


def take_step(buf: Table, i: int, table: Table, pieces: Table) -> tuple[int, int]:
    """Accept the computed step; return WAITING and the guard broken at its end, or −1, or the final status."""
    h, stop = buf[R.TRIED, i], buf[R.STOP, i]
    reached = h >= stop - buf[R.TIME, i]
    beyond = step_to(buf, i, table, h)
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
    """Return the lane to explicit steps; check for stiffness soon if implicit steps paid, else later."""
    buf[R.STIFF_LOOK_AT, i] = buf[R.STEPS, i] + (1.0 if pays else LOOK_EVERY)
    buf[R.REJECTED, i] = 0.0
    buf[R.AIMED, i] = 0.0
    if 0.0 < rate < math.inf:
        buf[R.WANTED, i] = min(buf[R.WANTED, i], NEAR_BOUNDARY / rate)
    number = broken_now(buf, i)
    if number >= 0:
        return apply_resets(buf, i, table, pieces, number)
    set_next_stop(buf, i)
    return Status.WAITING
