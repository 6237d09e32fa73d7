"""One attempt at a step in the lanes that have runs."""

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.kernel.bound import DEMANDS, ORDER, SERIES, SWITCHING, WIDTH, R
from stylobate.engine.kernel.driver.demands import follow_demands
from stylobate.engine.kernel.driver.guards import bring_up_to_date, look_at_guards
from stylobate.engine.kernel.driver.series import make_series_step
from stylobate.engine.kernel.driver.stages import STAGE_NUMBERS, make_long_stage, make_stage
from stylobate.engine.kernel.driver.step_control import judge
from stylobate.engine.kernel.layout import Table


@fast
def step(buf: Table, width: int) -> None:
    """Try a step in each of the first lanes, and take it where its error allows and no event lies within."""
    if SERIES:
        make_series_step(buf, width)
    elif SWITCHING:
        make_long_step(buf)
    else:
        for stage in STAGE_NUMBERS:
            make_stage(buf, stage, width)
    judge(buf, width)
    if SWITCHING:
        bring_up_to_date(buf)
    if DEMANDS:
        follow_demands(buf, width)


@fast
def make_long_step(buf: Table) -> None:
    """Make a step of a model whose equations are long, and look at its guards within."""
    for i in lanes(WIDTH):
        for j in range(ORDER):
            buf[R.STEP + j, i] = buf[R.H, i]
    for stage in STAGE_NUMBERS:
        make_long_stage(buf, stage)
    for i in lanes(WIDTH):
        for j in range(ORDER):
            buf[R.NEW + j, i] = buf[R.STAGE + j, i]
    look_at_guards(buf)
