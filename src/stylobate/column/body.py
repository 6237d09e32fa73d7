"""The numbers of a standing body of revolution, and those that follow from them."""

from dataclasses import dataclass, replace
from typing import Annotated, Any, Self

import numpy as np

from stylobate.column.numbers import (
    STANDARD_GRAVITY,
    FrequencyScale,
    Gravity,
    Height,
    Mass,
    MassHeight,
    Radius,
    Slenderness,
)
from stylobate.column.profiles import Profile
from stylobate.elementwise import atan2, hypot, larger, sqrt
from stylobate.errors import ParameterError, as_float, require_positive
from stylobate.quantities import Declared, Quantity

# Points of the quadrature over a quarter cycle; its relative error is below 1e-10 up to 0.95 of the tipping angle.
_POINTS = 24

ROUNDING = 1e-12
"""Relative slack for bounds that an exact body meets with equality (a hoop, a rod) and rounding may miss."""


@dataclass(frozen=True, slots=True, kw_only=True)
class StandingBody(Declared):
    """A rigid body of revolution on a flat circular base: its numbers, checks and derived numbers, for `Column`."""

    radius: Radius
    mass_height: MassHeight
    mass: Mass
    transverse_inertia: Annotated[
        float,
        Quantity(
            symbol="I_t",
            unit="kg m²",
            text="moment of inertia about a horizontal axis through the centre of mass",
            gt=0.0,
            in_repr=False,
        ),
    ]
    axial_inertia: Annotated[
        float, Quantity(symbol="I_a", unit="kg m²", text="moment of inertia about the axis", gt=0.0, in_repr=False)
    ]
    height: Height | None = None
    gravity: Gravity = STANDARD_GRAVITY
    profile: Profile | None = None

    def validate(self) -> None:
        """Raise ParameterError if the centre of mass lies outside the body, or no body can have these inertias."""
        if self.axial_inertia > self._most_axial:
            raise ParameterError(
                f"axial_inertia must be at most twice transverse_inertia = {self.transverse_inertia!r} kg m² "
                f"for a body of revolution, got {self.axial_inertia!r} kg m²"
            )
        if self.height is None:
            return
        if self.mass_height >= self.height:
            raise ParameterError(
                f"mass_height must lie inside the body, below height = {self.height!r} m, got {self.mass_height!r} m"
            )
        if self._spread > self._most_spread * (1.0 + ROUNDING):
            raise ParameterError(
                f"transverse_inertia must be at most {self._most_spread + self.axial_inertia / 2.0!r} kg m² for a body "
                f"of height {self.height!r} m, got {self.transverse_inertia!r} kg m²"
            )

    @property
    def consistent(self) -> Any:
        """Whether `validate` accepts the numbers; of arrays, for each column."""
        fits = self.axial_inertia <= self._most_axial
        if self.height is None:
            return fits
        inside = self.mass_height < self.height
        return fits & inside & (self._spread <= self._most_spread * (1.0 + ROUNDING))

    @property
    def _most_axial(self) -> float:
        # I_t = I_a/2 + ∫ z² dm for every body of revolution, z from the centre of mass.
        return 2.0 * self.transverse_inertia * (1.0 + ROUNDING)

    @property
    def _spread(self) -> float:
        """∫ z² dm along the axis, z from the centre of mass."""
        return self.transverse_inertia - self.axial_inertia / 2.0

    @property
    def _most_spread(self) -> float:
        """Spread of two points at the ends: no distribution of mass over 0…H with its mean at h has more."""
        assert self.height is not None
        return self.mass * self.mass_height * (self.height - self.mass_height)

    def with_slenderness(self, slenderness: float) -> Self:
        """Copy the column with the base radius that gives c = r/h = `slenderness`.

        Height of the centre of mass, mass and transverse inertia are kept; the axial inertia is proportional to r².
        """
        numbers = self.numbers_at_slenderness(require_positive("slenderness", slenderness))
        return replace(self, **numbers, profile=self._profile_scaled(radius=numbers["radius"] / self.radius))

    def _profile_scaled(self, **factors: float) -> Profile | None:
        return None if self.profile is None else self.profile.scaled(**factors)

    def numbers_at_slenderness(self, slenderness: Any) -> dict[str, Any]:
        """Return the numbers that change with the slenderness, a number or an array."""
        radius = slenderness * self.mass_height
        ratio = radius / self.radius
        return {"radius": radius, "axial_inertia": self.axial_inertia * (ratio * ratio)}

    def resized(self, size: float) -> Self:
        """Copy the column at the same shape and density, with all lengths times `size`."""
        numbers = self.numbers_at_size(require_positive("size", size))
        return replace(self, **numbers, profile=self._profile_scaled(height=size, radius=size))

    def numbers_at_size(self, size: Any) -> dict[str, Any]:
        """Return the numbers that change with all lengths times `size`, a number or an array."""
        cube = size * size * size
        fifth = cube * size * size
        return {
            "radius": size * self.radius,
            "mass_height": size * self.mass_height,
            "mass": cube * self.mass,
            "transverse_inertia": fifth * self.transverse_inertia,
            "axial_inertia": fifth * self.axial_inertia,
            "height": None if self.height is None else size * self.height,
        }

    @property
    def slenderness(self) -> Slenderness:
        """c = r/h, the tipping angle of the small-angle models."""
        return self.radius / self.mass_height

    @property
    def base_inertia(self) -> float:
        """J0 = I_t + m h², about a diameter of the base [kg m²]."""
        return self.transverse_inertia + self.mass * (self.mass_height * self.mass_height)

    @property
    def rim_inertia(self) -> float:
        """K = I_t + m (h² + r²), about a tangent of the rim [kg m²]."""
        return self.base_inertia + self.mass * (self.radius * self.radius)

    @property
    def inertia_ratio(self) -> float:
        """κ = m h²/J0, between 0 and 1."""
        return self.mass * (self.mass_height * self.mass_height) / self.base_inertia

    @property
    def axial_ratio(self) -> float:
        """i_a = I_a/(m r²)."""
        return self.axial_inertia / (self.mass * (self.radius * self.radius))

    @property
    def frequency_scale(self) -> FrequencyScale:
        """ω0 = √(m g h/J0), the unit of dimensionless frequency [rad/s]."""
        return sqrt(self.mass * self.gravity * self.mass_height / self.base_inertia)

    @property
    def tipping_angle(
        self,
    ) -> Annotated[float, Quantity(symbol="α_c", unit="rad", text="angle of static tipping", in_repr=False)]:
        """α_c = atan(r/h), the angle of static tipping of the rocking-block literature [rad]."""
        return atan2(self.radius, self.mass_height)

    @property
    def rim_distance(self) -> float:
        """R = √(h² + r²), from the centre of mass to the rim: the size parameter of the literature [m]."""
        return hypot(self.mass_height, self.radius)

    @property
    def frequency_parameter(
        self,
    ) -> Annotated[float, Quantity(symbol="p", unit="rad/s", text="√(m g R/K) of the rocking block", in_repr=False)]:
        """p = √(m g R/K) of the rocking-block literature [rad/s]."""
        return sqrt(self.mass * self.gravity * self.rim_distance / self.rim_inertia)

    @property
    def housner_restitution(self) -> float:
        """Housner's e = 1 − 2 m r²/K, the ratio of rocking rates after and before a planar impact; 0 if negative."""
        return larger(0.0, 1.0 - 2.0 * self.mass * (self.radius * self.radius) / self.rim_inertia)

    def housner_damping(self, amplitude: float = 0.5) -> float:
        """Compute the viscous damping that loses as much energy per cycle of planar rocking as Housner's impacts.

        Parameters
        ----------
        amplitude
            Peak tilt over the tipping angle, between 0 and 1.

        Returns
        -------
        float
            Damping η of the models at finite tilt. It decreases with the amplitude.

        Raises
        ------
        ParameterError
            If `amplitude` is not between 0 and 1.

        See Also
        --------
        stylobate.theory.equivalent_viscous_damping : the limit of a slender column, for any restitution.

        Notes
        -----
        A yardstick for levels of damping, and no measured value: a column in three dimensions seldom has an impact. In
        units of J0 and ω0, free rocking from the tilt A has the energy U(A) = c sin A − (1 − cos A) and the rate θ̇² =
        2[U(A) − U(θ)]/K. An impact loses (1 − e²) U(A); damping loses 2ηS in the same half cycle, S = ∫₀^A θ̇ dθ:

            η = (1 − e²) U(A)/(2S).

        Examples
        --------
        >>> import stylobate as sb
        >>> column = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
        >>> [round(column.housner_damping(amplitude), 3) for amplitude in (0.25, 0.5, 0.75)]
        [0.117, 0.08, 0.064]
        """
        if not 0.0 < as_float("amplitude", amplitude) < 1.0:
            raise ParameterError(f"amplitude: must lie between 0 and 1 (got {amplitude!r}). Give it in tipping angles.")
        points, weights = np.polynomial.legendre.leggauss(_POINTS)
        root = np.append(0.5 + 0.5 * points, 0.0)
        peak = amplitude * self.tipping_angle
        tilt = peak * (1.0 - root**2)  # the integrand is smooth in the root
        *energy, highest = self.slenderness * np.sin(tilt) - 2.0 * np.sin(0.5 * tilt) ** 2  # U
        rate = np.sqrt(2.0 * (highest - energy) * self.base_inertia / self.rim_inertia)
        action = peak * float(np.sum(weights * rate * root[:-1]))  # S
        return float((1.0 - self.housner_restitution**2) * highest / (2.0 * action))
