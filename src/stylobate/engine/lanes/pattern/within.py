"""The state within the step just made."""

from typing import TYPE_CHECKING

from stylobate.engine.lanes.layout import Table
from stylobate.engine.lanes.roots import cubic

if TYPE_CHECKING:
    from stylobate.engine.lanes.pattern.head import ORDER, SERIES, R, series_within

# --- the kernel's text begins here ---


def set_within(buf: Table, i: int, elapsed: float) -> None:
    """Put the state at this time after the step just made began into the rows of the new state.

    It is that of the step's series, or of cubics through its ends.
    """
    if SERIES:
        state = series_within(buf, i, elapsed)
        for j in range(ORDER):
            buf[R.NEW + j, i] = state[j]
        return
    h = buf[R.MADE, i]
    for j in range(ORDER):
        slope, end_slope = h * buf[R.LAST_SLOPE + j, i], h * buf[R.SLOPE + j, i]
        buf[R.NEW + j, i] = cubic(elapsed / h, buf[R.LAST_STATE + j, i], buf[R.STATE + j, i], slope, end_slope)
