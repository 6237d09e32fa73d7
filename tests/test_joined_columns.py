"""Columns of parts and prisms: joined bodies against the whole and integrals, polygons against their circles."""

import math
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

import stylobate as sb
from stylobate.config import read_config
from stylobate.earthquakes import AssessConfig
from stylobate.errors import ParameterError

lengths = st.floats(0.05, 20.0)
shares = st.floats(0.05, 0.95)
STONE = 2700.0
# Sums of a few products; a difference of squares in the frustum loses up to three digits.
ROUNDING = 1e-12

PLINTH = sb.Column.solid(radius=0.5, height=0.8, density=2300.0)
SHAFT = sb.Column.frustum(radius=0.3, top_radius=0.2, height=1.5, density=STONE)
VASE = sb.Column.hollow(radius=0.25, inner_radius=0.2, height=0.4, density=1900.0)


def numbers(column):
    return column.mass, column.mass_height, column.transverse_inertia, column.axial_inertia


def assert_same(column, other, rel=ROUNDING):
    assert numbers(column) == pytest.approx(numbers(other), rel=rel)
    assert (column.radius, column.height) == pytest.approx((other.radius, other.height), rel=rel)


@given(radius=lengths, height=lengths, share=shares)
def test_two_pieces_of_a_cylinder_are_the_cylinder(radius, height, share):
    pieces = [sb.Column.solid(radius=radius, height=height * part, density=STONE) for part in (share, 1.0 - share)]
    assert_same(sb.Column.from_parts(pieces), sb.Column.solid(radius=radius, height=height, density=STONE))


@given(radius=lengths, top=lengths, height=lengths, share=shares)
def test_two_pieces_of_a_frustum_are_the_frustum(radius, top, height, share):
    cut = radius + share * (top - radius)
    pieces = [
        sb.Column.frustum(radius=radius, top_radius=cut, height=share * height, density=STONE),
        sb.Column.frustum(radius=cut, top_radius=top, height=(1.0 - share) * height, density=STONE),
    ]
    whole = sb.Column.frustum(radius=radius, top_radius=top, height=height, density=STONE)
    assert_same(sb.Column.from_parts(pieces), whole, rel=1e-9)


@given(radius=lengths, height=lengths, share=shares)
def test_a_core_in_a_tube_is_the_solid_cylinder(radius, height, share):
    tube = sb.Column.hollow(radius=radius, inner_radius=share * radius, height=height, density=STONE)
    core = sb.Column.solid(radius=share * radius, height=height, density=STONE)
    both = sb.Column.from_parts([tube, core], elevations=[0.0, 0.0])
    assert_same(both, sb.Column.solid(radius=radius, height=height, density=STONE))


def test_the_order_of_placed_parts_and_their_grouping_change_nothing():
    stack = sb.Column.from_parts([PLINTH, SHAFT, VASE])
    placed = [(PLINTH, 0.0), (SHAFT, PLINTH.height), (VASE, PLINTH.height + SHAFT.height)]
    for order in permutations(placed):
        parts, elevations = zip(*order, strict=True)
        assert_same(sb.Column.from_parts(parts, elevations=elevations), stack)
    assert_same(sb.Column.from_parts([sb.Column.from_parts([PLINTH, SHAFT]), VASE]), stack)
    assert_same(sb.Column.from_parts([SHAFT]), SHAFT)


