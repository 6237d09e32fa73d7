"""Ctrl-C in the middle of a study keeps what was computed, equal to the beginning of the whole."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import Interrupted
from stylobate.orbits import BranchEnd

SLENDER = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)
LINE = sb.Harmonic.straight(acceleration=0.04, angular_frequency=1.0)
STONE = sb.Wobbling(sb.Column.solid(radius=0.3, height=3.0, density=2700.0), damping=0.1)
PULSE = sb.Pulse.one_sine(acceleration=4.0, angular_frequency=4.0)


class StopAfter:
    """Ctrl-C at a certain report of progress."""

    def __init__(self, reports):
        self.left = reports

    def __call__(self, *news):
        self.left -= 1
        if self.left == 0:
            raise KeyboardInterrupt


def stopped(study, *arguments, after, **named):
    with pytest.raises(Interrupted) as caught:
        study(*arguments, **named, progress=StopAfter(after))
    assert "partial" in str(caught.value) or "resume" in str(caught.value)
    return caught.value.partial


def test_ctrl_c_before_the_first_result_is_an_interruption_without_partial_result(monkeypatch):
    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("stylobate.engine.ensemble.broadcast", interrupted)
    for study in (
        lambda: sb.simulate_ensemble(SLENDER, CIRCLE, duration=1.0),
        lambda: sb.studies.overturning_map(SLENDER, CIRCLE, over={"tilt_x": [0.0], "tilt_y": [0.0]}, periods=2.0),
    ):
        with pytest.raises(Interrupted, match=r"nothing is kept|after 0") as caught:
            study()
        assert caught.value.partial is None or not (caught.value.partial["outcome"] >= 0).any()


@pytest.fixture(scope="module")
def branch():
    orbit = sb.orbits.periodic_orbit(SLENDER, CIRCLE)
    return sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(1.35, 2.05))


@pytest.mark.parametrize("after", [1, 4, 30])
def test_a_branch_is_kept_as_far_as_it_was_continued(branch, tmp_path, after):
    orbit = sb.orbits.periodic_orbit(SLENDER, CIRCLE)
    partial = stopped(sb.orbits.continue_branch, orbit, "angular_frequency", bounds=(1.35, 2.05), after=after)
    assert BranchEnd.INTERRUPTED in partial.ends
    values, whole = ([point.value for point in one.path] for one in (partial, branch))
    first = whole.index(values[0])
    assert values == whole[first : first + len(values)]
    assert len(values) < len(whole)
    assert [one.parameter for one in partial.bifurcations] == [
        one.parameter for one in branch.bifurcations if values[0] < one.parameter < values[-1]
    ]
    assert sb.load(partial.save(tmp_path / "branch.nc")).ends == partial.ends


@pytest.mark.slow
def test_a_curve_of_bifurcations_is_kept_as_far_as_it_was_continued(branch):
    arguments = (branch.bifurcations[0], "acceleration")
    bounds = ((1.3, 1.5), (0.06, 0.07))
    whole = sb.orbits.bifurcation_curve(*arguments, bounds=bounds)
    partial = stopped(sb.orbits.bifurcation_curve, *arguments, bounds=bounds, after=3)
    values, known = ([point.values for point in one.path] for one in (partial, whole))
    assert len(values) == 4
    assert values == known[known.index(values[0]) :][:4]
    assert partial.ends[1] is BranchEnd.INTERRUPTED


def test_a_response_keeps_its_branches():
    arguments = {"angular_frequency": (1.0, 1.6), "generations": 1}
    partial = stopped(sb.studies.exact_response, SLENDER, LINE, **arguments, after=5)
    assert partial["branch_name"].size == 1
    assert BranchEnd.INTERRUPTED.value in partial["branch_end"].item()
    assert partial.sizes["point"] >= 5


@pytest.mark.slow
def test_a_boundary_keeps_its_curves():
    arguments = {"bounds": (0.05, 0.08), "angular_frequency": (1.0, 3.0), "values": [0.065, 0.07]}
    partial = stopped(sb.studies.stability_boundary, SLENDER, CIRCLE, **arguments, after=2)
    whole = sb.studies.stability_boundary(SLENDER, CIRCLE, **{**arguments, "values": [0.065]})
    xr.testing.assert_identical(partial, whole)


def test_rows_of_a_map_of_the_averaging_error_are_kept():
    arguments = {"angular_frequency": [2.0, 3.0]}
    partial = stopped(sb.studies.averaging_map, SLENDER, CIRCLE, values=[0.05, 0.06, 0.07], **arguments, after=2)
    xr.testing.assert_identical(partial, sb.studies.averaging_map(SLENDER, CIRCLE, values=[0.05, 0.06], **arguments))


def test_counts_after_a_bifurcation_are_kept(branch):
    arguments = {"count": 4, "periods": 60.0, "rng": 1}
    study, one = sb.studies.after_bifurcation, branch.bifurcations[0]
    partial = stopped(study, one, values=[1.38, 1.39, 1.4], **arguments, after=1)
    xr.testing.assert_identical(partial, study(one, values=[1.38], **arguments))


def test_estimates_of_lyapunov_exponents_are_kept():
    start = sb.studies.steady_start(SLENDER, CIRCLE)
    study = sb.studies.lyapunov_exponents
    partial = stopped(study, SLENDER, CIRCLE, **start, periods=40, skip=10, after=30)
    whole = study(SLENDER, CIRCLE, **start, periods=40, skip=10)
    assert int(partial["periods_counted"]) == 20
    np.testing.assert_array_equal(partial["running"], whole["running"][:20])
    assert np.isnan(partial["lyapunov_exponent"]).all()
    assert partial.attrs["ending"] == "was interrupted"


def test_a_verdict_is_kept_and_counts_the_other_variations_as_undecided():
    partial = stopped(sb.verdict, STONE, PULSE, runs=60, after=4)
    whole = sb.verdict(STONE, PULSE, runs=60)
    assert isinstance(partial, sb.results.Verdict)
    state, known = (one.data["overturned"].to_numpy() for one in (partial, whole))
    assert 0 < (state >= 0).sum() < (known >= 0).sum()
    np.testing.assert_array_equal(state[state >= 0], known[state >= 0])
    assert partial.interval[0] <= whole.share <= partial.interval[1]
    assert partial.provenance == whole.provenance


def test_ctrl_c_before_the_first_result_has_no_partial_result_and_at_the_end_the_whole():
    arguments = {"bounds": (0.05, 0.08), "angular_frequency": (1.0, 3.0), "values": [0.065]}
    assert stopped(sb.studies.stability_boundary, SLENDER, CIRCLE, **arguments, after=1) is None
    arguments = {"values": [0.05], "angular_frequency": [2.0, 3.0]}
    partial = stopped(sb.studies.averaging_map, SLENDER, CIRCLE, **arguments, after=1)
    xr.testing.assert_identical(partial, sb.studies.averaging_map(SLENDER, CIRCLE, **arguments))
