"""Names that the integration of a flow leaves open: each flow binds them to a model."""

from collections.abc import Callable

from stylobate.compiler.programs import placeholders

ORDER: int
"""Number of equations."""
COLUMNS: int
"""Number of columns of state and derivatives: at least `ORDER` + 2, in whole vectors."""
ACCELERATIONS: int
"""Number of acceleration components: three, or two (along the plane and vertical) if planar."""
NUMBERS: int
"""Number of parameters of the model."""
PLANAR: bool
LOSES: bool
"""Whether a planar passage through the vertical loses energy."""

rates: Callable[..., tuple[float, ...]]
tilt_of: Callable[..., tuple[float, float, float, float]]
from_plane: Callable[..., tuple[float, ...]]
impact_map: Callable[..., tuple[float, ...]]
"""The model's functions: see `Model`."""
jacobian: Callable[..., tuple[tuple[float, ...], ...]]
"""Derivatives of each rate with respect to states, accelerations and parameters, of the model or from its equations."""

__getattr__ = placeholders(__name__, __annotations__)
