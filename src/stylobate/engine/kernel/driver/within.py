"""State within the step just made."""

from stylobate.engine.kernel.bound import ORDER, SERIES, R
from stylobate.engine.kernel.driver.series import series_within
from stylobate.engine.kernel.driver.stages import dense_change, set_dense
from stylobate.engine.kernel.layout import Table
from stylobate.engine.kernel.roots import cubic


def set_dense_output(buf: Table, i: int) -> None:
    """Compute the dense output of the step just made."""
    if not SERIES:
        for j in range(ORDER):
            buf[R.NEW + j, i] = buf[R.STATE + j, i]
        h = buf[R.MADE, i]
        set_dense(buf, i, R.LAST_STATE, R.LAST_SLOPE, buf[R.TIME, i] - h, h)


def set_within_closely(buf: Table, i: int, elapsed: float) -> None:
    """Set the state as `set_within` does, but from the dense output, at the order of the method."""
    if SERIES:
        set_within(buf, i, elapsed)
        return
    u = elapsed / buf[R.MADE, i]
    for j in range(ORDER):
        buf[R.NEW + j, i] = buf[R.LAST_STATE + j, i] + dense_change(buf, i, u, j)


def set_within(buf: Table, i: int, elapsed: float) -> None:
    """Set the rows of the new state to the state at the time `elapsed` after the start of the step just made.

    The state is that of the series of the step, or of cubics through its ends.
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
