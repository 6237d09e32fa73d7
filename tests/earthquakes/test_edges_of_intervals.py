"""Edges found in a scan and halved are those of the outcomes along the scale, whatever these are."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes.overturning_scales import Cases, Edges, Ends, interval_table

MODEL = sb.Slender(sb.Column.dimensionless(0.1))
PULSE = sb.Pulse.half_sine(acceleration=0.1, angular_frequency=2.0)
UNKNOWN = -2


def outcomes_of(changes, unknown=()):
    """Return what runs come to that overturn between the 1st and 2nd of the `changes`, the 3rd and 4th, and so on."""

    def tell(scale):
        scale = np.asarray(scale, dtype=float)
        state = np.searchsorted(changes, scale) % 2
        for low, high in unknown:
            state = np.where((scale > low) & (scale < high), UNKNOWN, state)
        side = np.where(np.searchsorted(changes, scale) % 4 == 1, 0.0, math.pi)
        return Ends(scale, state.astype(np.int64), np.where(state == 1, side, np.nan), np.zeros(scale.shape, bool))

    return tell


def between(scan):
    """Return the edges of the scan of one case."""
    return Edges.between(np.zeros(scan.scale.size, dtype=int), scan.reshaped(-1))


def searched(tell, scales, width):
    """Return scan and edges of one case after all halvings, and how many these were."""
    scan = tell(np.array([scales]))
    edges, runs = between(scan), 0
    while (wide := edges.wide(width)).any():
        runs += int(wide.sum())
        edges = edges.halved(wide, tell(edges.middle[wide]))
    return scan, edges, runs


def intervals(scan, edges):
    return interval_table(Cases.of(MODEL, PULSE, None), scan, edges)


SCALES = np.geomspace(1.0, 10.0, 11)


def test_every_interval_that_a_scale_falls_into_is_found_to_the_width():
    changes = [1.7, 2.9, 4.0, 6.5, 8.3]
    scan, edges, _ = searched(outcomes_of(changes), SCALES, 1e-6)
    found = intervals(scan, edges)
    np.testing.assert_allclose(found["interval_from"], [1.7, 4.0, 8.3], rtol=1e-6)
    np.testing.assert_allclose(found["interval_to"], [2.9, 6.5, 10.0], rtol=1e-6)
    assert (found["safe_below"] < [1.7, 4.0, 8.3]).all()
    assert (found["interval_from"] > [1.7, 4.0, 8.3]).all()
    assert (found["safe_above"][:2] > [2.9, 6.5]).all()
    assert found["open_above"].values.tolist() == [False, False, True]
    assert not found["open_below"].any()


def test_a_gap_between_two_scales_shows_by_the_direction_on_either_side():
    scan, edges, _ = searched(outcomes_of([1.5, 4.1, 4.2, 20.0]), [1.0, 3.0, 9.0], 1e-4)
    found = intervals(scan, edges)
    assert int(found["intervals"]) == 2
    np.testing.assert_allclose(found["interval_to"][0], 4.1, rtol=1e-4)
    np.testing.assert_allclose(found["interval_from"][1], 4.2, rtol=1e-4)


def test_a_direction_that_turns_without_a_gap_leaves_one_interval():
    scan, edges, _ = searched(outcomes_of([1.5, 4.1, 4.1, 20.0]), [1.0, 3.0, 9.0], 1e-4)
    found = intervals(scan, edges)
    assert int(found["intervals"]) == int(found["reversals"]) == 1
    assert found["open_above"].item()


def test_halving_halves_edges_and_keeps_what_they_enclose():
    tell = outcomes_of([1.7, 2.9, 4.0])
    scan = tell(np.array([SCALES]))
    edges = between(scan)
    for _ in range(5):
        cut = edges.halved(edges.wide(0.0), tell(edges.middle))
        np.testing.assert_allclose(
            np.log(cut.high.scale / cut.low.scale), 0.5 * np.log(edges.high.scale / edges.low.scale), rtol=1e-12
        )
        assert (cut.low.scale >= edges.low.scale).all()
        assert (cut.high.scale <= edges.high.scale).all()
        edges = cut


def test_the_halvings_announced_are_those_made():
    tell = outcomes_of([1.7, 2.9, 4.0])
    _, _, runs = searched(tell, SCALES, 1e-3)
    assert runs == between(tell(np.array([SCALES]))).halvings(1e-3)


def test_undecided_runs_part_intervals_and_are_halved_like_every_other_edge():
    # Overturns from 1.7 to 2.9 and from 4 to 6.5; undecided inside both, and where the second ends.
    hidden = [(2.1, 2.7), (5.0, 7.0)]
    scan, edges, _ = searched(outcomes_of([1.7, 2.9, 4.0, 6.5], unknown=hidden), SCALES, 1e-6)
    found = intervals(scan, edges)
    np.testing.assert_allclose(found["interval_from"], [1.7, 2.7, 4.0], rtol=1e-6)
    np.testing.assert_allclose(found["interval_to"], [2.1, 2.9, 5.0], rtol=1e-6)
    assert found["open_above"].values.tolist() == found["undecided_above"].values.tolist() == [True, False, True]
    assert found["open_below"].values.tolist() == found["undecided_below"].values.tolist() == [False, True, False]
    # No edge to an undecided run is called safe on its other side.
    assert found["safe_above"].isnull().values.tolist() == [True, False, True]
    assert found["safe_below"].isnull().values.tolist() == [False, True, False]
    assert found["uncertain_above"].values.tolist() == [True, False, True]
    np.testing.assert_allclose(found["undecided_from"], [2.1, 5.0], rtol=1e-6)
    np.testing.assert_allclose(found["undecided_to"], [2.7, 7.0], rtol=1e-6)
    assert float(found["decided_to"]) == float(found["undecided_from"][0])
    assert int(found["unknown"]) == sum(np.count_nonzero((low < SCALES) & (high > SCALES)) for low, high in hidden)


@pytest.mark.parametrize(
    ("hidden", "decided_to", "stretches"),
    [([(0.0, 2.4)], np.nan, [(1.0, 2.4)]), ([(7.0, 20.0)], 7.0, [(7.0, 10.0)]), ([(0.0, 20.0)], np.nan, [(1.0, 10.0)])],
)
def test_undecided_runs_at_an_end_of_the_scan_reach_to_it(hidden, decided_to, stretches):
    found = intervals(*searched(outcomes_of([30.0], unknown=hidden), SCALES, 1e-6)[:2])
    assert int(found["intervals"]) == 0
    np.testing.assert_allclose(found["decided_to"], decided_to, rtol=1e-6)
    shown = np.stack([found["undecided_from"], found["undecided_to"]], axis=-1)
    np.testing.assert_allclose(shown, stretches, rtol=1e-6)


def test_a_scan_that_is_decided_throughout_has_no_undecided_stretch():
    found = intervals(*searched(outcomes_of([1.7, 2.9]), SCALES, 1e-3)[:2])
    assert found["undecided_from"].isnull().all()
    assert float(found["decided_to"]) == SCALES[-1]


@pytest.mark.parametrize("states", [[1, 1, 1], [UNKNOWN] * 3, [0, 0, 0]])
def test_what_never_changes_has_one_interval_or_none(states):
    scan = Ends(np.array([[1.0, 2.0, 3.0]]), np.array([states]), np.zeros((1, 3)), np.zeros((1, 3), dtype=bool))
    found = intervals(scan, between(scan))
    assert int(found["intervals"]) == (1 if states[0] == 1 else 0)
    if states[0] == 1:
        assert bool(found["open_below"].all() & found["open_above"].all())
        assert (found["interval_from"].item(), found["interval_to"].item()) == (1.0, 3.0)
    else:
        assert found["interval_from"].isnull().all()
