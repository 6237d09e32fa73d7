"""Lanes of a batch in plain Python: runs that enter and leave them, and idle lanes."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.kernel.columns import LOG, STATE, Log, Setup
from stylobate.engine.kernel.driver.events import RunStatus

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
    assert not batch.driver.pause(batch.buffer, batch.table)
    column = LOG + Log.NEXT_TRACE
    assert list(batch.table[[3, 1], column]) == [7.0, 7.0]
    batch.table[:, column] = 0.0
    assert batch.driver.begin_or_continue(batch.buffer, batch.table, batch.pieces) == 4
    assert batch.buffer[batch.row("next_trace"), :2].tolist() == [0.0, 0.0]
    assert math.isfinite(batch["run"])
