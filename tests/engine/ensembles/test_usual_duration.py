"""Runs without a stated duration last as long as their base motions, and a free vibration of 20/p."""

import json

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.studies.sweeps import Sweep

MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
PULSE = sb.Pulse.one_sine(acceleration=0.2, angular_frequency=3.0)
TAIL = 20.0 / MODEL.column.frequency_parameter


def duration_of(runs):
    return json.loads(runs.attrs["provenance"])["duration"]


def test_a_run_of_an_ensemble_lasts_as_long_as_a_single_run():
    single, runs = sb.simulate(MODEL, PULSE), sb.simulate_ensemble(MODEL, PULSE)
    assert duration_of(runs) == single.provenance["duration"] == pytest.approx(PULSE.duration + TAIL, rel=1e-15)
    assert sb.Outcome(runs["outcome"].item()) == single.outcome
    assert runs["peak_tilt"].item() == single.measures["peak_tilt"]


def test_the_longest_base_motion_of_the_runs_counts():
    slow = sb.with_parameters(MODEL, PULSE, angular_frequency=1.5)[1]
    varied = sb.simulate_ensemble(MODEL, PULSE, parameters={"angular_frequency": [3.0, 1.5, 6.0]})
    chosen = sb.simulate_ensemble(MODEL, sb.OneOf(motions=(PULSE, slow)), parameters={"motion": [0, 1]})
    delayed = sb.simulate_ensemble(MODEL, PULSE, parameters={"delay": [0.0, 2.0]})
    assert duration_of(varied) == duration_of(chosen) == pytest.approx(slow.duration + TAIL)
    assert duration_of(delayed) == pytest.approx(PULSE.duration + 2.0 + TAIL)


@pytest.mark.parametrize(
    "sweep",
    [
        lambda motion: Sweep.grid(MODEL, motion, over={"tilt_x": [0.0, 0.01], "tilt_y": [0.0]}),
        lambda motion: Sweep.random(MODEL, motion, over={"tilt_x": [0.0, 0.01]}, count=3, rng=1),
        lambda motion: Sweep.points(MODEL, motion, at={"tilt_x": np.array([0.0, 0.01])}),
    ],
)
def test_a_sweep_has_the_same_default(sweep):
    assert sweep(PULSE).duration == pytest.approx(PULSE.duration + TAIL)
    with pytest.raises(ParameterError, match="a sweep needs one of duration"):
        sweep(sb.Harmonic.circular(acceleration=0.1, angular_frequency=2.0))


@pytest.mark.parametrize(
    ("motion", "what"),
    [
        (None, "a base at rest"),
        (sb.Harmonic.circular(acceleration=0.1, angular_frequency=2.0), "a base motion that does not end"),
    ],
)
def test_without_an_end_the_duration_is_asked_for_in_one_line(motion, what):
    with pytest.raises(ParameterError, match=rf"^duration: missing for {what} \(got None\)\. State it in s"):
        sb.simulate_ensemble(MODEL, motion)
