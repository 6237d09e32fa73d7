"""Expected number of steps of a run, and log messages on its progress."""

import logging
import math

from stylobate.models import Model

LOG = logging.getLogger("stylobate")

EVERY = 1000
"""Number of steps between reports of the progress of a run."""

# Minimum number of steps of DOP853 per period of the base motion, and the stability limit of step times decay rate.
_STEPS_PER_PERIOD, _STABLE = 2.0, 6.0
_RATES = ("damping", "spin_damping")


def step_limit(most: int) -> str:
    """Return the reason of a run that reached its limit of `most` steps."""
    return f"its step limit is reached, max_steps = {most}; raise max_steps, shorten the run or loosen rtol"


def unseen(most: int) -> str:
    """Return the reason of a run whose column stood for `most` periods of a base motion that has more periods."""
    return f"it stands for {most} periods of the base motion, as many as max_steps allows to search; raise max_steps"


def expected_steps(model: Model, frequency: float, end: float) -> float:
    """Return the minimum number of steps of a run that moves to its end.

    Parameters
    ----------
    model
        Model, whose damping and spin damping limit the steps by stability.
    frequency
        Highest dimensionless frequency of the base motion.
    end
        Dimensionless duration.
    """
    decay = max(float(getattr(model, name, 0.0) or 0.0) for name in _RATES)
    return end * max(frequency / (2.0 * math.pi) * _STEPS_PER_PERIOD, decay / _STABLE)


def announce(expected: float, most: int) -> None:
    """Log a warning if a run that moves to its end needs more than `most` steps."""
    if expected > most:
        LOG.warning(
            "about %.2g steps are expected and max_steps is %d: a run that moves to its end fails there; shorten it",
            expected,
            most,
        )


def report(steps: int, most: int, time: float, end: float) -> None:
    """Log the progress of a run: `steps` of at most `most`, `time` of `end` [s]."""
    LOG.info("%d steps of at most %d, at %.4g of %.4g s", steps, most, time, end)
