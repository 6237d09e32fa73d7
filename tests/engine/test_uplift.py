"""Uplift from rest: single runs against closed forms, earlier series and other tolerances."""

import math
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import expm
from scipy.optimize import brentq

import stylobate as sb
from stylobate.models.model import Push

C = 0.1
COLUMN = sb.Column.dimensionless(C, 0.75, 0.5)
DEPARTURE = 1e-3


def uplift_time(amplitude, nu, phase):
    """Return the first time at which a = A cos(ντ + φ), φ in (−π, 0], exceeds c."""
    return max(0.0, (-math.acos(C / amplitude) - phase) / nu)


def first_swing(amplitude, nu, phase, eta, elapsed):
    """Return tilt and rate after the time `elapsed` since uplift: α̈ + ηα̇ − α = c − A cos(ντ + φ), from rest.

    (1) on one side is linear; its exponential propagates α, α̇, 1, cos and sin.
    """
    matrix = np.zeros((5, 5))
    matrix[0, 1], matrix[1, 0], matrix[1, 1] = 1.0, 1.0, -eta
    matrix[1, 2], matrix[1, 3] = C, -amplitude
    matrix[3, 4], matrix[4, 3] = -nu, nu
    angle = nu * uplift_time(amplitude, nu, phase) + phase
    return (expm(matrix * elapsed) @ [0.0, 0.0, 1.0, math.cos(angle), math.sin(angle)])[:2]


@pytest.mark.parametrize("phase", [-1.2, 0.0], ids=["gradual", "jump"])
@pytest.mark.parametrize(("amplitude", "nu", "eta"), [(1.02 * C, 2.0, 0.0), (1.02 * C, 2.0, 0.3), (3.0 * C, 1.0, 0.5)])
def test_uplift_by_a_curved_push_has_no_error_that_tolerances_cannot_remove(phase, amplitude, nu, eta):
    motion = sb.Harmonic.straight(
        acceleration=amplitude * COLUMN.gravity, angular_frequency=nu * COLUMN.frequency_scale, start_phase=phase
    )
    # Error of the series in the tilt: F̈δ⁴/72; that of the rate is of the order δ⁴ F⃛/216. Rounding of c stays.
    lapse = DEPARTURE / (1.0 + nu)
    allowed = 2.0 * amplitude * nu**2 * lapse**4 / 72.0 + 4.0 * np.finfo(float).eps * C
    for elapsed in (0.002, 0.01, 0.05, 0.15):
        end = (uplift_time(amplitude, nu, phase) + elapsed) / COLUMN.frequency_scale
        run = sb.simulate(sb.Slender(COLUMN, damping=eta), motion, duration=end, rtol=1e-13, samples=2)
        exact = first_swing(amplitude, nu, phase, eta, elapsed)
        assert abs(run.data["tilt"].to_numpy()[-1, 0] - exact[0]) < allowed
        assert abs(run.data["tilt_rate"].to_numpy()[-1, 0] / COLUMN.frequency_scale - exact[1]) < 3.0 * allowed


MODELS = {
    "slender": sb.Slender(COLUMN, damping=0.1),
    "slender rolling": sb.SlenderRolling(COLUMN, damping=0.1),
    "wobbling": sb.Wobbling(COLUMN, damping=0.1, rolling_resistance=0.002),
    "rolling": sb.Rolling(COLUMN, damping=0.1),
}


class TurningPush(NamedTuple):
    """An elliptic base acceleration (A cos(ντ + φ), B cos(ντ + φ + δ)) [g] in units of 1/ω0."""

    size: float
    narrow: float
    lag: float
    nu: float
    start: float

    @property
    def motion(self):
        return sb.Harmonic.elliptic(
            amplitude=(self.size * COLUMN.gravity, self.narrow * COLUMN.gravity), phase=self.lag,
            angular_frequency=self.nu * COLUMN.frequency_scale, start_phase=self.start,
        )  # fmt: skip

    def at(self, tau):
        angle = self.nu * tau + self.start
        return np.array([self.size * math.cos(angle), self.narrow * math.cos(angle + self.lag)])

    def excess(self, tau):
        return np.hypot(*self.at(tau)) - C

    @property
    def uplift(self):
        """The first time at which the push exceeds c: 0 if it does so at the start."""
        times = np.linspace(0.0, 2.0 * math.pi / self.nu, 2001)
        first = int(np.argmax([self.excess(tau) > 0.0 for tau in times]))
        if first == 0:
            return 0.0
        return brentq(self.excess, times[first - 1], times[first], xtol=1e-16, rtol=1e-15)

    def integrated(self, model, end):
        """Return the state at `end` by the equations alone, and the minimum tilt after the first swing.

        They begin at a time after uplift that is a tenth of the engine's, so that the error is a thousandth.
        """
        early = 0.1 * DEPARTURE / (1.0 + self.nu)
        now, later = self.at(self.uplift), self.at(self.uplift + 2.0 / 3.0 * early)
        here, there = np.hypot(*now), np.hypot(*later)
        turned = math.atan2(now[0] * later[1] - now[1] * later[0], now @ later)
        rates = (there - here) / (early / 1.5), turned / (early / 1.5)
        push = Push(tuple(-now / here), here, here - C if self.uplift == 0.0 else 0.0, *rates)
        found = solve_ivp(
            lambda tau, y: model.rates(*y, *self.at(tau), 0.0, *model.parameters), (self.uplift + early, end),
            model.departure(push, early, *model.parameters), "DOP853", rtol=1e-13, atol=1e-22,
        ).y  # fmt: skip
        tilt = np.hypot(*found[:2])
        falls = int(np.argmax(np.diff(tilt) < 0.0))
        return found[:, -1], float(tilt[falls:].min()) if falls else math.inf

    def error(self, model, end, rtol):
        """Return the error of the tilt vector [c] at `end`, or when it overturned, and the minimum tilt [c].

        The minimum counts from the end of the first swing.
        """
        run = sb.simulate(model, self.motion, duration=end / COLUMN.frequency_scale, rtol=rtol, samples=2)
        last = run.data.isel(time=-1)
        exact, least = self.integrated(model, float(last["time"]) * COLUMN.frequency_scale)
        return float(np.abs(last["tilt"].to_numpy() - exact[:2]).max()) / C, least / C


