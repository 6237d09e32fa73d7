"""The column: a rigid body of revolution that stands free on its flat circular base."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import Annotated, Any, Literal, Self

import numpy as np

from stylobate.elementwise import atan2, hypot, larger, sqrt
from stylobate.errors import ParameterError, as_float, require_not_negative, require_positive
from stylobate.liquids import TankLiquid, point_mass
from stylobate.mass_properties import MassProperties, circumscribed_radius, inscribed_radius, joined, prism
from stylobate.quantities import Declared, Quantity, checked_arguments, question_input

STANDARD_GRAVITY = 9.80665
"""Standard gravity [m/s²]."""

# Points of the quadrature over a quarter cycle; its relative error is below 1e-10 up to 0.95 of the tipping angle.
_POINTS = 24

# Relative slack for bounds that an exact body meets with equality (a hoop, a rod) and rounding may miss.
_ROUNDING = 1e-12

_LIGHTEST, _DENSEST = 10.0, 25_000.0

# Beyond the towers and tanks that exist; the tower of Pisa has a radius of 7.8 m and a height of 57 m.
Radius = Annotated[float, Quantity(symbol="r", unit="m", text="radius of the base", gt=0.0, unlikely_above=25.0)]
Height = Annotated[float, Quantity(symbol="H", unit="m", text="height of the body", gt=0.0, unlikely_above=150.0)]
Mass = Annotated[float, Quantity(symbol="m", unit="kg", text="mass", gt=0.0)]
# From light foam to osmium.
Density = Annotated[
    float,
    Quantity(symbol="ρ", unit="kg/m³", text="density", gt=0.0, unlikely_above=_DENSEST, unlikely_below=_LIGHTEST),
]
Gravity = Annotated[
    float, Quantity(symbol="g", unit="m/s²", text="acceleration of gravity", gt=0.0, slider=(0.5, 15.0))
]

Sides = Annotated[int, Quantity(symbol="n", text="number of sides", ge=3, le=1000, whole=True)]
Side = Annotated[float, Quantity(symbol="b", unit="m", text="length of a side", gt=0.0, unlikely_above=50.0)]
Circle = Annotated[Literal["inscribed", "circumscribed"], Quantity(text="circle in place of the polygon")]
WallThickness = Annotated[float, Quantity(unit="m", text="thickness of the wall", gt=0.0)]
FloorThickness = Annotated[float, Quantity(unit="m", text="thickness of the floor", gt=0.0)]
LiquidDepth = Annotated[float, Quantity(symbol="H_l", unit="m", text="depth of the liquid", gt=0.0)]
Liquid = Annotated[Literal["frozen", "impulsive", "level"], Quantity(text="motion of the liquid")]

TopRadius = Annotated[float, Quantity(symbol="r_t", unit="m", text="radius of the top", gt=0.0)]
MassHeight = Annotated[float, Quantity(symbol="h", unit="m", text="height of the centre of mass", gt=0.0)]
FrequencyScale = Annotated[
    float, Quantity(symbol="ω0", unit="rad/s", text="√(m g h/J0), the unit of dimensionless frequency")
]
Slenderness = Annotated[float, Quantity(symbol="c", text="slenderness r/h", gt=0.0, slider=(0.02, 0.5))]


@dataclass(frozen=True, slots=True, kw_only=True)
class Column(Declared):
    """A rigid free-standing body of revolution on a flat circular base.

    Parameters
    ----------
    radius
        Base radius r [m].
    mass_height
        Height h of the centre of mass above the base [m].
    mass
        Mass m [kg].
    transverse_inertia
        Moment of inertia I_t about a horizontal axis through the centre of mass [kg m²].
    axial_inertia
        Moment of inertia I_a about the axis of the column [kg m²].
    height
        Height of the whole body [m], if known. It bounds the other numbers and serves drawings.
    gravity
        Acceleration of gravity g [m/s²].

    Raises
    ------
    ParameterError
        If a length, mass or inertia is not finite and positive, if the centre of mass lies outside the body,
        or if no body can have these inertias.

    Examples
    --------
    >>> column = Column.solid(radius=0.5, height=10.0, density=2700.0)
    >>> round(column.slenderness, 3), round(column.inertia_ratio, 4), round(column.frequency_scale, 4)
    (0.1, 0.7486, 1.2117)
    """

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
        if self._spread > self._most_spread * (1.0 + _ROUNDING):
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
        return fits & inside & (self._spread <= self._most_spread * (1.0 + _ROUNDING))

    @property
    def _most_axial(self) -> float:
        # I_t = I_a/2 + ∫ z² dm for every body of revolution, z from the centre of mass.
        return 2.0 * self.transverse_inertia * (1.0 + _ROUNDING)

    @property
    def _spread(self) -> float:
        """∫ z² dm along the axis, z from the centre of mass."""
        return self.transverse_inertia - self.axial_inertia / 2.0

    @property
    def _most_spread(self) -> float:
        """Spread of two points at the ends: no distribution of mass over 0…H with its mean at h has more."""
        assert self.height is not None
        return self.mass * self.mass_height * (self.height - self.mass_height)

    @classmethod
    @checked_arguments
    def solid(
        cls,
        *,
        radius: Radius,
        height: Height,
        density: Density | None = None,
        mass: Mass | None = None,
        gravity: Gravity = STANDARD_GRAVITY,
    ) -> Self:
        """Describe a solid cylinder by `radius` [m], `height` [m], and either `density` [kg/m³] or `mass` [kg].

        Raises
        ------
        ParameterError
            If both density and mass are given, or neither.
        """
        density = _density(density, mass, math.pi * (radius * radius) * height)
        column = cls.frustum(radius=radius, top_radius=radius, height=height, density=density, gravity=gravity)
        return column if mass is None else replace(column, mass=mass)

    @classmethod
    @checked_arguments
    def hollow(
        cls,
        *,
        radius: Radius,
        inner_radius: Annotated[float, Quantity(symbol="r_i", unit="m", text="inner radius", gt=0.0)],
        height: Height,
        density: Density,
        gravity: Gravity = STANDARD_GRAVITY,
    ) -> Self:
        """Describe a tube by outer `radius` and `inner_radius` [m], `height` [m] and wall `density` [kg/m³].

        The tube tips over its outer rim, as a solid cylinder does.
        """
        if inner_radius >= radius:
            raise ParameterError(f"inner_radius must be below radius = {radius!r} m, got {inner_radius!r} m")
        mass = density * math.pi * (radius - inner_radius) * (radius + inner_radius) * height
        squares = radius * radius + inner_radius * inner_radius
        return cls(
            radius=radius,
            mass_height=height / 2.0,
            mass=mass,
            transverse_inertia=mass * (3.0 * squares + height * height) / 12.0,
            axial_inertia=mass * squares / 2.0,
            height=height,
            gravity=gravity,
        )

    @classmethod
    @checked_arguments
    def frustum(
        cls,
        *,
        radius: Radius,
        top_radius: TopRadius,
        height: Height,
        density: Density,
        gravity: Gravity = STANDARD_GRAVITY,
    ) -> Self:
        """Describe a solid frustum of a cone by base `radius`, `top_radius`, `height` [m] and `density` [kg/m³]."""
        a, b = radius, top_radius
        # Moments of the cross-section: ∫ R² zⁿ dz and ∫ R⁴ dz with R linear from a to b, z in heights.
        area = (a * a + a * b + b * b) / 3.0
        first = (a * a + 2.0 * a * b + 3.0 * b * b) / 12.0
        second = (a * a + 3.0 * a * b + 6.0 * b * b) / 30.0
        aa, ab, bb = a * a, a * b, b * b
        fourth = (aa * aa + aa * ab + aa * bb + ab * bb + bb * bb) / 5.0
        line_density = density * math.pi * height
        mass = line_density * area
        mass_height = height * first / area
        axial = line_density * fourth / 2.0
        about_base = axial / 2.0 + line_density * (height * height) * second
        return cls(
            radius=a,
            mass_height=mass_height,
            mass=mass,
            transverse_inertia=about_base - mass * (mass_height * mass_height),
            axial_inertia=axial,
            height=height,
            gravity=gravity,
        )

    @classmethod
    @checked_arguments
    def prism(
        cls,
        *,
        sides: Sides,
        side: Side,
        height: Height,
        density: Density | None = None,
        mass: Mass | None = None,
        circle: Circle = "inscribed",
        gravity: Gravity = STANDARD_GRAVITY,
    ) -> Self:
        """Describe a solid prism on a regular polygon of `sides` of length `side` [m] that stands on a circle.

        Mass and inertia are exact. Uplift and tipping angle of the inscribed circle are lower bounds of those of the
        polygon in every direction, those of the circumscribed circle upper bounds. Overturning has no such bound.

        Examples
        --------
        >>> pedestal = Column.prism(sides=4, side=0.5, height=1.2, density=2700.0)
        >>> round(pedestal.radius, 3), round(pedestal.mass, 3)
        (0.25, 810.0)
        """
        inner = inscribed_radius(sides, side)
        density = _density(density, mass, 0.5 * sides * side * inner * height)
        column = cls(
            radius=inner if circle == "inscribed" else circumscribed_radius(sides, side),
            **prism(sides, side, height, density)._asdict(),
            height=height,
            gravity=gravity,
        )
        return column if mass is None else replace(column, mass=mass)

    @classmethod
    @checked_arguments
    def from_parts(
        cls, parts: "Sequence[Column]", *, elevations: Sequence[float] | None = None, radius: Radius | None = None
    ) -> Self:
        """Join coaxial columns into one rigid body, such as a statue fixed to its plinth.

        Parameters
        ----------
        parts
            The columns, each with a height, from the bottom up.
        elevations
            Height of the base of each part above the floor [m]; by default each part stands on the part before it.
            Parts may overlap, as a core in a tube does.
        radius
            Radius of the circle on which the body stands [m]; by default the radius of the lowest part. State it for a
            body on feet or on a ring without mass, whose parts may all be above the floor.

        Raises
        ------
        ParameterError
            If there are no parts, if a part has no height or another gravity, if the elevations do not fit the parts,
            or if no part stands on the floor and no radius is given.

        Examples
        --------
        >>> plinth = Column.solid(radius=0.4, height=0.9, density=2300.0)
        >>> statue = Column.frustum(radius=0.25, top_radius=0.15, height=1.7, density=2700.0)
        >>> both = Column.from_parts([plinth, statue])
        >>> round(both.height, 2), round(both.mass_height, 2), round(both.slenderness, 2)
        (2.6, 0.87, 0.46)
        """
        bases = _bases_of(parts, elevations)
        lowest = min(range(len(parts)), key=bases.__getitem__)
        if radius is None and bases[lowest] > 0.0:
            raise ParameterError(
                f"elevations: no part stands on the floor (got {bases[lowest]!r} m for the lowest). "
                "Lower the parts, or state the radius of their feet."
            )
        return cls(
            radius=parts[lowest].radius if radius is None else radius,
            **joined(map(_at, bases, parts))._asdict(),
            height=max(base + float(one.height or 0.0) for base, one in zip(bases, parts, strict=True)),
            gravity=parts[0].gravity,
        )

    @classmethod
    @checked_arguments
    def tank(
        cls,
        *,
        radius: Radius,
        height: Height,
        wall_thickness: WallThickness,
        floor_thickness: FloorThickness | None = None,
        density: Density,
        liquid_depth: LiquidDepth,
        liquid_density: Density = 1000.0,
        liquid: Liquid = "frozen",
        gravity: Gravity = STANDARD_GRAVITY,
    ) -> Self:
        """Describe an open rigid tank with a flat floor and liquid as a rigid body, in one limit of its motion.

        The limit `liquid` is "frozen", liquid as a solid; "impulsive", for shaking much faster than the sloshing: the
        impulsive mass without the weight of the rest; or "level", for motion much slower than the sloshing: all liquid
        at its metacentre. No rigid body moves as a tank with liquid does: run all three. The floor is as thick as the
        wall unless stated; lengths are in m, densities in kg/m³. `stylobate.theory.TankLiquid` has the equations.
        """
        floor = wall_thickness if floor_thickness is None else floor_thickness
        inner = radius - wall_thickness
        if inner <= 0.0:
            raise ParameterError(f"wall_thickness: must be below the radius (got {wall_thickness!r} m). Reduce it.")
        if liquid_depth > height - floor:
            room = f"{height - floor:.6g} m"
            raise ParameterError(f"liquid_depth: must be at most {room} (got {liquid_depth!r} m). Reduce it.")
        plate = cls.solid(radius=inner, height=floor, density=density, gravity=gravity)
        wall = cls.hollow(radius=radius, inner_radius=inner, height=height, density=density, gravity=gravity)
        contents = cls.solid(radius=inner, height=liquid_depth, density=liquid_density, gravity=gravity)
        if liquid == "frozen":
            return cls.from_parts([wall, plate, contents], elevations=[0.0, 0.0, floor])
        moving = point_mass(TankLiquid(radius=inner, depth=liquid_depth, gravity=gravity), contents.mass, liquid)
        whole = joined([_at(0.0, wall), _at(0.0, plate), moving.raised(floor)])
        return cls(radius=radius, **whole._asdict(), height=height, gravity=gravity)

    @classmethod
    def dimensionless(
        cls,
        slenderness: Slenderness,
        inertia_ratio: Annotated[float, Quantity(symbol="κ", text="m h²/J0", gt=0.0, slider=(0.3, 0.95))] = 0.75,
        axial_ratio: Annotated[float, Quantity(symbol="i_a", text="I_a/(m r²)", gt=0.0, slider=(0.1, 1.0))] = 0.5,
    ) -> Self:
        """Describe a column with m = g = ω0 = 1: its SI numbers are the numbers of the dimensionless equations.

        Parameters
        ----------
        slenderness
            c = r/h.
        inertia_ratio
            κ = m h²/J0, below 1; ¾ is the slender solid cylinder.
        axial_ratio
            I_a/(m r²); ½ is the solid cylinder.

        Returns
        -------
        Column
            With h = κ, r = cκ and J0 = κ.

        Raises
        ------
        ParameterError
            If a ratio is out of range, or no body of revolution has these ratios.
        """
        c = require_positive("slenderness", slenderness)
        ratio = require_positive("inertia_ratio", inertia_ratio)
        axial_ratio = require_positive("axial_ratio", axial_ratio)
        if ratio >= 1.0:
            raise ParameterError(f"inertia_ratio must be below 1 (a point mass has 1), got {inertia_ratio!r}")
        radius = c * ratio
        # I_a ≤ 2 I_t with I_t = κ(1 − κ), I_a = axial_ratio (cκ)².
        most = 2.0 * (1.0 - ratio) / (c**2 * ratio)
        if axial_ratio > most * (1.0 + _ROUNDING):
            raise ParameterError(
                f"axial_ratio must be at most {most!r} for a body of revolution with slenderness {c!r} and "
                f"inertia_ratio {ratio!r}, got {axial_ratio!r}"
            )
        return cls(
            radius=radius,
            mass_height=ratio,
            mass=1.0,
            transverse_inertia=ratio * (1.0 - ratio),
            axial_inertia=axial_ratio * (radius * radius),
            gravity=1.0,
        )

    def with_slenderness(self, slenderness: float) -> Self:
        """Copy the column with the base radius that gives c = r/h = `slenderness`.

        Height of the centre of mass, mass and transverse inertia are kept; the axial inertia is proportional to r².
        """
        return replace(self, **self.numbers_at_slenderness(require_positive("slenderness", slenderness)))

    def numbers_at_slenderness(self, slenderness: Any) -> dict[str, Any]:
        """Return the numbers that change with the slenderness, a number or an array."""
        radius = slenderness * self.mass_height
        ratio = radius / self.radius
        return {"radius": radius, "axial_inertia": self.axial_inertia * (ratio * ratio)}

    def resized(self, size: float) -> Self:
        """Copy the column at the same shape and density, with all lengths times `size`."""
        return replace(self, **self.numbers_at_size(require_positive("size", size)))

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
        >>> column = Column.solid(radius=0.3, height=3.0, density=2700.0)
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


def _at(elevation: float, one: Column) -> MassProperties:
    """Return the mass properties of a column whose base is at an `elevation` [m]."""
    return MassProperties(one.mass, elevation + one.mass_height, one.transverse_inertia, one.axial_inertia)


def _bases_of(parts: Sequence[Column], elevations: Sequence[float] | None) -> list[float]:
    """Return the heights of the bases of the parts of a body; raise ParameterError if the parts do not fit together."""
    if not parts:
        raise ParameterError("parts: a body needs at least one part (got none). State its columns from the bottom up.")
    for place, one in enumerate(parts):
        if not isinstance(one, Column):
            raise ParameterError(
                f"parts[{place}]: must be a column (got {one!r}). Describe it by Column.solid or another."
            )
        if one.height is None:
            raise ParameterError(f"parts[{place}]: has no height (got {one!r}). State the height of the part.")
        if one.gravity != parts[0].gravity:
            raise ParameterError(
                f"parts[{place}]: gravity differs from that of the first part (got {one.gravity!r} m/s², not "
                f"{parts[0].gravity!r} m/s²). Use the same gravity for all parts."
            )
    if elevations is None:
        return list(accumulate((float(one.height or 0.0) for one in parts[:-1]), initial=0.0))
    if len(elevations) != len(parts):
        raise ParameterError(
            f"elevations: must have one number for each of {len(parts)} parts (got {len(elevations)}). State all."
        )
    return [require_not_negative(f"elevations[{place}]", one, "m") for place, one in enumerate(elevations)]


def _density(density: float | None, mass: float | None, volume: float) -> float:
    """Return the density of a solid body that states either its density or its mass."""
    if (density is None) == (mass is None):
        got = "neither" if density is None else f"{density!r} kg/m³ and {mass!r} kg"
        raise ParameterError(f"density or mass: a solid column needs one of them (got {got}). State one.")
    if density is not None:
        return density
    assert mass is not None
    density = mass / volume
    if not _LIGHTEST <= density <= _DENSEST:
        question_input(
            f"mass: {mass:.6g} kg is unlikely, with a density of {density:.4g} kg/m³. "
            "Check its unit, such as g, kg or t, and those of radius and height."
        )
    return density


SHAPES: Mapping[str, Callable[..., Column]] = {
    "solid": Column.solid,
    "hollow": Column.hollow,
    "frustum": Column.frustum,
    "dimensionless": Column.dimensionless,
    "given": Column,
}
"""The ways to describe a column, by their name in files and on the command line."""

SHAPES_IN_FILES: Mapping[str, Callable[..., Column]] = {
    "prism": Column.prism,
    "tank": Column.tank,
    "parts": Column.from_parts,
}
"""Further ways to describe a column in files; the command line and the laboratory have no options for them."""
