"""Levels of damping beside Housner's: the viscous damping that loses as much as planar impacts of the column."""

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from stylobate.column import Column

AMPLITUDES = {0.25: "¼", 0.5: "½", 0.75: "¾"}
"""Peak tilts of the yardstick, in tipping angles α_c."""

# Parameters that a planar cycle does not distinguish from damping alone; others lose energy beside it.
_COMPARED = {"damping", "spin_damping"}


def damping_yardstick(column: "Column") -> dict[float, float]:
    """Compute Housner's damping of a column at each of the `AMPLITUDES`; it falls as they rise."""
    return {amplitude: column.housner_damping(amplitude) for amplitude in AMPLITUDES}


def yardstick_text(values: Iterable[float]) -> str:
    """Write the values of Housner's damping at the `AMPLITUDES` in a line.

    >>> yardstick_text([0.1173, 0.0802, 0.0641])
    'η = 0.12, 0.08, 0.064 at a peak tilt of ¼, ½, ¾ α_c'
    """
    written = ", ".join(f"{value:.2g}" for value in values)
    return f"η = {written} at a peak tilt of {', '.join(AMPLITUDES.values())} α_c"


def side_of_yardstick(
    column: "Column", levels: Iterable[Mapping[str, float]]
) -> Literal["below", "above", "among", "not compared"]:
    """Determine on which side of Housner's damping a set of levels of dissipation lies.

    Parameters
    ----------
    column
        The column.
    levels
        Dissipation parameters of each level, by name.

    Returns
    -------
    str
        "below" if the damping of every level is below the yardstick at all amplitudes, "above" if it is above, "among"
        otherwise; "not compared" if a level has no damping, or loses energy by rolling resistance or restitution too.
    """
    given = list(levels)
    if not given or any("damping" not in one or not _COMPARED.issuperset(one) for one in given):
        return "not compared"
    dampings, yardstick = [one["damping"] for one in given], damping_yardstick(column).values()
    if max(dampings) < min(yardstick):
        return "below"
    return "above" if min(dampings) > max(yardstick) else "among"
