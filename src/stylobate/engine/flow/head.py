"""Declarations of the names that the head of a flow module defines; `modules` writes the real head."""

from collections.abc import Callable

ORDER: int
"""Number of equations."""
ACCELERATIONS: int
"""Number of acceleration components: three, or two (along the plane and vertical) if planar."""
NUMBERS: int
"""Number of parameters of the model."""
PLANAR: bool

rates_into: Callable[..., None]
jacobian_into: Callable[..., None]
speed_after_passage: Callable[..., float]
"""(rate, parameters) → tilt rate after a planar passage through the vertical."""
lean_of: Callable[..., tuple[float, float, float, float]]
"""(state, parameters) → tilt vector and its rate."""
