"""Lanes of a batch in plain Python: runs that enter and leave them, and idle lanes."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.columns import LOG, STATE, Log, Setup
from stylobate.engine.kernel.driver.events import RunStatus
from stylobate.models.sliding import Contact

SLENDER = sb.Slender(sb.Column.dimensionless(0.1))
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)


@pytest.fixture
def batch(lane_of):
    """Make a buffer of idle lanes, with a table of five runs whose numbers are all different."""
    one = lane_of(SLENDER, CIRCLE)
    one.table = np.arange(5.0)[:, None] + 0.001 * np.arange(400.0)
    one.table[:, LOG + Log.STATUS] = RunStatus.WAITING
    for i in range(one.buffer.shape[1]):
        one.driver.set_idle(one.buffer, i)
    return one


def runs_of(one):
    return one.buffer[one.row("run")].astype(int).tolist()


def test_runs_move_to_the_first_lanes_and_steps_are_made_in_whole_vectors(batch):
    width, rows = batch.buffer.shape[1], len(batch.buffer)
    assert batch.driver.gather(batch.buffer) == 0
    grain = batch.scope("gather")["GRAIN"]
    for lanes, steps in (((2,), grain), ((1, grain + 1), grain), (tuple(range(3, grain + 4)), 2 * grain)):
        for i in range(width):
            batch.driver.set_idle(batch.buffer, i)
        for run, i in enumerate(lanes):
            batch.buffer[:, i] = run + 0.5 + np.arange(rows)
            batch.buffer[batch.row("run"), i] = run
        assert batch.driver.gather(batch.buffer) == steps
        count = len(lanes)
        assert runs_of(batch) == [*range(count), *[-1] * (width - count)]
        assert batch.buffer[0, :count].tolist() == [run + 0.5 for run in range(count)]
        assert batch["no_return"] == 0.5 + batch.row("no_return")
        assert (batch.buffer[batch.row("stop"), count:] == 1e300).all()


def test_a_run_enters_a_lane_with_its_numbers_state_and_parameters(batch, monkeypatch):
    scope, called = batch.scope("enter"), []
    for name in ("set_look", "set_pair", "set_sample", "set_strobe", "set_break", "set_bounds", "set_leg"):
        monkeypatch.setitem(scope, name, lambda *_, name=name: called.append(name))
    monkeypatch.setitem(scope, "begin", lambda *_: RunStatus.LIFTED)
    monkeypatch.setitem(scope, "square_of_speed", lambda _buf, _i, energy: 7.0 * energy)
    table = batch.table
    table[3, [Setup.SLENDERNESS, Setup.PERIOD, Setup.REST_ENERGY, Setup.REST_ENERGY_FOR_GOOD]] = 0.2, 4.0, 1e-3, 3e-3
    assert batch.driver.enter(batch.buffer, 1, table, batch.pieces, 3) == RunStatus.LIFTED
    lane = batch.buffer[:, 1]
    np.testing.assert_array_equal(lane[:STATE], table[3, :STATE])
    first = batch.row("y0")
    np.testing.assert_array_equal(lane[first : first + 4], table[3, STATE : STATE + 4])
    p, at = batch.row("p0"), batch.shape.parameters_at
    np.testing.assert_array_equal(lane[p : p + batch.shape.parameters], table[3, at : at + batch.shape.parameters])
    found = [lane[batch.row(name)] for name in ("run", "piece", "per_turn", "rest_tilt", "grown")]
    assert found == pytest.approx([3.0, 0.0, 0.25, 3e-3 * 0.2, 1e-3 * 0.2])
    assert [lane[batch.row(name)] for name in ("slow_square", "rest_square")] == pytest.approx([21e-3, 7e-3])
    assert len(called) == 7
    table[3, Setup.PERIOD] = 0.0
    batch.driver.enter(batch.buffer, 1, table, batch.pieces, 3)
    assert lane[batch.row("per_turn")] == 0.0


@pytest.mark.parametrize("status", [RunStatus.OVERTURNED, RunStatus.RESTED, RunStatus.TO_PLANE])
@pytest.mark.parametrize("stands", [0.0, 1.0])
def test_a_run_leaves_its_record_and_state_in_the_table(batch, status, stands):
    batch.table[2] = 9.0
    batch.buffer[:, 0] = 0.25 * np.arange(len(batch.buffer))
    given = {"run": 2.0, "time": 5.0, "decided": 3.0, "stands": stands, "turns": 2.0, "x": -0.03, "y": 0.03}
    for name, value in (given | {"last_azimuth": 0.1}).items():
        batch[name] = value
    batch.driver.leave(batch.buffer, 0, batch.table, status)
    row, log = batch.table[2], LOG
    assert (row[:log] == 9.0).all()
    assert row[log + Log.STATUS] == status
    assert row[log + Log.DECIDED] == (5.0 if status == RunStatus.OVERTURNED else 3.0)
    moves = not stands and status != RunStatus.TO_PLANE
    assert row[log + Log.LAST_AZIMUTH] == pytest.approx(2.375 if moves else 0.1)
    assert list(row[STATE : STATE + 4]) == [batch[f"y{j}"] for j in range(4)]
    assert row[STATE - 1] == batch.buffer[STATE - 1, 0]


def test_runs_that_end_at_once_leave_the_lane_to_the_next(batch, monkeypatch):
    begun, left = [], []
    scope = batch.scope("fill")
    statuses = {0: RunStatus.LIFTED, 1: RunStatus.RESTED, 3: RunStatus.WAITING, 4: RunStatus.WAITING}

    def enter(buf, i, _table, _pieces, run):
        begun.append(run)
        buf[batch.row("run"), i] = run
        return statuses[run]

    monkeypatch.setitem(scope, "enter", enter)
    monkeypatch.setitem(scope, "leave", lambda _buf, _i, _table, status: left.append(status))
    batch.table[2, LOG + Log.STATUS] = RunStatus.STOPPED  # has ended before
    assert batch.driver.fill(batch.buffer, 0, batch.table, batch.pieces, 0) == 4
    assert (begun, left, batch["run"]) == ([0, 1, 3], [RunStatus.LIFTED, RunStatus.RESTED], 3.0)
    assert batch.driver.fill(batch.buffer, 1, batch.table, batch.pieces, 4) == 5
    assert batch.driver.fill(batch.buffer, 2, batch.table, batch.pieces, 5) == 5
    assert runs_of(batch)[:3] == [3, 4, -1]


def test_a_paused_batch_goes_on_behind_its_last_run(batch):
    for i, run in enumerate((3, 1)):
        batch.buffer[batch.row("run"), i] = run
        batch.buffer[batch.row("next_trace"), i] = 7.0
        batch.buffer[[batch.row("steps"), batch.row("time")], i] = 40.0, 2.5
    batch.driver.pause(batch.buffer, batch.table)
    column = LOG + Log.NEXT_TRACE
    for name, value in ((Log.NEXT_TRACE, 7.0), (Log.STEPS, 40.0), (Log.TIME, 2.5)):
        assert list(batch.table[[3, 1], LOG + name]) == [value, value]
    batch.table[:, column] = 0.0
    assert batch.driver.begin_or_continue(batch.buffer, batch.table) == 4
    assert batch.buffer[batch.row("next_trace"), :2].tolist() == [0.0, 0.0]
    assert math.isfinite(batch["run"])


# Groups of lanes: runs that roll, runs that slip, and all others.

ROLLS, SLIPS, FLIES = (float(kind) for kind in (Contact.ROLLING, Contact.SLIPPING, Contact.FLYING))


@pytest.fixture
def groups(lane_of):
    """Make the groups of lanes of a sliding column, all idle, and a table without runs that wait."""
    one = lane_of(sb.Sliding(sb.Column.dimensionless(0.1)), CIRCLE)
    one.table = np.zeros((0, 400))
    one.rows = len(one.shape.rows())
    one.kind = one.row("y0") + one.shape.order - 1
    one.buffer[one.row("run") :: one.rows] = -1.0
    return one


def put(groups, group, i, run, kind):
    groups.buffer[group * groups.rows : (group + 1) * groups.rows, i] = run + 0.5
    groups.buffer[group * groups.rows + groups.row("run"), i] = run
    groups.buffer[group * groups.rows + groups.kind, i] = kind


def runs_in(groups, group):
    return groups.buffer[group * groups.rows + groups.row("run")].astype(int).tolist()


def assigned(groups, group):
    return groups.driver.assign(groups.buffer, groups.table, groups.pieces, 0, group)[0]


def test_a_run_whose_contact_has_changed_moves_with_all_its_numbers(groups):
    assert [kind for kind, _ in groups.shape.groups[:2]] == [ROLLS, SLIPS]
    put(groups, 0, 1, 7, SLIPS)
    put(groups, 0, 2, 8, ROLLS)
    assert assigned(groups, 0)
    assert (runs_in(groups, 0)[:3], runs_in(groups, 1)[0]) == ([-1, -1, 8], 7)
    lane = groups.buffer[groups.rows : 2 * groups.rows, 0]
    assert np.sum(lane == 7.5) > 0.8 * groups.rows
    # What does not change while it slips has no slopes left.
    moving = groups.shape.groups[1][1]
    for stage in range(13):
        slopes = lane[groups.row(f"k{stage}_0") :][: groups.shape.order]
        assert (slopes[:moving] == 7.5).all()
        assert not slopes[moving:].any()


def test_runs_change_places_if_no_lane_is_idle_and_wait_if_there_is_none_for_them(groups):
    width = groups.buffer.shape[1]
    for i in range(width):
        put(groups, 0, i, i, ROLLS)
        put(groups, 1, i, 100 + i, SLIPS)
    put(groups, 0, 3, 3, SLIPS)
    assert not assigned(groups, 0)  # all that slip fill their group
    assert assigned(groups, 1)
    put(groups, 1, 5, 105, ROLLS)
    assert assigned(groups, 0)
    assert (runs_in(groups, 0)[3], runs_in(groups, 1)[5]) == (105, 3)


def test_three_full_groups_whose_runs_go_round_do_not_block_each_other(groups):
    width = groups.buffer.shape[1]
    for group, kind in enumerate((ROLLS, SLIPS, FLIES)):
        for i in range(width):
            put(groups, group, i, 100 * group + i, kind)
    for group, kind in enumerate((SLIPS, FLIES, ROLLS)):  # each has one that belongs to the next
        put(groups, group, 0, 100 * group, kind)
    assert assigned(groups, 0)
    assert [runs_in(groups, group)[0] for group in range(3)] == [200, 0, 100]


@pytest.mark.parametrize("kind", [Contact.ROLLING, Contact.SLIPPING])
def test_states_that_a_group_leaves_alone_have_no_rates(kind):
    model, rng = sb.Sliding(sb.Column.dimensionless(0.1), 0.4, patch=0.1), np.random.default_rng(2)
    moving = model.moving_states[kind]
    for _ in range(50):
        state = [*(0.1 * rng.normal(size=len(model.state_names) - 1)), float(kind)]
        rates = model.rates(*state, *rng.normal(size=3), *model.parameters)
        assert not any(rates[moving:])
        assert all(rates[:moving])
