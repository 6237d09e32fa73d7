"""Times at which a lane records its state, and what it records, in plain Python: samples, looks and pairs."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.columns import EARLIER, LAGS, NOTE, PAIRS, Pair, pair_begins

SLENDER = sb.Slender(sb.Column.dimensionless(0.1))
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)


def times_of(one, kind, *, most=60):
    """Return the times of all records of a kind, and their indices."""
    found = []
    one.do(f"set_{kind}")
    while one[f"{kind}s_at"] < math.inf and len(found) < most:
        found.append((one[f"{kind}s_at"], one[f"next_{kind}"]))
        one[f"next_{kind}"] += 1.0
        one.do(f"set_{kind}")
    return [time for time, _ in found], [int(index) for _, index in found]


@pytest.mark.parametrize("count", [0, 2, 5, 11])
def test_samples_divide_the_run_and_the_last_is_its_end(lane_of, count):
    times, _ = times_of(lane_of(SLENDER, CIRCLE, end=0.7, samples=float(count)), "sample")
    assert times == pytest.approx(np.linspace(0.0, 0.7, count))
    assert times[-1:] == [0.7][:count]


@pytest.mark.parametrize(("first", "end", "asked"), [(0.0, 10.0, 4), (0.7, 10.0, 4), (0.7, 10.7, 4), (0.7, 10.0, 20)])
def test_stroboscopic_samples_are_the_last_times_of_phase_zero(lane_of, first, end, asked):
    one = lane_of(SLENDER, CIRCLE, end=end, period=2.5, strobe=first, strobes=float(asked))
    times, indices = times_of(one, "strobe")
    known = first + 2.5 * np.arange(math.floor((end - first) / 2.5 + 1e-9) + 1)
    assert times == pytest.approx(known[-asked:])
    # The last column is the last time; columns before the run are empty.
    assert indices == list(range(asked - len(times), asked))
    assert times_of(lane_of(SLENDER, CIRCLE, end=end, strobes=float(asked)), "strobe") == ([], [])


@pytest.mark.parametrize(("periods", "back", "held"), [(20, 40, 60), (20, 0, 60), (12, 30, 25), (20, 0, 15)])
def test_looks_follow_each_other_after_a_period_up_to_the_end(lane_of, periods, back, held):
    end, looks = held * 2.5, EARLIER + LAGS + 1 + periods
    one = lane_of(
        SLENDER, CIRCLE, end=end, period=2.5, periods=float(periods), looks=float(looks), looked_back=float(back)
    )
    times, indices = times_of(one, "look")
    if held < periods + 1:
        assert times == []
        return
    expected = {index: end - (looks - 1 - index) * 2.5 for index in range(EARLIER, looks)}
    if back:
        expected |= {index: end - (back + EARLIER - 1 - index) * 2.5 for index in range(EARLIER)}
    late = {index: time for index, time in expected.items() if index < EARLIER or time >= -1e-9}
    assert dict(zip(indices, times, strict=True)) == pytest.approx(late)
    assert times[-1] == end


@pytest.mark.parametrize("held", [50.0, 8.0, 0.0])
def test_a_pair_is_two_states_one_period_apart_within_the_run(lane_of, held):
    one = lane_of(SLENDER, CIRCLE, end=held * 2.5, period=2.5, pair_spacing=3.0)
    times, indices = times_of(one, "pair")
    begins = [held * 2.5 - pair_begins(pair, 3.0) * 2.5 for pair in range(PAIRS)]
    expected = [time for begin in begins if begin >= 0.0 for time in (begin, begin + 2.5)]
    assert times == pytest.approx(expected)
    assert indices == list(range(2 * PAIRS - len(expected), 2 * PAIRS))
    assert times_of(lane_of(SLENDER, CIRCLE, end=99.0, period=2.5), "pair") == ([], [])


def note(one, index):
    column = one.scope("note_column")["BREAKS_AT"] + int(one["breaks"]) + NOTE * index
    return one.table[0, column : column + NOTE]


@pytest.mark.parametrize("planar", [False, True])
def test_a_sample_is_the_tilt_vector_and_its_rate_in_three_dimensions(lane_of, planar):
    line = {"line_x": 0.6, "line_y": 0.8, "breaks": 3.0}
    lean = {"x": 0.5, "vx": -2.0} if planar else {"x": 0.3, "y": 0.4, "vx": -1.2, "vy": -1.6}
    one = lane_of(SLENDER, CIRCLE, planar=planar, **line, **lean)
    one.do("record_lean", one.table, 2, 7.5)
    assert note(one, 2) == pytest.approx([0.3, 0.4, -1.2, -1.6, 7.5])
    one["stands"] = 1.0
    one.do("record_lean", one.table, 2, 8.5)
    assert list(note(one, 2)) == [0.0, 0.0, 0.0, 0.0, 8.5]


def test_a_pair_holds_the_change_over_a_period_and_the_azimuth_before_it(lane_of):
    counts = {"samples": 2.0, "strobes": 1.0, "looks": 4.0, "breaks": 1.0}
    one = lane_of(SLENDER, CIRCLE, x=-0.03, y=0.03, vx=0.1, vy=0.2, turns=2.0, next_pair=6.0, **counts)
    one.do("take_pair", one.table)
    found = note(one, 7 + 3)
    assert found == pytest.approx([-0.03, 0.03, 0.1, 0.2, 2.375])
    for name, value in {"x": 0.01, "y": 0.06, "vx": 0.4, "vy": 0.6, "next_pair": 7.0}.items():
        one[name] = value
    one.do("take_pair", one.table)
    expected = {Pair.TILT_CHANGE: 0.05, Pair.RATE_CHANGE: 0.5, Pair.AZIMUTH: 2.375}
    expected |= {Pair.TILT: math.hypot(0.01, 0.06), Pair.RATE: math.hypot(0.4, 0.6)}
    assert found == pytest.approx([expected[column] for column in Pair])


def test_observation_begins_with_the_first_look_of_the_last_periods(lane_of):
    one = lane_of(SLENDER, CIRCLE, x=-0.03, y=0.04, turns=2.0, late_minimum_tilt=1.0, samples=2.0)
    for index in range(EARLIER + LAGS + 2):
        one["next_look"], one["watched"] = float(index), 0.0
        one.do("take_look", one.table, 5.0)
        assert one["watched"] == float(index == EARLIER + LAGS)
        assert note(one, 2 + index)[4] == pytest.approx(2.5 - math.atan2(0.04, 0.03) / (2.0 * math.pi))
    assert one["late_minimum_tilt"] == pytest.approx(0.05)


def test_each_record_at_a_stop_is_taken_once_and_the_next_is_set(lane_of):
    counts = {"samples": 4.0, "strobes": 2.0, "period": 1.0, "end": 3.0}
    one = lane_of(SLENDER, CIRCLE, x=0.1, **counts)
    one.do("set_sample")
    one.do("set_strobe")
    for t in (0.0, 1.0, 2.0):
        one["x"] = 0.1 + t
        assert one.do("next_stop") == t
        one.do("meet_stop", one.table, one.pieces, t)
    assert [note(one, index)[0] for index in range(6)] == pytest.approx([0.1, 1.1, 2.1, 0.0, 2.1, 0.0])
    assert [note(one, index)[4] for index in range(6)] == [0.0, 1.0, 2.0, 0.0, 2.0, 0.0]
    one.do("set_next_stop")
    assert (one["stop"], one["samples_at"], one["strobes_at"]) == (3.0, 3.0, 3.0)
