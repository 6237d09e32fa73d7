"""How many steps a run is expected to take, and a sign of life from one that takes many: messages to the log."""

import logging
import math

from stylobate.models import Model

LOG = logging.getLogger("stylobate")

EVERY = 1000
"""After so many steps a run reports how far it is."""

# DOP853 takes at least two steps a period of the base motion, and is stable up to about so much times a rate of decay.
_STEPS_PER_PERIOD, _STABLE = 2.0, 6.0
_RATES = ("damping", "spin_damping")


def step_limit(most: int) -> str:
    """Return the reason of a run that `most` steps did not bring to its end."""
    return f"its step limit is reached, max_steps = {most}; raise max_steps, shorten the run or loosen rtol"


def unseen(most: int) -> str:
    """Return the reason of a run in which `most` periods of the base motion released no standing column, with more."""
    return f"it stands for {most} periods of the base motion, as many as max_steps allows to search; raise max_steps"


def expected_steps(model: Model, frequency: float, end: float) -> float:
    """Return the least number of steps of a run that moves to its end.

    Parameters
    ----------
    model
        Its damping and spin damping limit steps by stability.
    frequency
        Highest dimensionless frequency of the base motion.
    end
        Dimensionless duration.
    """
    decay = max(float(getattr(model, name, 0.0) or 0.0) for name in _RATES)
    return end * max(frequency / (2.0 * math.pi) * _STEPS_PER_PERIOD, decay / _STABLE)


def announce(expected: float, most: int) -> None:
    """Log a warning if a run that moves to its end will need more steps than it may take."""
    if expected > most:
        LOG.warning(
            "about %.2g steps are expected and max_steps is %d: a run that moves to its end fails there; shorten it",
            expected,
            most,
        )


def report(steps: int, most: int, time: float, end: float) -> None:
    """Log how far a run is, after so many `steps` of at most so many; times in s."""
    LOG.info("%d steps of at most %d, at %.4g of %.4g s", steps, most, time, end)
