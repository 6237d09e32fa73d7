"""Attractors are found from strobed states, whatever the order of the runs, and named."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import Outcome, ParameterError
from stylobate.results.outcomes import code_of
from stylobate.studies.branches import follow_branches
from stylobate.studies.finding import UNSETTLED, Attractor, find_attractors
from stylobate.studies.strobes import (
    AttractorRules,
    OrbitScales,
    cycle_distance,
    group_cycles,
    is_flat,
    keeps_moving,
    repeating_periods,
)

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
MOTION = sb.Harmonic.circular(acceleration=0.065, angular_frequency=np.pi)
SCALES = OrbitScales.of(MODEL, MOTION)
RULES = AttractorRules()
STROBES = 32
RNG = np.random.default_rng(7)


def states(count):
    return RNG.normal(size=(count, 2)) + 1j * RNG.normal(size=(count, 2))


def repeated(cycle, begin=0):
    return np.stack([cycle[(begin + i) % len(cycle)] for i in range(STROBES)])


def runs_of(outcomes, strobes, turns):
    """A dataset of runs with these strobed states, as an ensemble gives it."""
    tilt, tilt_rate = SCALES.vectors(np.array(strobes))
    over = ("run", "strobe", "axis")
    return xr.Dataset(
        {
            "outcome": ("run", np.array([-1 if one is None else code_of(one) for one in outcomes], dtype=np.int8)),
            "strobe_tilt": (over, tilt),
            "strobe_tilt_rate": (over, tilt_rate),
            "mean_rolling_rate": ("run", 2.0 * np.pi / SCALES.period * np.array(turns, dtype=float)),
            "mean_tilt": ("run", np.full(len(outcomes), 0.01)),
        }
    )


@pytest.mark.parametrize("period", [1, 2, 3, 5, 16])
def test_an_orbit_of_k_strobes_repeats_after_k(period):
    periods, left = repeating_periods(repeated(states(period))[np.newaxis], RULES)
    assert periods.tolist() == [period]
    assert left[0] == 0.0


def test_what_creeps_or_wanders_or_has_no_strobe_does_not_repeat():
    creeping = states(1) + 1e-3 * np.arange(STROBES)[:, np.newaxis]
    gap = repeated(states(1))
    gap[0] = np.nan
    periods, _ = repeating_periods(np.stack([creeping, states(STROBES), gap]), RULES)
    assert periods.tolist() == [0, 0, 0]


def test_a_spiral_is_no_orbit_of_the_periods_in_which_it_turns():
    turns = np.exp(2j * np.pi / 3.0 * np.arange(STROBES)) * 0.95 ** np.arange(STROBES)
    spiral = states(1) + 1.1e-3 * turns[:, np.newaxis]
    after_three = np.abs(spiral - spiral[-3:][(np.arange(STROBES) - STROBES) % 3]).max()
    assert after_three < RULES.repeat_tolerance
    assert repeating_periods(spiral[np.newaxis], RULES)[0] == 0


def test_a_torus_goes_on_and_a_spiral_does_not():
    turns = np.exp(1j * np.sqrt(2.0) * np.arange(STROBES))[:, np.newaxis]
    damped = 0.99 ** np.arange(STROBES)[:, np.newaxis]
    strobes = np.stack([states(1) * turns, states(1) + states(1) * turns * damped, states(1) * turns / damped])
    # In the 16 strobes from one half to the other 0.99^16 = 0.85 is left, beyond the tolerance of a tenth.
    assert keeps_moving(strobes, RULES).tolist() == [True, False, False]
    assert not keeps_moving(1e-3 * strobes, RULES).any()


def test_an_orbit_in_a_plane_does_not_roll_whatever_its_azimuth_says():
    lean = np.exp(0.7j) * RNG.normal(size=(5, 2))
    assert is_flat(lean, RULES.match_tolerance)
    assert not is_flat(states(5), RULES.match_tolerance)
    runs = runs_of([Outcome.STILL_MOVING], [repeated(lean)], [-0.2])
    assert [one.kind for one in find_attractors(runs, SCALES, RULES).attractors] == ["rocking"]


def test_the_distance_of_orbits_does_not_depend_on_where_they_begin():
    first, second = states(3), states(3)
    apart = cycle_distance(first[np.newaxis], second)
    for shift in range(3):
        np.testing.assert_allclose(cycle_distance(np.roll(first, shift, axis=0)[np.newaxis], second), apart, rtol=1e-15)
        assert cycle_distance(np.roll(first, shift, axis=0)[np.newaxis], first)[0] == 0.0


def test_groups_do_not_depend_on_the_order_of_the_runs():
    orbits = [states(2) for _ in range(3)]
    cycles = np.stack([np.roll(orbits[i % 3], i % 2, axis=0) + 1e-3 * RNG.normal() for i in range(30)])
    left = RNG.random(30)
    order = RNG.permutation(30)
    groups, leaders = group_cycles(cycles, left, 3e-2)
    shuffled, leaders_shuffled = group_cycles(cycles[order], left[order], 3e-2)
    np.testing.assert_array_equal(shuffled, groups[order])
    np.testing.assert_array_equal(order[leaders_shuffled], leaders)
    assert len(leaders) == 3


def test_every_kind_of_attractor_is_found_and_listed_in_one_order():
    still = np.zeros((STROBES, 2), dtype=complex)
    rolling, other, double = states(1), states(1), states(2)
    wandering = states(STROBES)
    drifting = states(1) * np.exp(1j * np.sqrt(2.0) * np.arange(STROBES))[:, np.newaxis]
    creeping = states(1) + drifting * 0.95 ** np.arange(STROBES)[:, np.newaxis]
    ended = np.full((STROBES, 2), np.nan, dtype=complex)
    table = [
        (Outcome.OVERTURNED, ended, np.nan, "overturned"),
        (Outcome.ROLLING, repeated(rolling), -1.0, "rolling clockwise"),
        (Outcome.STILL_MOVING, repeated(double), 0.0, "rocking, period 2"),
        (Outcome.STILL_MOVING, repeated(double, begin=1), 0.0, "rocking, period 2"),
        (Outcome.ROCKING, repeated(other), 0.0, "rocking"),
        (Outcome.MODULATED, wandering, 1.0, "modulated anticlockwise"),
        (Outcome.AT_REST, ended, np.nan, "at rest"),
        (Outcome.AT_REST, still, np.nan, "at rest"),
        (Outcome.STILL_MOVING, drifting, -0.35, "aperiodic clockwise"),
        (Outcome.STILL_MOVING, drifting, 0.01, "aperiodic"),
        (Outcome.STILL_MOVING, drifting, 0.98, "modulated anticlockwise"),
        (Outcome.STILL_MOVING, creeping, 0.2, None),
        (Outcome.FAILED, wandering, np.nan, None),
        (None, ended, np.nan, None),
    ]
    outcomes, strobes, turns, names = zip(*table, strict=True)
    found = sb.studies.label_attractors(runs_of(outcomes, strobes, turns), MODEL, MOTION)
    listed = found["attractor_name"].values.tolist()
    assert listed == [
        "at rest",
        "rolling clockwise",
        "rocking",
        "rocking, period 2",
        "modulated anticlockwise",
        "aperiodic clockwise",
        "aperiodic",
        "overturned",
    ]
    labels = found["attractor"].values
    assert [listed[label] if label >= 0 else None for label in labels] == list(names)
    assert labels[-3:].tolist() == [UNSETTLED, UNSETTLED, -1]
    assert int(found["computed"]) == len(table) - 1
    assert int(found["unsettled"]) == 2
    assert int(found["count"].sum()) == len(table) - 3


def test_a_column_that_stands_for_a_part_of_each_period_rocks():
    rocking = repeated(states(1))
    found = find_attractors(runs_of([Outcome.AT_REST], [rocking], [np.nan]), SCALES, RULES)
    assert [one.kind for one in found.attractors] == ["rocking"]


def test_attractors_and_their_numbers_do_not_depend_on_the_order_or_number_of_runs():
    orbits = [states(1) * size for size in (0.5, 1.0, 2.0)]
    chosen = RNG.integers(3, size=40)
    runs = runs_of([Outcome.ROCKING] * 40, [repeated(orbits[i]) for i in chosen], [0.0] * 40)
    order = RNG.permutation(40)
    first, second = (find_attractors(one, SCALES, RULES) for one in (runs, runs.isel(run=order)))
    np.testing.assert_array_equal(second.labels, first.labels[order])
    fewer = find_attractors(runs.isel(run=slice(20)), SCALES, RULES)
    np.testing.assert_array_equal(fewer.labels, first.labels[:20])
    # The largest comes first.
    sizes = [np.abs(one.states).max() for one in first.attractors]
    assert sizes == sorted(sizes, reverse=True)


def test_several_of_a_kind_are_numbered():
    runs = runs_of([Outcome.ROCKING] * 2, [repeated(states(1)), repeated(states(1))], [0.0, 0.0])
    names = sb.studies.label_attractors(runs, MODEL, MOTION)["attractor_name"].values
    assert names.tolist() == ["rocking (1)", "rocking (2)"]


def test_runs_without_strobes_are_refused():
    runs = runs_of([Outcome.AT_REST], [repeated(states(1))], [0.0]).drop_vars("strobe_tilt")
    with pytest.raises(ParameterError, match="strobes"):
        sb.studies.label_attractors(runs, MODEL)


def test_states_and_vectors_are_inverse():
    tilt, tilt_rate = RNG.normal(size=(2, 5, 3, 2))
    for given, back in zip((tilt, tilt_rate), SCALES.vectors(SCALES.states(tilt, tilt_rate)), strict=True):
        np.testing.assert_allclose(back, given, rtol=1e-15)


def attractor(kind, place, period=1):
    return Attractor(kind, period, 0.0, 0.0, np.full((period, 2), place, dtype=complex))


def test_branches_follow_the_nearest_of_a_kind_whatever_their_order():
    along = [
        [attractor("rocking", 1.0), attractor("rocking", 3.0)],
        [attractor("rocking", 2.9), attractor("rocking", 1.2), attractor("overturned", 0.0)],
        [attractor("rocking", 1.4)],
        [attractor("rocking", 1.6), attractor("rocking", 2.8), attractor("rocking", 2.0, period=2)],
    ]
    branches = follow_branches(along)
    assert [one.kind for one in branches.last] == ["rocking", "rocking", "rocking", "overturned"]
    # The second rocking is lost at the third value and found again; two periods are no branch of one.
    assert branches.places == ((0, 1), (1, 0, 3), (0,), (0, 1, 2))


@pytest.mark.parametrize("sense", [1, -1])
def test_rolling_under_circular_motion_is_the_closed_form(sense):
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0, sense=sense, start_phase=0.4)
    start = sb.studies.steady_start(MODEL, motion)
    near = {
        f"{name}_{axis}": (0.98 * value, 1.02 * value)
        for name, pair in start.items()
        for axis, value in zip("xy", pair, strict=True)
    }
    over = {name: tuple(sorted(pair)) for name, pair in near.items()}
    # A deviation of 0.02 shrinks as exp(-ηt/2): after 100 periods by e^-10, to 1e-6 of the tilt.
    found = sb.studies.attractors(MODEL, motion, over=over, count=4, seed=3, periods=100)
    steady = sb.theory.steady_rolling(3.0, 0.065, c=0.1, eta=0.1).upper.amplitude
    assert found["attractor_name"].values.tolist() == [f"rolling {'anti' if sense > 0 else ''}clockwise"]
    assert found["attractor_turns"].item() == sense
    for size in ("attractor_mean_tilt", "attractor_largest_tilt"):
        assert found[size].item() == pytest.approx(steady, rel=2e-6)
    assert np.hypot(*found["attractor_tilt"].values[0, 0]) == pytest.approx(steady, rel=2e-6)
    assert found.attrs["kind"] == "attractors"
    assert "run" not in found.dims


def test_starts_that_change_the_system_are_refused():
    with pytest.raises(ParameterError, match="damping"):
        sb.studies.attractors(MODEL, over={"damping": (0.0, 0.1)}, count=2, duration=1.0)
