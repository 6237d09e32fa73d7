"""Base classes of models whose state is the tilt vector and its rate, x, y, vx, vy, and optionally a spin."""

from typing import Any, ClassVar

from stylobate.models.model import Model

LEAN = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")
"""Names of these states."""


def tilt_of(x: Any, y: Any, vx: Any, vy: Any, *_: Any) -> tuple[Any, Any, Any, Any]:
    """Return the tilt vector and its rate: the state itself."""
    return x, y, vx, vy


def from_plane(tilt: Any, rate: Any, ux: float, uy: float, *_: float) -> tuple[Any, ...]:
    """Return the state of a motion along the unit vector (ux, uy)."""
    return tilt * ux, tilt * uy, rate * ux, rate * uy


def from_plane_without_spin(tilt: Any, rate: Any, ux: float, uy: float, *_: float) -> tuple[Any, ...]:
    """Return the state of a motion along the unit vector (ux, uy), with zero spin."""
    return tilt * ux, tilt * uy, rate * ux, rate * uy, 0.0 * tilt


class TiltVectorModel(Model):
    """A model whose state is the tilt vector and its rate."""

    __slots__ = ()

    state_names: ClassVar[tuple[str, ...]] = LEAN

    tilt_of = staticmethod(tilt_of)
    from_plane = staticmethod(from_plane)

    def start(self, tilt: tuple[float, float], tilt_rate: tuple[float, float]) -> tuple[float, ...]:
        """Return the state with this tilt vector [rad] and its rate [rad/s]."""
        scale = self.time_scale
        return tilt[0], tilt[1], tilt_rate[0] * scale, tilt_rate[1] * scale


class SpinningModel(TiltVectorModel):
    """A model with the spin as its fifth state."""

    __slots__ = ()

    state_names: ClassVar[tuple[str, ...]] = (*LEAN, "spin")
    spin_state: ClassVar[int | None] = len(LEAN)

    from_plane = staticmethod(from_plane_without_spin)

    def start(self, tilt: tuple[float, float], tilt_rate: tuple[float, float]) -> tuple[float, ...]:
        """Return the state with this tilt vector [rad] and its rate [rad/s], without spin."""
        return *TiltVectorModel.start(self, tilt, tilt_rate), 0.0 * tilt[0]
