"""Stiffness detection: steps of a lane that stability limits, as in slow slip with a contact patch."""

from stylobate.engine.kernel.bound import SLIDING, SLIPPING, R
from stylobate.engine.kernel.driver.stages import stability
from stylobate.engine.kernel.layout import Table

# Steps between checks, the same in runs that have been stiff, number of successive steps near the stability boundary
# (hλ = 6) that show stiffness (one could be near it by chance), and the hλ that counts as near.
LOOK_EVERY, LOOK_AGAIN, STIFF_STEPS, NEAR_BOUNDARY = 500.0, 50.0, 20.0, 3.0


def detect_stiffness(buf: Table, i: int) -> bool:
    """Return whether stability limits the steps of a slipping contact; check the step just made if a check is due."""
    if buf[R.STEPS, i] < buf[R.STIFF_LOOK_AT, i]:
        return False
    near = buf[R.CONTACT, i] in (SLIDING, SLIPPING) and stability(buf, i) > NEAR_BOUNDARY
    buf[R.STIFF_LOOKS, i] = buf[R.STIFF_LOOKS, i] + 1.0 if near else 0.0
    buf[R.STIFF_LOOK_AT, i] = buf[R.STEPS, i] + (1.0 if near else buf[R.STIFF_WAIT, i])
    return buf[R.STIFF_LOOKS, i] >= STIFF_STEPS
