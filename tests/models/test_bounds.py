"""One declaration of each number: models, studies, sweeps and the schema of the laboratory accept the same numbers."""

import math

import pytest

import stylobate as sb
from stylobate.errors import LARGEST, ParameterError, UnsupportedError
from stylobate.lab import Limits, openapi
from stylobate.models.declared import MODELS, model_quantities
from stylobate.quantities import parameters_of
from stylobate.studies.checks import require_bounds, require_parameters
from stylobate.studies.responses.response_curves import averaged_motion
from stylobate.studies.sweeps.designs import checked_values

COLUMN = sb.Column.dimensionless(0.1)
QUANTITIES = model_quantities()
CASES = [(model, name) for model in MODELS.values() for name in parameters_of(model) if name in QUANTITIES]


def outside(name):
    low, high = QUANTITIES[name].ge, QUANTITIES[name].le
    return [
        *([] if low is None else [math.nextafter(low, -math.inf)]),
        math.nextafter(LARGEST if high is None else high, math.inf),
        math.nan,
    ]


def inside(name):
    low, high = QUANTITIES[name].ge, QUANTITIES[name].le
    return [-10.0 if low is None else low, 10.0 if high is None else min(high, 10.0)]


def built(model, name, value):
    more = {"friction_coefficient": min(value, 0.1)} if name == "static_friction_coefficient" and value >= 0.0 else {}
    return model(COLUMN, **{name: value}, **more)


@pytest.mark.parametrize(("model", "name"), CASES, ids=lambda case: getattr(case, "__name__", case))
def test_a_model_accepts_what_its_bounds_say_and_nothing_outside(model, name):
    for value in inside(name):
        assert getattr(built(model, name, value), name) == value
    for value in outside(name):
        with pytest.raises(ParameterError, match=rf"^{name}\b"):
            built(model, name, value)


@pytest.mark.parametrize("name", [name for name in QUANTITIES if name != "passage_tilt"])
def test_studies_sweeps_and_the_schema_have_the_bounds_of_the_models(name):
    low, high = inside(name)
    checked_values("over", name, [low, high])
    require_parameters([low, high], name)
    require_bounds((low, high), name)
    for value in outside(name):
        with pytest.raises(ParameterError, match=name):
            checked_values("over", name, [value])
        if math.isfinite(value):
            with pytest.raises(ParameterError, match=name):
                require_parameters([value], name)
            with pytest.raises(ParameterError, match=name):
                require_bounds(sorted((value, 0.5 * (low + high))), name)
    quantity, bounds = QUANTITIES[name], openapi._bounds(Limits())[name]
    described = openapi._finite({"type": "number", **bounds})
    assert described["minimum"] == (-LARGEST if quantity.ge is None else quantity.ge)
    assert described["maximum"] == (LARGEST if quantity.le is None else quantity.le)


def test_a_number_of_several_models_is_declared_once():
    for model in MODELS.values():
        for name, parameter in parameters_of(model).items():
            if name in QUANTITIES:
                assert parameter.quantity is QUANTITIES[name], (model, name)


@pytest.mark.parametrize("name", ["friction_coefficient", "static_friction_coefficient"])
def test_friction_beyond_what_is_resolved_is_refused_with_the_model_that_never_slips(name):
    with pytest.raises(ParameterError, match=rf"^{name} must lie between 0 and 1e\+08, Rolling is the model"):
        sb.Sliding(COLUMN, **{name: 1e9})
    run = sb.simulate(sb.Sliding(COLUMN, friction_coefficient=1e8), tilt=(0.03, 0.0), duration=1.0)
    assert run.outcome is sb.Outcome.STILL_MOVING


def test_averaged_equations_are_refused_for_a_subclass_with_equations_of_its_own():
    class Other(sb.Slender):
        rates = staticmethod(sb.Slender.rates)

    motion = sb.Harmonic.straight(acceleration=0.04, angular_frequency=3.0)
    with pytest.raises(UnsupportedError, match=r"^model: averaged_motion holds for Slender only \(got Other\)\."):
        averaged_motion(Other(COLUMN, damping=0.1), motion, tilt=(0.05, 0.0), duration=1.0)
