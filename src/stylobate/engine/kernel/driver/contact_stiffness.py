"""Whether steps of a lane are cut by stability alone, as where a patch creeps."""

from stylobate.engine.kernel.bound import SLIDING, SLIPPING, R
from stylobate.engine.kernel.driver.stages import stability
from stylobate.engine.kernel.layout import Table

# Steps from one look to the next, and in runs that have been stiff. From a step near the boundary of stability, at
# hλ = 6, each step is looked at until so many in turn are near it: one may be so by chance.
LOOK_EVERY, LOOK_AGAIN, STIFF_STEPS, NEAR_BOUNDARY = 500.0, 50.0, 20.0, 3.0


def found_stiff(buf: Table, i: int) -> bool:
    """Look now and then whether stability cuts the steps of a contact that slips; the step was just made."""
    if buf[R.STEPS, i] < buf[R.STIFF_LOOK_AT, i]:
        return False
    near = buf[R.CONTACT, i] in (SLIDING, SLIPPING) and stability(buf, i) > NEAR_BOUNDARY
    buf[R.STIFF_LOOKS, i] = buf[R.STIFF_LOOKS, i] + 1.0 if near else 0.0
    buf[R.STIFF_LOOK_AT, i] = buf[R.STEPS, i] + (1.0 if near else buf[R.STIFF_WAIT, i])
    return buf[R.STIFF_LOOKS, i] >= STIFF_STEPS
