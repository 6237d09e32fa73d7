"""Columns: moments of inertia against integrals, derived numbers, refusals."""

import dataclasses
import math
from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

import stylobate as sb
from stylobate.errors import ParameterError, UnlikelyInputWarning

lengths = st.floats(0.05, 20.0)


def integrated(outer, inner, height, density):
    """Return mass, height of the mass centre, I_t and I_a of a body of revolution by slices of its density."""

    def over_height(slice_at):
        return quad(slice_at, 0.0, height, epsabs=0.0, epsrel=1e-12)[0]

    def ring(z, power):
        return (outer(z) ** power - inner(z) ** power) / power * 2.0 * math.pi * density

    mass = over_height(lambda z: ring(z, 2))
    centre = over_height(lambda z: z * ring(z, 2)) / mass
    axial = over_height(lambda z: ring(z, 4))
    transverse = axial / 2.0 + over_height(lambda z: (z - centre) ** 2 * ring(z, 2))
    return mass, centre, transverse, axial


def numbers(column):
    return column.mass, column.mass_height, column.transverse_inertia, column.axial_inertia


@given(radius=lengths, height=lengths)
def test_a_solid_cylinder_has_the_moments_of_its_density(radius, height):
    column = sb.Column.solid(radius=radius, height=height, density=2700.0)
    expected = integrated(lambda _: radius, lambda _: 0.0, height, 2700.0)
    assert numbers(column) == pytest.approx(expected, rel=1e-9)
    assert column.transverse_inertia == pytest.approx(column.mass * (3.0 * radius**2 + height**2) / 12.0, rel=1e-9)


@given(radius=lengths, share=st.floats(0.01, 0.99), height=lengths)
def test_a_tube_has_the_moments_of_its_density(radius, share, height):
    column = sb.Column.hollow(radius=radius, inner_radius=share * radius, height=height, density=7800.0)
    expected = integrated(lambda _: radius, lambda _: share * radius, height, 7800.0)
    assert numbers(column) == pytest.approx(expected, rel=1e-9)


@given(radius=lengths, top=lengths, height=lengths)
def test_a_frustum_has_the_moments_of_its_density(radius, top, height):
    column = sb.Column.frustum(radius=radius, top_radius=top, height=height, density=2700.0)
    expected = integrated(lambda z: radius + (top - radius) * z / height, lambda _: 0.0, height, 2700.0)
    assert numbers(column) == pytest.approx(expected, rel=1e-9)


def test_a_frustum_without_taper_and_a_tube_without_bore_are_the_solid_cylinder():
    solid = sb.Column.solid(radius=0.5, height=10.0, density=2700.0)
    straight = sb.Column.frustum(radius=0.5, top_radius=0.5, height=10.0, density=2700.0)
    bored = sb.Column.hollow(radius=0.5, inner_radius=1e-9, height=10.0, density=2700.0)
    assert numbers(straight) == pytest.approx(numbers(solid), rel=1e-14)
    assert numbers(bored) == pytest.approx(numbers(solid), rel=1e-14)
    assert solid.axial_inertia == pytest.approx(solid.mass * 0.125, rel=1e-14)


@given(c=st.floats(0.001, 1.0), ratio=st.floats(0.3, 0.95), axial=st.floats(0.01, 0.6))
def test_a_dimensionless_column_has_unit_mass_gravity_and_frequency(c, ratio, axial):
    if axial * c**2 * ratio > 2.0 * (1.0 - ratio):
        return  # no body has these inertias
    column = sb.Column.dimensionless(c, ratio, axial)
    assert (column.mass, column.gravity) == (1.0, 1.0)
    assert column.frequency_scale == pytest.approx(1.0, rel=1e-14)
    assert column.slenderness == pytest.approx(c, rel=1e-14)
    assert column.inertia_ratio == pytest.approx(ratio, rel=1e-14)
    assert column.axial_ratio == pytest.approx(axial, rel=1e-14)
    assert column.base_inertia == pytest.approx(ratio, rel=1e-14)


def test_the_numbers_of_the_literature():
    column = sb.Column.solid(radius=0.5, height=6.0, density=2000.0, gravity=9.81)
    mass, half = 2000.0 * math.pi * 0.25 * 6.0, 3.0
    inertia = mass * (0.25 / 4.0 + 36.0 / 12.0)
    distance = math.hypot(0.5, 3.0)
    assert column.tipping_angle == pytest.approx(math.atan(0.5 / 3.0), rel=1e-15)
    assert column.rim_distance == pytest.approx(distance, rel=1e-15)
    assert column.base_inertia == pytest.approx(inertia + mass * half**2, rel=1e-13)
    assert column.rim_inertia == pytest.approx(inertia + mass * distance**2, rel=1e-13)
    assert column.frequency_scale == pytest.approx(
        math.sqrt(mass * 9.81 * half / (inertia + mass * half**2)), rel=1e-13
    )
    expected = math.sqrt(mass * 9.81 * distance / (inertia + mass * distance**2))
    assert column.frequency_parameter == pytest.approx(expected, rel=1e-13)
    # A slender block or column swings about its rim at about √(3g/4R).
    assert column.frequency_parameter == pytest.approx(math.sqrt(0.75 * 9.81 / distance), rel=0.02)


def test_gravity_changes_the_frequency_and_nothing_of_the_shape():
    earth, moon = (sb.Column.solid(radius=0.5, height=6.0, density=2000.0, gravity=g) for g in (9.0, 1.0))
    assert earth.frequency_scale == pytest.approx(3.0 * moon.frequency_scale, rel=1e-15)
    assert dataclasses.replace(earth, gravity=1.0) == moon


