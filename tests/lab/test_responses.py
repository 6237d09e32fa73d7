"""Runs as plain values, without a server."""

import json

import pytest

import stylobate as sb
from stylobate.config import SimulationConfig
from stylobate.lab.requests import Description
from stylobate.lab.runs import answered_run

# Past the vertical within 1e-12 of the tipping angle, out of a plane.
CLOSE = {"tilt": [0.03, 0.0], "tilt_rate": [-0.3, 1e-11]}
IN_PLANE = {"tilt": [0.03, 0.0], "max_steps": 3}


@pytest.mark.parametrize(
    ("kind", "start"),
    [
        *((kind, CLOSE) for kind in ("slender", "slender_rolling", "wobbling", "rolling")),
        ("sliding", {**IN_PLANE, "tilt_rate": [-0.3, 0.1]}),
        ("planar_rocking", IN_PLANE),
    ],
)
def test_an_uncertain_run_of_each_model_is_json(kind, start):
    column = {"shape": "solid", "radius": 0.1, "height": 1.0, "density": 2000.0}
    values = {"column": column, "model": {"kind": kind}, "duration": 0.5, **start}
    setup = SimulationConfig.parse(values).build()
    run = sb.simulate(setup.model, setup.motion, **setup.options)
    assert run.uncertain is True
    frequency = setup.model.column.frequency_scale
    answer = answered_run(run, setup.model, Description(values, values), frequency=frequency)
    assert json.loads(answer.as_json())["uncertain"] is True
    for values in (run.measures, run.thresholds):
        assert {type(value) for value in values.values()} <= {float, int, bool}
    assert {type(event.time) for event in run.events} <= {float}
    assert type(run.decided_at) is float
