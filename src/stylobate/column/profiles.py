"""Profiles of columns: outlines over the height, and moments of inertia estimated from a kind of outline.

The kinds are drawings of this package, general forms and no single piece. Heights are relative to the height of the
body, radii to its largest radius. A wall is relative to the largest radius, and measured along the normal of the
outline.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Annotated, Literal, NamedTuple, Self

import numpy as np
import numpy.typing as npt

from stylobate.errors import ParameterError, require_finite
from stylobate.quantities import Quantity, question_input

ProfileName = Annotated[
    Literal["cylinder", "cone", "vase", "amphora", "bottle", "statue", "bust"],
    Quantity(text="file of a drawn profile, or kind from which moments of inertia are estimated"),
]
ProfileLabel = Annotated[str, Quantity(text="kind of profile, or file with its table")]
MaxRadius = Annotated[float, Quantity(symbol="r_max", unit="m", text="largest radius of the body", gt=0.0)]
InertiaSpread = Annotated[
    float, Quantity(text="relative standard deviation of the transverse moment of inertia", ge=0.0, lt=1.0)
]

TRANSVERSE_SPREAD = 0.10
"""Relative standard deviation of an estimated moment of inertia about a horizontal axis."""
AXIAL_SPREAD, AXIAL_SPREAD_OF_MAX_RADIUS = 0.35, 0.12
"""The same about the axis, without and with a stated largest radius."""


@dataclass(frozen=True, slots=True, repr=False)
class Profile:
    """The outline of a column, and the spread of its moments of inertia.

    Parameters
    ----------
    name
        Kind of the profile, or name of its table.
    heights, radii
        Corners of the outline from the base up [m]; empty if it is not known.
    transverse_spread, axial_spread
        Relative standard deviations of both moments of inertia; 0 for moments that are not estimated.
    """

    name: str = ""
    heights: tuple[float, ...] = ()
    radii: tuple[float, ...] = ()
    transverse_spread: float = 0.0
    axial_spread: float = 0.0

    def __repr__(self) -> str:
        """Write the name, and whether moments of inertia are estimated."""
        return f"{self.name or 'drawn'!r}" + (f" ({self.spread_in_words})" if self.is_estimated else "")

    @property
    def is_estimated(self) -> bool:
        """Whether some moment of inertia is uncertain."""
        return self.transverse_spread > 0.0 or self.axial_spread > 0.0

    @property
    def spread_in_words(self) -> str:
        """The spread of the moments of inertia in a few words."""
        across, along = (f"{100.0 * one:.3g} %" for one in (self.transverse_spread, self.axial_spread))
        return f"inertia estimated, ±{across}, about the axis ±{along}"

    def scaled(self, *, height: float = 1.0, radius: float = 1.0) -> Self:
        """Copy the profile with heights and radii times these factors."""
        return replace(
            self,
            heights=tuple(height * one for one in self.heights),
            radii=tuple(radius * one for one in self.radii),
        )


class ProfileKind(NamedTuple):
    """A kind of profile.

    Attributes
    ----------
    text
        What is drawn, in a few words.
    heights, radii
        Corners of the outline, relative to height and largest radius.
    wall
        Thickness of wall and floor, relative to the largest radius; 0 for a solid body.
    """

    text: str
    heights: tuple[float, ...]
    radii: tuple[float, ...]
    wall: float = 0.0


PROFILES: Mapping[str, ProfileKind] = MappingProxyType(
    {
        "cylinder": ProfileKind("solid drum, pedestal or box", (0.0, 1.0), (1.0, 1.0)),
        "cone": ProfileKind("solid cone on its broad base", (0.0, 1.0), (1.0, 0.0)),
        "vase": ProfileKind(
            "hollow, belly above the middle, wide mouth",
            (0.0, 0.03, 0.12, 0.3, 0.5, 0.65, 0.78, 0.88, 0.95, 1.0),
            (0.56, 0.56, 0.62, 0.84, 0.98, 1.0, 0.86, 0.6, 0.52, 0.6),
            0.1,
        ),
        "amphora": ProfileKind(
            "hollow, narrow foot, high belly, narrow neck",
            (0.0, 0.03, 0.1, 0.25, 0.42, 0.58, 0.7, 0.78, 0.82, 0.95, 1.0),
            (0.4, 0.4, 0.42, 0.68, 0.92, 1.0, 0.84, 0.5, 0.34, 0.33, 0.42),
            0.1,
        ),
        "bottle": ProfileKind(
            "hollow, cylindrical body, narrow neck",
            (0.0, 0.02, 0.1, 0.55, 0.66, 0.74, 0.97, 1.0),
            (0.93, 1.0, 1.0, 1.0, 0.78, 0.36, 0.32, 0.35),
            0.1,
        ),
        "statue": ProfileKind(
            "solid, standing figure on its plate",
            (0.0, 0.06, 0.07, 0.25, 0.45, 0.55, 0.68, 0.8, 0.85, 0.88, 0.93, 1.0),
            (1.0, 1.0, 0.62, 0.58, 0.6, 0.55, 0.66, 0.62, 0.3, 0.3, 0.36, 0.18),
        ),
        "bust": ProfileKind(
            "solid, head and shoulders on a narrow socle",
            (0.0, 0.08, 0.1, 0.25, 0.3, 0.42, 0.55, 0.62, 0.7, 0.8, 0.92, 1.0),
            (0.62, 0.62, 0.4, 0.36, 0.6, 1.0, 0.96, 0.5, 0.4, 0.5, 0.46, 0.15),
        ),
    }
)
"""The kinds of profile by name."""

# Slices between two corners of an outline; the moments then have a relative error below 1e-4.
_SLICES = 64
# Bisections of the exponent by which the mass is moved, from ±_STEEPEST to rounding.
_BISECTIONS, _STEEPEST = 64, 200.0
# Relative error of the centre of mass: that of the last bisection, or far larger if no slice lies beyond the centre.
_CENTRED = 1e-9
# Ratio of the densities at top and base, as its logarithm, beyond which a body is hardly one of the kind.
_UNLIKELY = 4.0
# Corners of the shortest profile.
_FEWEST = 2
# Smallest radius of an outline whose foot is narrowed, relative to the largest.
_THINNEST = 0.05


class Estimate(NamedTuple):
    """Moments of inertia by mass [m²], and the profile of which they are."""

    transverse: float
    axial: float
    profile: Profile


def estimate(
    name: str, *, radius: float, height: float, mass_height: float, max_radius: float | None, spread: float | None
) -> Estimate:
    """Estimate the moments of inertia of a body of a kind of profile from the numbers that are easily measured.

    Parameters
    ----------
    name
        Kind of the profile.
    radius, height, mass_height
        Radius of the foot, height of the body and of its centre of mass [m].
    max_radius
        Largest radius [m]; by default the foot of the kind decides.
    spread
        Relative standard deviation of the transverse moment; None for that of the estimates.

    Raises
    ------
    ParameterError
        If the centre of mass lies outside the body, or the largest radius does not suit the kind.

    Notes
    -----
    The mass of the drawn body per height, w(z), is moved to w(z) exp(βz) with the β that puts its centre at the stated
    height. Of all distributions with this centre, it differs least from the drawn one (relative entropy). The wall of
    a hollow body is then thicker where there is more mass; the outline of a solid one is wider, r(z) exp(βz/2), unless
    its largest radius is stated. With the radius of gyration s of each slice about the axis,

        I_a = ∫ s² dm,  I_t = I_a/2 + ∫ (z − h)² dm.
    """
    kind = PROFILES[name]
    if mass_height >= height:
        raise ParameterError(
            f"mass_height must lie inside the body, below height = {height!r} m, got {mass_height!r} m"
        )
    places, radii = np.array(kind.heights), _fitted(name, kind, radius, max_radius)
    middles = (np.arange(_SLICES) + 0.5) / _SLICES
    z, outer = ((one[:-1, None] + np.diff(one)[:, None] * middles).ravel() for one in (places, radii))
    slope = np.repeat(np.diff(radii) / (np.diff(places) * height), _SLICES)
    wall = kind.wall * radii.max()
    inner = np.where(z * height > wall, np.maximum(outer - wall * np.sqrt(1.0 + slope * slope), 0.0), 0.0)
    inner = inner if kind.wall else np.zeros_like(outer)
    thickness = np.repeat(np.diff(places), _SLICES) / _SLICES
    weight = (outer * outer - inner * inner) * thickness
    gyration = 0.5 * (outer * outer + inner * inner)
    share = mass_height / height
    steepness, low, high = 0.0, -_STEEPEST, _STEEPEST
    for _ in range(_BISECTIONS):
        steepness = 0.5 * (low + high)
        mass = weight * np.exp(steepness * (z - share))
        low, high = (steepness, high) if float(mass @ z) < share * float(mass.sum()) else (low, steepness)
    if not math.isclose(float(mass @ z), share * float(mass.sum()), rel_tol=_CENTRED):
        raise ParameterError(
            f"mass_height: lies too close to an end of the body of height {height!r} m (got {mass_height!r} m). "
            "Check it."
        )
    if abs(steepness) > _UNLIKELY:
        own = height * float(weight @ z) / float(weight.sum())
        question_input(
            f"mass_height: {mass_height:.4g} m is unlikely for the profile {name}, whose centre of mass is near "
            f"{own:.2g} m at this height. Check it, or choose another profile."
        )
    if not kind.wall and max_radius is None:
        gyration, radii = gyration * np.exp(steepness * z), radii * np.exp(0.5 * steepness * places)
    mass /= mass.sum()
    axial = float(mass @ gyration)
    transverse = 0.5 * axial + height * height * float(mass @ ((z - share) ** 2 + thickness * thickness / 12.0))
    across = TRANSVERSE_SPREAD if spread is None else spread
    along = AXIAL_SPREAD if max_radius is None else AXIAL_SPREAD_OF_MAX_RADIUS
    profile = Profile(
        name, tuple((places * height).tolist()), tuple(radii.tolist()), across, along if across > 0.0 else 0.0
    )
    return Estimate(transverse, axial, profile)


def _fitted(name: str, kind: ProfileKind, radius: float, max_radius: float | None) -> npt.NDArray[np.float64]:
    """Return the radii of a kind with a stated foot; with a largest radius the outline below it is bent to the foot."""
    relative: npt.NDArray[np.float64] = np.array(kind.radii)
    if max_radius is None:
        return np.asarray(relative * (radius / relative[0]))
    widest = kind.heights[int(np.argmax(relative))]
    if max_radius < radius or (widest == 0.0 and not math.isclose(max_radius, radius)):
        problem = f"must be at least the radius of the base, {radius!r} m" if max_radius < radius else "the foot is it"
        raise ParameterError(
            f"max_radius: {problem}, for the profile {name} (got {max_radius!r} m). Correct it, or leave it out."
        )
    if widest == 0.0:
        return np.asarray(relative * radius)
    below = np.clip(1.0 - np.array(kind.heights) / widest, 0.0, None)
    bent = relative + (radius / max_radius - relative[0]) * below
    return np.asarray(np.maximum(bent, min(_THINNEST, radius / max_radius)) * max_radius)


def drawn(
    heights: Sequence[float], radii: Sequence[float], inner_radii: Sequence[float] | None, wall: float | None
) -> tuple[list[float], list[float], list[float] | None]:
    """Check the corners of a drawn profile; return heights, outer radii and inner radii, None for a solid body [m].

    Raises
    ------
    ParameterError
        If they are not as many, heights fall, radii are negative or contradict each other.
    """
    given = {"heights": heights, "radii": radii, **({} if inner_radii is None else {"inner_radii": inner_radii})}
    if inner_radii is not None and wall is not None:
        raise ParameterError(f"wall_thickness: inner_radii state the wall (got {wall!r} m). Leave one of them out.")
    found: dict[str, list[float]] = {}
    for name, values in given.items():
        found[name] = [require_finite(f"{name}[{place}]", one, "m") for place, one in enumerate(values)]
        if len(found[name]) != len(found["heights"]) or len(found[name]) < _FEWEST:
            wanted = f"{len(found['heights'])} numbers, as heights have" if name != "heights" else "two numbers or more"
            raise ParameterError(f"{name}: must be {wanted} (got {len(found[name])}). State one for each corner.")
    z, outer, inner = found["heights"], found["radii"], found.get("inner_radii")
    for place in range(1, len(z)):
        if z[place] < z[place - 1]:
            raise ParameterError(
                f"heights[{place}]: must not lie below the corner before, {z[place - 1]!r} m (got {z[place]!r} m). "
                "List the corners from the base up."
            )
    for place, own in enumerate(outer):
        if own < 0.0 or own == place == 0.0:
            raise ParameterError(f"radii[{place}]: must be positive, or 0 above the foot (got {own!r} m). Correct it.")
        if inner is not None and not 0.0 <= inner[place] <= own:
            raise ParameterError(
                f"inner_radii[{place}]: must lie between 0 and the outer radius, {own!r} m (got {inner[place]!r} m). "
                "Correct it."
            )
    return z, outer, inner if wall is None else [one - wall for one in outer]
