"""Many runs at once against single runs, against theory, and against themselves in other company."""

import math
import os
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import Interrupted, ParameterError, UnsupportedError

C = ETA = 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=ETA)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)
LINE = sb.Harmonic.straight(acceleration=0.15, angular_frequency=2.0, direction=0.3)


def names(runs):
    return [sb.Outcome(code).name for code in runs["outcome"].to_numpy()]


def rolling(nu):
    steady = sb.theory.steady_rolling(nu, 0.065, c=C, eta=ETA).upper
    cos, sin = np.cos(steady.phase), np.sin(steady.phase)
    tilt = steady.amplitude[:, np.newaxis] * np.stack([cos, sin], axis=1)
    rate = (steady.amplitude * nu)[:, np.newaxis] * np.stack([-sin, cos], axis=1)
    return tilt, rate, steady


def test_steady_rolling_ends_where_it_began_and_is_told_as_theory_has_it():
    nu = np.linspace(3.0, 6.0, 60)
    tilt, rate, steady = rolling(nu)
    runs = sb.simulate_ensemble(
        MODEL,
        CIRCLE,
        tilt=tilt,
        tilt_rate=rate,
        duration=100 * 2.0 * math.pi / nu,
        parameters={"angular_frequency": nu},
        strobes=3,
    )
    # Some thousand steps, each with an error of 1e-8 times the tilt, add up to no more than 1e-7 of it.
    np.testing.assert_allclose(runs["end_tilt"], tilt, atol=1e-7 * C)
    np.testing.assert_allclose(runs["strobe_tilt"], np.repeat(tilt[:, np.newaxis], 3, axis=1), atol=1e-7 * C)
    assert set(names(runs)) == {"ROLLING"}
    np.testing.assert_allclose(runs["mean_tilt"], steady.amplitude, rtol=1e-7)
    np.testing.assert_allclose(runs["phase"], steady.phase, atol=1e-6)
    np.testing.assert_allclose(runs["mean_rolling_rate"], nu, rtol=1e-8)
    np.testing.assert_allclose(runs["turns"], 100.0, atol=1e-6)


@pytest.mark.parametrize("sense", [1, -1])
def test_rolling_in_either_sense_has_the_phase_of_theory_from_any_start_phase(sense):
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0, sense=sense, start_phase=0.7)
    start = sb.studies.steady_start(MODEL, motion)
    runs = sb.simulate_ensemble(MODEL, motion, **start, duration=60.0)
    steady = sb.theory.steady_rolling(3.0, 0.065, c=C, eta=ETA).upper
    assert float(runs["phase"][0]) == pytest.approx(float(steady.phase), abs=1e-6)
    assert float(runs["mean_rolling_rate"][0]) == pytest.approx(3.0 * sense, rel=1e-8)


def mixed(count, seed):
    rng = np.random.default_rng(seed)
    heading, course = rng.uniform(0.0, 2.0 * math.pi, (2, count))
    lean, speed = rng.uniform(0.0, 0.08, (2, count)) * (rng.random(count) < 0.6)
    return {
        "tilt": lean[:, np.newaxis] * np.stack([np.cos(heading), np.sin(heading)], axis=1),
        "tilt_rate": speed[:, np.newaxis] * np.stack([np.cos(course), np.sin(course)], axis=1),
    }, {
        "acceleration": rng.uniform(0.05, 0.3, count),
        "angular_frequency": rng.uniform(0.5, 6.0, count),
        "start_phase": rng.uniform(0.0, 2.0 * math.pi, count),
        "damping": rng.choice([0.0, 0.05, 0.1, 0.3], count),
    }


@pytest.mark.slow  # another comparison with single runs: that of ensembles/test_agreement.py is quick
@pytest.mark.parametrize(
    "motion", [sb.Harmonic.elliptic(amplitude=(0.1, 0.06), phase=1.0, angular_frequency=2.0), LINE]
)
def test_runs_are_those_of_simulate_but_where_they_are_sensitive(motion):
    starts, parameters = mixed(60, 5)
    options = {"duration": 40.0, "rtol": 1e-9}
    runs = sb.simulate_ensemble(MODEL, motion, **starts, parameters=parameters, **options)
    finer = sb.simulate_ensemble(MODEL, motion, **starts, parameters=parameters, duration=40.0, rtol=1e-11)
    moved = np.hypot(*(runs["end_tilt"] - finer["end_tilt"]).to_numpy().T)
    # What another tolerance does not move by 1e-6, another integrator must not either.
    steady = (moved < 1e-6) & (names(runs) == np.array(names(finer)))
    steady &= np.abs(runs["decided_at"] - finer["decided_at"]).to_numpy() < 1e-6
    assert steady.mean() > 0.7
    for i in np.flatnonzero(steady):
        chosen = {name: float(values[i]) for name, values in parameters.items()}
        model, moving = sb.with_parameters(MODEL, motion, **chosen)
        start = {name: values[i] for name, values in starts.items()}
        single = sb.simulate(model, moving, **start, duration=40.0, rtol=1e-11)
        run = runs.isel(run=i)
        assert names(runs)[i] == single.outcome.name
        assert bool(run["planar"]) == single.planar
        assert int(run["uplifts"]) == sum(event.kind == "uplift" for event in single.events)
        assert float(run["decided_at"]) == pytest.approx(single.decided_at, abs=1e-5)
        assert float(run["peak_tilt"]) == pytest.approx(single.measures["peak_tilt"], rel=1e-5, abs=1e-9)


