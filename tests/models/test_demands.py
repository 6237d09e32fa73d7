"""The largest demands on the contact in a run, and the warnings that come of them."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.models.contact import LEAST_FORCE, per_normal_force

from .same_body import body_of, shaken_in_space, state_of

COLUMN = sb.Column.solid(radius=0.3, height=2.0, density=2000.0)
C, SCALE = COLUMN.slenderness, COLUMN.frequency_scale
START = (0.07, 0.4, -0.05, 0.1, 0.1)
MODELS = {
    "rolling": sb.Rolling(COLUMN, damping=0.1, spin_damping=0.2),
    "wobbling": sb.Wobbling(COLUMN, damping=0.1),
    "rubber": sb.Wobbling(COLUMN, damping=0.1, constraint="rubber"),
}
CIRCLE = sb.Harmonic.circular(acceleration=0.05 * COLUMN.gravity, angular_frequency=2.0 * SCALE)


def begun(model):
    state = state_of(model, *START)
    spin = {} if model.spin_state is None else {"spin": START[-1] * SCALE}
    return {"tilt": state[:2], "tilt_rate": np.array(state[2:4]) * SCALE, **spin}


@pytest.mark.slow
@pytest.mark.parametrize("name", MODELS)
def test_the_largest_demands_are_those_of_newton_and_euler(name):
    model, duration = MODELS[name], 3.0 / SCALE
    motion, acceleration = shaken_in_space(COLUMN, 2.0)
    run = sb.simulate(model, motion, **begun(model), duration=duration, rtol=1e-11)
    body, (theta, beta, w1, w2, w3) = body_of(model), START
    first = body.state(
        theta=theta, beta=beta, w1=w1 * SCALE, w2=w2 * SCALE, w3=w3 * SCALE if name == "rolling" else None
    )
    track = body.follow(
        first, duration=duration, acceleration=acceleration, times=np.linspace(0.0, duration, 400)[1:-1], rtol=1e-10
    )
    weight = COLUMN.mass * COLUMN.gravity
    friction, normal = run.measures["peak_friction_demand"], run.measures["minimum_normal_force"]
    # Between its own samples the oracle can only have missed a little: half the curvature times a half step squared.
    assert friction == pytest.approx(max(track.demand.max(), track.peak_demand), rel=1e-4)
    assert friction >= track.demand.max() * (1.0 - 1e-8)
    assert normal == pytest.approx(track.normal.min() / weight, rel=1e-4)
    assert normal <= track.normal.min() / weight * (1.0 + 1e-8)
    if name != "rolling":
        moment = np.abs(track.couple[:, 2]) / (track.normal * COLUMN.radius)
        assert run.measures["peak_pivoting_demand"] == pytest.approx(moment.max(), rel=1e-4)


def test_demands_do_not_depend_on_the_samples_kept():
    model = MODELS["rolling"]
    few, many = (
        sb.simulate(model, CIRCLE, **begun(model), duration=5.0, samples=samples).measures for samples in (2, 5001)
    )
    assert few == many


@pytest.mark.parametrize("name", MODELS)
def test_a_run_warns_of_slipping_where_more_friction_is_needed_than_there_is_and_only_there(name):
    model = MODELS[name]
    needed = sb.simulate(model, CIRCLE, **begun(model), duration=3.0).measures["peak_friction_demand"]
    for share, warned in ((1.001, False), (0.999, True)):
        run = sb.simulate(model, CIRCLE, **begun(model), duration=3.0, friction_coefficient=share * needed)
        assert bool(run.warnings) is warned
        if warned:
            (line,) = run.warnings
            assert line.startswith("it would slip")
            assert f"at most {needed:.4g} times the normal force" in line
            assert "\n" not in line
    assert sb.simulate(model, CIRCLE, **begun(model), duration=3.0).warnings == ()


def test_the_first_moment_of_slipping_is_told():
    model = MODELS["wobbling"]
    run = sb.simulate(model, CIRCLE, **begun(model), duration=3.0, friction_coefficient=0.15)
    demand, time = run.data["friction_demand"].to_numpy(), run.data["time"].to_numpy()
    first = time[np.argmax(demand > 0.15)]
    assert f"it would slip from {first:.4g} s on" in run.warnings[0]


def test_a_column_that_is_thrown_down_fast_would_lift_off():
    # At the upright z'θ̈ and ρ'θ̇² take from the weight: N = 1 + κ(z'θ̈ − ρ'θ̇²) < 0 for fast motions.
    kappa = COLUMN.inertia_ratio
    for rate, lifts in ((0.9, False), (1.3, True)):
        run = sb.simulate(
            sb.Wobbling(COLUMN), tilt=(0.05, 0.0), tilt_rate=(rate * SCALE, 0.01), duration=0.1 / SCALE,
            friction_coefficient=100.0,
        )  # fmt: skip
        assert (run.measures["minimum_normal_force"] < 0.0) is lifts
        assert any("it would lift off" in line for line in run.warnings) is lifts
        expected = 1.0 + kappa * (
            -((C * math.cos(0.05) - math.sin(0.05)) ** 2) / (1.0 + kappa * C**2)
            - (math.cos(0.05) + C * math.sin(0.05)) * rate**2
        )
        assert float(run.data["normal_force"][0]) / (COLUMN.mass * COLUMN.gravity) == pytest.approx(expected, abs=1e-3)
        infinite = np.isinf(run.data["friction_demand"].to_numpy())
        np.testing.assert_array_equal(infinite, run.data["normal_force"].to_numpy() <= 0.0)
        assert math.isinf(run.measures["peak_friction_demand"]) is lifts


# Whose normal force, m(g + a_z) to leading order, vanishes as the column lifts off, where rounding decides its sign.
LIFTED = [
    model(sb.Column.dimensionless(0.1), damping=0.05) for model in (sb.Slender, sb.SlenderRolling)
]  # fmt: skip


@pytest.mark.parametrize("model", LIFTED, ids=lambda model: model.name)
@pytest.mark.parametrize("frequency", [3.0, 4.7, *(pytest.param(nu, marks=pytest.mark.slow) for nu in (2.0, 3.1))])
def test_the_demand_of_a_run_that_lifts_off_is_unbounded_and_no_number_made_of_rounding(model, frequency, tmp_path):
    throw = sb.Harmonic.oblique(acceleration=1.6, angular_frequency=frequency, angle=1.2)
    run = sb.simulate(model, throw, tilt=(0.05, 0.0), tilt_rate=(0.0, 0.03), duration=30.0, friction_coefficient=0.3)
    assert run.outcome is sb.Outcome.LIFTED_OFF
    assert any("without bound where nothing presses on the base" in line for line in run.warnings)
    assert run.measures["peak_friction_demand"] == math.inf
    demand = run.data["friction_demand"].to_numpy()
    assert demand[np.isfinite(demand)].max() < 1.0 / LEAST_FORCE
    assert sb.load(run.save(tmp_path / "run.nc")).measures["peak_friction_demand"] == math.inf


def test_a_ratio_to_no_normal_force_is_infinite_and_of_two_forces_that_are_none_nothing():
    rounding = 1e-3 * LEAST_FORCE
    forces = np.array([0.2, 0.2, 0.2, 0.2, rounding, 0.0])
    normals = np.array([0.5, rounding, 0.0, -0.1, rounding, 0.0])
    assert per_normal_force(forces, normals).tolist() == [0.4, math.inf, math.inf, math.inf, 0.0, 0.0]


def test_nothing_is_demanded_of_a_contact_in_flight():
    hop = sb.Harmonic.oblique(acceleration=1.6, angular_frequency=3.0, angle=1.2)
    model = sb.Sliding(sb.Column.dimensionless(0.1), friction_coefficient=0.3, damping=0.05, normal_restitution=0.3)
    data = sb.simulate(model, hop, tilt=(0.05, 0.0), tilt_rate=(0.0, 0.03), duration=3.0).data
    flies = data["contact"].to_numpy() == sb.Contact.FLYING
    assert 0 < flies.sum() < flies.size
    for name in ("friction_demand", "pivoting_demand"):
        np.testing.assert_array_equal(np.isnan(data[name].to_numpy()), flies)
    # On the plane friction gives what it can at most.
    assert data["friction_demand"].to_numpy()[~flies].max() <= 0.3 * (1.0 + 1e-9)


def test_a_column_that_only_stands_needs_the_friction_of_its_base():
    run = sb.simulate(MODELS["rolling"], CIRCLE, duration=2.0, friction_coefficient=0.01)
    assert bool(run.data["resting"].all())
    assert run.measures["peak_friction_demand"] == pytest.approx(0.05, rel=1e-12)
    assert run.warnings[0].startswith("it would slip from 0 s on")


def test_the_peak_demand_is_that_of_the_motion_where_moving_needs_more_than_standing():
    # A standing column needs |a_h|/g = 0.9 c; a brief push releases it, and the demand of the motion is what counts.
    motion = sb.Harmonic.circular(acceleration=1.05 * C * COLUMN.gravity, angular_frequency=2.0 * SCALE, ramp=8.0)
    run = sb.simulate(sb.Wobbling(COLUMN, damping=0.1), motion, duration=12.0)
    moving = ~run.data["resting"].to_numpy()
    assert 0 < moving.sum() < moving.size
    expected = run.data["friction_demand"].to_numpy()[moving].max()
    assert run.measures["peak_friction_demand"] == pytest.approx(expected, rel=1e-3)
    assert run.measures["peak_friction_demand"] >= expected


def test_release_from_rest_needs_the_friction_that_theory_says():
    # Let go at a small tilt a column needs κc; free of forcing, near the upright.
    run = sb.simulate(sb.Wobbling(COLUMN), tilt=(1e-6, 0.0), duration=1e-4)
    known = float(sb.theory.required_friction(C, inertia_ratio=COLUMN.inertia_ratio))
    # Over the normal force, which falls meanwhile by κc².
    normal = 1.0 - COLUMN.inertia_ratio * C**2 / (1.0 + COLUMN.inertia_ratio * C**2)
    friction = COLUMN.inertia_ratio * C / (1.0 + COLUMN.inertia_ratio * C**2)
    assert run.measures["peak_friction_demand"] == pytest.approx(friction / normal, rel=1e-4)
    assert friction / normal == pytest.approx(known, rel=1e-12)


def test_warnings_and_demands_are_saved_and_loaded(tmp_path):
    model = MODELS["rolling"]
    run = sb.simulate(model, CIRCLE, **begun(model), duration=3.0, friction_coefficient=0.01)
    loaded = sb.load(run.save(tmp_path / "run.nc"))
    assert loaded.warnings == run.warnings
    assert len(loaded.warnings) == 1
    for name in ("peak_friction_demand", "peak_pivoting_demand", "minimum_normal_force"):
        assert loaded.measures[name] == run.measures[name]
    np.testing.assert_array_equal(loaded.data["friction_demand"], run.data["friction_demand"])
    assert loaded.provenance["friction_coefficient"] == 0.01


class _Quiet(sb.Wobbling):
    """A model without equations for what its contact bears."""

    contact = None

    def outputs(self, states, accelerations, resting):
        return {}


def test_a_model_without_contact_forces_has_no_demands():
    run = sb.simulate(_Quiet(COLUMN), CIRCLE, tilt=(0.05, 0.0), duration=1.0, friction_coefficient=0.01)
    assert run.warnings == ()
    assert "peak_friction_demand" not in run.measures


@pytest.mark.parametrize(("spin", "least"), [(0.05, 1e-5), (0.05, 1e-6), (0.3, 1e-4), (0.3, 1e-6)])
def test_what_the_contact_bears_for_a_moment_is_not_missed(spin, least):
    # A spinning column that passes closely in the sense of its spin needs most there, within least/speed: made by
    # following it from the passage and back in time.
    body = sb.Column.dimensionless(0.2, 0.74, 0.5)
    model, away = sb.Rolling(body), 0.537
    gone = sb.simulate(
        model, tilt=(least, 0.0), tilt_rate=(0.0, 0.15), spin=spin, duration=away, rtol=1e-12, atol=1e-16
    ).data.isel(time=-1)
    run = sb.simulate(
        model, tilt=gone["tilt"].values, tilt_rate=-gone["tilt_rate"].values, spin=-float(gone["spin"]),
        duration=2.0 * away - 1e-3, rtol=1e-11, friction_coefficient=0.2,
    )  # fmt: skip
    fine = run.sample(away + np.linspace(-100.0, 100.0, 20001) * least)
    assert run.measures["least_passage"] == pytest.approx(least, rel=1e-4)
    assert run.measures["peak_friction_demand"] >= float(fine["friction_demand"].max()) * (1.0 - 1e-6)
    assert run.measures["minimum_normal_force"] <= float(fine["normal_force"].min()) + 1e-6
    assert len(run.warnings) == (2 if run.measures["minimum_normal_force"] < 0.0 else 1)


# Friction demand |a_h|/(g + a_z) is a statement on the base alone while the column stands on it.
STOUT = sb.Slender(sb.Column.dimensionless(0.4), damping=0.1)
BELOW_UPLIFT = {
    "straight": (sb.Harmonic.straight(acceleration=0.3, angular_frequency=2.0), 0.3),
    "beside a vertical": (
        sb.Harmonic.straight(acceleration=0.2, angular_frequency=2.0)
        + sb.Harmonic.vertical(acceleration=0.4, angular_frequency=2.0, start_phase=math.pi),
        0.2 / 0.6,
    ),
    "pulse": (sb.Pulse.half_sine(acceleration=0.35, angular_frequency=3.0), 0.35),
}


@pytest.mark.parametrize("name", ["beside a vertical", "pulse", pytest.param("straight", marks=pytest.mark.slow)])
def test_a_column_that_stands_needs_the_friction_of_a_body_that_moves_with_the_base(name):
    motion, expected = BELOW_UPLIFT[name]
    run = sb.simulate(STOUT, motion, duration=20.0, friction_coefficient=0.9 * expected)
    runs = sb.simulate_ensemble(STOUT, motion, duration=[20.0], demands=True)
    assert not run.events
    assert run.measures["peak_friction_demand"] == pytest.approx(expected, rel=1e-9)
    # Parabolas through 64 samples to a period: the next term is (2π/128)⁴/4! of the height.
    assert float(runs["peak_friction_demand"][0]) == pytest.approx(expected, rel=1e-6)
    assert run.measures["peak_pivoting_demand"] == 0.0
    (line,) = run.warnings
    assert "slides before it rocks" in line
    assert sb.simulate(STOUT, motion, duration=20.0, friction_coefficient=1.1 * expected).warnings == ()


def test_standing_before_release_needs_the_friction_at_which_rocking_begins():
    # The base motion passes c g on its way up: the column stands until then, with the demand c.
    motion = sb.Pulse.half_sine(acceleration=0.405, angular_frequency=3.0)
    run = sb.simulate(STOUT, motion, duration=20.0)
    runs = sb.simulate_ensemble(STOUT, motion, duration=[20.0], demands=True)
    assert run.events[0].kind == "uplift"
    for demand in (run.measures["peak_friction_demand"], float(runs["peak_friction_demand"][0])):
        assert demand >= 0.4 * (1.0 - 1e-9)


def test_the_base_slides_under_a_standing_column_when_the_record_first_needs_more_than_there_is():
    motion = sb.Record(samples=[0.0, 0.1, -0.3, 0.3, 0.0], step=1.0)
    run = sb.simulate(STOUT, motion, duration=10.0, friction_coefficient=0.2)
    runs = sb.simulate_ensemble(STOUT, motion, duration=[10.0], demands=True)
    assert run.measures["peak_friction_demand"] == pytest.approx(0.3, rel=1e-15)
    assert float(runs["peak_friction_demand"][0]) == pytest.approx(0.3, rel=1e-15)
    # From 0.1 at 1 s to -0.3 at 2 s: |a| = 0.2 at 1.75 s.
    assert "from 1.75 s on" in run.warnings[0]
