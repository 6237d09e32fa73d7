"""The free-vibration time after a record, in which the outcome is decided."""

from stylobate.column import Column
from stylobate.config.simulation import FREE_TAIL
from stylobate.errors import require_not_negative


def tail_of(column: Column, tail: float | None = None) -> float:
    """Return for how long `column` is followed after the end of a record [s]: `tail`, or by default 20/p.

    Near the unstable equilibrium at the tilt α a deviation grows as exp(pt), p = √(m g R/K): in 20/p by 5·10⁸. So a
    column that the record left nearer to overturning than one that has not decided by then is one in 10⁸.

    Raises
    ------
    ParameterError
        If `tail` is negative.
    """
    return FREE_TAIL / column.frequency_parameter if tail is None else require_not_negative("tail", tail, "s")