def test_a_run_does_not_depend_on_its_neighbours_its_place_or_the_threads():
    starts, parameters = mixed(100, 8)
    motion = sb.Harmonic.elliptic(amplitude=(0.1, 0.06), phase=1.0, angular_frequency=2.0)
    whole = sb.simulate_ensemble(MODEL, motion, **starts, parameters=parameters, duration=30.0, threads=1)
    order = np.random.default_rng(1).permutation(100)
    shuffled = sb.simulate_ensemble(
        MODEL,
        motion,
        **{name: values[order] for name, values in starts.items()},
        parameters={name: values[order] for name, values in parameters.items()},
        duration=30.0,
        threads=2,
    )
    for name in whole.data_vars:
        np.testing.assert_array_equal(whole[name].to_numpy()[order], shuffled[name].to_numpy(), err_msg=name)
    alone = sb.simulate_ensemble(
        MODEL,
        motion,
        tilt=starts["tilt"][7],
        tilt_rate=starts["tilt_rate"][7],
        duration=30.0,
        parameters={name: values[7] for name, values in parameters.items()},
    )
    for name in whole.data_vars:
        np.testing.assert_array_equal(whole[name].to_numpy()[7:8], alone[name].to_numpy(), err_msg=name)


def test_looks_samples_and_strobes_see_a_run_and_leave_it_as_it_is():
    # To the tolerance: a stop for a sample ends a step.
    plain = sb.simulate_ensemble(MODEL, LINE, duration=30.0, rtol=1e-10)
    seen = sb.simulate_ensemble(MODEL, LINE, duration=30.0, rtol=1e-10, samples=31, strobes=4)
    np.testing.assert_allclose(plain["end_tilt"], seen["end_tilt"], atol=1e-8)
    single = sb.simulate(MODEL, LINE, duration=30.0, rtol=1e-10)
    time = seen["sample_time"].to_numpy()[0]
    known = np.isfinite(time)
    expected = single.sample(np.minimum(time[known], float(single.data["time"][-1])))["tilt"]
    np.testing.assert_allclose(seen["sampled_tilt"].to_numpy()[0][known], expected, atol=1e-7)


def test_an_acceleration_of_just_the_limit_leaves_the_column_standing():
    runs = sb.simulate_ensemble(
        MODEL, LINE.rotated(-0.3), duration=50.0, parameters={"acceleration": [C, np.nextafter(C, 0.0), C * 1.01]}
    )
    assert runs["uplifts"].to_numpy().tolist()[:2] == [0, 0]
    assert runs["uplifts"].to_numpy()[2] > 0
    assert names(runs)[:2] == ["AT_REST", "AT_REST"]


