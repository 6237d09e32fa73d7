"""Rigid column of any proportions: shape, inertia over J0, and geometry on its rim.

Moments of inertia are over J0, the moment about a diameter of the base, and lengths over the height h of the centre of
mass; gravity, m g h over J0 ω0², is then 1.
"""

from dataclasses import dataclass
from typing import Any, Self, TypeAlias

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError
from stylobate.theory.arguments import FloatArray, Real, positive

Numbers: TypeAlias = npt.NDArray[Any]
"""Real numbers, or complex numbers of a complex-step derivative."""

# Relative tolerance of the bound on the inertias, which rounding may violate at equality.
_ROUNDING = 1e-12


@dataclass(frozen=True, slots=True, kw_only=True)
class RigidBody:
    """Slenderness and inertia ratios of a rigid column of revolution, arrays of one shape.

    Parameters
    ----------
    c
        Slenderness r/h.
    kappa
        κ = m h²/J0.
    axial_ratio
        i_a = I_a/(m r²).
    """

    c: FloatArray
    kappa: FloatArray
    axial_ratio: FloatArray

    @classmethod
    def checked(cls, c: Real, inertia_ratio: Real, axial_ratio: Real) -> Self:
        """Return the body, or raise ParameterError if no body of revolution can have these numbers."""
        slender, kappa, axial = np.broadcast_arrays(
            positive("c", c), below_one("inertia_ratio", inertia_ratio), positive("axial_ratio", axial_ratio)
        )
        body = cls(c=slender, kappa=kappa, axial_ratio=axial)
        bad = body.axial > 2.0 * body.transverse * (1.0 + _ROUNDING)
        if bad.any():
            radius, ratio, given = (float(number[bad][0]) for number in (slender, kappa, axial))
            message = (
                f"axial_ratio must be at most {2.0 * (1.0 - ratio) / (ratio * radius**2)!r} for a body of revolution "
                f"with c = {radius!r} and inertia_ratio = {ratio!r}, got {given!r}"
            )
            raise ParameterError(message)
        return body

    def __getitem__(self, cells: Any) -> "RigidBody":
        return RigidBody(c=self.c[cells], kappa=self.kappa[cells], axial_ratio=self.axial_ratio[cells])

    @property
    def transverse(self) -> FloatArray:
        """I_t about the centre of mass."""
        return 1.0 - self.kappa

    @property
    def axial(self) -> FloatArray:
        """I_a."""
        return self.kappa * self.axial_ratio * self.c**2

    @property
    def rim(self) -> FloatArray:
        """K about a tangent of the rim."""
        return 1.0 + self.kappa * self.c**2

    @property
    def freedom(self) -> FloatArray:
        """D = 1 + i_a − κ, by which free spin reduces the effect of forces across the lean."""
        return 1.0 + self.axial_ratio - self.kappa

    def reach(self, tilt: Numbers) -> Numbers:
        """Compute ρ/h, the horizontal distance of the centre of mass from the axis of the column at rest."""
        return np.sin(tilt) + self.c * (1.0 - np.cos(tilt))

    def height(self, tilt: Numbers) -> Numbers:
        """Compute ρ'/h = z/h, the height of the centre of mass."""
        return np.cos(tilt) + self.c * np.sin(tilt)

    def overhang(self, tilt: Numbers) -> Numbers:
        """Compute −z'/h, the overhang of the centre of mass over the contact point; negative below α_c."""
        return np.sin(tilt) - self.c * np.cos(tilt)


def below_one(name: str, value: Real) -> FloatArray:
    """Return `value` as an array of floats, or raise ParameterError unless all lie in (0, 1)."""
    array = positive(name, value)
    if np.any(array >= 1.0):
        message = f"{name} = m h²/J0 must be below 1, got {float(np.max(array))!r}"
        raise ParameterError(message)
    return array
