"""Beside a bifurcation runs come to what the branches say."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.plots.cells import KIND_LOOKS

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)


@pytest.fixture(scope="module")
def pitchfork():
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
    orbit = sb.orbits.periodic_orbit(MODEL, motion)
    branch = sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(1.2, 4.0))
    return branch.bifurcations[-1]


def test_runs_follow_the_branches_below_a_soft_pitchfork(pitchfork):
    # Located on the branches: doublings at 1.571124 and 1.563530; below 1.5333 nothing stable is left of the family.
    found = sb.studies.after_bifurcation(pitchfork, values=[1.63, 1.6, 1.568, 1.562, 1.5], count=12)
    counts = found["count"].to_pandas()
    assert counts.loc[1.63, "rolling anticlockwise"] == 12
    assert counts.loc[1.6, "rolling anticlockwise"] == 12
    assert counts.loc[1.568, "rolling anticlockwise, period 2"] == 12
    assert counts.loc[1.562, "rolling anticlockwise, period 4"] == 12
    assert counts.loc[1.5, "overturned"] == 12
    assert set(counts.sum(axis=1)) == {12}


def test_the_same_seed_gives_the_same_runs(pitchfork):
    first, second = (
        sb.studies.after_bifurcation(pitchfork, values=[1.55], count=6, periods=300.0, rng=3) for _ in range(2)
    )
    assert first.identical(second)


def test_the_figure_names_every_fate(pitchfork):
    found = sb.studies.after_bifurcation(pitchfork, values=[1.63, 1.568], count=6, periods=400.0)
    figure = sb.plot(found)
    told = {text.get_text() for text in figure.legends[0].get_texts()}
    assert told == set(found["fate"].values)
    widths = [patch.get_width() for patch in figure.axes[0].patches]
    assert sum(widths) == pytest.approx(2.0)


@pytest.mark.parametrize("options", [{"values": []}, {"values": [np.nan]}, {"values": [1.5], "count": 0}])
def test_bad_input_is_refused(pitchfork, options):
    with pytest.raises(ParameterError):
        sb.studies.after_bifurcation(pitchfork, **options)


def test_a_branch_is_no_bifurcation():
    orbit = sb.orbits.periodic_orbit(MODEL, sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0))
    branch = sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(2.9, 3.1))
    with pytest.raises(ParameterError, match="bifurcation must be one of a branch"):
        sb.studies.after_bifurcation(branch, values=[1.6])


def test_the_bifurcation_is_drawn_between_the_bars_on_either_side(pitchfork):
    found = sb.studies.after_bifurcation(pitchfork, values=[1.7, 1.63, 1.6], count=2, periods=50.0)
    (axes,) = sb.plot(found).axes
    (line,) = axes.lines
    height = line.get_ydata()[0]
    bars = [(patch.get_y(), patch.get_y() + patch.get_height()) for patch in axes.patches]
    assert not any(low <= height <= high for low, high in bars)
    # Of 1.6, 1.63 and 1.7 the first alone lies below 1.6205.
    assert height == 0.5


def test_a_fate_has_the_colour_that_it_has_in_maps(pitchfork):
    found = sb.studies.after_bifurcation(pitchfork, values=[1.63, 1.568], count=4, periods=400.0)
    (axes,) = sb.plot(found).axes
    drawn = {bars.get_label(): to_hex(bars.patches[0].get_facecolor()) for bars in axes.containers}
    rolling = KIND_LOOKS["rolling anticlockwise"].colour.lower()
    assert drawn == {"rolling anticlockwise": rolling, "rolling anticlockwise, period 2": rolling}
