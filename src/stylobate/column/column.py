"""The column: a rigid body of revolution that stands free on its flat circular base, by named constructors."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate
from typing import Annotated, Self

from stylobate.column.body import ROUNDING, StandingBody
from stylobate.column.numbers import (
    DENSEST,
    LIGHTEST,
    STANDARD_GRAVITY,
    Circle,
    Density,
    FloorThickness,
    Gravity,
    Height,
    Liquid,
    LiquidDepth,
    Mass,
    MassHeight,
    Radius,
    Side,
    Sides,
    Slenderness,
    TopRadius,
    WallThickness,
)
from stylobate.column.profiles import InertiaSpread, MaxRadius, Profile, ProfileLabel, ProfileName, drawn, estimate
from stylobate.errors import ParameterError, require_not_negative, require_positive
from stylobate.liquids import TankLiquid, point_mass
from stylobate.mass_properties import MassProperties, circumscribed_radius, frustums, inscribed_radius, joined, prism
from stylobate.quantities import Quantity, checked_arguments, question_input


@dataclass(frozen=True, slots=True, kw_only=True)
class Column(StandingBody):
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
    profile
        Outline for drawings, and the spread of estimated moments of inertia; `estimated` and `from_profile` state it.

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
        whole = joined(map(_at, bases, parts))
        if radius is None and bases[lowest] > 0.0:
            raise ParameterError(
                f"elevations: no part stands on the floor (got {bases[lowest]!r} m for the lowest). "
                "Lower the parts, or state the radius of their feet."
            )
        return cls(
            radius=parts[lowest].radius if radius is None else radius,
            **whole._asdict(),
            height=max(base + float(one.height or 0.0) for base, one in zip(bases, parts, strict=True)),
            gravity=parts[0].gravity,
            profile=_spread_of(parts, whole),
        )

    @classmethod
    @checked_arguments
    def estimated(
        cls,
        *,
        radius: Radius,
        height: Height,
        mass_height: MassHeight,
        mass: Mass,
        profile: ProfileName,
        max_radius: MaxRadius | None = None,
        inertia_spread: InertiaSpread | None = None,
        gravity: Gravity = STANDARD_GRAVITY,
    ) -> Self:
        """Describe an object by foot, height, centre of mass and mass; its moments of inertia are estimated.

        Parameters
        ----------
        radius, height, mass_height, mass, gravity
            As of a column [m, kg, m/s²]; `radius` is that of the foot.
        profile
            Kind of profile: "cylinder", "cone", "vase", "amphora", "bottle", "statue" or "bust".
        max_radius
            Largest radius [m], such as that of the belly. It makes the moment about the axis far surer.
        inertia_spread
            Relative standard deviation of the transverse moment of inertia; by default 0.1. Verdicts, assessments and
            inventories vary both moments by their spreads; 0 states that they are certain.

        Raises
        ------
        ParameterError
            If the centre of mass lies outside the body, or the largest radius does not suit the profile.

        Warns
        -----
        UnlikelyInputWarning
            If the centre of mass is far from that of the profile.

        Examples
        --------
        >>> amphora = Column.estimated(radius=0.11, height=0.95, mass_height=0.52, mass=14.0, profile="amphora")
        >>> print(f"{amphora.transverse_inertia:.2f} kg m², {amphora.profile}")
        1.00 kg m², 'amphora' (inertia estimated, ±10 %, about the axis ±35 %)
        """
        found = estimate(
            profile,
            radius=radius,
            height=height,
            mass_height=mass_height,
            max_radius=max_radius,
            spread=inertia_spread,
        )
        outline = found.profile
        _question_density(mass, math.fsum(one.of_density(1.0).mass for one in frustums(outline.heights, outline.radii)))
        return cls(
            radius=radius,
            mass_height=mass_height,
            mass=mass,
            transverse_inertia=mass * found.transverse,
            axial_inertia=mass * found.axial,
            height=height,
            gravity=gravity,
            profile=found.profile,
        )

    @classmethod
    @checked_arguments
    def from_profile(
        cls,
        heights: Sequence[float],
        radii: Sequence[float],
        *,
        inner_radii: Sequence[float] | None = None,
        wall_thickness: WallThickness | None = None,
        floor_thickness: FloorThickness | None = None,
        density: Density | None = None,
        mass: Mass | None = None,
        gravity: Gravity = STANDARD_GRAVITY,
        profile: ProfileLabel = "",
    ) -> Self:
        """Describe a body of revolution by its drawn profile, straight between its corners; it is computed exactly.

        Parameters
        ----------
        heights
            Heights of the corners from the base up [m]; the first is that of the floor. Two corners at one height are
            a step.
        radii
            Outer radii there [m]. The body stands on the largest one at the floor.
        inner_radii
            Inner radii there [m], 0 where the body is solid. In its place a hollow body may state `wall_thickness`.
        wall_thickness
            Thickness of the wall, measured horizontally [m]. The body is open at the top and closed at the bottom.
        floor_thickness
            Height at which the hollow begins [m]; by default the thickness of the wall, or 0 with inner radii.
        density, mass
            Density of the material [kg/m³], or mass [kg].
        gravity
            Acceleration of gravity [m/s²].
        profile
            Name of the profile, for drawings and reports.

        Raises
        ------
        ParameterError
            If heights fall, radii are negative, the hollow is not inside the body, or nothing is left of the body.

        Examples
        --------
        >>> bell = Column.from_profile([0.0, 0.2, 0.3], [0.15, 0.1, 0.02], wall_thickness=0.01, density=8700.0)
        >>> print(f"{bell.mass:.1f} kg, h = {bell.mass_height:.3f} m")
        21.4 kg, h = 0.092 m
        """
        z, outer, inner = drawn(heights, radii, inner_radii, wall_thickness)
        floor = z[0] + (wall_thickness or 0.0 if floor_thickness is None else floor_thickness)
        hollow = [] if inner is None else [one.of_density(-1.0) for one in frustums(z, inner, above=floor)]
        solid = [one.of_density(1.0) for one in frustums(z, outer)]
        if not math.fsum(one.mass for one in (*solid, *hollow)) > 0.0:
            raise ParameterError(f"inner_radii: nothing is left of the body (got {inner!r} m). Reduce them.")
        body = joined([*solid, *hollow]).raised(-z[0])
        density = _density(density, mass, body.mass)
        return cls(
            radius=max(one for height, one in zip(z, outer, strict=True) if height == z[0]),
            mass_height=body.mass_height,
            mass=density * body.mass,
            transverse_inertia=density * body.transverse_inertia,
            axial_inertia=density * body.axial_inertia,
            height=z[-1] - z[0],
            gravity=gravity,
            profile=Profile(profile, tuple(one - z[0] for one in z), tuple(outer)),
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
        if axial_ratio > most * (1.0 + ROUNDING):
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


def _at(elevation: float, one: Column) -> MassProperties:
    """Return the mass properties of a column whose base is at an `elevation` [m]."""
    return MassProperties(one.mass, elevation + one.mass_height, one.transverse_inertia, one.axial_inertia)


def _spread_of(parts: Sequence[Column], whole: MassProperties) -> Profile | None:
    """Return the spread of the inertia of joined parts, each by itself; None if no part is estimated."""
    estimated = [(one, one.profile) for one in parts if one.profile is not None and one.profile.is_estimated]
    if not estimated:
        return None
    across = math.hypot(*(one.transverse_inertia * own.transverse_spread for one, own in estimated))
    along = math.hypot(*(one.axial_inertia * own.axial_spread for one, own in estimated))
    return Profile(
        "parts",
        transverse_spread=across / whole.transverse_inertia,
        axial_spread=along / whole.axial_inertia,
    )


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
        raise ParameterError(f"density or mass: a column needs one of them (got {got}). State one.")
    if density is not None:
        return density
    assert mass is not None
    return _question_density(mass, volume)


def _question_density(mass: float, volume: float) -> float:
    """Return the mean density of a body, and question one that no solid or hollow body of this outline has."""
    density = mass / volume
    if not LIGHTEST <= density <= DENSEST:
        question_input(
            f"mass: {mass:.6g} kg is unlikely, with a density of {density:.4g} kg/m³. "
            "Check its unit, such as g, kg or t, and those of radius and height."
        )
    return density
