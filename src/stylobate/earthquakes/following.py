"""The free-vibration time after a record, in which the outcome is decided."""

from stylobate.column import Column
from stylobate.errors import require_not_negative
from stylobate.run_arguments import FREE_TAIL


def tail_of(column: Column, tail: float | None = None) -> float:
    """Return the free-vibration time of `column` after the end of a record [s]: `tail`, or by default 20/p.

    Near the unstable equilibrium at the tilt α_c a deviation grows as exp(pt), p = √(m g R/K): by 5·10⁸ in 20/p. So
    only a column that the record left within about 10⁻⁸ α_c of this equilibrium is still undecided after 20/p.

    Raises
    ------
    ParameterError
        If `tail` is negative.
    """
    return FREE_TAIL / column.frequency_parameter if tail is None else require_not_negative("tail", tail, "s")
