"""Plans of runs for tests that look into kernels."""

import numpy as np

from stylobate.engine.ensembles.batch import Plan
from stylobate.engine.ensembles.run_columns import MotionPlan
from stylobate.run_arguments import checked_options


def plan_of(model, motion, duration=1.0, *, traces=0, rtol=1e-8, tilt_limit=None, method="dop853", demands=False):
    """Return the plan of runs of this duration [s]; the other options are the usual ones."""
    options = checked_options({"method": method, "rtol": rtol, "tilt_limit": tilt_limit, "demands": demands})
    return Plan(model, MotionPlan.of(motion, {}, np.array([duration])), options, traces=traces)
