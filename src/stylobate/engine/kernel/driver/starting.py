"""Start of a run in a lane."""

from stylobate.engine.kernel.bound import R
from stylobate.engine.kernel.driver.events import Status, limit_passed
from stylobate.engine.kernel.driver.lift_off import find_lift
from stylobate.engine.kernel.driver.moving import start_moving
from stylobate.engine.kernel.driver.resting import stand
from stylobate.engine.kernel.driver.stops import resume
from stylobate.engine.kernel.layout import Table


def begin(buf: Table, i: int, table: Table, pieces: Table) -> int:
    """Start the run of a lane; return WAITING if the column moves, else the status with which the run ends at once."""
    t = buf[R.TIME, i]
    find_lift(buf, i, table, pieces)
    if buf[R.STANDS, i] > 0.0:
        return stand(buf, i, table, pieces, t)
    start_moving(buf, i, t, 0.0)
    status = limit_passed(buf, i)
    return resume(buf, i, table, pieces) if status == Status.WAITING else status