@pytest.mark.slow
@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_runs_from_rest_converge_to_rounding_under_a_turning_push(model):
    push = TurningPush(size=1.5 * C, narrow=0.6 * C, lag=0.9, nu=2.0, start=-1.3)
    assert push.error(model, 2.5, 1e-8)[0] < 1e-6
    assert push.error(model, 2.5, 1e-13)[0] < 2e-11


def random_runs_from_rest(model, count, rtol):
    """Return the errors of random runs [rtol c], of those that do not pass the vertical closer than c/100."""
    rng = np.random.default_rng(300)
    errors = []
    while len(errors) < count:
        size, nu = C * rng.uniform(1.02, 4.0), math.exp(rng.uniform(math.log(0.5), math.log(6.0)))
        push = TurningPush(size, size * rng.uniform(), rng.uniform(-math.pi, math.pi), nu, rng.uniform(-math.pi, 0.0))
        error, least = push.error(model, push.uplift + 2.0, rtol)
        if least > 1e-2:
            errors.append(error / rtol)
    return np.array(errors)


@pytest.mark.parametrize(("count", "rtol"), [(5, 1e-8), pytest.param(75, 1e-10, marks=pytest.mark.slow)])
@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_random_runs_from_rest_have_errors_of_the_order_of_the_tolerance(model, count, rtol):
    assert random_runs_from_rest(model, count, rtol).max() < 20.0


@pytest.mark.parametrize("kind", [sb.Rolling, sb.SlenderRolling])
def test_columns_with_spin_do_not_stall_after_uplift_at_tight_tolerances(kind):
    # The tilt begins below 1e-18; a tolerance relative to it kept the steps at 1e-9 for the whole of the record.
    model = kind(sb.Column.solid(radius=0.4, height=4.0, density=2500.0), damping=0.02)
    record = sb.sample_record("el centro 1940").trimmed(0.0, 12.0).resampled(0.005)
    scales = np.linspace(0.5, 1.5, 16)
    coarse, fine = (
        sb.simulate_ensemble(model, record, parameters={"scale": scales}, duration=15.0, rtol=rtol)
        for rtol in (1e-9, 1e-11)
    )
    assert not np.any(fine["outcome"] == sb.Outcome.FAILED)
    assert float(fine["steps"].mean()) < 2.0 * float(coarse["steps"].mean())


def test_lossy_passages_that_follow_ever_faster_end_in_an_instant_of_rest():
    # With spin the column returns to the side from which it came; the base pushes harder than the column can resist.
    column = sb.Column.dimensionless(0.1)
    model = sb.Rolling(column, damping=0.1, restitution=0.9)
    motion = sb.Harmonic.circular(acceleration=0.109, angular_frequency=5.0)
    run = sb.simulate(
        model, motion, tilt=(0.0164334, 0.0012537), tilt_rate=(-0.003761, 0.0493003), duration=25.0, max_steps=20_000
    )
    assert run.outcome is not sb.Outcome.FAILED
    kinds = [event.kind for event in run.events]
    rests = [k for k, kind in enumerate(kinds) if kind == "rest"]
    assert rests
    for k in rests:  # uplift follows at once, and the spin continues
        assert kinds[k + 1] == "uplift"
        assert run.events[k + 1].time == run.events[k].time
        around = run.sample(run.events[k].time + np.array([-1e-4, 1e-4]))["spin"].to_numpy()
        assert abs(around[1] - around[0]) < 1e-2 * abs(around[0])
