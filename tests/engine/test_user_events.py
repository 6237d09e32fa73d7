"""Event functions of a user, beside the events that every run locates."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate.errors import ParameterError

MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.05)
CIRCLE = sb.Harmonic.circular(acceleration=0.08, angular_frequency=1.7)
START = {"tilt": (0.04, 0.01), "tilt_rate": (-0.01, 0.06)}
SOLID = sb.Column.solid(radius=0.15, height=1.2, density=1000.0)


def along_x(time, state):
    return state["tilt"][0] - 0.01 * math.sin(0.3 * time)


def by_scipy(direction):
    """Return the times of the zeros of `along_x` as SciPy finds them in the equations of the slender column."""

    def derivative(time, y):
        acceleration = [float(part) for part in CIRCLE.acceleration(np.array([time]))[0]]
        return MODEL.rates(*y, *acceleration, *MODEL.parameters)

    def crossing(time, y):
        return along_x(time, {"tilt": y[:2]})

    crossing.direction = direction
    start = (*START["tilt"], *START["tilt_rate"])
    found = solve_ivp(derivative, (0.0, 20.0), start, "DOP853", events=crossing, rtol=1e-12, atol=1e-15, max_step=0.1)
    return found.t_events[0]


@pytest.mark.parametrize("direction", [-1, 0, 1])
def test_events_of_a_slender_column_are_where_scipy_finds_them(direction):
    events = [sb.EventFunction("crossing", along_x, direction=direction)]
    run = sb.simulate(MODEL, CIRCLE, **START, duration=20.0, rtol=1e-12, events=events)
    expected = by_scipy(direction)
    times = [event.time for event in run.events if event.kind == "crossing"]
    assert len(expected) >= 2
    np.testing.assert_allclose(times, expected, rtol=0.0, atol=1e-8)


def test_events_change_nothing_else():
    bare = sb.simulate(MODEL, CIRCLE, **START, duration=20.0)
    run = sb.simulate(MODEL, CIRCLE, **START, duration=20.0, events=[along_x])
    assert run.data.identical(bare.data)
    assert run.measures == bare.measures
    assert [event for event in run.events if event.kind != "along_x"] == list(bare.events)


@pytest.mark.parametrize("count", [1, 3])
def test_a_terminal_event_ends_the_run(count):
    events = [sb.EventFunction("crossing", along_x, terminal=count)]
    run = sb.simulate(MODEL, CIRCLE, **START, duration=20.0, rtol=1e-12, events=events)
    assert run.outcome is sb.Outcome.STOPPED
    assert run.reason == "its event 'crossing' ended the run"
    assert [event.kind for event in run.events] == ["crossing"] * count
    assert run.decided_at == run.events[-1].time == pytest.approx(by_scipy(0)[count - 1], abs=1e-8)
    assert float(run.data["time"][-1]) == pytest.approx(run.decided_at, rel=1e-14)


def test_functions_with_the_attributes_of_scipy_are_events():
    def upright(time, state):
        return state["amplitude"] - 0.02

    upright.direction, upright.terminal = -1, True
    run = sb.simulate(MODEL, tilt=(0.05, 0.0), duration=20.0, events=[upright])
    assert run.outcome is sb.Outcome.STOPPED
    assert run.events[-1] == sb.Event("upright", run.decided_at)
    assert float(run.data["amplitude"][-1]) == pytest.approx(0.02, abs=1e-12)


def test_an_event_in_the_plane_is_where_the_closed_form_has_it():
    # Without damping α = c − (c − A0) cosh τ up to the vertical.
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1))
    events = [sb.EventFunction("low", lambda _, state: state["tilt"][0] - 0.01)]
    run = sb.simulate(model, tilt=(0.05, 0.0), duration=1.5, rtol=1e-12, events=events)
    assert run.planar
    (low,) = [event.time for event in run.events if event.kind == "low"]
    assert low == pytest.approx(math.acosh(0.09 / 0.05), abs=1e-9)


def test_an_event_while_the_column_stands():
    motion = sb.Harmonic.straight(acceleration=0.05, angular_frequency=2.0)
    events = [sb.EventFunction("push", lambda _, state: state["base_acceleration"][0] - 0.02, direction=1, terminal=2)]
    run = sb.simulate(MODEL, motion, duration=20.0, events=events)
    first, second = (event.time for event in run.events if event.kind == "push")
    assert second - first == pytest.approx(math.pi, rel=1e-12)
    assert motion.acceleration(np.array([first]))[0, 0] == pytest.approx(0.02, rel=1e-12)
    assert run.outcome is sb.Outcome.STOPPED
    assert run.data["resting"].all()


def test_an_impact_that_changes_the_sign_is_an_event():
    model = sb.PlanarRocking(SOLID, restitution=0.5)
    events = [sb.EventFunction("slow", lambda _, state: np.hypot(*state["tilt_rate"]) - 0.05, direction=-1)]
    run = sb.simulate(model, tilt=(0.01, 0.0), duration=3.0, events=events)
    impacts = {event.time for event in run.events if event.kind == "impact"}
    assert impacts.intersection(event.time for event in run.events if event.kind == "slow")


@pytest.mark.parametrize("make", [sb.Slender, sb.SlenderRolling, sb.Wobbling, sb.Rolling, sb.Sliding])
def test_every_model_has_events_whose_states_are_those_of_its_data(make):
    options = {"friction_coefficient": 0.5} if make is sb.Sliding else {}
    model = make(SOLID, damping=0.1, **options)
    seen = {}

    def watched(time, state):
        seen[time] = dict(state, energy=state["energy"])
        return state["tilt_rate"][0]

    start = {"tilt": (0.05, 0.0), "tilt_rate": (0.0, 0.2), "duration": 0.6}
    run = sb.simulate(model, **start, events=[watched])
    assert any(event.kind == "watched" for event in run.events)
    time = max(time for time in seen if time < 0.5)
    at = run.sample(time).isel(time=0)
    for name, value in seen[time].items():
        if name not in ("base_acceleration", "resting"):
            np.testing.assert_allclose(value, at[name], rtol=1e-9, atol=1e-12, err_msg=name)


def test_a_sliding_column_stops_where_its_base_has_slid_far_enough():
    model = sb.Sliding(SOLID, friction_coefficient=0.05)
    shaking = sb.Harmonic.straight(acceleration=2.0, angular_frequency=4.0)
    events = [sb.EventFunction("slid", lambda _, state: np.hypot(*state["footprint"]) - 0.05, terminal=True)]
    run = sb.simulate(model, shaking, duration=10.0, events=events)
    assert run.outcome is sb.Outcome.STOPPED
    assert float(np.hypot(*run.data["footprint"][-1])) == pytest.approx(0.05, abs=1e-10)


@pytest.mark.parametrize(
    ("events", "message"),
    [
        ([1.0], r"^events\[0\]: not callable \(got 1\.0\)\. Provide an EventFunction"),
        (along_x, r"^events: must be a list of event functions \(got <function"),
        ([along_x, along_x], r"^events\[1\]: its name is taken \(got 'along_x'\)\. Use EventFunction"),
        ([sb.EventFunction("impact", along_x)], r"^events\[0\]: its name is taken \(got 'impact'\)"),
        ([lambda time, state: math.nan], "^events: '<lambda>' is NaN at 0 s. Return a number there"),
        ([lambda time, state: "x"], "^events: the value of '<lambda>' must be a real number, got 'x'"),
        ([lambda time, state: state["lean"]], "^events: no variable 'lean' in the state. Use one of tilt, tilt_rate, "),
    ],
)
def test_mistakes_name_the_event(events, message):
    with pytest.raises(ParameterError, match=message):
        sb.simulate(MODEL, tilt=(0.05, 0.0), duration=1.0, events=events)


def test_mistakes_in_an_event_function_are_refused():
    with pytest.raises(ParameterError, match=r"^function: not callable \(got None\)"):
        sb.EventFunction("none", None)
    with pytest.raises(ParameterError, match=r"^name: must be a text"):
        sb.EventFunction("", along_x)
    with pytest.raises(ParameterError, match=r"^terminal must be a whole number"):
        sb.EventFunction("some", along_x, terminal=-1)
    with pytest.raises(ParameterError, match=r"^direction: must be a number \(got nan\)\. Use [^\n]*$"):
        sb.EventFunction("some", along_x, direction=float("nan"))


@pytest.mark.parametrize("truth", [bool, np.bool_])
def test_a_truth_value_has_no_sign_that_changes_and_is_refused(truth):
    beyond = sb.EventFunction("beyond", lambda _, state: truth(state["tilt"][0] > 0.0))
    with pytest.raises(ParameterError, match=r"^events: 'beyond' must return a number \(got True\)\. Return [^\n]*$"):
        sb.simulate(MODEL, CIRCLE, **START, duration=5.0, events=[beyond])


@pytest.mark.slow
def test_events_are_kept_in_files(tmp_path):
    run = sb.simulate(MODEL, CIRCLE, **START, duration=5.0, events=[along_x])
    assert sb.load(run.save(tmp_path / "run.nc")).events == run.events
