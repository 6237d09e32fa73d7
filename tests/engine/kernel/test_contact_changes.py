"""Changes between kinds of contact in a lane, in plain Python: guards, resets, counts and their record."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine import dop853
from stylobate.engine.kernel.columns import Trace
from stylobate.engine.kernel.driver.events import RunStatus, TraceKind
from stylobate.models.sliding.balance import Contact

MODEL = sb.Sliding(sb.Column.solid(radius=0.5, height=3.0, density=2700.0))
CIRCLE = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.2)
GUARD = {name: number for number, name in enumerate(MODEL.guard_names)}
ORDER = len(MODEL.state_names)


@pytest.fixture
def lane(lane_of):
    """Make a lane whose column rolls on its rim, leaning along the azimuth of 3/8 of a turn."""
    leaning = {"x": -0.03, "y": 0.03, "tilt": 0.03 * math.sqrt(2.0), "y0": -0.03, "y1": 0.03, "y15": 2.0}
    usual = {"atol": 1e-9, "rtol": 1e-8, "wanted": 0.01, "first_azimuth": math.nan, "last_azimuth": math.nan}
    return lambda **given: lane_of(MODEL, CIRCLE, **(leaning | usual | given))


# Guards within a step.


def test_guards_are_evaluated_at_stages_in_the_order_of_their_times(lane):
    scope = lane().scope("first_broken_guard")
    stages, places = scope["GUARD_STAGES"], scope["PLACES"]
    np.testing.assert_array_equal(places, [*(dop853.C[stage] for stage in stages[:-1]), 1.0])
    assert (np.diff([0.0, *places]) > 0.0).all()
    assert stages[-1] == dop853.STAGES  # the end of the step, whose state and rates are those of the next one


@pytest.mark.parametrize(
    ("name", "before", "marks"), [("lift", 1.0, 1.0), ("face_impact", 1.0, 1.0), ("face_impact", -1.0, 0.0)]
)
def test_a_broken_guard_marks_the_lane_the_last_one_only_if_it_falls(lane, name, before, marks):
    one = lane(guard_now=before)
    margins = tuple(-0.1 if guard == name else 1.0 for guard in GUARD)
    lean = one.scope("mark_broken_guards")["lean"](0.01, 0.0, 0.0, 0.0)
    one.do("mark_broken_guards", margins, lean)
    assert (one["broken"], one["guard_now"]) == (marks, margins[-1])
    one.do("mark_broken_guards", (1.0,) * len(GUARD), lean)
    assert one["broken"] == marks  # until the end of the step


# Motion after a change.


@pytest.mark.parametrize("last", [math.nan, 2.3, -1.6])
def test_the_azimuth_goes_on_from_the_last_one_without_a_jump(lane, last):
    one = lane(last_azimuth=last)
    assert one.do("set_moving", one.table, one.pieces) == RunStatus.WAITING
    expected = 0.375 if math.isnan(last) else 0.375 + round(last - 0.375)
    assert (one.do("azimuth_now"), one["first_azimuth"]) == pytest.approx((expected, expected))


@pytest.mark.parametrize(("before", "peak", "at"), [(0.04, 0.03 * math.sqrt(2.0), 5.0), (0.05, 0.05, 1.0)])
def test_a_change_of_contact_can_be_the_peak_of_the_tilt(lane, before, peak, at):
    one = lane(time=5.0, peak_tilt=before, peak_at=1.0)
    one.do("set_moving", one.table, one.pieces)
    assert (one["peak_tilt"], one["peak_at"]) == (peak, at)


@pytest.mark.parametrize("watched", [0.0, 1.0])
def test_a_reset_that_takes_time_is_observed_with_its_tilt(lane, watched):
    one = lane(time=5.0, watched=watched, late_minimum_tilt=1.0, low=2e-3, last0=-0.03, last1=0.03)
    one.do("pass_lapse", 1e-4)
    assert one["time"] == pytest.approx(5.0001)
    # Both ends lean alike: the integral is the tilt times the duration.
    assert one["mean_tilt"] == pytest.approx(1e-4 * 0.03 * math.sqrt(2.0) * watched)
    assert one["late_minimum_tilt"] == (pytest.approx(0.03 * math.sqrt(2.0)) if watched else 1.0)


@pytest.mark.parametrize("number", [-1, GUARD["friction"]])
def test_explicit_steps_begin_with_the_reset_of_a_guard_that_is_broken(lane, monkeypatch, number):
    one, resets = lane(time=1.0, samples_at=3.0, rejected=1.0, aimed=1.0), []
    scope = one.scope("go_on_explicitly")
    monkeypatch.setitem(scope, "broken_now", lambda *_: number)
    monkeypatch.setitem(scope, "apply_resets", lambda *given: resets.append(given[-1]) or RunStatus.LIMIT)
    status = one.driver.go_on_explicitly(one.buffer, 0, one.table, one.pieces, 1.0, pays=True)
    assert (status, resets) == ((RunStatus.LIMIT, [number]) if number >= 0 else (RunStatus.WAITING, []))
    assert one["stop"] == (99.0 if number >= 0 else 3.0)
    assert (one["rejected"], one["aimed"]) == (0.0, 0.0)


def test_a_guard_broken_within_an_implicit_step_ends_the_kind_of_contact(lane, monkeypatch):
    for number in (-1, GUARD["lift"]):
        one, ended = lane(time=1.0), []
        scope = one.scope("follow_implicitly")
        for name, value in (("set_rates", None), ("set_jacobian", 7), ("fastest_rate", 1e5), ("attempt", 0.1)):
            monkeypatch.setitem(scope, name, lambda *_, value=value: value)
        monkeypatch.setitem(scope, "first_broken_guard", lambda *_, number=number: (0.05, number))
        monkeypatch.setitem(
            scope, "end_contact", lambda *given, ended=ended: ended.append(given[-2:]) or RunStatus.JAMMED
        )
        monkeypatch.setitem(scope, "take_step", lambda *_: (RunStatus.STEP_LIMIT, -1))
        status = one.do("follow_implicitly", one.table, one.pieces)
        assert (status, ended) == ((RunStatus.JAMMED, [(0.05, number)]) if number >= 0 else (RunStatus.STEP_LIMIT, []))


def test_a_step_to_an_event_keeps_its_start_and_its_slopes(lane):
    one = lane(time=1.0, tried=0.2, steps=3.0, radial=1e-3, turns=2.0)
    start, slopes, change = np.random.default_rng(7).normal(size=(3, ORDER))
    start[0], start[1], start[15] = -0.03, 0.03, Contact.ROLLING
    change[0] = change[1] = change[15] = 0.0
    for j in range(ORDER):
        one[f"y{j}"], one[f"k0_{j}"], one[f"dense0_{j}"] = start[j], slopes[j], change[j]
    one.do("step_to", one.table, 0.1)
    assert [one[f"last{j}"] for j in range(ORDER)] == list(start)
    assert [one[f"last_slope{j}"] for j in range(ORDER)] == list(slopes)
    # Half of the step, on a dense output that is linear.
    np.testing.assert_allclose([one[f"y{j}"] for j in range(ORDER)], start + 0.5 * change, rtol=1e-14)
    assert (one["time"], one["made"], one["steps"], one["turns"]) == (1.1, 0.1, 4.0, 2.0)


# Counts.

R, S, ROLLS, SLIPS, FLIES = Contact.RESTING, Contact.SLIDING, Contact.ROLLING, Contact.SLIPPING, Contact.FLYING


@pytest.mark.parametrize(
    ("guard", "before", "after", "elapsed", "counted"),
    [
        ("friction", ROLLS, SLIPS, 0.0, {"slips"}),
        ("friction", R, S, 0.0, {"slips", "releases"}),
        ("friction", SLIPS, ROLLS, 0.0, set()),
        ("friction", SLIPS, SLIPS, 0.0, set()),  # continues in another direction
        ("friction", SLIPS, SLIPS, 0.1, {"slips"}),  # stuck for a time
        ("support", S, S, 0.0, {"slips"}),
        ("jam", ROLLS, SLIPS, 0.0, set()),
        ("face_impact", ROLLS, SLIPS, 0.0, {"impacts"}),
        ("lift", FLIES, ROLLS, 0.0, {"impacts"}),
        ("lift", FLIES, R, 0.0, {"impacts", "rests"}),
        ("rest", ROLLS, R, 0.0, {"rests"}),
        ("rest", R, R, 0.0, set()),
        ("support", R, ROLLS, 0.0, {"releases"}),
    ],
)
def test_a_change_of_contact_counts_as_impact_slip_rest_or_uplift(lane, guard, before, after, elapsed, counted):
    one = lane()
    one.do("count", GUARD[guard], int(before), int(after), elapsed)
    assert {name for name in ("impacts", "slips", "rests", "releases") if one[name] == 1.0} == counted
    assert one["released_from_rest"] == 0.0
    again = lane(rests=1.0)
    again.do("count", GUARD[guard], int(before), int(after), elapsed)
    assert again["released_from_rest"] == float("releases" in counted)


# Reset maps and their record.


@pytest.mark.parametrize("elapsed", [0.0, 0.01])
@pytest.mark.parametrize("traces", [0.0, 9.0])
def test_a_reset_changes_the_state_and_is_recorded(lane, monkeypatch, elapsed, traces):
    one = lane(time=5.0, since=2.0, time_rolling=1.0, traces=traces, turns=2.0, trace_azimuth=2.375)
    after = (*np.linspace(0.01, 0.02, ORDER - 1).tolist(), float(Contact.SLIPPING))
    before = [one[f"y{j}"] for j in range(ORDER)]
    monkeypatch.setitem(one.scope("apply_reset"), "model_reset", lambda *_: (elapsed, after))
    one.do("apply_reset", one.table, GUARD["friction"])
    assert [one[f"y{j}"] for j in range(ORDER)] == list(after)
    assert [one[f"last{j}"] for j in range(ORDER)] == before
    assert (one["time"], one["since"], one["time_rolling"]) == (5.0 + elapsed, 5.0, 4.0)
    assert (one["slips"], one["stands"], one["last_azimuth"]) == (1.0, 0.0, 2.375)
    assert (one["x"], one["y"]) == (after[0], after[1])
    width = one.shape.trace_width
    first = one.scope("trace_entry")["BREAKS_AT"]
    entries = [one.table[0, first + width * number :] for number in range(2)]
    if not traces:
        assert not entries[0].any()
        return
    kind, lapse = entries
    assert (kind[Trace.KIND], kind[Trace.START]) == (TraceKind.CONTACT, 5.0)
    assert list(kind[len(Trace) : len(Trace) + 3]) == [GUARD["friction"], Contact.ROLLING, Contact.SLIPPING]
    assert one["next_trace"] == (2.0 if elapsed else 1.0)
    if elapsed:
        assert (lapse[Trace.KIND], lapse[Trace.START]) == (TraceKind.ANALYTICAL_STEP, 5.0)
        assert lapse[Trace.LENGTH] == elapsed


def test_a_slip_that_goes_on_and_the_start_of_a_run_are_no_events(lane):
    one = lane(traces=9.0)
    going = tuple([0.0] * (ORDER - 1) + [float(Contact.SLIPPING)])
    one["y15"] = float(Contact.SLIPPING)
    one.do("trace_change", one.table, GUARD["friction"], 0.0, going)
    one.do("trace_change", one.table, -1, 0.0, going)
    assert one["next_trace"] == 0.0
    one.do("trace_change", one.table, GUARD["friction"], 0.1, going)
    assert one["next_trace"] == 1.0


def test_more_than_a_hundred_changes_at_one_time_end_the_run(lane):
    one = lane(time=5.0, changed_at=-math.inf)
    assert [one.do("endless") for _ in range(102)] == [False] * 101 + [True]
    one["time"] = 5.0 + 1e-11
    assert not one.do("endless")
    assert (one["at_once"], one["changed_at"]) == (0.0, one["time"])


def test_resets_follow_each_other_until_no_guard_is_broken(lane, monkeypatch):
    one, applied = lane(time=5.0, changed_at=-math.inf), []
    scope = one.scope("apply_resets")
    rest = iter([GUARD["lift"], GUARD["friction"], -1])
    monkeypatch.setitem(scope, "apply_reset", lambda _buf, _i, _table, number: applied.append(number))
    monkeypatch.setitem(scope, "broken_now", lambda *_: next(rest))
    monkeypatch.setitem(scope, "set_moving", lambda *_: RunStatus.WAITING)
    assert one.do("apply_resets", one.table, one.pieces, GUARD["rest"]) == RunStatus.WAITING
    assert applied == [GUARD["rest"], GUARD["lift"], GUARD["friction"]]
    assert one.do("apply_resets", one.table, one.pieces, GUARD["fallen"]) == RunStatus.OVERTURNED
    assert one.do("apply_resets", one.table, one.pieces, len(GUARD)) == RunStatus.LIMIT
    one["y15"] = float(Contact.JAMMED)
    assert one.do("apply_resets", one.table, one.pieces, GUARD["jam"]) == RunStatus.JAMMED
    assert len(applied) == 4


# Stiffness.


def test_some_successive_steps_near_the_boundary_of_stability_show_stiffness(lane, monkeypatch):
    one = lane(steps=500.0, stiff_look_at=500.0, stiff_wait=500.0, y15=float(Contact.SLIPPING))
    monkeypatch.setitem(one.scope("detect_stiffness"), "stability", lambda *_: 3.1)
    found = []
    for _ in range(8):
        found.append(one.do("detect_stiffness"))
        one["steps"] += 1.0
    assert found == [False] * 7 + [True]
    one["y15"] = float(Contact.ROLLING)
    assert not one.do("detect_stiffness")
    assert (one["stiff_looks"], one["stiff_look_at"]) == (0.0, 1008.0)
    one["y15"] = float(Contact.SLIPPING)
    assert not one.do("detect_stiffness")
    assert one["stiff_looks"] == 0.0  # no check is due
    monkeypatch.setitem(one.scope("detect_stiffness"), "stability", lambda *_: 2.9)
    one["steps"] = 1008.0
    assert not one.do("detect_stiffness")
    assert one["stiff_looks"] == 0.0


@pytest.mark.parametrize(
    ("number", "turns", "outcome"), [(-1, False, "again"), (1, True, "shorter"), (1, False, "ends"), (0, True, "ends")]
)
def test_a_step_held_back_is_repeated_shortened_or_ends_the_contact(lane, monkeypatch, number, turns, outcome):
    one, ended = lane(tried=0.2), []
    scope = one.scope("handle_held_step")
    for name, found in (("set_dense", None), ("first_broken_guard", (0.05, number)), ("slip_turns", turns)):
        monkeypatch.setitem(scope, name, lambda *_, found=found: found)
    monkeypatch.setitem(scope, "end_contact", lambda *given: ended.append(given[-2:]) or RunStatus.JAMMED)
    status = one.do("handle_held_step", one.table, one.pieces)
    assert (status, ended) == ((RunStatus.JAMMED, [(0.05, number)]) if outcome == "ends" else (RunStatus.WAITING, []))
    assert (one["aimed"], one["rejected"]) == (float(outcome == "again"), float(outcome == "shorter"))
    if outcome != "ends":
        assert one["h"] == (0.2 if outcome == "again" else pytest.approx(scope["SLIP_SHORTER"] * 0.05))
