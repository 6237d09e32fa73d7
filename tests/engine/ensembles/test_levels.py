"""Ensembles of every level of the ladder are what each run is alone: spin, losses, loads of the contact."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError, UnsupportedError

C = 0.1
COLUMN = sb.Column.dimensionless(C)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
STRONG = sb.Harmonic.circular(acceleration=0.12, angular_frequency=2.0)
LINE = sb.Harmonic.straight(acceleration=0.13, angular_frequency=2.0)
SWEEP = sb.SineSweep.linear(acceleration=0.13, frequencies=(0.35, 0.45), length=20.0)
VERTICAL = sb.Harmonic(amplitude=(0.065, 0.05, 0.2), phase=(0.0, 1.0, 2.0), angular_frequency=3.0)

IN_SPACE = {
    "slender rolling": sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.1),
    "wobbling": sb.Wobbling(COLUMN, damping=0.1),
    "rubber": sb.Wobbling(COLUMN, damping=0.1, constraint="rubber"),
    "rolling": sb.Rolling(COLUMN, damping=0.1, spin_damping=0.1),
    "rolling resistance": sb.Rolling(COLUMN, spin_damping=0.1, rolling_resistance=0.02),
}
# In quick runs the column that rolls stands for all: each model has a kernel of its own to compile.
NAMES = [pytest.param(name, marks=[] if name.startswith("rolling") else pytest.mark.slow) for name in IN_SPACE]
RTOL = 1e-9
# Errors of single steps, each of rtol at most, over some hundreds of them in motions that do not diverge.
CLOSE = 100.0 * RTOL
DEMANDS = ("peak_friction_demand", "peak_pivoting_demand", "minimum_normal_force")


def together_and_alone(model, motion, *, duration, tilt, tilt_rate, spin=None, demands=True, **options):
    """The runs of an ensemble, and each of them by `simulate`."""
    starts = {"tilt": np.array(tilt), "tilt_rate": np.array(tilt_rate)}
    spins = {} if spin is None else {"spin": np.array(spin)}
    options = {"duration": duration, "rtol": RTOL, **options}
    runs = sb.simulate_ensemble(model, motion, **starts, **spins, demands=demands, threads=1, **options)
    alone = [
        sb.simulate(
            model,
            motion,
            tilt=tuple(starts["tilt"][index]),
            tilt_rate=tuple(starts["tilt_rate"][index]),
            **({} if spin is None else {"spin": spin[index]}),
            **options,
        )
        for index in range(len(tilt))
    ]
    return runs, alone


def require_same(runs, alone, *, close=CLOSE):
    for index, run in enumerate(alone):
        assert sb.Outcome(int(runs["outcome"][index])) is run.outcome
        assert float(runs["decided_at"][index]) == pytest.approx(run.decided_at, abs=1e-5)
        np.testing.assert_allclose(runs["end_tilt"][index], run.data["tilt"][-1], rtol=0.0, atol=close)
        np.testing.assert_allclose(runs["end_tilt_rate"][index], run.data["tilt_rate"][-1], rtol=0.0, atol=10.0 * close)
        assert float(runs["peak_tilt"][index]) == pytest.approx(run.measures["peak_tilt"], rel=1e-6)
        if "spin" in run.data:
            assert float(runs["end_spin"][index]) == pytest.approx(float(run.data["spin"][-1]), abs=10.0 * close)


STARTS = {"tilt": [(0.03, 0.0), (0.02, 0.01), (0.05, -0.02)], "tilt_rate": [(0.0, 0.06), (0.01, 0.05), (0.02, 0.04)]}


@pytest.mark.parametrize("motion", [CIRCLE, pytest.param(VERTICAL, marks=pytest.mark.slow)], ids=["level", "vertical"])
@pytest.mark.parametrize("name", NAMES)
def test_runs_of_an_ensemble_are_those_alone(name, motion):
    model = IN_SPACE[name]
    spin = None if model.spin_state is None else [0.0, 0.2, -0.3]
    runs, alone = together_and_alone(model, motion, duration=30.0, spin=spin, **STARTS)
    require_same(runs, alone)
    for index, run in enumerate(alone):
        for demand in DEMANDS:
            # Parabolas through the quarters of a step, of cubics between its ends: steps of about a tenth of a period.
            # They err by parts of the weight: a demand over a small normal force by so many times more.
            close = 2e-3 * max(1.0, run.measures[demand])
            assert float(runs[demand][index]) == pytest.approx(run.measures[demand], rel=close, abs=1e-9)


@pytest.mark.parametrize("name", [name for name in NAMES if name.values[0] in {"wobbling", "rolling"}])
def test_runs_that_begin_at_rest_or_overturn_are_those_alone(name):
    starts = {"tilt": [(0.0, 0.0), (0.05, 0.0)], "tilt_rate": [(0.0, 0.0), (0.0, 0.0)]}
    runs, alone = together_and_alone(IN_SPACE[name], STRONG, duration=15.0, **starts)
    require_same(runs, alone)
    assert {run.outcome for run in alone} == {sb.Outcome.OVERTURNED}


@pytest.mark.parametrize(
    "model",
    [sb.Wobbling(COLUMN, restitution=0.9), sb.Rolling(COLUMN, restitution=0.9)],
    ids=["wobbling", "rolling"],
)
@pytest.mark.slow
def test_losses_at_the_upright_are_those_of_single_runs(model):
    # The first three pass it within 0.01 c, on the way and again after each loss; the last one in a plane.
    starts = {"tilt": [(0.05, 0.0)] * 4, "tilt_rate": [(0.0, 1e-5), (0.0, 1e-4), (0.0, 5e-4), (0.0, 0.0)]}
    runs, alone = together_and_alone(model, None, duration=12.0, **starts)
    require_same(runs, alone)
    energies = [float(run.data["energy"][-1] / run.data["energy"][0]) for run in alone]
    assert max(energies) < 0.9**2 + 1e-9  # at least one passage, with what speed there is about the upright


def test_a_loss_out_of_a_plane_beside_runs_in_forced_motion():
    frictions = {"damping": 0.05, "spin_damping": 0.05}
    starts = {"tilt": [(0.03, 0.0), (0.02, 0.01)], "tilt_rate": [(0.0, 0.0), (-0.02, 0.01)]}
    model = sb.Rolling(COLUMN, **frictions, restitution=0.8, passage_tilt=0.01)
    runs, alone = together_and_alone(model, CIRCLE, duration=6.0, **starts)
    require_same(runs, alone, close=1e-6)
    lossless = sb.simulate_ensemble(
        sb.Rolling(COLUMN, **frictions), CIRCLE, **starts, duration=6.0, rtol=RTOL, demands=True
    )
    assert np.all(np.hypot(*(lossless["end_tilt"] - runs["end_tilt"]).to_numpy().T) > 1e-4)  # each lost some


# The sweep needs the kernel of other tests, without demands.
@pytest.mark.parametrize("motion", [SWEEP, pytest.param(LINE, marks=pytest.mark.slow)], ids=["sweep", "line"])
@pytest.mark.parametrize(
    "model",
    [
        pytest.param(sb.PlanarRocking(COLUMN), id="Housner"),
        pytest.param(sb.PlanarRocking(COLUMN, damping=0.05, restitution=0.95), id="measured"),
        pytest.param(IN_SPACE["rolling"], id="rolling", marks=pytest.mark.slow),
    ],
)
def test_runs_in_a_plane_are_those_alone(model, motion):
    starts = {"tilt": [(0.05, 0.0), (0.0, 0.0), (0.02, 0.0)], "tilt_rate": [(0.0, 0.0)] * 3}
    runs, alone = together_and_alone(model, motion, duration=15.0, **starts, demands=motion is LINE)
    require_same(runs, alone, close=1e-6)
    assert runs["planar"].all()


def test_a_model_of_one_plane_refuses_motion_out_of_it():
    model = sb.PlanarRocking(COLUMN)
    with pytest.raises(ParameterError, match=r"^tilt, tilt_rate and motion must lie in one vertical plane"):
        sb.simulate_ensemble(model, CIRCLE, tilt=(0.05, 0.0), duration=1.0)


def test_a_model_of_one_plane_refuses_to_be_set_in_motion_out_of_it():
    with pytest.raises(ParameterError, match=r"^tilt, tilt_rate and motion must lie in one vertical plane"):
        sb.simulate_ensemble(sb.PlanarRocking(COLUMN), STRONG, duration=1.0)


def test_a_spin_is_refused_where_there_is_none():
    with pytest.raises(ParameterError, match=r"^spin must be left out: .* got 0\.2 rad/s$"):
        sb.simulate_ensemble(sb.Slender(COLUMN), CIRCLE, tilt=(0.05, 0.0), spin=0.2, duration=1.0)
    with pytest.raises(ParameterError, match=r"^spin must be 0 for a column that stands"):
        sb.simulate_ensemble(IN_SPACE["rolling"], CIRCLE, spin=[0.0, 0.2], duration=1.0)


@pytest.mark.slow
def test_spin_has_its_dimension_like_any_other_argument():
    model, spin = IN_SPACE["rolling"], [0.0, 0.1, 0.2]
    runs = sb.simulate_ensemble(model, CIRCLE, tilt=(0.03, 0.0), tilt_rate=(0.0, 0.06), spin=spin, duration=0.5)
    assert runs.sizes["run"] == 3
    assert np.all(np.diff(runs["end_spin"]) > 0.05)


class Silent(sb.Slender):
    """A model without forces of its contact."""

    contact = None


def test_demands_are_refused_of_a_model_that_tells_none():
    with pytest.raises(UnsupportedError, match=r"^model slender has no forces of its contact"):
        sb.simulate_ensemble(Silent(COLUMN), CIRCLE, tilt=(0.05, 0.0), duration=1.0, demands=True)


def test_a_column_that_never_moves_demands_what_it_takes_to_stand():
    weak = sb.Harmonic.circular(acceleration=0.05, angular_frequency=2.0)
    runs = sb.simulate_ensemble(IN_SPACE["rolling"], weak, duration=5.0, demands=True)
    assert runs["peak_friction_demand"].item() == pytest.approx(0.05, rel=1e-12)
    assert runs["peak_pivoting_demand"].item() == 0.0
    assert runs["minimum_normal_force"].item() == pytest.approx(1.0, rel=1e-12)


def test_least_tilts_of_single_runs_are_those_of_ensembles():
    # A passage between two samples, at 0.8 % of c.
    starts = {"tilt": [(0.03, 0.0)], "tilt_rate": [(0.0, 0.0015)]}
    runs, (run,) = together_and_alone(IN_SPACE["rolling"], CIRCLE, duration=6.0, **starts)
    assert run.measures["minimum_tilt"] == pytest.approx(float(runs["minimum_tilt"][0]), rel=1e-3)
    assert run.measures["minimum_tilt"] < float(run.data["amplitude"].min())


@pytest.mark.slow  # a kernel of its own
def test_demands_change_nothing_else():
    model = IN_SPACE["rolling"]
    start = {"tilt": (0.03, 0.0), "tilt_rate": (0.0, 0.06), "duration": 10.0}
    with_them = sb.simulate_ensemble(model, CIRCLE, **start, demands=True)
    without = sb.simulate_ensemble(model, CIRCLE, **start)
    assert set(with_them) - set(without) == set(DEMANDS)
    np.testing.assert_allclose(with_them["end_tilt"], without["end_tilt"], rtol=0.0, atol=1e-13)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["slender rolling", "rolling"])
def test_taylor_series_agree(name):
    starts = {key: np.array(value) for key, value in STARTS.items()}
    ends = [
        sb.simulate_ensemble(IN_SPACE[name], CIRCLE, **starts, spin=0.1, duration=20.0, rtol=1e-10, method=method)
        for method in ("dop853", "taylor")
    ]
    np.testing.assert_allclose(ends[0]["end_tilt"], ends[1]["end_tilt"], rtol=0.0, atol=1e-9)


def test_ensembles_settle_on_steady_rolling_at_finite_tilt():
    nu = 3.0
    steady = sb.theory.full_rolling(nu, 0.065, c=C, eta=0.1, zeta=0.1)
    stable = np.flatnonzero(steady.stable)
    assert stable.size == 1
    amplitude, spin = float(steady.amplitude[stable[0]]), float(steady.spin[stable[0]])
    # The slowest deviation decays by exp(−0.0254 τ).
    start = {"tilt": (0.01, 0.0), "tilt_rate": (0.0, 0.03), "spin": -0.3}
    runs = sb.simulate_ensemble(IN_SPACE["rolling"], CIRCLE, **start, duration=900.0, rtol=1e-10, demands=True)
    assert sb.Outcome(int(runs["outcome"][0])) is sb.Outcome.ROLLING
    assert float(runs["mean_tilt"][0]) == pytest.approx(amplitude, rel=1e-7)
    assert float(runs["end_spin"][0]) == pytest.approx(spin, rel=1e-7)
    assert math.hypot(*runs["end_tilt"][0].to_numpy()) == pytest.approx(amplitude, rel=1e-7)
