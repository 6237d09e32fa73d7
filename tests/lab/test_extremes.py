"""Charts of the laboratory show the extremes of the motion, not beats of its samples."""

import json

import numpy as np
import pytest

from stylobate.lab.extremes import extremes
from stylobate.lab.options import lessons
from stylobate.lab.requests import Description
from stylobate.lab.tasks import run

COLUMNS = 300
"""Columns of pixels of a chart, one to two thirds of a hump."""


def series_of(identity, **change):
    """Return the description of a lesson, and the histories of its run as they are sent to the page."""
    values = {**next(one for one in lessons() if one.identity == identity).description, **change}
    answer = json.loads(run(Description(values, values), lambda _: None))
    return values, answer


def charted(series, name):
    """Return times and values of a history as the page draws it."""
    points = [*zip(series["time"], series[name], strict=True), *map(tuple, series["extremes"].get(name, []))]
    return np.array(sorted(points)).T


def envelope(time, values, edges):
    """Return the lowest and the highest value in each column of a chart."""
    place = np.clip(np.searchsorted(edges, time, side="right") - 1, 0, len(edges) - 2)
    low, high = np.full(len(edges) - 1, np.inf), np.full(len(edges) - 1, -np.inf)
    np.minimum.at(low, place, values)
    np.maximum.at(high, place, values)
    return low, high


def test_the_friction_demand_of_a_standing_column_has_no_beat():
    values, answer = series_of("stands")
    time, demand = charted(answer["series"], "friction_demand")
    motion, peak = values["motion"], values["motion"]["acceleration"] / 9.80665
    edges = np.linspace(0.0, time[-1], COLUMNS + 1)
    dense = np.linspace(0.0, time[-1], 1_000_001)
    exact = np.abs(peak * np.cos(motion["angular_frequency"] * dense))  # that of a column at rest: |a|/g
    wanted, found = envelope(dense, exact, edges), envelope(time, demand, edges)
    # Between two points that are drawn the curve is a chord: its error is that of a chord over half a sample.
    chord = peak * (motion["angular_frequency"] * time[-1] / 1999) ** 2 / 8.0
    for side, other in zip(found, wanted, strict=True):
        inner = (side > 0.01 * peak) & (side < 0.99 * peak)  # cut by the edge of the column: the line crosses it there
        np.testing.assert_allclose(side[~inner], other[~inner], atol=0.01 * peak + chord)
    humps = demand[(demand < np.roll(demand, 1)) & (demand < np.roll(demand, -1))][1:-1]
    assert len(humps) > 190
    assert humps.max() < 1e-3 * peak


def test_each_impact_is_drawn_at_zero_tilt():
    _, answer = series_of("rocks")
    time, tilt = charted(answer["series"], "amplitude")
    impacts = [one["time"] for one in answer["events"] if one["kind"] == "impact"]
    assert len(impacts) > 5
    for first, next_one in zip([0.0, *impacts], impacts, strict=False):
        swing = tilt[(time > first) & (time < next_one)].max()
        about = np.abs(time - next_one) < 0.02
        if swing > 0.01 * tilt.max() and next_one < time[-1] - 0.1:  # the last points have none beyond
            assert tilt[about].min() < 2e-3 * tilt.max()


@pytest.mark.parametrize("many", [2000, 100])  # ten samples in each hump, and half a sample
def test_extremes_are_found_whatever_the_samples_are(many):
    time = np.linspace(0.0, 200.0 * np.pi / 9.0, many)
    found = extremes(lambda at: {"hump": np.abs(np.sin(9.0 * at))}, time, 9.0)["hump"]
    at, values = np.array(found).T
    assert np.all(np.diff(at) > 0.0)
    np.testing.assert_allclose(values, np.abs(np.sin(9.0 * at)), atol=1e-12)
    assert np.all((values < 1e-3) | (values > 1.0 - 1e-6))
    assert np.count_nonzero(values < 1e-3) >= min(199, many - 3)  # the first and the last minimum are samples


def test_what_is_level_has_no_extremes():
    time = np.linspace(0.0, 10.0, 500)
    assert extremes(lambda at: {"level": 0.3 + 1e-13 * np.sin(1e5 * at)}, time, 9.0) == {}
