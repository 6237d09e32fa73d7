"""Liquid in tanks: its masses against another series and a published table, its slow limit against a tilted surface."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import ive, jnp_zeros

import stylobate as sb
from stylobate import liquids
from stylobate.errors import ParameterError
from stylobate.theory import TankLiquid

WATER = 1000.0
STEEL = {"radius": 1.0, "height": 3.2, "wall_thickness": 0.006, "density": 7850.0, "liquid_depth": 3.0}

# Depth over radius, m_i/m and h_i'/H: the table that Malhotra, Wenk and Wieland (2000) give, and Eurocode 8, part 4.
# Quoted from memory.
TABLE = [
    (0.3, 0.176, 2.640),
    (0.5, 0.300, 1.460),
    (0.7, 0.414, 1.009),
    (1.0, 0.548, 0.721),
    (1.5, 0.686, 0.555),
    (2.0, 0.763, 0.500),
    (2.5, 0.810, 0.480),
    (3.0, 0.842, 0.472),
]


@pytest.mark.parametrize(("ratio", "fraction", "height"), TABLE)
def test_the_impulsive_mass_and_its_height_are_those_of_the_table(ratio, fraction, height):
    liquid = TankLiquid(radius=2.0, depth=2.0 * ratio)
    assert liquid.impulsive_fraction == pytest.approx(fraction, abs=5.1e-4)
    # The table of heights is rounded to two digits at its ends.
    assert liquid.impulsive_height / liquid.depth == pytest.approx(height, abs=5e-3)


@given(ratio=st.floats(0.2, 6.0))
def test_the_impulsive_mass_is_that_of_the_series_of_pressures(ratio):
    # m_i/m = 2γ Σ I1(ν/γ)/[ν³ I1'(ν/γ)] with ν = (n + ½)π: pressures without a wave, in place of the rest of all waves.
    order = (np.arange(5000) + 0.5) * math.pi
    x = order / ratio
    series = 2.0 * ratio * np.sum(ive(1, x) / (0.5 * (ive(0, x) + ive(2, x))) / order**3)
    # Either series leaves out a tail of the order of its number of terms to the power of −2.
    assert TankLiquid(radius=1.0, depth=ratio).impulsive_fraction == pytest.approx(
        series, abs=3e-8 * max(1.0, 1 / ratio)
    )


def test_the_roots_are_those_of_the_derivative_of_the_bessel_function():
    found = [liquids._root(number) for number in range(1, 41)]
    assert found == pytest.approx(jnp_zeros(1, 40), rel=1e-7)


@pytest.mark.parametrize("ratio", [row[0] for row in TABLE])
def test_housners_closed_form_is_within_eight_per_cent(ratio):
    x = math.sqrt(3.0) / ratio
    fraction = TankLiquid(radius=1.0, depth=ratio).impulsive_fraction
    assert math.tanh(x) / x == pytest.approx(fraction, rel=0.08)


def test_a_level_surface_in_a_tilted_tank_puts_the_liquid_at_its_metacentre():
    # Moment of the weight about the centre of the floor, by quadrature over the radius and the angle.
    liquid, tilt = TankLiquid(radius=0.8, depth=1.1), 1e-5
    angle = 2.0 * math.pi * (np.arange(64) + 0.5) / 64
    points, weights = np.polynomial.legendre.leggauss(8)
    radius, share = 0.4 * (1.0 + points), 0.4 * weights * 0.4 * (1.0 + points) * 2.0 * math.pi / 64
    x = radius[:, None] * np.cos(angle)
    top = liquid.depth + x * math.tan(tilt)  # in the frame of the tank, whose axis leans towards x
    volume = np.sum(share[:, None] * top)
    moment = np.sum(share[:, None] * (x * top * math.cos(tilt) + 0.5 * top**2 * math.sin(tilt)))
    assert volume == pytest.approx(math.pi * 0.8**2 * 1.1, rel=1e-12)
    assert moment / (volume * tilt) == pytest.approx(liquid.metacentre, rel=1e-9)


def test_the_sloshing_frequency_of_a_deep_tank_is_that_of_deep_water():
    liquid = TankLiquid(radius=1.5, depth=30.0, gravity=9.81)
    assert liquid.sloshing_frequency == pytest.approx(math.sqrt(1.8411837813 * 9.81 / 1.5), rel=1e-12)


def tank(liquid, **changes):
    return sb.Column.tank(**{**STEEL, **changes}, liquid=liquid)


@given(depth=st.floats(0.4, 3.0), radius=st.floats(0.4, 2.0))
def test_a_tank_lies_between_its_limits(depth, radius):
    frozen, impulsive, level = (
        tank(one, liquid_depth=depth, radius=radius, height=12.0) for one in ("frozen", "impulsive", "level")
    )
    water = TankLiquid(radius=radius - 0.006, depth=depth)
    # Uplift with the full weight and the moment of the impulsive mass comes later than that of the frozen liquid.
    assert water.impulsive_fraction * water.impulsive_height < 0.5 * depth
    assert level.mass == pytest.approx(frozen.mass, rel=1e-12)
    assert impulsive.mass < frozen.mass
    assert level.mass_height > frozen.mass_height  # the free surface lowers the angle of static tipping
    moved = frozen.mass * frozen.mass_height + WATER * math.pi * water.radius**4 / 4.0
    assert level.mass * level.mass_height == pytest.approx(moved, rel=1e-12)


def test_a_frozen_tank_is_its_parts():
    wall = sb.Column.hollow(radius=1.0, inner_radius=0.994, height=3.2, density=7850.0)
    plate = sb.Column.solid(radius=0.994, height=0.006, density=7850.0)
    water = sb.Column.solid(radius=0.994, height=3.0, density=WATER)
    assert tank("frozen") == sb.Column.from_parts([wall, plate, water], elevations=[0.0, 0.0, 0.006])


def test_the_limits_of_a_tank_have_their_moments():
    water, frozen = TankLiquid(radius=0.994, depth=3.0), tank("frozen")
    liquid = WATER * math.pi * 0.994**2 * 3.0
    empty = frozen.mass * frozen.mass_height - liquid * 1.506
    impulsive, level = tank("impulsive"), tank("level")
    mass = liquid * water.impulsive_fraction
    assert impulsive.mass * impulsive.mass_height - empty == pytest.approx(mass * (0.006 + water.impulsive_height))
    assert level.mass * level.mass_height - empty == pytest.approx(liquid * (0.006 + water.metacentre))
    # The axial inertia is that of the steel: the liquid does not turn with the tank.
    assert impulsive.axial_inertia == pytest.approx(level.axial_inertia, rel=1e-14)
    assert frozen.axial_inertia - level.axial_inertia == pytest.approx(liquid * 0.994**2 / 2.0)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"wall_thickness": 1.0}, "wall_thickness: must be below the radius (got 1.0 m). Reduce it."),
        ({"liquid_depth": 3.2}, "liquid_depth: must be at most 3.194 m (got 3.2 m). Reduce it."),
    ],
)
def test_an_impossible_tank_is_refused(changes, message):
    with pytest.raises(ParameterError) as caught:
        tank("frozen", **changes)
    assert str(caught.value) == message


@pytest.mark.parametrize("name", ["radius", "depth", "gravity"])
def test_impossible_numbers_of_a_liquid_are_refused(name):
    with pytest.raises(ParameterError, match=f"^{name} must be positive"):
        TankLiquid(**{"radius": 1.0, "depth": 1.0, name: 0.0})
