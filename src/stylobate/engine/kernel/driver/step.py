"""One attempted step in all lanes that have runs."""

from stylobate.compiler.marks import fast, lanes
from stylobate.engine.kernel.bound import DEMANDS, ORDER, SERIES, SWITCHING, WIDTH, R
from stylobate.engine.kernel.driver.demands import follow_demands
from stylobate.engine.kernel.driver.guards import evaluate_guards, project_states
from stylobate.engine.kernel.driver.series import make_series_step
from stylobate.engine.kernel.driver.stages import STAGE_NUMBERS, make_long_stage, make_stage
from stylobate.engine.kernel.driver.step_control import control_step
from stylobate.engine.kernel.layout import Table


@fast
def step(buf: Table, width: int) -> None:
    """Try a step in each of the first `width` lanes; accept it if its error is small and it contains no event."""
    if SERIES:
        make_series_step(buf, width)
    elif SWITCHING:
        make_long_step(buf)
    else:
        for stage in STAGE_NUMBERS:
            make_stage(buf, stage, width)
    control_step(buf, width)
    if SWITCHING:
        project_states(buf)
    if DEMANDS:
        follow_demands(buf, width)


@fast
def make_long_step(buf: Table) -> None:
    """Make a step of a model with long equations, and evaluate its guards within the step."""
    for i in lanes(WIDTH):
        for j in range(ORDER):
            buf[R.STEP + j, i] = buf[R.H, i]
    for stage in STAGE_NUMBERS:
        make_long_stage(buf, stage)
    for i in lanes(WIDTH):
        for j in range(ORDER):
            buf[R.NEW + j, i] = buf[R.STAGE + j, i]
    evaluate_guards(buf)
