"""Liquid in an upright rigid cylindrical tank: its impulsive part, its sloshing part, and its slow limit.

Potential flow of small amplitude under a horizontal acceleration of the tank, as in Eurocode 8, part 4, annex A.2.
"""

import math
from dataclasses import dataclass
from typing import Literal

from stylobate.errors import require_positive
from stylobate.mass_properties import MassProperties

# Roots of J1'(λ) = 0; from the fourth on McMahon's series has an error below 1e-7.
_ROOTS = (1.8411837813, 5.3314427735, 8.5363163663)
# Modes of sloshing that are summed; the rest of the impulsive mass is below 1e-8 of the liquid.
_MODES = 2000


@dataclass(frozen=True, slots=True, kw_only=True)
class TankLiquid:
    """Liquid in an upright rigid cylindrical tank with a free surface.

    Under horizontal shaking a part of the liquid, the impulsive mass, moves with the tank. The rest sloshes: it counts
    as masses on springs. Heights are above the floor of the tank.

    Parameters
    ----------
    radius
        Inner radius R of the tank [m].
    depth
        Depth H of the liquid [m].
    gravity
        Acceleration of gravity g [m/s²].

    Raises
    ------
    ParameterError
        If a number is not finite and positive.

    Notes
    -----
    With γ = H/R and the roots λ of J1'(λ) = 0, the mode n of sloshing has the fraction and the height

        m_n/m = 2 tanh(λγ)/[γ λ (λ² − 1)],   h_n/H = 1 + (2 − cosh λγ)/(λγ sinh λγ),

    where the height includes the pressure on the floor. The impulsive mass is the rest. A tank that accelerates slowly
    tilts the surface, and the moment on its floor is that of all liquid at the metacentre, H/2 + R²/(4H). The impulsive
    height follows from the difference.

    Housner's closed form (1957) of the impulsive fraction, tanh(√3/γ)/(√3/γ), is within 8 % up to γ = 3.

    References
    ----------
    A. S. Veletsos and J. Y. Yang (1977); EN 1998-4:2006, annex A.2; P. K. Malhotra, T. Wenk and M. Wieland (2000). The
    equations are derived; the texts were not read.

    Examples
    --------
    >>> water = TankLiquid(radius=2.0, depth=4.0)
    >>> round(water.impulsive_fraction, 3), round(water.sloshing_frequency, 2)
    (0.763, 3.0)
    """

    radius: float
    depth: float
    gravity: float = 9.80665

    def __post_init__(self) -> None:
        """Check the numbers."""
        for name, unit in (("radius", "m"), ("depth", "m"), ("gravity", "m/s²")):
            object.__setattr__(self, name, require_positive(name, getattr(self, name), unit))

    @property
    def impulsive_fraction(self) -> float:
        """m_i/m, the fraction of the liquid that moves with the tank."""
        return 1.0 - math.fsum(fraction for fraction, _ in self._modes())

    @property
    def impulsive_height(self) -> float:
        """Height at which the impulsive mass has the moment of the pressures on wall and floor [m]."""
        whole = self.metacentre / self.depth
        rest = whole - math.fsum(fraction * height for fraction, height in self._modes())
        return self.depth * rest / self.impulsive_fraction

    @property
    def metacentre(self) -> float:
        """H/2 + R²/(4H), the height at which all liquid acts on a tank that moves slowly [m]."""
        return self.depth / 2.0 + self.radius * self.radius / (4.0 * self.depth)

    @property
    def sloshing_frequency(self) -> float:
        """Angular frequency of the first mode of sloshing, √[(λ g/R) tanh(λγ)] [rad/s]."""
        root = _ROOTS[0]
        return math.sqrt(root * self.gravity / self.radius * math.tanh(root * self.depth / self.radius))

    def _modes(self) -> list[tuple[float, float]]:
        """Return the fraction and the height, in depths, of each mode of sloshing."""
        ratio, found = self.depth / self.radius, []
        for number in range(1, _MODES + 1):
            root = _root(number)
            x = root * ratio
            small = math.exp(-x)
            slope = (1.0 - small * small) / (1.0 + small * small)  # tanh x
            # (2 − cosh x)/sinh x, without overflow.
            bend = 4.0 * small / (1.0 - small * small) - 1.0 / slope
            found.append((2.0 * slope / (x * (root * root - 1.0)), 1.0 + bend / x))
        return found


def point_mass(liquid: TankLiquid, mass: float, limit: Literal["impulsive", "level"]) -> MassProperties:
    """Return the point that stands for a `mass` [kg] of liquid, at a height above the floor of the tank.

    The limit "impulsive" is shaking much faster than the sloshing, "level" motion much slower.
    """
    if limit == "impulsive":
        return MassProperties(mass * liquid.impulsive_fraction, liquid.impulsive_height, 0.0, 0.0)
    return MassProperties(mass, liquid.metacentre, 0.0, 0.0)


def _root(number: int) -> float:
    """Return a root of J1', by McMahon's series for the large ones."""
    if number <= len(_ROOTS):
        return _ROOTS[number - 1]
    beta = 8.0 * math.pi * (number - 0.25)
    return beta / 8.0 - 7.0 / beta - 1724.0 / (3.0 * beta**3) - 956_576.0 / (15.0 * beta**5)
