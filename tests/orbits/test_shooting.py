"""Periodic orbits by shooting: against closed forms, against direct integration, from any start."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.errors import NoOrbitError, ParameterError, UnsupportedError
from stylobate.orbits import periodic_orbit, periodic_orbits
from stylobate.orbits.shooting import shots

C, ETA = 0.1, 0.1


def slender(eta=ETA):
    return sb.Slender(sb.Column.dimensionless(C), damping=eta)


MODEL = slender()
STRAIGHT = sb.Harmonic.straight(acceleration=0.04, angular_frequency=2.0)
ELLIPSE = sb.Harmonic.elliptic(amplitude=(0.08, 0.04), phase=-math.pi / 2.0, angular_frequency=2.0)


def circle(nu, a0, sense=1):
    return sb.Harmonic.circular(acceleration=a0, angular_frequency=nu, sense=sense)


def distance_of_sets(found, expected):
    """Return the largest distance from one of `expected` to the nearest of `found`, both used once."""
    left = list(found)
    distances = []
    for value in expected:
        nearest = min(range(len(left)), key=lambda k: abs(left[k] - value))
        distances.append(abs(left.pop(nearest) - value))
    return max(distances)


CIRCULAR = [
    (nu, a0, eta)
    for nu in (0.8, 1.2, 1.7, 3.0)
    for a0 in (0.02, 0.065, 0.12)
    for eta in (0.02, 0.1, 0.4)
    if a0 > eta * C / math.sqrt(4.0 + eta**2)
]


@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize(("nu", "a0", "eta"), CIRCULAR)
def test_multipliers_of_circular_motion_are_exponentials_of_the_exact_eigenvalues(nu, a0, eta, sense):
    orbit = periodic_orbit(slender(eta), circle(nu, a0, sense), sense=sense)
    rolling = sb.theory.steady_rolling(nu, a0, c=C, eta=eta).upper
    expected = np.exp(2.0 * math.pi / nu * rolling.eigenvalues)
    # A double multiplier, as a collision brings it, would have half the digits.
    assert distance_of_sets(orbit.multipliers, expected) < 1e-8 * max(1.0, np.abs(expected).max())
    assert orbit.stable == bool(rolling.stable)
    assert orbit.turns == sense
    assert orbit.inversion


@pytest.mark.parametrize(("nu", "a0", "eta"), CIRCULAR)
def test_orbits_of_circular_motion_are_steady_rolling(nu, a0, eta):
    rolling = sb.theory.steady_rolling(nu, a0, c=C, eta=eta).upper
    # Begun off it: theory's guess would be exact already.
    start = rolling.amplitude * np.exp(1j * rolling.phase)
    exact = np.array([start.real, start.imag, -nu * start.imag, nu * start.real])
    orbit = periodic_orbit(slender(eta), circle(nu, a0), guess=exact * 1.001)
    np.testing.assert_allclose(orbit.state, exact, rtol=0.0, atol=1e-11)
    assert orbit.minimum_tilt == pytest.approx(rolling.amplitude, rel=1e-9)
    assert orbit.peak_tilt == pytest.approx(rolling.amplitude, rel=1e-9)
    assert orbit.mean_tilt == pytest.approx(rolling.amplitude, rel=1e-9)


@pytest.mark.parametrize("nu", [1.2, 2.0])
def test_the_lower_branch_is_a_saddle_with_the_eigenvalues_of_theory(nu):
    rolling = sb.theory.steady_rolling(nu, 0.065, c=C, eta=ETA).lower
    start = rolling.amplitude * np.exp(1j * rolling.phase)
    guess = np.array([start.real, start.imag, -nu * start.imag, nu * start.real])
    orbit = periodic_orbit(MODEL, circle(nu, 0.065), guess=guess)
    np.testing.assert_allclose(orbit.state, guess, rtol=0.0, atol=1e-11)
    expected = np.exp(2.0 * math.pi / nu * rolling.eigenvalues)
    # The least ones stand beside the largest one: rounding of that is their error.
    assert distance_of_sets(orbit.multipliers, expected) < 1e-10 * np.abs(expected).max()
    assert not orbit.stable


@pytest.mark.parametrize("motion", [STRAIGHT, ELLIPSE, circle(2.0, 0.065)], ids=["straight", "ellipse", "circle"])
def test_the_product_of_all_multipliers_is_what_friction_makes_of_volumes(motion):
    orbit = periodic_orbit(MODEL, motion)
    assert np.prod(orbit.multipliers).real == pytest.approx(math.exp(-2.0 * ETA * orbit.period), rel=1e-9)


@pytest.mark.parametrize("motion", [STRAIGHT, ELLIPSE], ids=["straight", "ellipse"])
@pytest.mark.parametrize("sense", [1, -1])
def test_simulate_repeats_the_orbit(motion, sense):
    if sense < 0 and motion is ELLIPSE:
        pytest.skip("no such guess")
    orbit = periodic_orbit(MODEL, motion, sense=sense)
    run = sb.simulate(
        MODEL, motion, tilt=orbit.tilt, tilt_rate=orbit.tilt_rate, duration=5.0 * orbit.period, rtol=1e-12
    )
    end = run.data.isel(time=-1)
    # Stable: what the steps err by decays.
    np.testing.assert_allclose(end["tilt"], orbit.tilt, rtol=0.0, atol=1e-9 * C)
    np.testing.assert_allclose(end["tilt_rate"], orbit.tilt_rate, rtol=0.0, atol=1e-9 * C)
    tilts = np.hypot(*run.data["tilt"].to_numpy().T)
    # Samples miss an extreme by the square of their distance.
    assert orbit.peak_tilt == pytest.approx(tilts.max(), rel=1e-3)
    assert orbit.minimum_tilt == pytest.approx(tilts.min(), rel=1e-3)


def test_a_stable_orbit_is_where_runs_end_and_a_run_is_a_guess():
    orbit = periodic_orbit(MODEL, STRAIGHT)
    run = sb.simulate(MODEL, STRAIGHT, tilt=orbit.tilt * 1.1, tilt_rate=orbit.tilt_rate, duration=100.0 * orbit.period)
    found = periodic_orbit(MODEL, STRAIGHT, guess=run)
    np.testing.assert_allclose(found.state, orbit.state, rtol=0.0, atol=1e-11)


def test_mirrored_motions_have_mirrored_orbits():
    """Straight along x: y → −y turns one sense of rolling into the other."""
    one, other = (periodic_orbit(MODEL, STRAIGHT, sense=sense) for sense in (1, -1))
    np.testing.assert_allclose(other.state, one.state * [1.0, -1.0, 1.0, -1.0], rtol=0.0, atol=1e-12)
    assert (one.turns, other.turns) == (1.0, -1.0)
    assert distance_of_sets(one.multipliers, other.multipliers) < 1e-9


@pytest.mark.parametrize("angle", [0.7, -2.0])
def test_turned_motions_have_turned_orbits(angle):
    usual, turned = (periodic_orbit(MODEL, motion, guess=guess) for motion, guess in _turned(angle))
    rotation = np.exp(1j * angle)
    for k in (0, 2):
        whole = complex(*usual.state[k : k + 2]) * rotation
        assert complex(*turned.state[k : k + 2]) == pytest.approx(whole, abs=1e-12)


def _turned(angle):
    guess = periodic_orbit(MODEL, ELLIPSE).state
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    return (ELLIPSE, guess), (ELLIPSE.rotated(angle), np.concatenate([turn @ guess[:2], turn @ guess[2:]]))


@pytest.mark.parametrize("arcs", [2, 3, 8])
@pytest.mark.parametrize("periods", [1, 2])
def test_orbit_and_multipliers_do_not_depend_on_the_number_of_arcs(arcs, periods):
    usual = periodic_orbit(MODEL, STRAIGHT)
    orbit = periodic_orbit(MODEL, STRAIGHT, periods=periods, arcs=arcs)
    np.testing.assert_allclose(orbit.state, usual.state, rtol=0.0, atol=1e-12)
    assert distance_of_sets(orbit.multipliers, usual.multipliers) < 1e-9
    np.testing.assert_allclose(orbit.path, usual.path, rtol=0.0, atol=1e-11)


@pytest.mark.parametrize("periods", [2, 3, 4])
def test_an_orbit_is_told_with_its_least_period(periods):
    usual, orbit = periodic_orbit(MODEL, STRAIGHT), periodic_orbit(MODEL, STRAIGHT, periods=periods)
    assert (orbit.periods, orbit.period) == (1, usual.period)
    np.testing.assert_allclose(orbit.state, usual.state, rtol=0.0, atol=1e-12)


def test_derivatives_of_a_chain_equal_differences_of_its_residual():
    system = PeriodicSystem(MODEL, STRAIGHT)
    states = periodic_orbit(MODEL, STRAIGHT, arcs=3).chain.states * 1.01
    for sense, periods in ((1.0, 1.0), (-1.0, 0.5)):
        change = system.derivative("angular_frequency")
        chain = shots(system, states, periods, sense=sense, change=change)

        def residual(x, sense=sense, periods=periods):
            return shots(system, x.reshape(states.shape), periods, sense=sense).residual.ravel()

        h = 1e-5
        columns = [(residual(states.ravel() + d) - residual(states.ravel() - d)) / (2 * h) for d in h * np.eye(12)]
        # Differences: third derivatives are about 1/C² of the first ones.
        np.testing.assert_allclose(chain.matrix, np.transpose(columns), rtol=0.0, atol=1e-6)

        def at(nu, sense=sense, periods=periods):
            changed = system.changed(angular_frequency=nu)
            return shots(changed, states, periods, sense=sense).residual.ravel()

        np.testing.assert_allclose(chain.by_parameter, (at(2.0 + h) - at(2.0 - h)) / (2 * h), rtol=0.0, atol=1e-8)


# In a plane.

PLANAR = [(nu, a1, eta) for nu in (1.5, 3.0, 6.0) for a1 in (0.04, 0.13, 0.3) for eta in (0.0, 0.05, 0.1, 0.4)]


def planar_case(nu, a1, expected, *, later, eta=ETA):
    """Return the base motion, and the orbit of theory, both begun a part `later` of a period after the passage."""
    phase, speed = float(expected.phase), float(expected.crossing_velocity)
    direction = 0.3
    along = np.array([math.cos(direction), math.sin(direction)])
    begun, motion = (
        sb.Harmonic.straight(acceleration=a1, angular_frequency=nu, direction=direction, start_phase=start)
        for start in (phase, phase + 2.0 * math.pi * later)
    )
    system = PeriodicSystem(slender(eta), begun, (float(along[0]), float(along[1])))
    state = system.carry(np.array([0.0, speed]), 0.0, later).end
    return motion, np.concatenate([state[0] * along, state[1] * along])


@pytest.mark.parametrize(("nu", "a1", "eta"), PLANAR)
def test_symmetric_orbits_in_a_plane_are_those_of_the_closed_form(nu, a1, eta):
    response = sb.theory.planar_forced_response(nu, a1, c=C, eta=eta)
    existing = [expected for expected in (response.fast, response.slow) if expected.exists]
    if not existing:
        pytest.skip("theory has no orbit here")
    for expected in existing:
        motion, exact = planar_case(nu, a1, expected, later=0.2, eta=eta)
        orbit = periodic_orbit(slender(eta), motion, guess=exact * 1.0001)
        assert orbit.planar
        assert orbit.inversion
        np.testing.assert_allclose([*orbit.tilt, *orbit.tilt_rate], exact, rtol=0.0, atol=1e-10 * np.abs(exact).max())
        assert orbit.peak_tilt == pytest.approx(float(expected.amplitude), rel=1e-3)
        squared = expected.multipliers**2
        # Twice the same multiplier has half the digits.
        assert distance_of_sets(orbit.multipliers, squared) < 1e-7 * max(1.0, np.abs(squared).max())
        assert orbit.stable == bool(expected.stable_in_plane)


@pytest.mark.parametrize("later", [0.0, 0.5, 0.25])
@pytest.mark.parametrize(("nu", "a1"), [(3.0, 0.13), (6.0, 0.13), (6.0, 0.3), (3.0, 0.3)])
def test_orbits_in_a_plane_may_pass_the_upright_where_they_begin_or_are_sampled(nu, a1, later):
    """As theory gives them: from a passage; a quarter of a period later a passage is among the samples."""
    expected = sb.theory.planar_forced_response(nu, a1, c=C, eta=ETA).fast
    motion, exact = planar_case(nu, a1, expected, later=later)
    orbit = periodic_orbit(MODEL, motion, guess=exact)
    np.testing.assert_allclose([*orbit.tilt, *orbit.tilt_rate], exact, rtol=0.0, atol=1e-10)
    assert orbit.inversion
    assert orbit.mean_tilt > 0.5 * float(expected.amplitude)
    squared = expected.multipliers**2
    assert distance_of_sets(orbit.multipliers, squared) < 1e-7 * max(1.0, np.abs(squared).max())


def test_largest_tilts_in_a_plane_are_exact():
    response = sb.theory.planar_forced_response(3.0, 0.13, c=C, eta=ETA).fast
    motion, guess = planar_case(3.0, 0.13, response, later=0.2)
    orbit = periodic_orbit(MODEL, motion, guess=guess)
    assert orbit.peak_tilt == pytest.approx(float(response.amplitude), rel=1e-8)


@pytest.mark.parametrize("arcs", [2, 3, 5, 7])
def test_an_orbit_in_a_plane_does_not_depend_on_the_number_of_arcs(arcs):
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
    guess = [0.02523651, 0.0, -0.00401839, 0.0]
    usual, orbit = (periodic_orbit(MODEL, motion, guess=guess, arcs=count) for count in (1, arcs))
    np.testing.assert_allclose(orbit.state, usual.state, rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(orbit.path, usual.path, rtol=0.0, atol=1e-11)
    assert distance_of_sets(orbit.multipliers, usual.multipliers) < 1e-9


def test_arcs_that_begin_near_a_passage_keep_to_their_side():
    """States asked for on a grid that has a passage between the last of them and the next arc."""
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
    guess = [0.02523651, 0.0, -0.00401839, 0.0]
    usual = periodic_orbit(MODEL, motion, guess=guess)
    for arcs in (2, 3, 5):
        orbit = periodic_orbit(MODEL, motion, guess=guess, arcs=arcs)
        for count in (5, 7, 11):
            np.testing.assert_allclose(orbit.states(count), usual.states(count), rtol=0.0, atol=1e-11)


# Many orbits.


def test_a_search_finds_both_senses_and_unstable_orbits_each_once():
    orbits = periodic_orbits(MODEL, STRAIGHT)
    assert {orbit.turns for orbit in orbits if orbit.stable} == {1.0, -1.0}
    assert any(not orbit.stable and orbit.turns == 0.0 for orbit in orbits)
    for orbit in orbits:
        assert np.abs(orbit.chain.residual).max() < 1e-12
    for k, one in enumerate(orbits):
        for other in orbits[:k]:
            assert np.abs(one.state - other.state).max() > 1e-5 * C
    expected = periodic_orbit(MODEL, STRAIGHT)
    assert any(np.allclose(orbit.state, expected.state, rtol=0.0, atol=1e-11) for orbit in orbits)


@pytest.mark.parametrize("direction", [0.0, 0.7])
def test_under_a_motion_along_a_line_a_search_finds_the_mirror_image_of_each_orbit(direction):
    """The reflection in the plane of the base motion maps orbits to orbits, with the same multipliers."""
    motion = sb.Harmonic.straight(acceleration=0.04, angular_frequency=2.0, direction=direction)
    orbits = periodic_orbits(MODEL, motion, count=12)
    assert any(orbit.turns == 1.0 for orbit in orbits)
    cos, sin = math.cos(2.0 * direction), math.sin(2.0 * direction)
    reflection = np.kron(np.eye(2), [[cos, sin], [sin, -cos]])
    for orbit in orbits:
        (image,) = (one for one in orbits if np.allclose(one.state, reflection @ orbit.state, rtol=0.0, atol=1e-11))
        assert image.turns == -orbit.turns
        # Beside a large multiplier the least ones have its rounding.
        assert distance_of_sets(image.multipliers, orbit.multipliers) < 1e-9 * abs(orbit.multipliers[0])


def test_a_search_gives_the_same_for_the_same_seed():
    first, second = (periodic_orbits(MODEL, STRAIGHT, count=8, rng=3) for _ in range(2))
    assert len(first) == len(second)
    for one, other in zip(first, second, strict=True):
        np.testing.assert_array_equal(one.state, other.state)


def test_a_search_finds_what_is_near_its_starts():
    """The saddle of circular motion, from starts within a fifth of its tilt."""
    lower = sb.theory.steady_rolling(1.2, 0.065, c=C, eta=ETA).lower
    state = np.array([np.cos(lower.phase), np.sin(lower.phase)]) * lower.amplitude
    state = np.array([*state, -1.2 * state[1], 1.2 * state[0]])
    reach = 0.1 * float(lower.amplitude)
    names = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")
    over = {name: (number - reach, number + reach) for name, number in zip(names, state, strict=True)}
    orbits = periodic_orbits(MODEL, circle(1.2, 0.065), over=over, count=8)
    assert any(np.allclose(orbit.state, state, rtol=0.0, atol=1e-11) for orbit in orbits)


def test_orbits_found_over_two_periods_are_told_with_their_own_period():
    usual = periodic_orbit(MODEL, STRAIGHT)
    names = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")
    over = {name: (number - 0.002, number + 0.002) for name, number in zip(names, usual.state, strict=True)}
    (orbit, *_) = periodic_orbits(MODEL, STRAIGHT, over=over, count=4, periods=2)
    assert orbit.periods == 1
    np.testing.assert_allclose(orbit.state, usual.state, rtol=0.0, atol=1e-11)


def test_a_search_over_two_periods_finds_what_one_over_one_period_finds():
    usual, twice = (periodic_orbits(MODEL, STRAIGHT, count=32, periods=periods) for periods in (1, 2))
    stable = [orbit.turns for orbit in usual if orbit.stable]
    assert sorted(stable) == sorted(orbit.turns for orbit in twice if orbit.stable)


def test_a_search_begins_in_its_ranges():
    """One start, beside rolling anticlockwise: that and its mirror image."""
    over = {"tilt_x": (0.01, 0.02), "tilt_y": (-0.001, 0.001), "tilt_rate_x": (0.0, 0.0), "tilt_rate_y": (0.03, 0.05)}
    orbits = periodic_orbits(MODEL, STRAIGHT, over=over, count=1)
    assert [orbit.turns for orbit in orbits] == [1.0, -1.0]


# Bad input.


def test_the_tolerance_stays_with_the_orbit():
    orbit = periodic_orbit(MODEL, STRAIGHT, rtol=1e-9)
    assert orbit.system.rtol == 1e-9


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"guess": [0.1, 0.2]}, "guess"),
        ({"guess": [0.1, 0.2, math.nan, 0.0]}, "guess"),
        ({"guess": "somewhere"}, "guess"),
        ({"guess": [[0.1, 0.0, 0.0, 0.0]]}, "guess"),
        ({"sense": 2}, "sense"),
        ({"sense": 0}, "sense"),
        ({"sense": 2, "guess": [0.02, 0.0, 0.0, 0.03]}, "sense"),
        ({"periods": 0}, "periods"),
        ({"periods": 1.5}, "periods"),
        ({"arcs": 0}, "arcs"),
        ({"rtol": 0.0}, "rtol"),
        ({"rtol": math.nan}, "rtol"),
    ],
)
def test_bad_input_is_told_in_one_line(arguments, words):
    with pytest.raises(ParameterError, match=words) as told:
        periodic_orbit(MODEL, STRAIGHT, **arguments)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"count": 0}, "count"),
        ({"periods": 0}, "periods"),
        ({"rtol": -1.0}, "rtol"),
        ({"over": {"height": (0.0, 1.0)}}, "height"),
        ({"over": {"tilt_x": (0.1, 0.0)}}, "tilt_x"),
        ({"over": {"tilt_x": (0.1,)}}, "tilt_x"),
        ({"over": {"tilt_x": (0.0, math.nan)}}, "tilt_x"),
        ({"rng": -1}, "rng"),
    ],
)
def test_bad_input_of_a_search_is_told_in_one_line(arguments, words):
    with pytest.raises(ParameterError, match=words) as told:
        periodic_orbits(MODEL, STRAIGHT, **arguments)
    assert "\n" not in str(told.value)


def test_a_guess_that_leads_nowhere_is_told_in_one_line():
    for guess in ([0.3, 0.0, 0.1, 0.0], [1e-9, 0.0, 0.0, 1e-9]):
        with pytest.raises(NoOrbitError, match="no periodic orbit was reached") as told:
            periodic_orbit(MODEL, ELLIPSE, guess=guess)
        assert "\n" not in str(told.value)
    with pytest.raises(NoOrbitError, match="no steady rolling") as told:
        periodic_orbit(slender(0.3), circle(1.0, 0.01))
    assert "\n" not in str(told.value)


def test_motions_without_a_theory_need_a_guess():
    with pytest.raises(UnsupportedError, match="guess must be given"):
        periodic_orbit(MODEL, sb.Harmonic(amplitude=(0.1, 0.0, 0.1), angular_frequency=2.0))
    with pytest.raises(ParameterError, match="last at least one period"):
        periodic_orbit(MODEL, STRAIGHT, guess=sb.simulate(MODEL, STRAIGHT, tilt=(0.02, 0.01), duration=1.0))
