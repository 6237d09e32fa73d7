"""Processor time of single runs, one beside SciPy's solver of the bare equations (1); run by `make bench`."""

import time
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stylobate as sb

_TABLE = Path(__file__).parents[1] / "docs" / "_static" / "benchmarks" / "single-runs.txt"
C, ETA, A0, NU = 0.1, 0.1, 0.065, 3.0
COLUMN = sb.Column.dimensionless(C)
SLENDER = sb.Slender(COLUMN, damping=ETA)
MOTION = sb.Harmonic.circular(acceleration=A0, angular_frequency=NU)
START = sb.studies.steady_start(SLENDER, MOTION)
STONE = sb.Column.solid(radius=0.3, height=3.0, density=2700.0)
RUNS = {
    "`Slender` on steady rolling, 60 periods": (SLENDER, MOTION, {**START, "duration": 60.0 * MOTION.period}),
    "`Slender` on steady rolling, 200 periods": (SLENDER, MOTION, {**START, "duration": 200.0 * MOTION.period}),
    "`Rolling` on a circling base, 143 periods": (
        sb.Rolling(COLUMN, damping=ETA, spin_damping=0.1),
        MOTION,
        {"tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.07), "duration": 300.0},
    ),
    "`Wobbling` under El Centro 1940": (sb.Wobbling(STONE, damping=0.03), sb.sample_record("el centro 1940"), {}),
}
pytestmark = pytest.mark.benchmark(timer=time.process_time)


@pytest.fixture(scope="module")
def times():
    """Processor times of the runs [s] by name; written as a table at the end."""
    measured = {}
    yield measured
    if measured:
        lines = ["| one run, one core | processor time [ms] |", "|---|---|"]
        lines += [f"| {name} | {1e3 * seconds:.0f} |" for name, seconds in measured.items()]
        _TABLE.write_text("\n".join(lines) + "\n", encoding="utf-8")


def measure(benchmark, times, name, function, *arguments, **options):
    """Call a function several times; keep the shortest processor time, and return the last result."""
    result = benchmark(function, *arguments, **options)
    if benchmark.stats:  # else the benchmarks are disabled
        times[name] = benchmark.stats.stats.min
    return result


@pytest.mark.parametrize("name", RUNS)
def test_simulate_with_events_outcome_and_history(benchmark, times, name):
    model, motion, options = RUNS[name]
    run = measure(benchmark, times, name, sb.simulate, model, motion, **options)
    assert run.outcome is not sb.Outcome.FAILED


def equations_1(tau, state):
    x, y, vx, vy = state
    lean = 1.0 - C / np.sqrt(x * x + y * y)
    return vx, vy, lean * x - ETA * vx - A0 * np.cos(NU * tau), lean * y - ETA * vy - A0 * np.sin(NU * tau)


def test_scipy_on_the_bare_equations(benchmark, times):
    start = [*START["tilt"], *START["tilt_rate"]]
    flow = measure(
        benchmark,
        times,
        "SciPy's DOP853 on the bare equations, 200 periods",
        solve_ivp,
        equations_1,
        (0.0, 200.0 * MOTION.period),
        start,
        method="DOP853",
        rtol=1e-8,
        atol=1e-11,
    )
    assert flow.success
