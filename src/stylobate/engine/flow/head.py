"""What the head of a flow's module defines, for reading its text by itself; `modules` writes the real one."""

from collections.abc import Callable

ORDER: int
"""Number of equations."""
ACCELERATIONS: int
"""Three of the base in space; along the plane and vertically in a plane."""
NUMBERS: int
"""Parameters of the model."""
PLANAR: bool

rates_into: Callable[..., None]
jacobian_into: Callable[..., None]
speed_left: Callable[..., float]
"""(rate, parameters) → the rate of a tilt in a plane after a passage of the upright."""
lean_of: Callable[..., tuple[float, float, float, float]]
"""(state, parameters) → the tilt vector and its rate."""
