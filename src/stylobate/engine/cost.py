"""Cost of runs: expected steps, progress and memory."""

import logging
import math
import os
import sys

from stylobate.errors import ParameterError
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


def memory_of_the_machine() -> float:
    """Return the physical memory of this machine [bytes]; infinite if the system does not report it.

    The limit of a container may be lower.
    """
    if sys.platform == "win32":
        return math.inf
    try:
        return float(os.sysconf("SC_PAGE_SIZE")) * float(os.sysconf("SC_PHYS_PAGES"))
    except (OSError, ValueError):
        return math.inf


def require_memory(size: float, runs: int, remedy: str) -> None:
    """Refuse results that memory cannot hold.

    Parameters
    ----------
    size
        Size of the results [bytes].
    runs
        Number of runs.
    remedy
        Remedy in the message, as an imperative.

    Raises
    ------
    ParameterError
        If the machine has less memory than `size`.
    """
    there = memory_of_the_machine()
    if size > there:
        raise ParameterError(
            f"the results of {runs:.6g} runs take {size / _GIB:.3g} GiB of memory, of which this machine has "
            f"{there / _GIB:.3g} GiB. {remedy}."
        )


_GIB = 2.0**30