def test_a_stack_has_the_moments_of_its_density_by_quadrature():
    stack = sb.Column.from_parts([PLINTH, SHAFT, VASE])
    ends = np.cumsum([0.0, PLINTH.height, SHAFT.height, VASE.height])

    def slices(power):
        """Yield for each part its ends and ∫ 2π ρ s^(power − 1) ds over its cross-section at a height."""
        yield ends[0:2], lambda _: 2300.0 * 2.0 * math.pi * 0.5**power / power
        yield ends[1:3], lambda z: STONE * 2.0 * math.pi * (0.3 - 0.1 * (z - ends[1]) / 1.5) ** power / power
        yield ends[2:4], lambda _: 1900.0 * 2.0 * math.pi * (0.25**power - 0.2**power) / power

    def over_height(power, weight):
        return sum(
            quad(lambda z, at=at: weight(z) * at(z), *span, epsabs=0.0, epsrel=1e-12)[0] for span, at in slices(power)
        )

    mass = over_height(2, lambda _: 1.0)
    centre = over_height(2, lambda z: z) / mass
    axial = over_height(4, lambda _: 1.0)
    transverse = axial / 2.0 + over_height(2, lambda z: (z - centre) ** 2)
    assert numbers(stack) == pytest.approx((mass, centre, transverse, axial), rel=1e-10)
    assert (stack.radius, stack.height) == (0.5, pytest.approx(2.7, rel=1e-15))


def test_the_kinetic_energy_of_a_stack_is_that_of_its_parts():
    # Turning about a diameter of the base at 1 rad/s: each centre of mass moves at its height, and each part turns.
    stack = sb.Column.from_parts([PLINTH, SHAFT])
    heights = (PLINTH.mass_height, PLINTH.height + SHAFT.mass_height)
    parts = [0.5 * (one.mass * z**2 + one.transverse_inertia) for one, z in zip((PLINTH, SHAFT), heights, strict=True)]
    assert 0.5 * stack.base_inertia == pytest.approx(sum(parts), rel=ROUNDING)


def test_a_ring_without_mass_changes_the_base_alone():
    raised = sb.Column.from_parts([SHAFT], elevations=[0.1], radius=0.4)
    assert raised.radius == 0.4
    assert (raised.mass_height, raised.height) == pytest.approx((SHAFT.mass_height + 0.1, SHAFT.height + 0.1))
    assert (raised.mass, raised.axial_inertia) == (SHAFT.mass, SHAFT.axial_inertia)
    assert raised.transverse_inertia == pytest.approx(SHAFT.transverse_inertia, rel=ROUNDING)


MOON = sb.Column.solid(radius=0.2, height=1.0, density=STONE, gravity=1.62)


@pytest.mark.parametrize(
    ("parts", "more", "message"),
    [
        ([], {}, "parts: a body needs at least one part (got none)."),
        ([PLINTH, 3.0], {}, "parts[1]: must be a column (got 3.0)."),
        ([PLINTH, sb.Column.dimensionless(0.1)], {}, "parts[1]: has no height (got Column("),
        (
            [PLINTH, MOON],
            {},
            "parts[1]: gravity differs from that of the first part (got 1.62 m/s², not 9.80665 m/s²).",
        ),
        ([PLINTH, SHAFT], {"elevations": [0.0]}, "elevations: must have one number for each of 2 parts (got 1)."),
        ([PLINTH, SHAFT], {"elevations": [0.0, -0.1]}, "elevations[1] must be zero or positive, got -0.1"),
        (
            [PLINTH, SHAFT],
            {"elevations": [0.2, 0.1]},
            "elevations: no part stands on the floor (got 0.1 m for the lowest)",
        ),
    ],
)
def test_parts_that_do_not_fit_together_are_refused(parts, more, message):
    with pytest.raises(ParameterError) as caught:
        sb.Column.from_parts(parts, **more)
    assert str(caught.value).startswith(message)


def corners(sides, side):
    angle = 2.0 * math.pi * np.arange(sides) / sides
    return side / (2.0 * math.sin(math.pi / sides)) * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


