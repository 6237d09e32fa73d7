"""Whether steps of a lane are cut by stability alone, as where a patch creeps, and giving it up for that."""

from typing import TYPE_CHECKING

from stylobate.engine.lanes.columns import Status
from stylobate.engine.lanes.layout import Table

if TYPE_CHECKING:
    from stylobate.engine.lanes.pattern.head import SLIDING, SLIPPING, R, stability

# --- the kernel's text begins here ---

# Steps from one look to the next. So many looks that find a step near the boundary of stability, at hλ = 6, take a lane
# a second or two: about as long as an implicit method takes for the whole run.
LOOK_EVERY, MOST_STIFF_LOOKS, NEAR_BOUNDARY = 500.0, 1000.0, 3.0


def look_whether_stiff(buf: Table, i: int) -> None:
    """Look now and then whether stability cuts the steps of a contact that slips; the step was just made.

    Steps that it cuts do not count among those a run may take.
    """
    if buf[R.STEPS, i] < buf[R.STIFF_LOOK_AT, i]:
        return
    buf[R.STIFF_LOOK_AT, i] = buf[R.STEPS, i] + LOOK_EVERY
    if buf[R.CONTACT, i] in (SLIDING, SLIPPING) and stability(buf, i) > NEAR_BOUNDARY:
        buf[R.STIFF_LOOKS, i] += 1.0
        buf[R.MOST_STEPS, i] += LOOK_EVERY


def stiff_for_long(buf: Table, i: int) -> bool:
    return buf[R.STIFF_LOOKS, i] >= MOST_STIFF_LOOKS


def out_of_steps(buf: Table, i: int) -> int:
    """Return the status of a run whose steps are used up: stiff if that took half of them."""
    stiff = 2.0 * LOOK_EVERY * buf[R.STIFF_LOOKS, i] >= buf[R.STEPS, i]
    return Status.STIFF if stiff else Status.STEP_LIMIT
