"""Columns by their profile: exact integrals of drawn ones, and estimates from a kind against drawn ones."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad

import stylobate as sb
from stylobate.column.profiles import AXIAL_SPREAD, AXIAL_SPREAD_OF_MAX_RADIUS, PROFILES, TRANSVERSE_SPREAD
from stylobate.column.shapes import SHAPES_OF_PROFILES
from stylobate.errors import ParameterError, UnlikelyInputWarning
from stylobate.mass_properties import frustums
from stylobate.quantities import parameters_of

VASE = [0.0, 0.02, 0.15, 0.3, 0.3, 0.42], [0.06, 0.06, 0.11, 0.14, 0.09, 0.1]


def numbers(column):
    return column.mass, column.mass_height, column.transverse_inertia, column.axial_inertia


def of(column):
    return pytest.approx(numbers(column), rel=1e-12)


def integrated(heights, radii, inner, floor, density):
    """Return mass, height of the mass centre, I_t and I_a by quadrature over each straight piece of the profile."""
    breaks = sorted({*heights, floor})

    def total(power, moment):
        def ring(z, low, high):
            at = np.searchsorted(heights, (low + high) / 2.0)
            share = (z - heights[at - 1]) / (heights[at] - heights[at - 1])
            outer, hollow = (one[at - 1] + share * (one[at] - one[at - 1]) for one in (radii, inner))
            hollow = max(hollow, 0.0) if z >= floor else 0.0
            return moment(z) * (outer**power - hollow**power) * 2.0 * math.pi / power * density

        pieces = [(low, high) for low, high in pairwise(breaks) if high > low]
        return sum(quad(ring, *piece, args=piece, epsabs=0.0, epsrel=1e-11)[0] for piece in pieces)

    mass = total(2, lambda _: 1.0)
    centre = total(2, lambda z: z) / mass
    axial = total(4, lambda _: 1.0)
    return mass, centre, axial / 2.0 + total(2, lambda z: (z - centre) ** 2), axial


@pytest.mark.parametrize("wall", [None, 0.02])
def test_a_drawn_profile_has_the_moments_of_its_density(wall):
    column = sb.Column.from_profile(*VASE, wall_thickness=wall, density=2100.0)
    heights, radii = VASE
    inner = [0.0] * len(radii) if wall is None else [one - wall for one in radii]
    assert numbers(column) == pytest.approx(integrated(heights, radii, inner, wall or 0.0, 2100.0), rel=1e-9)
    assert (column.radius, column.height) == (0.06, 0.42)


def test_the_profiles_of_frustum_cylinder_and_tube_are_these_bodies():
    frustum = sb.Column.frustum(radius=0.3, top_radius=0.1, height=1.1, density=2000.0)
    assert numbers(sb.Column.from_profile([0.0, 0.4, 1.1], [0.3, 0.3 - 0.08 / 1.1, 0.1], density=2000.0)) == of(frustum)
    solid = sb.Column.solid(radius=0.3, height=1.1, mass=70.0)
    assert numbers(sb.Column.from_profile([0.0, 1.1], [0.3, 0.3], mass=70.0)) == of(solid)
    tube = sb.Column.hollow(radius=0.3, inner_radius=0.25, height=1.1, density=2000.0)
    by_radii = sb.Column.from_profile([0.0, 1.1], [0.3, 0.3], inner_radii=[0.25, 0.25], density=2000.0)
    assert numbers(by_radii) == of(tube)
    tank = sb.Column.tank(
        radius=0.3,
        height=1.1,
        wall_thickness=0.05,
        floor_thickness=0.1,
        density=2000.0,
        liquid_depth=1.0,
        liquid_density=10.0,
    )
    plate = sb.Column.from_profile([0.0, 1.1], [0.3, 0.3], wall_thickness=0.05, floor_thickness=0.1, density=2000.0)
    water = sb.Column.solid(radius=0.25, height=1.0, density=10.0)
    assert numbers(sb.Column.from_parts([plate, water], elevations=[0.0, 0.1])) == of(tank)


def test_a_body_is_the_sum_of_its_slices_by_the_parallel_axis_theorem():
    whole = sb.Column.from_profile([0.0, 0.2, 0.5], [0.1, 0.2, 0.05], density=1000.0)
    low = sb.Column.from_profile([0.0, 0.2], [0.1, 0.2], density=1000.0)
    high = sb.Column.from_profile([0.2, 0.5], [0.2, 0.05], density=1000.0)
    assert numbers(sb.Column.from_parts([low, high])) == of(whole)


def test_a_thin_ring_has_the_volume_of_pappus():
    # A triangle of base w and height 2w between two cones turns about the axis at the distance of its centroid.
    width, radius = 1e-3, 0.2
    ring = sb.Column.from_profile(
        [0.0, width, 2.0 * width],
        [radius, radius + width, radius],
        inner_radii=[radius, radius, radius],
        density=1000.0,
    )
    area = width * width
    assert ring.mass == pytest.approx(1000.0 * 2.0 * math.pi * (radius + width / 3.0) * area, rel=1e-9)


def test_the_profile_of_a_sphere_converges_with_the_square_of_its_corners():
    def errors(count):
        angle = np.linspace(0.0, np.pi, count + 1)[1:]  # without the pole, on which nothing stands
        ball = sb.Column.from_profile(1.0 - np.cos(angle), np.sin(angle).clip(0.0), mass=5000.0)
        return np.abs(np.array([ball.transverse_inertia, ball.axial_inertia]) - 2000.0)

    assert errors(40) / errors(80) == pytest.approx([4.0, 4.0], rel=0.1)


def test_a_wall_thicker_than_the_body_leaves_it_solid_there():
    slices = list(frustums([0.0, 1.0], [-0.1, 0.3]))
    assert [(one.bottom, one.radius, one.top_radius) for one in slices] == [pytest.approx((0.25, 0.0, 0.3))]
    thick = sb.Column.from_profile([0.0, 0.5], [0.1, 0.2], wall_thickness=0.3, density=1000.0)
    assert numbers(thick) == of(sb.Column.from_profile([0.0, 0.5], [0.1, 0.2], density=1000.0))


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"radii": [0.1]}, r"^radii: must be 3 numbers, as heights have \(got 1\)"),
        ({"heights": [0.0, 0.3, 0.2]}, r"^heights\[2\]: must not lie below the corner before, 0.3 m \(got 0.2 m\)"),
        ({"radii": [0.1, -0.1, 0.1]}, r"^radii\[1\]: must be positive"),
        ({"radii": [0.0, 0.1, 0.1]}, r"^radii\[0\]: must be positive"),
        ({"inner_radii": [0.0, 0.2, 0.0]}, r"^inner_radii\[1\]: must lie between 0 and the outer radius, 0.1 m"),
        ({"inner_radii": [0.1, 0.1, 0.1]}, "^inner_radii: nothing is left of the body"),
        ({"inner_radii": [0.0, 0.0, 0.0], "wall_thickness": 0.01}, "^wall_thickness: inner_radii state the wall"),
    ],
)
def test_corners_that_are_no_body_are_refused(arguments, message):
    given = {"heights": [0.0, 0.2, 0.3], "radii": [0.1, 0.1, 0.1], "density": 1000.0, **arguments}
    with pytest.raises(ParameterError, match=message):
        sb.Column.from_profile(given.pop("heights"), given.pop("radii"), **given)


def test_a_cylinder_and_a_cone_have_their_own_moments():
    solid = sb.Column.solid(radius=0.2, height=1.0, mass=30.0)
    same = sb.Column.estimated(radius=0.2, height=1.0, mass_height=0.5, mass=30.0, profile="cylinder")
    assert numbers(same) == of(solid)
    cone = sb.Column.estimated(radius=0.3, height=1.0, mass_height=0.25, mass=10.0, profile="cone")
    # 3 m r²/10 about the axis, 3 m (r² + H²/4)/20 across it through the centre of mass; 64 slices.
    assert cone.axial_inertia == pytest.approx(0.3 * 10.0 * 0.09, rel=1e-3)
    assert cone.transverse_inertia == pytest.approx(0.15 * 10.0 * (0.09 + 0.25), rel=1e-3)


def test_every_kind_is_offered_and_drawn():
    assert parameters_of(SHAPES_OF_PROFILES["estimated"])["profile"].choices == tuple(PROFILES)
    for kind in PROFILES.values():
        assert kind.heights[0] == 0.0
        assert kind.heights[-1] == 1.0
        assert max(kind.radii) == 1.0
        assert len(kind.heights) == len(kind.radii)


# Drawn bodies with which estimates are compared: their proportions vary as those of objects do. All have height 1 m.


def smooth(heights, radii):
    """Return corners of a smooth outline: cosine waves between the stated heights."""
    z = np.linspace(0.0, 1.0, 25)
    at = np.clip(np.searchsorted(heights, z, side="right"), 1, len(heights) - 1)
    share = (z - np.take(heights, at - 1)) / (np.take(heights, at) - np.take(heights, at - 1))
    first, last = np.take(radii, at - 1), np.take(radii, at)
    return z, first + (last - first) * 0.5 * (1.0 - np.cos(np.pi * share))


def shell(rng, corners, radius):
    """Return a hollow body, its wall along the normal, thicker at the base or at the top, on a floor."""
    z, outer = corners[0], radius * corners[1]
    wall = rng.uniform(0.04, 0.15) * radius * (1.0 + rng.uniform(-0.6, 0.4) * (z - 0.5))
    slope = np.clip(np.gradient(outer, z), -3.0, 3.0)
    inner = np.clip(outer - wall * np.sqrt(1.0 + slope * slope), 0.0, None)
    return sb.Column.from_profile(z, outer, inner_radii=inner, floor_thickness=rng.uniform(0.01, 0.06), density=2000.0)


def vase(rng):
    foot, belly, neck, place = (rng.uniform(*ends) for ends in ((0.4, 0.75), (0.4, 0.72), (0.35, 0.8), (0.82, 0.93)))
    mouth = min(1.0, neck * rng.uniform(1.0, 1.3))
    return shell(rng, smooth([0.0, belly, place, 1.0], [foot, 1.0, neck, mouth]), rng.uniform(0.18, 0.4))


def amphora(rng):
    foot, belly, neck, place = (rng.uniform(*ends) for ends in ((0.25, 0.55), (0.45, 0.68), (0.25, 0.45), (0.74, 0.88)))
    mouth = neck * rng.uniform(1.0, 1.4)
    return shell(rng, smooth([0.0, belly, place, 1.0], [foot, 1.0, neck, mouth]), rng.uniform(0.18, 0.35))


def bottle(rng):
    foot, shoulder, neck = (rng.uniform(*ends) for ends in ((0.88, 1.0), (0.4, 0.7), (0.25, 0.45)))
    place = min(0.9, shoulder + rng.uniform(0.1, 0.25))
    corners = smooth([0.0, 0.05, shoulder, place, 1.0], [foot, 1.0, 1.0, neck, neck])
    return shell(rng, corners, rng.uniform(0.1, 0.25))


def statue(rng):
    body, plate = rng.uniform(0.45, 0.75), rng.uniform(0.03, 0.1)
    places = [0.0, plate, plate, 0.25, 0.47, 0.64, 0.8, 0.85, 0.92, 1.0]
    shares = [body * rng.uniform(*ends) for ends in ((0.8, 1.1), (0.9, 1.1), (0.9, 1.1), (0.75, 1.05), (0.9, 1.2))]
    radii = [1.0, 1.0, *shares, 0.27 * rng.uniform(0.8, 1.2), 0.33 * rng.uniform(0.8, 1.2), 0.12]
    return sb.Column.from_profile(places, rng.uniform(0.1, 0.22) * np.array(radii), density=2000.0)


def bust(rng):
    foot = rng.uniform(0.45, 0.8)
    stem = foot * rng.uniform(0.5, 0.8)
    places = [0.0, 0.08, 0.08, rng.uniform(0.18, 0.28), rng.uniform(0.36, 0.46), 0.54, 0.64, 0.7, 0.82, 0.92, 1.0]
    head = 0.5 * rng.uniform(0.9, 1.1)
    radii = [foot, foot, stem, stem, 1.0, rng.uniform(0.8, 1.0), rng.uniform(0.4, 0.55), 0.38, head, 0.44, 0.12]
    return sb.Column.from_profile(places, rng.uniform(0.2, 0.35) * np.array(radii), density=2000.0)


def cylinder(rng):
    shaft, taper, cap = rng.uniform(0.85, 1.0), rng.uniform(0.85, 1.0), rng.uniform(0.85, 1.0)
    radii = [1.0, 1.0, shaft, shaft * taper, cap, cap]
    places = [0.0, 0.08, 0.08, 0.92, 0.92, 1.0]
    return sb.Column.from_profile(places, rng.uniform(0.08, 0.4) * np.array(radii), density=2000.0)


def cone(rng):
    z, top, bow = np.linspace(0.0, 1.0, 9), rng.uniform(0.0, 0.4), rng.uniform(-0.2, 0.2)
    return sb.Column.from_profile(
        z, rng.uniform(0.1, 0.5) * (1.0 + (top - 1.0) * z + bow * z * (1.0 - z)), density=2000.0
    )


DRAWN = {one.__name__: one for one in (cylinder, cone, vase, amphora, bottle, statue, bust)}


def errors(kind, bodies, **known):
    """Return the logarithms of estimate over truth of both moments, shape (2, bodies)."""
    found = []
    for one in bodies:
        own = {name: max(one.profile.radii) for name in known}
        guess = sb.Column.estimated(
            radius=one.radius, height=one.height, mass_height=one.mass_height, mass=one.mass, profile=kind, **own
        )
        found.append((guess.transverse_inertia / one.transverse_inertia, guess.axial_inertia / one.axial_inertia))
    return np.log(found).T


@pytest.mark.parametrize("kind", PROFILES)
def test_the_stated_spreads_cover_drawn_bodies_with_the_same_numbers(kind):
    rng = np.random.default_rng(7)
    bodies = [DRAWN[kind](rng) for _ in range(40)]
    across, along = errors(kind, bodies)
    assert np.mean(np.abs(across) <= 2.0 * TRANSVERSE_SPREAD) >= 0.9
    assert np.mean(np.abs(along) <= 2.0 * AXIAL_SPREAD) >= 0.9
    if np.argmax(PROFILES[kind].radii) > 0:  # its foot is not its widest place
        across, along = errors(kind, bodies, max_radius=True)
        assert np.mean(np.abs(across) <= 2.0 * TRANSVERSE_SPREAD) >= 0.9
        assert np.mean(np.abs(along) <= 2.0 * AXIAL_SPREAD_OF_MAX_RADIUS) >= 0.9


def test_the_spread_is_not_far_wider_than_the_errors():
    rng = np.random.default_rng(7)
    found = np.concatenate([errors(kind, [draw(rng) for _ in range(8)]) for kind, draw in DRAWN.items()], axis=1)
    assert 0.5 * TRANSVERSE_SPREAD < np.sqrt(np.mean(found[0] ** 2)) < TRANSVERSE_SPREAD
    assert 0.4 * AXIAL_SPREAD < np.sqrt(np.mean(found[1] ** 2)) < AXIAL_SPREAD


AMPHORA = {"radius": 0.11, "height": 0.95, "mass_height": 0.52, "mass": 14.0, "profile": "amphora"}


def test_the_line_of_a_column_states_that_its_inertia_is_estimated():
    assert "profile='amphora' (inertia estimated, ±10 %, about the axis ±35 %)" in repr(sb.Column.estimated(**AMPHORA))
    known = sb.Column.estimated(**AMPHORA, max_radius=0.2, inertia_spread=0.05)
    assert "±5 %, about the axis ±12 %" in repr(known)
    assert max(known.profile.radii) == 0.2
    assert not sb.Column.estimated(**AMPHORA, inertia_spread=0.0).profile.is_estimated


def test_numbers_that_do_not_suit_a_kind_are_refused():
    with pytest.raises(ParameterError, match=r"profile must be 'cylinder' or 'cone' or .*, got 'amfora'"):
        sb.Column.estimated(**{**AMPHORA, "profile": "amfora"})
    with pytest.raises(ParameterError, match="mass_height must lie inside the body"):
        sb.Column.estimated(**{**AMPHORA, "mass_height": 0.95})
    with pytest.raises(ParameterError, match=r"max_radius: must be at least the radius of the base, 0\.11 m"):
        sb.Column.estimated(**AMPHORA, max_radius=0.1)
    with pytest.raises(ParameterError, match="max_radius: the foot is it, for the profile cylinder"):
        sb.Column.estimated(**{**AMPHORA, "profile": "cylinder"}, max_radius=0.2)
    with pytest.raises(ParameterError, match="mass_height: lies too close to an end of the body"):
        sb.Column.estimated(**{**AMPHORA, "mass_height": 1e-4})
    with pytest.warns(UnlikelyInputWarning, match="mass_height: 0.15 m is unlikely for the profile amphora"):
        sb.Column.estimated(**{**AMPHORA, "mass_height": 0.15})


def test_a_resized_column_keeps_its_profile_to_scale():
    column = sb.Column.estimated(**AMPHORA)
    twice = column.resized(2.0)
    assert twice.profile.heights[-1] == pytest.approx(2.0 * 0.95)
    assert twice.profile.radii[0] == pytest.approx(twice.radius)
    slim = column.with_slenderness(0.1)
    assert slim.profile.radii[0] == pytest.approx(slim.radius)
    assert slim.profile.axial_spread == column.profile.axial_spread


def test_a_body_of_parts_keeps_the_spread_of_estimated_ones():
    figure = sb.Column.estimated(radius=0.2, height=1.6, mass_height=0.7, mass=300.0, profile="statue")
    plinth = sb.Column.solid(radius=0.4, height=0.8, mass=500.0)
    both = sb.Column.from_parts([plinth, figure])
    share = figure.transverse_inertia / both.transverse_inertia
    assert both.profile.transverse_spread == pytest.approx(TRANSVERSE_SPREAD * share)
    assert sb.Column.from_parts([plinth, plinth]).profile is None
