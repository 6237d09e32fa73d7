"""Descriptions of maps and basins: their axes and samples, and what they share with that of a run."""

import json
import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.config import SimulationConfig, study_config
from stylobate.config.axis import Axis
from stylobate.errors import ConfigError, ParameterError, UnsupportedError

MapConfig, BasinConfig = study_config(sb.studies.overturning_map), study_config(sb.studies.basins)
COLUMN = {"shape": "dimensionless", "slenderness": 0.1}
AXES = {
    "x": {"name": "angular_frequency", "from": 1.0, "to": 4.0, "number": 3, "spacing": "log"},
    "y": {"name": "acceleration", "values": [0.05, 0.2]},
}
MAP = {"column": COLUMN, "motion": {"kind": "circular"}, "periods": 3.0, "map": AXES}
SAMPLE = {"random": 10, "seed": 2, "over": {"tilt_x": [-0.1, 0.1]}}
CIRCULAR = {"kind": "circular", "acceleration": 0.02, "angular_frequency": 1.2}
BASIN = {"column": COLUMN, "motion": CIRCULAR, "duration": 9.0, "basin": SAMPLE}


def test_an_axis_is_spaced_evenly_in_its_values_or_their_logarithm():
    ends = {"name": "tilt-x", "from": 0.1, "to": 1.6, "number": 5}
    assert Axis.parse(ends).name == "tilt_x"
    np.testing.assert_array_equal(Axis.parse(ends).build(), np.linspace(0.1, 1.6, 5))
    np.testing.assert_allclose(Axis.parse({**ends, "spacing": "log"}).build(), [0.1, 0.2, 0.4, 0.8, 1.6], rtol=1e-14)


def test_what_varies_may_be_missing_in_the_motion_and_is_met_exactly():
    setup = MapConfig.parse(MAP).build()
    np.testing.assert_allclose(setup.options["over"]["angular_frequency"], [1.0, 2.0, 4.0])
    found = sb.studies.overturning_map(setup.model, setup.motion, **setup.options)
    _, motion = sb.with_parameters(setup.model, setup.motion, angular_frequency=2.0, acceleration=0.2)
    assert motion.peak_horizontal(0.0) == 0.2
    assert found["outcome"].dims == ("angular_frequency", "acceleration")


def test_descriptions_are_plain_values_and_come_back():
    for kind, values in ((MapConfig, MAP), (BasinConfig, BASIN)):
        description = kind.parse(values)
        stored = json.loads(json.dumps(description.values()))
        assert kind.parse(stored) == description


def test_one_file_serves_all_commands():
    both = {**MAP, **BASIN, "samples": 5, "points": 3, "strobes": 8, "confidence": 0.9, "method": "taylor"}
    del both["periods"]
    assert SimulationConfig.parse(both).build().options["duration"] == 9.0
    assert "strobes" not in MapConfig.parse(both).build().options
    assert BasinConfig.parse(both).build().options["strobes"] == 8
    # A single run has one method only.
    assert "method" not in SimulationConfig.parse(both).build().options
    assert MapConfig.parse(both).build().options["method"] == "taylor"
    assert BasinConfig.parse(both).build().options["method"] == "taylor"


@pytest.mark.parametrize(
    ("kind", "values"),
    [(MapConfig, MAP), (BasinConfig, {**BASIN, "duration": 60.0})],
)
def test_a_saved_result_tells_what_repeats_it(kind, values):
    setup = kind.parse({**values, "rules": {"periods": 5}, "method": "taylor"}).build()
    study = sb.studies.overturning_map if kind is MapConfig else sb.studies.basins
    found = study(setup.model, setup.motion, **setup.options)
    axes = {str(dim): found[dim].values.tolist() for dim in found["outcome"].dims if dim in found.coords}
    again = kind.of_saved(json.loads(found.attrs["provenance"]), axes).build()
    repeated = study(again.model, again.motion, **again.options)
    assert repeated.attrs["provenance"] == found.attrs["provenance"]


@pytest.mark.parametrize("method", ["rk4", 5])
def test_a_description_with_another_method_is_refused(method):
    with pytest.raises(ConfigError) as caught:
        MapConfig.parse({**MAP, "method": method})
    assert caught.value.problems == (f"method: input should be 'dop853' or 'taylor', got {method!r}",)


def test_given_points_and_own_models_cannot_be_repeated():
    setup = MapConfig.parse(MAP).build()
    found = sb.studies.overturning_map(setup.model, setup.motion, **setup.options)
    provenance = json.loads(found.attrs["provenance"])
    with pytest.raises(ParameterError, match="design 'points'"):
        MapConfig.of_saved({**provenance, "design": {"kind": "points"}}, {})
    with pytest.raises(UnsupportedError, match="only the repr is kept"):
        MapConfig.of_saved({**provenance, "model": {"kind": "other", "repr": "Own()"}}, {})


@pytest.mark.parametrize(
    ("axis", "told"),
    [
        ({}, "map.x.name is missing"),
        ({"name": "damping"}, "map.x: damping needs from, to and number, or values; got none of them"),
        ({"name": "damping", "from": 0, "to": 1}, "map.x: damping needs from, to and number, or values; got from, to"),
        ({"name": "damping", "from": 0, "to": 1, "number": 2, "values": [1]}, "got from, to, number, values"),
        ({"name": "damping", "from": 0, "to": 1, "number": 2, "spacing": "log"}, "map.x: from must be positive"),
        ({"name": "damping", "from": 0, "to": "inf", "number": 2}, "map.x: to must be finite"),
        ({"name": "damping", "from": 0, "to": 1, "number": 2, "step": 1}, "map.x.step is not known here"),
        ({"name": "damping", "values": [0, float("nan")]}, "map.x: values must be finite, got nan"),
        ({"name": "damping", "values": []}, "map.x: damping must have at least one value, got none"),
        ("damping", "map.x: input should be"),
    ],
)
def test_mistakes_in_an_axis_are_told_with_its_place(axis, told):
    with pytest.raises(ConfigError) as caught:
        MapConfig.parse({**MAP, "map": {**AXES, "x": axis}, "motion": CIRCULAR}).build()
    (problem,) = caught.value.problems
    assert told in problem


def test_a_map_over_the_frequency_of_a_pulse_follows_the_slowest_to_its_end():
    values = {
        "column": {"shape": "solid", "radius": 0.1, "height": 1.0, "density": 2000.0},
        "motion": {"kind": "one_sine", "acceleration": 3.0, "angular_frequency": 10.0},
        "map": {
            "x": {"name": "angular_frequency", "from": 2.0, "to": 20.0, "number": 3},
            "y": {"name": "acceleration", "from": 1.0, "to": 9.0, "number": 3},
        },
    }
    setup = MapConfig.parse(values).build()
    slowest = 2.0 * math.pi / 2.0
    assert setup.options["duration"] == pytest.approx(slowest + 20.0 / setup.model.column.frequency_parameter)