SOLID = {"radius": 0.5, "height": 10.0, "density": 2700.0}
MISSING = ("density", None)  # a solid column can have a mass instead
GIVEN = {"radius": 0.5, "mass_height": 5.0, "mass": 1e3, "transverse_inertia": 8e3, "axial_inertia": 125.0}


@pytest.mark.parametrize("value", [0.0, -0.5, math.nan, math.inf, "wide", None, 1j])
@pytest.mark.parametrize("name", ["radius", "height", "density", "gravity"])
def test_an_impossible_number_is_refused_with_its_name_and_value(name, value):
    makers = [partial(sb.Column.frustum, top_radius=0.4), *([sb.Column.solid] if (name, value) != MISSING else [])]
    for make in makers:
        with pytest.raises(ParameterError, match=f"^{name} must be") as caught:
            make(**{**SOLID, name: value})
        assert repr(value) in str(caught.value)


@pytest.mark.filterwarnings("ignore::stylobate.errors.UnlikelyInputWarning")
@given(radius=lengths, height=lengths, mass=st.floats(1e-4, 1e6))
def test_a_solid_cylinder_of_a_mass_is_that_of_its_density(radius, height, mass):
    by_mass = sb.Column.solid(radius=radius, height=height, mass=mass)
    by_density = sb.Column.solid(radius=radius, height=height, density=mass / (math.pi * radius**2 * height))
    assert by_mass.mass == mass
    assert numbers(by_mass) == pytest.approx(numbers(by_density), rel=1e-14)


@pytest.mark.parametrize(
    ("stated", "remedy"),
    [
        ({"density": 0.884}, "density: 0.884 kg/m³ is unlikely. For 0.884 g/cm³ give 884 kg/m³."),
        ({"density": 7.85e6}, "density: 7.85e.06 kg/m³ is unlikely. Check its unit"),
        ({"mass": 500.0}, "mass: 500 kg is unlikely, with a density of 8.842e.05 kg/m³. Check its unit"),
        ({"mass": 5e-4}, "mass: 0.0005 kg is unlikely"),
    ],
)
def test_a_density_that_no_material_has_is_questioned(stated, remedy):
    with pytest.warns(UnlikelyInputWarning, match=f"^{remedy}") as caught:
        sb.Column.solid(radius=0.03, height=0.2, **stated)
    assert len(caught) == 1


@pytest.mark.parametrize(
    ("stated", "got"), [({}, "neither"), ({"density": 884.0, "mass": 0.5}, "884.0 kg/m³ and 0.5 kg")]
)
def test_a_solid_cylinder_has_either_a_density_or_a_mass(stated, got):
    with pytest.raises(ParameterError) as caught:
        sb.Column.solid(radius=0.03, height=0.2, **stated)
    assert str(caught.value) == f"density or mass: a column needs one of them (got {got}). State one."


@pytest.mark.parametrize("name", [*GIVEN, "height", "gravity"])
def test_each_number_of_a_given_column_is_checked(name):
    with pytest.raises(ParameterError, match=f"^{name} must be positive, got -1.0"):
        sb.Column(**{**GIVEN, name: -1.0})


@pytest.mark.parametrize("name", [*GIVEN, "gravity"])
def test_only_the_height_may_be_unknown(name):
    with pytest.raises(ParameterError, match=f"^{name} must be a real number, got None"):
        sb.Column(**{**GIVEN, name: None})
    assert sb.Column(**GIVEN, height=None).height is None


@pytest.mark.parametrize(
    ("make", "name", "value"),
    [
        (lambda: sb.Column.hollow(**SOLID, inner_radius=0.5), "inner_radius", "0.5"),
        (lambda: sb.Column.hollow(**SOLID, inner_radius=-0.1), "inner_radius", "-0.1"),
        (lambda: sb.Column.frustum(**SOLID, top_radius=0.0), "top_radius", "0.0"),
        (lambda: sb.Column.dimensionless(0.0), "slenderness", "0.0"),
        (lambda: sb.Column.dimensionless(0.1, 1.0), "inertia_ratio", "1.0"),
        (lambda: sb.Column.dimensionless(0.1, 0.75, -0.5), "axial_ratio", "-0.5"),
        (lambda: sb.Column.dimensionless(0.1, 0.75, 90.0), "axial_ratio", "90.0"),
        (lambda: sb.Column(**{**GIVEN, "axial_inertia": 2e4}), "axial_inertia", "20000.0"),
        (lambda: sb.Column(**GIVEN, height=5.0), "mass_height", "5.0"),
        (lambda: sb.Column(**{**GIVEN, "transverse_inertia": 4e4}, height=10.0), "transverse_inertia", "40000.0"),
    ],
)
def test_impossible_bodies_are_refused_with_name_and_value(make, name, value):
    with pytest.raises(ParameterError, match=f"^{name} must") as caught:
        make()
    assert value in str(caught.value)


def test_bodies_at_the_bounds_are_accepted():
    disc = sb.Column(**{**GIVEN, "axial_inertia": 16e3})
    assert disc.axial_inertia == 2.0 * disc.transverse_inertia
    ends = sb.Column(**{**GIVEN, "transverse_inertia": 25e3 + 62.5}, height=10.0)  # all mass at the ends
    assert ends.height == 10.0


def test_a_column_is_a_value():
    assert sb.Column.solid(**SOLID) == sb.Column.solid(**SOLID)
    with pytest.raises(dataclasses.FrozenInstanceError):
        sb.Column.solid(**SOLID).radius = 1.0
