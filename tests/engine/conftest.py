"""Plans of runs and lanes of kernels, for the tests in these folders."""

import pytest

from . import plans
from .lane import Lane


@pytest.fixture(scope="session")
def plan_of():
    """Make a plan of runs, see `plans.plan_of`."""
    return plans.plan_of


@pytest.fixture(scope="session")
def lane_of():
    """Make a lane of the kernel of a model under a base motion, with these numbers in its rows."""

    def made(model, motion, *, planar=False, method="dop853", demands=False, **given):
        plan = plans.plan_of(model, motion, method=method, demands=demands)
        return Lane(plan, model, planar=planar, **given)

    return made
