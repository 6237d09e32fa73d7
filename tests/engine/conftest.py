"""Plans of runs, for the tests in these folders."""

import pytest

from . import plans


@pytest.fixture(scope="session")
def plan_of():
    """Make a plan of runs, see `plans.plan_of`."""
    return plans.plan_of
