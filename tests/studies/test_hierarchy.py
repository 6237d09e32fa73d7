"""One case through all models: what they share, how they come together, and what they do not."""

import json

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.models.declared import dissipation_of
from stylobate.run_arguments import Accuracy
from stylobate.studies.hierarchy_study import Case, HierarchyArguments

COLUMN = sb.Column.dimensionless(slenderness=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
START = {"tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.07)}
FRICTIONS = {"damping": 0.1, "spin_damping": 0.1}
MODELS = ["slender", "slender rolling", "wobbling", "rolling"]


@pytest.fixture(scope="module")
def scaled():
    return sb.studies.model_hierarchy(
        COLUMN, CIRCLE, **FRICTIONS, **START, duration=20.0, slenderness=[0.05, 0.1, 0.2], samples=200, rtol=1e-10
    )


def test_levels_are_the_runs_of_their_models():
    found = sb.studies.model_hierarchy(COLUMN, CIRCLE, **FRICTIONS, **START, duration=10.0, friction_coefficient=0.05)
    models = (
        sb.Slender(COLUMN, damping=0.1),
        sb.SlenderRolling(COLUMN, **FRICTIONS),
        sb.Wobbling(COLUMN, damping=0.1),
        sb.Rolling(COLUMN, **FRICTIONS),
    )
    assert found["model"].to_numpy().tolist() == MODELS
    for model in models:
        run = sb.simulate(model, CIRCLE, **START, duration=10.0, friction_coefficient=0.05)
        told = found.sel(model=model.name)
        for name in ("peak_tilt", "peak_friction_demand", "peak_pivoting_demand", "minimum_normal_force"):
            assert float(told[name]) == run.measures[name]
        assert sb.Outcome(int(told["outcome"])) is run.outcome
        assert str(told["warnings"].to_numpy()) == "; ".join(run.warnings)


def test_finite_tilt_costs_the_square_of_the_slenderness(scaled):
    order = scaled["deviation_order"]
    assert float(order.sel(model="slender", other_model="wobbling")) == pytest.approx(2.0, abs=0.05)
    assert float(order.sel(model="slender rolling", other_model="rolling")) == pytest.approx(2.0, abs=0.05)


def test_the_twist_costs_the_same_however_slender_the_column_is(scaled):
    order = scaled["deviation_order"]
    assert float(order.sel(model="slender", other_model="rolling")) == pytest.approx(0.0, abs=0.05)
    distance = scaled["deviation"].sel(model="slender", other_model="slender rolling") / scaled["slenderness"]
    # The slender models are the same in units of c.
    np.testing.assert_allclose(distance, float(distance[0]), rtol=1e-6)
    assert float(distance[0]) > 0.1


def test_without_friction_and_base_motion_the_twist_is_no_matter():
    found = sb.studies.model_hierarchy(COLUMN, **START, duration=20.0, rtol=1e-10)
    assert float(found["deviation"].sel(model="slender", other_model="slender rolling")) < 1e-9


def test_differences_are_taken_from_the_reference(scaled):
    assert scaled.attrs["reference"] == "rolling"
    assert float(abs(scaled["peak_tilt_difference"].sel(model="rolling")).max()) == 0.0
    found = sb.studies.model_hierarchy(COLUMN, CIRCLE, **FRICTIONS, **START, duration=5.0, reference="slender")
    expected = found["peak_tilt"] - float(found["peak_tilt"].sel(model="slender"))
    np.testing.assert_array_equal(found["peak_tilt_difference"], expected)


def test_late_means_are_those_of_steady_rolling():
    nu, c = 1.8, 0.1
    found = sb.studies.model_hierarchy(COLUMN, CIRCLE, **FRICTIONS, **START, duration=300.0)
    free = sb.theory.free_twist_rolling(nu, 0.065, c=c, eta=0.1, zeta=0.1)
    paper = sb.theory.steady_rolling(nu, 0.065, c=c, eta=0.1)
    # What is left of the start decays as exp(growth τ); late is from τ = 240 on.
    for model, exact, growth in (
        ("slender rolling", float(free.amplitude), free.eigenvalues.real.max()),
        ("slender", float(paper.upper.amplitude), paper.upper.eigenvalues.real.max()),
    ):
        left = np.exp(240.0 * growth)
        assert float(found["mean_late_tilt"].sel(model=model)) == pytest.approx(exact, abs=0.4 * c * left + 1e-7)
    spin = float(found["mean_late_spin"].sel(model="slender rolling"))
    assert spin == pytest.approx(float(free.spin), abs=np.exp(240.0 * free.eigenvalues.real.max()) + 1e-6)
    assert np.isnan(found["mean_late_spin"].sel(model="slender"))


@pytest.mark.slow
def test_planar_rocking_joins_where_the_motion_lies_in_a_plane():
    line = sb.Harmonic.straight(acceleration=0.15, angular_frequency=3.0)
    start = {"tilt": (0.03, 0.0), "duration": 10.0}
    found = sb.studies.model_hierarchy(COLUMN, line, damping=0.1, **start)
    assert found["model"].to_numpy().tolist() == [*MODELS, "planar rocking"]
    # Housner's loss makes the difference; without it a rigid column in a plane is the same by every model.
    same = sb.studies.model_hierarchy(COLUMN, line, damping=0.1, restitution=1.0, **start)
    assert float(same["deviation"].sel(model="wobbling", other_model="planar rocking")) < 1e-9
    assert float(found["deviation"].sel(model="wobbling", other_model="planar rocking")) > 1e-5
    turned = sb.studies.model_hierarchy(COLUMN, line, damping=0.1, spin=0.1, **start)
    assert turned["model"].to_numpy().tolist() == MODELS


def test_a_column_at_rest_is_upright_to_the_end_and_one_that_fell_is_unknown():
    resting = sb.studies.model_hierarchy(COLUMN, damping=0.3, tilt=(0.01, 0.0), duration=200.0, samples=50)
    assert set(resting["outcome"].to_numpy()) == {sb.Outcome.AT_REST}
    assert float(resting["mean_late_tilt"].max()) == 0.0
    assert not resting["amplitude"].isnull().any()
    fallen = sb.studies.model_hierarchy(COLUMN, damping=0.1, tilt=(0.11, 0.0), duration=50.0, samples=50)
    assert set(fallen["outcome"].to_numpy()) == {sb.Outcome.OVERTURNED}
    assert fallen["mean_late_tilt"].isnull().all()


def test_histories_are_kept_on_request_and_files_hold_all(scaled, tmp_path, saved_dataset):
    assert scaled["amplitude"].dims == ("slenderness", "model", "time")
    assert "amplitude" not in sb.studies.model_hierarchy(COLUMN, **START, duration=2.0)
    again = saved_dataset(scaled, tmp_path / "hierarchy.nc")
    np.testing.assert_array_equal(again["amplitude"], scaled["amplitude"])
    assert json.loads(again.attrs["provenance"])["slenderness"] == [0.05, 0.1, 0.2]


@pytest.fixture
def saved_dataset():
    def through_a_file(data, path):
        data.to_netcdf(path, engine="h5netcdf")
        with xr.open_dataset(path, engine="h5netcdf") as stored:
            return stored.load()

    return through_a_file


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"reference": "sliding"}, "reference must be a model of this case, slender, slender rolling"),
        ({"slenderness": []}, "slenderness must be a list of positive numbers"),
        ({"slenderness": [0.1, -0.1]}, "slenderness must be a list of positive numbers"),
        ({"slenderness": [0.2], "tilt": (1.2, 0.0)}, r"becomes \(2.4, 0\) rad at slenderness 0.2"),
        ({"slenderness": [0.2, 4.0]}, "cannot be scaled to slenderness 4: axial_inertia"),
        ({"foo": 2}, "foo is no argument of model_hierarchy"),
        ({"samples": 1}, "samples must be a whole number"),
        ({"damping": -1.0}, "damping must be zero or positive"),
        ({"duration": 0.0}, "duration must be positive"),
        ({"spin": np.inf}, "spin must be finite"),
        ({"tilt": (1.0,)}, "tilt must have 2 numbers"),
        ({"motion": 3.0}, "motion must be a base motion"),
    ],
)
def test_misuse_is_told(options, line):
    with pytest.raises(ParameterError, match=line):
        sb.studies.model_hierarchy(**{"column": COLUMN, "duration": 5.0, **START, **options})


def test_each_level_takes_the_dissipation_that_it_declares():
    case = Case(
        column=COLUMN,
        motion=sb.base_motions.BASE_AT_REST,
        dissipation={"damping": 0.1, "spin_damping": 0.2, "rolling_resistance": 0.01, "restitution": None},
        tilt=(0.02, 0.0),
        tilt_rate=(0.0, 0.0),
        spin=0.0,
    )
    assert case.models() == (
        sb.Slender(COLUMN, damping=0.1),
        sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.2),
        sb.Wobbling(COLUMN, damping=0.1, rolling_resistance=0.01),
        sb.Rolling(COLUMN, damping=0.1, spin_damping=0.2, rolling_resistance=0.01),
        sb.PlanarRocking(COLUMN, damping=0.1, rolling_resistance=0.01),
    )


def test_the_shared_dissipation_is_that_which_the_levels_declare():
    shared = set(HierarchyArguments.__annotations__) - set(Accuracy.__annotations__)
    assert shared == set(dissipation_of(sb.Rolling))
    assert shared >= {
        name
        for model in (sb.Slender, sb.SlenderRolling, sb.Wobbling, sb.PlanarRocking)
        for name in dissipation_of(model)
    }
