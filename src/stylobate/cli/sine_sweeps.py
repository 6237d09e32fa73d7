"""The declared numbers of sine sweeps, for their options."""

from typing import Annotated, Any

from stylobate.base_motions.numbers import Acceleration, Direction, Start, StartPhase, VerticalRatio
from stylobate.quantities import Quantity


def sine_sweep(
    *,
    acceleration: Acceleration | None = None,
    displacement: Annotated[float, Quantity(unit="m", text="amplitude of the displacement")] | None = None,
    frequencies: Annotated[tuple[float, float], Quantity(unit="Hz", text="first and last frequency", components=2)],
    length: Annotated[float, Quantity(unit="s", text="length", gt=0.0)],
    direction: Direction = 0.0,
    start_phase: StartPhase = 0.0,
    start: Start = 0.0,
    vertical: VerticalRatio = 0.0,
) -> Any:
    """Declare the numbers of `SineSweep.linear` and `SineSweep.logarithmic`."""
