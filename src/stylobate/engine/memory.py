"""Memory limit of results: a request that does not fit is refused before the computation."""

import math
import os
import sys

from stylobate.errors import ParameterError


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
        message = (
            f"the results of {runs:.6g} runs take {size / _GIB:.3g} GiB of memory, of which this machine has "
            f"{there / _GIB:.3g} GiB. {remedy}."
        )
        raise ParameterError(message)


_GIB = 2.0**30
