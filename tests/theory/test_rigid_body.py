"""The equations of rolling and wobbling at finite tilt against the laws of Newton and Euler."""

import math

import numpy as np
import pytest
from tests.theory.turning_frame import full_rolling_rates, wobbling_rates

from stylobate import theory
from stylobate.errors import ParameterError

Z = np.array([0.0, 0.0, 1.0])
STEP = 1e-6  # of the differences below: their error is STEP² times third derivatives, and rounding over STEP


def random_body(rng):
    kappa = rng.uniform(0.2, 0.95)
    c = 10.0 ** rng.uniform(-1.5, 0.3)
    return c, {
        "inertia_ratio": kappa,
        "axial_ratio": rng.uniform(0.05, 1.0) * min(1.0, 2.0 * (1 - kappa) / kappa / c**2),
    }


class Body:
    """A body with m = h = g = 1 in the frame of the base, in vectors."""

    def __init__(self, c, inertia_ratio, axial_ratio):
        self.c, self.base = c, 1.0 / inertia_ratio
        self.transverse, self.axial = self.base - 1.0, axial_ratio * c**2
        self.rate = math.sqrt(1.0 / self.base)  # ω0

    def axes(self, tilt, azimuth):
        d = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
        u = math.cos(tilt) * d - math.sin(tilt) * Z
        return u, np.array([-d[1], d[0], 0.0]), math.sin(tilt) * d + math.cos(tilt) * Z

    def motion(self, state, azimuth):
        """Angular velocity, centre of mass from the contact point, its velocity, moment of momentum about it."""
        mu, omega, tilt, _, spin = state
        u, n, e3 = self.axes(tilt, azimuth)
        turning = self.rate * (-omega * math.sin(tilt) * u + mu * n + spin * e3)
        above = e3 - self.c * u
        along = e3 * (turning @ e3)
        momentum = self.transverse * (turning - along) + self.axial * along
        return turning, above, np.cross(turning, above), momentum

    def couple(self, state, rates, azimuth, push):
        """Couple that the contact must bear for these rates, beside the force, by Newton's and Euler's laws."""
        _, above, _, _ = self.motion(state, azimuth)
        ahead, behind = (self.motion(state + s * STEP * rates, azimuth + s * STEP * state[1]) for s in (1.0, -1.0))
        acceleration, torque = (self.rate * (ahead[i] - behind[i]) / (2.0 * STEP) for i in (2, 3))
        force = acceleration + push + Z
        return torque + np.cross(above, force), force


def equations(kind, state, nu, a0, eta, zeta, c, shape):
    if kind != "wobbling":
        return full_rolling_rates(state, nu, a0, c=c, eta=eta, zeta=zeta, **shape)
    rates = wobbling_rates(state[:4], nu, a0, c=c, eta=eta, **shape)
    mu, omega, tilt = state[:3]
    return np.append(rates, -rates[1] * (1.0 - math.cos(tilt)) - omega * math.sin(tilt) * mu)


@pytest.mark.parametrize("kind", ["rolling", "held", "wobbling"])
def test_the_equations_are_the_laws_of_newton_and_euler(kind):
    rng = np.random.default_rng(20)
    for _ in range(40):
        c, shape = random_body(rng)
        eta, zeta = rng.uniform(0.0, 1.0, 2)
        nu, a0, azimuth = rng.uniform(0.3, 4.0), rng.uniform(0.0, 2.0), rng.uniform(-3.0, 3.0)
        mu, omega, tilt, psi, spin = rng.normal(), 2.0 * rng.normal(), rng.uniform(0.1, 1.4), azimuth, rng.normal()
        if kind == "held":
            zeta, spin = math.inf, -omega * math.sin(tilt) * math.tan(tilt)
        if kind == "wobbling":
            spin = -omega * (1.0 - math.cos(tilt))
        state = np.array([mu, omega, tilt, psi, spin])
        rates = equations(kind, state, nu, a0, eta, zeta, c, shape)
        np.testing.assert_allclose(rates[2:4], [mu, omega - nu], rtol=1e-15)
        # The base acceleration stands at azimuth − ψ = 0 at this instant.
        body = Body(c, **shape)
        couple, force = body.couple(state, rates, azimuth, a0 * np.array([1.0, 0.0, 0.0]))
        u, n, e3 = body.axes(tilt, azimuth)
        turning = body.motion(state, azimuth)[0]
        rest = couple + eta * body.rate * body.base * ((turning @ u) * u + (turning @ n) * n)
        if kind == "rolling":
            freedom = 1.0 + shape["axial_ratio"] - shape["inertia_ratio"]
            rest += zeta * body.rate * c**2 * freedom * (turning @ Z) * Z
        else:
            # What forbids rotation does no work in the motions that it allows.
            allowed = Z if kind == "held" else (e3 + Z) / np.linalg.norm(e3 + Z)
            rest -= allowed * (rest @ allowed)
        assert np.abs(rest).max() <= 1e-7 * (1.0 + np.abs(force).max() + np.abs(rates).max()) * (1.0 + c)


@pytest.mark.parametrize("kind", ["rolling", "wobbling"])
def test_friction_and_moment_of_steady_rolling_are_the_forces_of_the_contact(kind):
    c, nu, a0, eta = 0.2, 1.7, 0.11, 0.3
    shape = {"inertia_ratio": 0.7, "axial_ratio": 0.4}
    if kind == "rolling":
        found = theory.full_rolling(nu, a0, c=c, eta=eta, zeta=0.4, **shape)
    else:
        found = theory.wobbling_rolling(nu, a0, c=c, eta=eta, **shape)
    body = Body(c, **shape)
    assert found.exists.sum() == 2
    for i in range(2):
        psi = found.phase[i]
        state = np.array([0.0, nu, found.amplitude[i], psi, found.spin[i]])
        couple, force = body.couple(state, np.array([0.0, 0.0, 0.0, nu, 0.0]), psi, a0 * np.array([1.0, 0.0, 0.0]))
        assert math.hypot(*force[:2]) / force[2] == pytest.approx(found.friction_demand[i], rel=1e-8)
        _, _, e3 = body.axes(found.amplitude[i], psi)
        # The viscous couple has no part about e3; the moment in question lies along Z, or along e3 + Z.
        pivoting = couple @ e3 / (e3 @ Z if kind == "rolling" else 1.0)
        assert pivoting / c == pytest.approx(found.friction_moment[i], rel=1e-7)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"inertia_ratio": 1.0}, "inertia_ratio = m h²/J0 must be below 1"),
        ({"axial_ratio": 70.0}, "axial_ratio must be at most 66.66"),
        ({"c": 0.0}, "c must be positive"),
        ({"eta": -0.1}, "eta"),
        ({"nu": 0.0}, "nu"),
        ({"a0": -1.0}, "a0"),
    ],
)
@pytest.mark.parametrize("solve", [theory.full_rolling, theory.wobbling_rolling])
def test_bad_numbers_are_refused_by_name(solve, change, told):
    with pytest.raises(ParameterError, match=told):
        solve(**({"nu": 2.0, "a0": 0.05, "c": 0.1, "eta": 0.1} | rest_of(solve) | change))


def rest_of(solve):
    return {"zeta": 0.1} if solve is theory.full_rolling else {}
