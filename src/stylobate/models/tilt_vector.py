"""What models share whose state begins with the tilt vector and its rate: x, y, vx, vy, and perhaps a spin."""

from typing import Any


def tilt_of(x: Any, y: Any, vx: Any, vy: Any, *_: Any) -> tuple[Any, Any, Any, Any]:
    """Return the tilt vector and its rate: the state itself."""
    return x, y, vx, vy


def from_plane(tilt: Any, rate: Any, ux: float, uy: float, *_: float) -> tuple[Any, Any, Any, Any]:
    """Return the state of a motion along the unit vector (ux, uy)."""
    return tilt * ux, tilt * uy, rate * ux, rate * uy


def from_plane_without_spin(tilt: Any, rate: Any, ux: float, uy: float, *_: float) -> tuple[Any, Any, Any, Any, Any]:
    """Return the same with a spin behind it, which there is none of in a plane."""
    return tilt * ux, tilt * uy, rate * ux, rate * uy, 0.0 * tilt
