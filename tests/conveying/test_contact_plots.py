"""Figures of runs that change their contact show when they had which kind."""

import numpy as np
import pytest
from matplotlib.colors import to_rgba

import stylobate as sb
from stylobate.models import Contact
from stylobate.plots.runs import COLOURS

COLUMN = sb.Column.dimensionless(slenderness=0.1)
MODEL = sb.Sliding(COLUMN, friction_coefficient=0.06, damping=0.05, passage_tilt=1e-3)


@pytest.fixture(scope="module")
def run():
    return sb.simulate(MODEL, tilt=(0.05, 0.0), tilt_rate=(0.0, 0.05), duration=30.0)


def strip_of(figure):
    names = {kind.name.lower() for kind in Contact}
    return [axes for axes in figure.axes if {label.get_text() for label in axes.get_yticklabels()} <= names]


def test_bars_are_as_long_as_the_times_in_each_kind_of_contact(run):
    (strip,) = strip_of(sb.plot(run))
    sample = np.diff(run.data["time"]).max()  # a change that is no event of its own is as close as that
    rows = [label.get_text() for label in strip.get_yticklabels()]
    assert len(rows) == len(strip.collections)
    for name, bars in zip(rows, strip.collections, strict=True):
        drawn = sum(np.ptp(path.vertices[:, 0]) for path in bars.get_paths())
        assert drawn == pytest.approx(run.measures[f"time_{name}"], abs=sample)
        np.testing.assert_allclose(bars.get_facecolor()[0], to_rgba(COLOURS[Contact[name.upper()]]))
    spent = {kind.name.lower() for kind in list(Contact)[:-1] if run.measures[f"time_{kind.name.lower()}"] > sample}
    assert spent <= set(rows)


def test_only_one_run_that_changes_its_contact_has_the_strip(run):
    held = sb.simulate(sb.Rolling(COLUMN, damping=0.05), tilt=(0.05, 0.0), duration=2.0)
    assert not strip_of(sb.plot(held))
    assert not strip_of(sb.plot([run, held]))


def test_a_saved_run_has_the_strip_of_its_samples(run, tmp_path):
    run.save(tmp_path / "run.nc")
    saved = sb.load(tmp_path / "run.nc")
    (strip,), (before,) = strip_of(sb.plot(saved)), strip_of(sb.plot(run))
    names = {axes: {label.get_text() for label in axes.get_yticklabels()} for axes in (strip, before)}
    assert names[strip] <= names[before]
    assert {"resting", "rolling", "slipping"} <= names[strip]


def test_one_case_of_the_start_of_motion_can_be_chosen():
    found = sb.conveying.start_boundary(
        MODEL, slenderness=[0.1, 0.2, 0.4], friction_coefficient=[0.1, 0.3], vertical_ratio=[0.0, 0.5]
    )
    both, one = sb.plot(found), sb.plot(found.sel(vertical_ratio=0.5, friction_coefficient=0.3))
    assert len(both.axes) == 2
    assert len(one.axes) == 1
