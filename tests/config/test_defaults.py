"""What a file leaves out is what Python, or the command line, has by default."""

import math

import pytest

from stylobate.config import SimulationConfig, study_config
from stylobate.engine.verdict import duration_of
from stylobate.errors import ConfigError, ParameterError
from stylobate.models import Slender, Wobbling
from stylobate.results import OutcomeRules
from stylobate.studies import model_hierarchy, response_curves

EXAMPLES = [
    {"kind": "rest"},
    {"kind": "straight", "acceleration": 0.1, "angular_frequency": 2.0},
    {"kind": "one_sine", "acceleration": 0.1, "angular_frequency": 2.0},
    {"kind": "type_c", "velocity": 0.1, "angular_frequency": 2.0, "cycles": 2},
    {"kind": "gabor", "velocity": 0.1, "frequency": 2.0, "oscillations": 3.0},
    {"kind": "linear_sweep", "acceleration": 0.1, "frequencies": [0.2, 2.0], "length": 4.0},
    {"kind": "logarithmic_sweep", "displacement": 0.1, "frequencies": [0.2, 2.0], "length": 4.0},
    {"kind": "record", "sample": "el centro 1940"},
]
CHANGED = [
    lambda one: one,
    lambda one: {"kind": "delayed", "motion": one, "delay": 1.0},
    lambda one: {"kind": "sum", "motions": [one, one]},
]


@pytest.mark.parametrize("change", CHANGED)
@pytest.mark.parametrize("motion", EXAMPLES, ids=lambda motion: motion["kind"])
@pytest.mark.parametrize("kind", [SimulationConfig, study_config(model_hierarchy)])
def test_a_run_needs_a_duration_in_a_file_where_it_needs_one_in_python_and_has_the_same_otherwise(kind, motion, change):
    values = {"column": {"slenderness": 0.1}, "motion": change(motion)}
    built = kind.parse({**values, "duration": 1.0}).build()
    open_ended = built.motion.duration == math.inf and built.motion.period is not None
    try:
        by_default = duration_of(None, built.model, built.motion, OutcomeRules())
        by_default = None if open_ended else by_default
    except ParameterError:
        by_default = "none"
    if by_default == "none" or (open_ended and kind is not SimulationConfig):  # models are compared over one duration
        with pytest.raises(ConfigError, match="duration is missing"):
            kind.parse(values).build()
    else:
        assert kind.parse(values).build().options["duration"] == by_default


@pytest.mark.parametrize(
    ("numbers", "shape"),
    [
        ({"radius": 0.5, "height": 5.0, "density": 2000.0}, "solid"),
        ({"radius": 0.5, "inner_radius": 0.2, "height": 5.0, "density": 2000.0}, "hollow"),
        ({"radius": 0.5, "top_radius": 0.4, "height": 5.0, "density": 2000.0}, "frustum"),
        ({"slenderness": 0.1}, "dimensionless"),
        ({"sides": 4, "side": 0.5, "height": 2.0, "mass": 900.0}, "prism"),
        ({"radius": 1.0, "height": 2.0, "wall_thickness": 0.01, "density": 7850.0, "liquid_depth": 1.5}, "tank"),
        ({"parts": [{"shape": "solid", "radius": 0.5, "height": 5.0, "density": 2000.0}]}, "parts"),
        (
            {"radius": 1.0, "mass_height": 5.0, "mass": 1.0, "transverse_inertia": 20.0, "axial_inertia": 0.5},
            "given",
        ),
    ],
)
def test_the_numbers_of_a_column_imply_its_shape_in_a_file_as_on_the_command_line(numbers, shape):
    described = SimulationConfig.parse({"column": numbers, "duration": 1.0})
    assert described == SimulationConfig.parse({"column": {"shape": shape, **numbers}, "duration": 1.0})


@pytest.mark.parametrize("column", [{"slenderness": 0.1}, {"radius": 0.5, "height": 5.0, "density": 2000.0}])
@pytest.mark.parametrize("model", [{}, {"model": {"damping": 0.1}}])
def test_a_file_without_a_model_wobbles_and_theory_of_steady_rolling_is_slender(column, model):
    motion = {"kind": "circular", "acceleration": 0.1, "angular_frequency": 2.0}
    values = {"column": column, "motion": motion, "duration": 1.0, "angular_frequency_range": [1.0, 2.0], **model}
    eta = 0.1 if model else 0.0
    kinds = ((SimulationConfig, Wobbling), (study_config(response_curves), Slender))
    for config, kind in kinds:
        built = config.parse({name: one for name, one in values.items() if name in config.model_fields}).build().model
        assert built == kind(built.column, damping=eta)