@given(sides=st.integers(3, 40), side=lengths, height=lengths)
def test_a_prism_has_the_moments_of_its_polygon_by_triangles(sides, side, height):
    prism = sb.Column.prism(sides=sides, side=side, height=height, density=STONE)
    points = corners(sides, side)
    nexts = np.roll(points, -1, axis=0)
    areas = 0.5 * (points[:, 0] * nexts[:, 1] - points[:, 1] * nexts[:, 0])
    # The rule of midpoints is exact for squares over a triangle.
    midpoints = np.stack([points / 2.0, nexts / 2.0, (points + nexts) / 2.0])
    squares = (areas[:, None] * (midpoints**2).mean(axis=0)).sum(axis=0)
    mass = STONE * height * areas.sum()
    assert squares[0] == pytest.approx(squares[1], rel=1e-10)  # no direction differs
    transverse = STONE * height * squares[0] + mass * height**2 / 12.0
    assert numbers(prism) == pytest.approx((mass, height / 2.0, transverse, STONE * height * squares.sum()), rel=1e-10)


@given(sides=st.integers(3, 12), direction=st.floats(0.0, 2.0 * math.pi))
def test_a_polygon_uplifts_and_tips_between_its_circles_in_every_direction(sides, direction):
    inner, outer = (
        sb.Column.prism(sides=sides, side=0.6, height=2.0, density=STONE, circle=circle)
        for circle in ("inscribed", "circumscribed")
    )
    # The body tips where the line of force through its centre of mass leaves the polygon: on the ray of the direction.
    ray = np.array([math.cos(direction), math.sin(direction)])
    points = corners(sides, 0.6)
    edges = np.roll(points, -1, axis=0) - points
    normals = np.stack([edges[:, 1], -edges[:, 0]], axis=-1)
    towards = normals @ ray
    reach = min((np.einsum("ij,ij->i", normals, points)[towards > 1e-12]) / towards[towards > 1e-12])
    assert inner.radius * (1.0 - ROUNDING) <= reach <= outer.radius * (1.0 + ROUNDING)
    assert inner.slenderness <= outer.slenderness


def test_the_inscribed_circle_of_a_square_prism_is_housners_block():
    block = sb.Column.prism(sides=4, side=0.6, height=2.0, mass=1800.0)
    distance = math.hypot(0.3, 1.0)
    assert block.frequency_parameter == pytest.approx(math.sqrt(0.75 * block.gravity / distance), rel=ROUNDING)
    assert block.housner_restitution == pytest.approx(1.0 - 1.5 * (0.3 / distance) ** 2, rel=ROUNDING)
    assert block.mass == 1800.0


def test_a_prism_of_many_sides_is_a_cylinder():
    sides = 1000
    prism = sb.Column.prism(sides=sides, side=2.0 * math.pi * 0.5 / sides, height=3.0, density=STONE)
    # Of equal perimeter, the area of the polygon is smaller by the fraction π²/(3 n²), its second moments by twice it.
    rel = 4.0 * math.pi**2 / (3.0 * sides**2)
    assert numbers(prism) == pytest.approx(numbers(sb.Column.solid(radius=0.5, height=3.0, density=STONE)), rel=rel)


@pytest.mark.parametrize(
    ("stated", "message"),
    [
        ({"sides": 2, "density": 1e3}, "sides must be a whole number of at least 3, got 2"),
        ({"sides": 4}, "density or mass: a column needs one of them (got neither). State one."),
        ({"sides": 4, "density": 1e3, "circle": "mean"}, "circle must be 'inscribed' or 'circumscribed', got 'mean'"),
    ],
)
def test_an_impossible_prism_is_refused(stated, message):
    with pytest.raises(ParameterError) as caught:
        sb.Column.prism(side=0.6, height=2.0, **stated)
    assert str(caught.value) == message


def test_the_study_of_a_cask_describes_the_cask_of_its_page():
    described = AssessConfig.parse(read_config(Path(__file__).parents[1] / "examples" / "cask" / "study.toml"))
    overpack = sb.Column.hollow(radius=1.685, inner_radius=0.935, height=6.1, density=3240.0)
    canister = sb.Column.solid(radius=0.87, height=4.8, mass=41000.0)
    cask = sb.Column.from_parts([overpack, canister], elevations=[0.0, 0.5])
    assert described.columns["cask"].build() == cask
