"""Plans of runs for tests that look into kernels."""

import numpy as np

from stylobate.engine.ensembles.batch import Plan
from stylobate.engine.ensembles.motion_columns import MotionPlan
from stylobate.engine.ensembles.options import Options


def plan_of(model, motion, duration=1.0, *, traces=0, rtol=1e-8, tilt_limit=None, method="dop853", demands=False):
    """Return the plan of runs of this duration [s]; the other options are the usual ones."""
    options = Options.checked(
        method=method,
        rtol=rtol,
        atol=None,
        tilt_limit=tilt_limit,
        rest_energy=None,
        max_steps=200_000,
        samples=None,
        strobes=0,
        rules=None,
        demands=demands,
    )
    return Plan(model, MotionPlan.of(motion, {}, np.array([duration])), options, traces=traces)
