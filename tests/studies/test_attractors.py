"""Attractors are found from strobed states, whatever the order of the runs, and named."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import Outcome, ParameterError
from stylobate.studies.maps.attractor_search import (
    UNSETTLED,
    Attractor,
    AttractorRules,
    FoundAttractors,
    OrbitScales,
    cycle_distance,
    find_attractors,
    group_cycles,
    is_flat,
    repeating_periods,
    with_strobes,
    with_turns,
)
from stylobate.studies.maps.attractors import label_attractors, shares, turns_of_paths
from stylobate.studies.maps.basin_fractions import follow_branches
from stylobate.studies.proportions import wilson_interval
from stylobate.studies.sweeps import Sweep

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
            "outcome": ("run", np.array([-1 if one is None else one for one in outcomes], dtype=np.int8)),
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
        (Outcome.APERIODIC, drifting, -0.35, "aperiodic clockwise"),
        (Outcome.APERIODIC, drifting, 0.01, "aperiodic"),
        (Outcome.MODULATED, drifting, 0.98, "modulated anticlockwise"),
        (Outcome.STILL_MOVING, creeping, 0.2, "not settled"),
        (Outcome.STILL_MOVING, wandering, 1.0, "not settled"),
        (Outcome.FAILED, wandering, np.nan, "not settled"),
        (None, ended, np.nan, None),
    ]
    outcomes, strobes, turns, names = zip(*table, strict=True)
    found = label_attractors(runs_of(outcomes, strobes, turns), MODEL, MOTION)
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
        "not settled",
    ]
    labels = found["attractor"].values
    assert [listed[label] if label >= 0 else None for label in labels] == list(names)
    assert labels[-1] == -1
    assert int(found["computed"]) == int(found["count"].sum()) == len(table) - 1
    assert int(found["unsettled"]) == int(found["count"][-1]) == 3
    assert "more periods" in found["unsettled"].attrs["comment"]
    assert float(found["fraction"].sum()) == pytest.approx(1.0, rel=1e-15)
    assert np.isnan(found["attractor_mean_tilt"].values[-1])
    assert found["attractor"].attrs["flag_meanings"].split()[-1] == "not_settled"


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
    names = label_attractors(runs, MODEL, MOTION)["attractor_name"].values
    assert names.tolist() == ["rocking (1)", "rocking (2)"]


def test_runs_without_strobes_are_refused():
    runs = runs_of([Outcome.AT_REST], [repeated(states(1))], [0.0]).drop_vars("strobe_tilt")
    with pytest.raises(ParameterError, match="strobes"):
        label_attractors(runs, MODEL)


def test_states_and_vectors_are_inverse():
    tilt, tilt_rate = RNG.normal(size=(2, 5, 3, 2))
    for given, back in zip((tilt, tilt_rate), SCALES.vectors(SCALES.states(tilt, tilt_rate)), strict=True):
        np.testing.assert_allclose(back, given, rtol=1e-15)


def test_means_over_a_part_of_an_orbit_are_not_taken_for_turns():
    cycle = states(3)
    rolling = [Outcome.STILL_MOVING], [repeated(cycle)]
    # One turn in three periods: the last ten hold three of them, or four if the part left over has one.
    for mean in (0.3, 0.4):
        (found,) = find_attractors(runs_of(*rolling, [mean]), SCALES, RULES).attractors
        assert (found.kind, found.period) == ("rolling anticlockwise", 3)
        assert np.isnan(found.turns)
    followed = runs_of(*rolling, [0.4]).assign_attrs(provenance='{"rules": {"periods": 12}}')
    assert find_attractors(followed, SCALES, RULES).attractors[0].turns == 1.0 / 3.0


def path_of(turns, samples=1025):
    """The path of an orbit that turns so often round the upright."""
    angle = 2.0 * np.pi * turns * np.linspace(0.0, 1.0, samples)
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def test_turns_are_counted_along_the_path_of_an_orbit():
    orbits = [attractor("rocking", 1.0, period) for period in (3, 7, 0)]
    paths = xr.Dataset(
        {"orbit_tilt": (("attractor_index", "orbit_sample", "axis"), np.stack([path_of(n) for n in (-2, 3, 1)]))}
    )
    np.testing.assert_array_equal(turns_of_paths(paths, orbits), [-2.0 / 3.0, 3.0 / 7.0, np.nan])
    through = path_of(0) * np.linspace(-1.0, 1.0, 1025)[:, np.newaxis]
    assert np.isnan(
        turns_of_paths(xr.Dataset({"orbit_tilt": (paths["orbit_tilt"].dims, through[np.newaxis])}), orbits[:1])
    )


def test_orbits_whose_turns_become_known_are_named_and_listed_anew():
    unknown = [replace(attractor("rolling anticlockwise", place, 3), turns=np.nan) for place in (2.0, 1.0)]
    found, order = with_turns(
        FoundAttractors((*unknown,), np.array([0, 1, 1, UNSETTLED])), np.array([0.0, 1.0 / 3.0]), 3e-2
    )
    assert [(one.kind, one.turns) for one in found.attractors] == [
        ("rolling anticlockwise", 1.0 / 3.0),
        ("rocking", 0.0),
    ]
    assert order.tolist() == [1, 0]
    assert found.labels.tolist() == [1, 0, 0, UNSETTLED]


def test_unsettled_runs_widen_the_intervals_of_the_fractions_upwards():
    labels = np.array([0] * 6 + [1] * 2 + [UNSETTLED] * 2)
    found = shares(FoundAttractors((attractor("rocking", 1.0), attractor("rocking", 2.0)), labels), 0.95)
    # Of what has not settled, listed last, nothing is open.
    np.testing.assert_array_equal(found["fraction_low"], wilson_interval([6, 2, 2], 10)[0])
    np.testing.assert_array_equal(found["fraction_high"], wilson_interval([8, 4, 2], 10)[1])


def attractor(kind, place, period=1):
    return Attractor(kind, period, 0.0, 0.0, np.full((period, 2), place, dtype=complex))


def test_branches_follow_the_nearest_of_a_kind_whatever_their_order():
    along = [
        [attractor("rocking", 1.0), attractor("rocking", 3.0)],
        [attractor("rocking", 2.9), attractor("rocking", 1.2), attractor("overturned", 0.0)],
        [attractor("rocking", 1.4)],
        [attractor("rocking", 1.6), attractor("rocking", 2.8), attractor("rocking", 2.0, period=2)],
    ]
    branches = follow_branches(along, RULES.branch_tolerance)
    assert [one.kind for one in branches.last] == ["rocking", "rocking", "rocking", "overturned"]
    # The second rocking is lost at the third value and found again; two periods are no branch of one.
    assert branches.places == ((0, 1), (1, 0, 3), (0,), (0, 1, 2))


def test_an_orbit_that_jumps_too_far_begins_a_branch():
    along = [[attractor("rocking", 1.0)], [attractor("rocking", 1.4)], [attractor("rocking", 2.0)]]
    assert follow_branches(along, 0.5).places == ((0,), (0,), (1,))
    assert follow_branches(along, 0.7).places == ((0,), (0,), (0,))


def test_what_has_no_period_is_followed_by_its_kind():
    wandering = [[attractor("aperiodic", place, 0)] for place in (1.0, -5.0)]
    assert follow_branches(wandering, 0.5).places == ((0,), (0,))


@pytest.mark.parametrize(("periods", "strobes"), [(100.0, 32), (32.0, 32), (25.0, 12), (8.0, 4)])
def test_short_runs_keep_the_strobes_of_their_second_half(periods, strobes):
    sweep = Sweep.grid(MODEL, MOTION, over={"tilt_x": [0.01]}, periods=periods)
    assert with_strobes(sweep, None).options["strobes"] == strobes
    followed = Sweep.grid(MODEL, MOTION, over={"tilt_x": [0.01]}, duration=periods * MOTION.period)
    assert with_strobes(followed, None).options["strobes"] == strobes


def test_runs_too_short_for_their_strobes_are_refused_before_they_are_computed():
    over = {"tilt_x": (-0.05, 0.05)}
    with pytest.raises(ParameterError, match=r"at least 8 periods .*, got 7 \(duration 14 s\); follow them longer"):
        sb.studies.attractors(MODEL, MOTION, over=over, count=2, periods=7.0)
    with pytest.raises(ParameterError, match=r"at least 32 periods .*, got 20 .* fewer strobes"):
        sb.studies.attractors(MODEL, MOTION, over=over, count=2, periods=20.0, strobes=32)
    along = {"angular_frequency": [np.pi / 4.0, np.pi]}
    with pytest.raises(ParameterError, match=r"at least 8 periods .*, got 5 "):  # at the lower frequency
        sb.studies.basin_fractions(MODEL, MOTION, along=along, over=over, count=2, duration=40.0)
    with pytest.raises(ParameterError, match=r"strobes must be .* at least 2"):
        sb.studies.attractors(MODEL, MOTION, over=over, count=2, periods=20.0, strobes=1)


def test_runs_without_any_full_row_of_strobes_are_refused():
    gap = repeated(states(1))
    gap[0] = np.nan
    with pytest.raises(ParameterError, match="strobes, 32, got shorter ones"):
        find_attractors(runs_of([Outcome.STILL_MOVING], [gap], [0.0]), SCALES, RULES)


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
    found = sb.studies.attractors(MODEL, motion, over=over, count=4, rng=3, periods=100)
    steady = sb.theory.steady_rolling(3.0, 0.065, c=0.1, eta=0.1).upper.amplitude
    assert found["attractor_name"].values.tolist() == [f"rolling {'anti' if sense > 0 else ''}clockwise"]
    assert found["attractor_turns"].item() == sense
    for size in ("attractor_mean_tilt", "attractor_peak_tilt"):
        assert found[size].item() == pytest.approx(steady, rel=2e-6)
    assert np.hypot(*found["attractor_tilt"].values[0, 0]) == pytest.approx(steady, rel=2e-6)
    assert found.attrs["kind"] == "attractors"
    assert "run" not in found.dims


def test_starts_that_change_the_system_are_refused():
    with pytest.raises(ParameterError, match="damping"):
        sb.studies.attractors(MODEL, over={"damping": (0.0, 0.1)}, count=2, duration=1.0)
