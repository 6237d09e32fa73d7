"""The numbers of a run are declared once: configurations have them with their defaults, and check them."""

import pytest

from stylobate import config, conveying, earthquakes, studies
from stylobate.earthquakes.config.fragility import FragilityConfig
from stylobate.errors import ConfigError
from stylobate.quantities import parameter_of
from stylobate.run_arguments import OneRun, SharedByRuns, SingleRun, Stroboscopic, numbers_of

CONFIGS = [
    (config.SimulationConfig, SingleRun),
    (config.study_config(studies.model_hierarchy), OneRun),
    (config.study_config(studies.overturning_map), SharedByRuns),
    (config.study_config(studies.basins), SharedByRuns),
    (config.study_config(studies.basins), Stroboscopic),
    (config.study_config(conveying.drift), SharedByRuns),
    (config.study_config(earthquakes.overturning_intervals), SharedByRuns),
    (FragilityConfig, SharedByRuns),
]


@pytest.mark.parametrize(("kind", "group"), CONFIGS)
def test_a_configuration_has_the_declared_numbers_of_its_runs(kind, group):
    for name, parameter in numbers_of(group).items():
        field = kind.model_fields[name]
        declared = parameter_of(name, field.rebuild_annotation(), field.default)
        assert declared is not None
        assert declared.quantity == parameter.quantity
        assert field.is_required() or field.default == parameter.default


@pytest.mark.parametrize(
    ("name", "value", "line"),
    [
        ("tilt", [0.0, float("nan")], "tilt[1] must be finite, got nan rad"),
        ("rtol", 0.0, "rtol must lie between 1e-13 and 0.01, got 0.0"),
        ("clearance", -1.0, "clearance must be zero or positive, got -1.0 m"),
        ("max_steps", 0, "max_steps must be a whole number of at least 1, got 0"),
        (
            "max_steps",
            2**31,
            "max_steps: too large (got 2147483648). Give at most 2147483647: steps are counted in 32 bits.",
        ),
        ("samples", 1, "samples must be a whole number of at least 2, got 1"),
        ("friction_coefficient", 0.0, "friction_coefficient must be positive, got 0.0"),
    ],
)
def test_a_number_of_a_run_that_cannot_be_is_one_line(name, value, line):
    described = config.SimulationConfig.parse({"column": {"slenderness": 0.1}, "duration": 1.0, name: value})
    with pytest.raises(ConfigError) as error:
        described.build()
    assert error.value.problems == (line,)