def test_dimensions_are_broadcast_by_name():
    nu = xr.DataArray([2.0, 3.0, 4.0], dims="angular_frequency")
    size = xr.DataArray([0.05, 0.2], dims="acceleration")
    runs = sb.simulate_ensemble(MODEL, LINE, duration=10.0, parameters={"angular_frequency": nu, "acceleration": size})
    assert runs["outcome"].dims == ("angular_frequency", "acceleration")
    assert runs["end_tilt"].shape == (3, 2, 2)
    with pytest.raises(ParameterError, match="must have 3 values along run"):
        sb.simulate_ensemble(MODEL, LINE, duration=[1.0, 2.0, 3.0], parameters={"acceleration": [0.1, 0.2]})
    with pytest.raises(ParameterError, match="same labels along x"):
        sb.simulate_ensemble(
            MODEL,
            LINE,
            duration=xr.DataArray([1.0, 2.0], dims="x", coords={"x": [0, 1]}),
            parameters={"acceleration": xr.DataArray([0.1, 0.2], dims="x", coords={"x": [1, 0]})},
        )


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"tilt": [(math.nan, 0.0)]}, "tilt must be finite, got nan"),
        ({"tilt_rate": [(math.inf, 0.0)]}, "tilt_rate must be finite, got inf"),
        ({"tilt": [(2.0, 0.0)]}, "tilt must be below"),
        ({"duration": [-1.0]}, "duration must be positive"),
        ({"parameters": {"acceleration": [math.nan]}}, "acceleration must be finite"),
        ({"parameters": {"angular_frequency": [0.0]}}, "angular_frequency must be positive"),
        ({"parameters": {"radius": [-1.0]}}, "radius must be positive"),
        ({"parameters": {"colour": [1.0]}}, "colour is not known here"),
        ({"parameters": [1, 2]}, r"parameters must name what differs, .* got \[1, 2\]"),
        ({"parameters": {"slenderness": 0.1, "radius": 0.2}}, "parameters: slenderness changes the radius"),
        ({"parameters": {"size": 2.0, "mass_height": 1.0}}, "parameters: size changes the mass_height"),
        ({"threads": 0}, "threads must be a whole number"),
    ],
)
def test_bad_input_is_told_in_one_line(change, said):
    with pytest.raises(ParameterError, match=said) as told:
        sb.simulate_ensemble(MODEL, LINE, **{"duration": 5.0, **change})
    assert "\n" not in str(told.value)


def test_no_runs_give_empty_results_of_the_right_shape():
    runs = sb.simulate_ensemble(MODEL, LINE, duration=5.0, parameters={"acceleration": []}, strobes=2)
    assert runs.sizes["run"] == 0
    assert runs["strobe_tilt"].shape == (0, 2, 2)


def test_what_was_computed_before_ctrl_c_is_kept():
    def stop(done, _):
        if done >= 300:
            raise KeyboardInterrupt

    acceleration = np.linspace(0.05, 0.4, 2000)
    options = {"duration": 30.0, "parameters": {"acceleration": acceleration}}
    with pytest.raises(Interrupted) as caught:
        sb.simulate_ensemble(MODEL, LINE, **options, progress=stop)
    partial, whole = caught.value.partial, sb.simulate_ensemble(MODEL, LINE, **options)
    computed = partial["outcome"].to_numpy() >= 0
    assert 256 <= computed.sum() < 2000
    np.testing.assert_array_equal(partial["end_tilt"].to_numpy()[computed], whole["end_tilt"].to_numpy()[computed])
    assert np.isnan(partial["end_tilt"].to_numpy()[~computed]).all()


class _Unsaid(sb.Slender):
    departure = None


@pytest.mark.slow
def test_a_model_that_cannot_depart_is_not_said_to_stand():
    with pytest.raises(UnsupportedError, match="does not say how a column departs"):
        sb.simulate_ensemble(_Unsaid(MODEL.column, damping=ETA), LINE, duration=5.0)


OWN = """
import math
import sys
from dataclasses import dataclass
from typing import ClassVar

import stylobate as sb

FACTOR = float(sys.argv[1])


def slowing(vx, vy, k):
    return k * FACTOR * math.sqrt(vx * vx + vy * vy)


@dataclass(frozen=True, slots=True)
class Dragged(sb.Slender):
    name: ClassVar[str] = "dragged"
    planar_rates = contact = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, _kappa):
        lean = (1.0 + az) * (1.0 - c / math.sqrt(x * x + y * y + 1e-300))
        drag = slowing(vx, vy, eta)
        return vx, vy, lean * x - drag * vx - ax, lean * y - drag * vy - ay


model = Dragged(sb.Column.dimensionless(0.1), damping=0.5)
start = {"tilt": (0.05, 0.01), "tilt_rate": (0.0, 0.03), "duration": 20.0}
many = sb.simulate_ensemble(model, **start)
one = sb.simulate(model, **start)
error = abs(many["end_tilt"].to_numpy()[0] - one.data["tilt"].to_numpy()[-1]).max()
assert error < 1e-7, error
print(many["end_tilt"].to_numpy().tobytes().hex())
"""


@pytest.mark.slow
def test_a_model_in_a_users_file_is_compiled_once_and_anew_when_it_changes(tmp_path):
    path = tmp_path / "dragged.py"
    path.write_text(OWN)
    environment = {**os.environ, "STYLOBATE_CACHE": str(tmp_path / "kept")}

    def run(factor):
        command = [sys.executable, str(path), factor]
        return subprocess.run(command, env=environment, capture_output=True, text=True, check=True)

    first, second, changed = run("2.0"), run("2.0"), run("3.0")
    assert "compiling dragged" in first.stderr
    assert second.stderr == ""
    assert second.stdout == first.stdout  # to the bit
    assert "compiling dragged" in changed.stderr
    assert changed.stdout != first.stdout
