"""Cost of a single run against SciPy's solver of the bare equations (1); run by `make bench`."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stylobate as sb

C, ETA, A0, NU = 0.1, 0.1, 0.065, 3.0
PERIODS = 200
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=ETA)
MOTION = sb.Harmonic.circular(acceleration=A0, angular_frequency=NU)
START = sb.studies.steady_start(MODEL, MOTION)
DURATION = PERIODS * MOTION.period


def equations_1(tau, state):
    x, y, vx, vy = state
    lean = 1.0 - C / np.sqrt(x * x + y * y)
    return vx, vy, lean * x - ETA * vx - A0 * np.cos(NU * tau), lean * y - ETA * vy - A0 * np.sin(NU * tau)


@pytest.mark.benchmark(group=f"rolling, {PERIODS} periods, rtol 1e-8")
def test_simulate_with_events_outcome_and_history(benchmark):
    run = benchmark(sb.simulate, MODEL, MOTION, **START, duration=DURATION)
    assert run.outcome is sb.Outcome.ROLLING


@pytest.mark.benchmark(group=f"rolling, {PERIODS} periods, rtol 1e-8")
def test_scipy_on_the_bare_equations(benchmark):
    start = [*START["tilt"], *START["tilt_rate"]]
    flow = benchmark(solve_ivp, equations_1, (0.0, DURATION), start, method="DOP853", rtol=1e-8, atol=1e-11)
    assert flow.success


COLUMN = sb.Column.dimensionless(C)
STONE = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
RUNS = {
    "slender, 60 periods": (MODEL, MOTION, {**START, "duration": 60.0 * MOTION.period}),
    "rolling, t = 300": (
        sb.Rolling(COLUMN, damping=ETA, spin_damping=0.1),
        MOTION,
        {"tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.07), "duration": 300.0},
    ),
    "wobbling, El Centro": (sb.Wobbling(STONE, damping=0.03), sb.sample_record("el centro 1940"), {}),
}


@pytest.mark.benchmark(group="single runs with events, outcome and history")
@pytest.mark.parametrize("name", RUNS)
def test_simulate(benchmark, name):
    model, motion, options = RUNS[name]
    run = benchmark(sb.simulate, model, motion, **options)
    assert run.outcome is not sb.Outcome.FAILED
