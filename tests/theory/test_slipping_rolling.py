"""Steady rolling with slip: against a body with a quaternion, where slip begins, under hard shaking, by integration."""

import math
from dataclasses import dataclass, field

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, root
from tests.theory.turning_frame import slipping_rolling_rates

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.theory import critical_frequency, full_rolling, steady_rolling
from stylobate.theory.free_twist import rolling_required_friction
from stylobate.theory.slipping_balance import EASED, EXPONENT, SLOWED, TWISTING
from stylobate.theory.slipping_rolling import slipping_rolling

from ..models.constrained_body import TURNING, UP, VELOCITY  # noqa: TID252
from ..models.sliding_body import SlidingBody  # noqa: TID252

PAPER = {"c": 0.1, "eta": 0.1}
BODIES = [
    {"c": 0.1, "inertia_ratio": 0.75, "axial_ratio": 0.5},
    {"c": 0.3, "inertia_ratio": 0.5, "axial_ratio": 0.9},
]
# ν, a0, and the frictions: points and patches, both signs of T_d, with and without ζ and η
CASES = [
    (3.0, 0.065, {"mu": 0.08, "eta": 0.1, "zeta": 0.1}),
    (3.0, 0.5, {"mu": 0.05, "eta": 0.1, "zeta": 2.0}),
    (1.5, 0.3, {"mu": 0.1, "eta": 0.0, "zeta": 0.0, "spin": 0.3}),
    (2.0, 0.065, {"mu": 0.11, "eta": 0.1, "zeta": 0.0, "patch": 0.03}),
    (1.5, 0.065, {"mu": 0.075, "eta": 0.1, "zeta": 0.1, "patch": 0.1}),
]


def states_of(found, nu):
    some = found.exists
    each = [found.amplitude, found.phase, found.spin, found.slip_along, found.slip_across]
    tilt, phase, spin, along, across = (part[some] for part in each)
    return np.array([np.zeros_like(tilt), np.full_like(tilt, nu), tilt, phase, spin, along, across])


@dataclass(frozen=True)
class DampedBody(SlidingBody):
    """With a moment against rotation about the vertical."""

    pivoting: float = field(default=0.0, kw_only=True)

    def touch(self, state, acceleration=(0.0, 0.0, 0.0)):
        at = super().touch(state, acceleration)
        couple = -self.pivoting * state[TURNING][2] * UP
        spin, contact = at.free_spin + at.mobility @ couple, at.free + at.by_couple(couple)
        return at._replace(free_spin=spin, free=contact)


def made(frictions, body):
    """Return the body, whose units are m, g and ω0, in which h = J0 = κ."""
    column = sb.Column.dimensionless(body["c"], body["inertia_ratio"], body["axial_ratio"])
    freedom = 1.0 + column.axial_ratio - column.inertia_ratio
    return DampedBody(
        column,
        kinetic=frictions["mu"],
        patch=frictions.get("patch", 0.0) * column.radius,
        viscous=frictions["eta"] * column.base_inertia,
        pivoting=frictions["zeta"] * column.mass * column.radius**2 * freedom,
    )


def touching_state(body, state):
    """Return (G, q, v_C, ω) at time 0 of a state in the frame of the motion."""
    w2, omega, tilt, phase, w3, along, across = state
    d, n = np.array([math.cos(phase), math.sin(phase)]), np.array([-math.sin(phase), math.cos(phase)])
    slip = body.column.mass_height * (along * d + across * n)
    start = body.state(theta=tilt, beta=phase, w1=-omega * math.sin(tilt), w2=w2, w3=w3, slip=slip)
    return body.touching(start)


# Equations


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("patch", [0.0, 0.2])
def test_the_rates_are_those_of_newton_and_euler_at_any_state(body, patch):
    rng = np.random.default_rng(8)
    frictions = {"mu": 0.15, "eta": 0.2, "zeta": 0.4, "patch": patch}
    other, nu, a0 = made(frictions, body), 1.7, 0.2
    for _ in range(30):
        state = rng.uniform([-0.3, -2.0, 0.05, -3.0, -1.0, -0.2, -0.2], [0.3, 2.0, 1.0, 3.0, 1.0, 0.2, 0.2])
        found = slipping_rolling_rates(state, nu, a0, **frictions, **body)
        start = touching_state(other, state)
        at = other.touch(start, a0 * np.array([1.0, 0.0, 0.0]))
        load = other.slipping(start, at)
        rates = other.rates_touching(start, at, load)
        assert load.denominator > 0.0
        w2, omega, tilt, phase, w3, along, across = state
        d, n = np.array([math.cos(phase), math.sin(phase), 0.0]), np.array([-math.sin(phase), math.cos(phase), 0.0])
        s, cosine, h = math.sin(tilt), math.cos(tilt), other.column.mass_height
        w1_rate = -found[1] * s - omega * w2 * cosine
        u, e3 = cosine * d - s * UP, s * d + cosine * UP
        # ω = w1 u + w2 n + w3 e3 with the directions turning at β̇ about Z and at w2 about n
        u_rate, e3_rate = omega * cosine * n - w2 * e3, omega * s * n + w2 * u
        turning = w1_rate * u - omega * s * u_rate + found[0] * n - w2 * omega * d + found[4] * e3 + w3 * e3_rate
        slipping = h * ((found[5] - omega * across) * d + (found[6] + omega * along) * n)
        size = 1.0 + np.abs(rates).max()
        np.testing.assert_allclose(rates[TURNING], turning, rtol=0.0, atol=1e-13 * size)
        np.testing.assert_allclose(rates[VELOCITY], slipping, rtol=0.0, atol=1e-13 * size)


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize(("nu", "a0", "frictions"), CASES)
def test_the_body_turns_as_a_whole_with_the_base(nu, a0, frictions, body):
    a0, frictions = a0 * body["c"] / 0.1, frictions | {"mu": frictions["mu"] * body["c"] / 0.1}
    found = slipping_rolling(nu, a0, **frictions, **body)
    other = made(frictions, body)
    assert body is not BODIES[0] or found.exists.any()
    for state, power in zip(states_of(found, nu).T, found.slip_power[found.exists], strict=True):
        start = touching_state(other, state)
        at = other.touch(start, (a0, 0.0, 0.0))
        load = other.slipping(start, at)
        rates = other.rates_touching(start, at, load)
        for part in (VELOCITY, TURNING):
            np.testing.assert_allclose(rates[part], nu * np.cross(UP, start[part]), rtol=0.0, atol=1e-11)
        assert load.force[2] == pytest.approx(1.0, rel=1e-12)  # the weight
        heat = -(load.force @ start[VELOCITY] + load.couple @ start[TURNING]) / other.column.mass_height
        assert power == pytest.approx(heat, rel=1e-9)
        assert power > 0.0


@pytest.mark.parametrize(("nu", "a0", "frictions"), CASES)
def test_a_search_from_many_starts_finds_no_other(nu, a0, frictions):
    rng = np.random.default_rng(3)
    found = slipping_rolling(nu, a0, **frictions, **BODIES[0])
    known = states_of(found, nu)[2:].T
    if "spin" in frictions:  # any spin will do
        known[:, 2] = frictions["spin"]

    def residual(unknown):
        state = np.concatenate([[0.0, nu], unknown])
        if state[2] < 1e-6 or state[2] > 1.5 or max(abs(state[5]), abs(state[6])) < 1e-12:
            return np.full(5, 1e3)
        rates = slipping_rolling_rates(state, nu, a0, **{k: v for k, v in frictions.items() if k != "spin"},
                                       **BODIES[0])[[0, 1, 4, 5, 6]]  # fmt: skip
        if "spin" in frictions:
            rates[2] = state[4] - frictions["spin"]
        return rates

    hits = 0
    for _ in range(40):
        tilt, speed = 10.0 ** rng.uniform(-3.0, -0.5), 10.0 ** rng.uniform(-4.0, -0.5)
        along = rng.uniform(-math.pi, math.pi)
        start = [tilt, rng.uniform(-3, 3), rng.uniform(-1, 0.5), speed * math.cos(along), speed * math.sin(along)]
        done = root(residual, start, tol=1e-12)
        if done.success and np.abs(done.fun).max() < 1e-9:
            done.x[1] = math.remainder(done.x[1], 2.0 * math.pi)
            hits += 1
            assert np.abs(known - done.x).max(axis=1).min() < 1e-6
    assert hits > 0


# Where slip begins


@pytest.mark.parametrize(
    ("nu", "a0", "zeta", "side"),
    [(3.0, 0.065, 0.1, 1.0), (3.0, 0.065, math.inf, 1.0), (4.0, 0.5, math.inf, -1.0), (6.0, 1.0, 0.1, -1.0)],
)
def test_it_leaves_rolling_without_slip_at_the_friction_that_needs(nu, a0, zeta, side):
    held = full_rolling(nu, a0, **PAPER, zeta=zeta)
    upper = int(held.exists.sum()) - 1
    excess = np.array([1e-5, 1e-6, 1e-7])
    found = slipping_rolling(nu, a0, **PAPER, zeta=zeta, mu=held.friction_demand[upper] * (1.0 + side * excess))
    branch = found.exists.sum(axis=-1) - 1  # that of the peak tilt
    rows = np.arange(3)
    speed = np.hypot(found.slip_along, found.slip_across)[rows, branch]
    off = np.array([
        np.abs(getattr(found, name)[rows, branch] - getattr(held, name)[upper])
        for name in ("amplitude", "phase", "spin")
    ])  # fmt: skip
    if math.isinf(zeta):
        off = off[:2]  # spin is of the order of the tilt squared
    for small in (speed, *off):
        np.testing.assert_allclose(small[:-1] / small[1:], 10.0, rtol=0.05)
    # The contact point gives way along the lean, against the force it bears there.
    assert np.all(np.sign(found.slip_along[rows, branch]) == side)
    beyond = slipping_rolling(nu, a0, **PAPER, zeta=zeta, mu=held.friction_demand[upper] * (1.0 - side * 1e-5))
    near = np.abs(beyond.amplitude / held.amplitude[upper] - 1.0) < 1e-3
    assert not near.any()
    # The direction of slip follows at once: the rate of that goes as 1/|v|.
    fastest = found.eigenvalues[rows, branch].real
    fastest = np.where(np.isfinite(fastest), fastest, 0.0).min(axis=-1)
    np.testing.assert_allclose(fastest[1:] / fastest[:-1], 10.0, rtol=0.05)
    assert not found.stable[rows, branch].any()


def test_slip_that_pushes_outwards_is_stable_some_way_below():
    held = full_rolling(4.0, 0.5, **PAPER, zeta=math.inf)
    assert held.stable[-1]
    found = slipping_rolling(4.0, 0.5, **PAPER, zeta=math.inf, mu=held.friction_demand[-1] * np.array([0.5, 0.9, 0.99]))
    np.testing.assert_array_equal(found.stable.any(axis=-1), [True, True, False])


def test_the_saddle_ends_on_the_lower_branch():
    held = full_rolling(3.0, 0.065, **PAPER, zeta=0.1)
    mu = held.friction_demand[0] * (1.0 + np.array([-1e-5, 1e-5]))
    found = slipping_rolling(3.0, 0.065, **PAPER, zeta=0.1, mu=mu)
    np.testing.assert_array_equal(found.exists[:, 0], [True, False])
    assert found.amplitude[0, 0] == pytest.approx(held.amplitude[0], rel=1e-3)
    assert not found.stable.any()


@pytest.mark.parametrize("nu", [1.5, 3.0])
def test_a_patch_sticks_where_it_can_bear_rolling_without_any_twist(nu):
    held = full_rolling(nu, 0.065, **PAPER, zeta=math.inf)
    drag, moment, patch = held.friction_demand[-1], held.friction_moment[-1] * 0.1, 0.1  # over m g, m g h

    def reserve(mu):  # the bound of what friction on a patch can be
        force, couple = (drag / mu) ** EXPONENT, (moment / (TWISTING * mu * patch * 0.1)) ** EXPONENT
        return 1.0 - force - couple * (1.0 + ((SLOWED * EASED) ** EXPONENT - 1.0) * force)

    mu = brentq(reserve, drag, 10.0, xtol=1e-15)
    found = slipping_rolling(nu, 0.065, **PAPER, zeta=0.0, patch=patch, mu=mu * (1.0 - np.array([1e-3, 1e-4])))
    # Friction of a patch falls with the cube of the ratio of slip to turn, not with slip: all is linear in 1 − μ/μ*.
    for name in ("amplitude", "phase"):
        off = np.abs(getattr(found, name)[:, -1] - getattr(held, name)[-1])
        assert off[0] / off[1] == pytest.approx(10.0, rel=0.05)
    speed = np.hypot(found.slip_along, found.slip_across)[:, -1]
    assert speed[0] / speed[1] == pytest.approx(10.0, rel=0.05)
    assert not slipping_rolling(nu, 0.065, **PAPER, zeta=0.0, patch=patch, mu=mu * 1.001).exists.any()


def test_a_small_patch_is_the_limit_of_a_point():
    # As far as slip is fast, its moment goes with ε², and the force that it loses with ε³.
    patch = np.array([0.0, 0.001, 0.002])
    found = slipping_rolling(3.0, 0.065, **PAPER, zeta=0.1, mu=0.08, patch=patch)
    off = np.abs(found.spin[1:, 0] - found.spin[0, 0])
    assert off[1] / off[0] == pytest.approx(4.0, rel=0.02)
    np.testing.assert_allclose(found.amplitude[1:, 0], found.amplitude[0, 0], rtol=1e-7)


# Hard shaking


def test_the_base_acceleration_does_not_move_the_tilt():
    found = slipping_rolling(3.0, np.array([0.5, 1.0, 5.0]), **PAPER, zeta=0.5, mu=0.02)
    assert found.exists.all()
    np.testing.assert_allclose(found.amplitude, found.amplitude[:1].repeat(3, axis=0), rtol=1e-12)
    assert np.all(np.diff(np.hypot(found.slip_along, found.slip_across), axis=0) > 0.0)


@pytest.mark.parametrize("kappa", [0.75, 0.5])
def test_under_hard_shaking_it_is_the_paper_s_column_about_its_centre_of_mass(kappa):
    c, mu, eta, nu = np.array([2e-2, 1e-2, 5e-3]), 0.6, 0.1, 3.0
    faster = math.sqrt(1.0 - kappa)
    found = slipping_rolling(nu, 1e5, c=c, eta=eta, zeta=math.inf, mu=mu * c, inertia_ratio=kappa)
    paper = steady_rolling(nu * faster, mu * c, c=c, eta=eta / faster)
    for branch, known in enumerate([paper.lower, paper.upper]):
        off = np.abs(found.amplitude[:, branch] - known.amplitude) / c
        np.testing.assert_allclose(np.log2(off[:-1] / off[1:]), 2.0, atol=0.05)
        np.testing.assert_array_equal(found.stable[:, branch], known.stable)
        # The other eigenvalues are that of the spin, held, and of the drift of the centre of mass, ±iν.
        expected = np.concatenate([known.eigenvalues[-1] / faster, [1j * nu, -1j * nu]])
        values = found.eigenvalues[-1, branch]
        values = values[np.isfinite(values)]
        away = np.abs(values[:, np.newaxis] - expected)
        assert max(away.min(axis=0).max(), away.min(axis=1).max()) < 1e-3
    low, high = (critical_frequency(mu * c, c=c, eta=eta / faster) / faster * (1.0 + x) for x in (-0.01, 0.01))
    for nu_near, stable in ((low, False), (high, True)):
        near = slipping_rolling(nu_near, 1e5, c=c, eta=eta, zeta=math.inf, mu=mu * c, inertia_ratio=kappa)
        assert np.all(near.stable.any(axis=-1) == stable)


@pytest.mark.parametrize(("a", "m", "kappa"), [(5.0, 0.3, 0.75), (20.0, 0.05, 0.75), (3.0, 1.0, 0.5)])
def test_without_other_friction_stability_begins_at_half_the_tipping_angle(a, m, kappa):
    c = 1e-3
    start = math.sqrt((1.0 + 2.0 * m) / (1.0 - kappa))
    nu = start * np.array([0.999, 1.001])  # off by a part of the order c² only
    found = slipping_rolling(nu, a * c, c=c, eta=0.0, zeta=math.inf, mu=m * c, inertia_ratio=kappa)
    np.testing.assert_array_equal(found.stable.any(axis=-1), [False, True])
    np.testing.assert_allclose(found.amplitude.max(axis=-1, initial=0.0, where=found.exists) / c, 0.5, rtol=2e-3)


def test_a_spin_that_nothing_decides_is_no_matter_of_stability():
    nu = np.linspace(3.0, 6.0, 50)
    found = slipping_rolling(nu, 0.5, c=0.1, eta=0.0, zeta=0.0, spin=0.1, mu=0.02)
    np.testing.assert_allclose(found.spin, 0.1, rtol=1e-14)
    sizes = np.sort(np.abs(found.eigenvalues[:, -1]), axis=-1)
    assert sizes[:, 0].max() < 1e-9
    assert sizes[:, 1].min() > 1e-2
    assert found.stable[:, -1].all()


def test_spin_damping_that_forbids_the_twist_is_the_limit_of_a_strong_one():
    strong = np.array([math.inf, 1e7])
    found = slipping_rolling(2.5, 2.0, c=0.6, eta=0.1, zeta=strong, mu=0.5, inertia_ratio=0.5, axial_ratio=0.8)
    assert found.exists[:, -1].all()
    assert found.amplitude[0, -1] > 0.25
    for name in ("amplitude", "phase", "spin", "slip_along", "slip_across", "slip_power"):
        limit, near = getattr(found, name)[:, -1]
        assert near == pytest.approx(limit, rel=1e-6)
    limit, near = (np.sort_complex(values[np.abs(values) < 1e4]) for values in found.eigenvalues[:, -1])
    assert len(limit) == 6
    np.testing.assert_allclose(near, limit, rtol=1e-5)


def test_slip_saves_a_column_that_would_not_roll_stably():
    held = full_rolling(3.0, 0.5, **PAPER, zeta=math.inf)
    slipping = slipping_rolling(3.0, 0.5, **PAPER, zeta=math.inf, mu=0.05)
    assert not held.stable.any()
    assert slipping.stable.any()


# Stability


@pytest.mark.parametrize(
    ("nu", "a0", "frictions"),
    [
        (3.0, 0.065, {"mu": 0.08, "eta": 0.1, "zeta": 0.1}),
        (3.0, 1.0, {"mu": 0.02, "eta": 0.1, "zeta": 0.1}),
        (2.0, 0.065, {"mu": 0.11, "eta": 0.1, "zeta": 0.0, "patch": 0.03}),
    ],
)
def test_the_body_leaves_or_comes_back_as_the_eigenvalues_say(nu, a0, frictions):
    body = BODIES[0]
    found, other = slipping_rolling(nu, a0, **frictions, **body), made(frictions, body)
    at = states_of(found, nu)
    for branch in range(at.shape[1]):
        values = found.eigenvalues[found.exists][branch]
        steady = at[:, branch]
        # All deviations of 1e-6, as the linear equations carry them on, after a time in which the fastest counts.
        jacobian = _jacobian(steady, nu, a0, frictions | body)
        after = 2.0 / max(values.real.max(), 0.5)
        kick = 1e-6 * steady[2] * np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0])
        expected = _propagated(jacobian, after) @ kick
        ends = [_followed(other, state, nu, a0, after) for state in (steady + kick, steady - kick)]
        np.testing.assert_allclose(0.5 * (ends[0] - ends[1]), expected[2], rtol=1e-3, atol=1e-4 * kick[2])
        np.testing.assert_allclose(np.sort_complex(np.linalg.eigvals(jacobian)), np.sort_complex(values), rtol=1e-5,
                                   atol=1e-6 * np.abs(values).max())  # fmt: skip


def _jacobian(state, nu, a0, numbers):
    steps = 1e-5 * np.abs(state) + 1e-8
    ahead, behind = (
        slipping_rolling_rates(state[:, np.newaxis] + sign * np.diag(steps), nu, a0, **numbers) for sign in (1, -1)
    )
    return (ahead - behind) / (2.0 * steps)


def _propagated(jacobian, time):
    values, vectors = np.linalg.eig(jacobian)
    return (vectors * np.exp(values * time) @ np.linalg.inv(vectors)).real


def _followed(body, state, nu, a0, time):
    """Return the tilt of the body after a time."""

    def rates(now, touching):
        at = body.touch(touching, (a0 * math.cos(nu * now), a0 * math.sin(nu * now), 0.0))
        return body.rates_touching(touching, at, body.slipping(touching, at))

    run = solve_ivp(rates, (0.0, time), touching_state(body, state), "LSODA", rtol=1e-12, atol=1e-14)
    e3 = body.axis(run.y[:, -1])
    return math.atan2(math.hypot(e3[0], e3[1]), e3[2])


# The friction that a slender column needs


@pytest.mark.parametrize("zeta", [0.1, math.inf])
def test_the_friction_of_a_slender_column_is_off_by_the_order_of_c_squared(zeta):
    c = np.array([0.02, 0.01, 0.005])
    numbers = {"c": c, "eta": 0.1, "zeta": zeta, "inertia_ratio": 0.6, "axial_ratio": 0.8}
    needed = rolling_required_friction(2.0, 0.65 * c, **numbers)
    full = full_rolling(2.0, 0.65 * c, **numbers)
    for branch, known in enumerate([needed.lower, needed.upper]):
        off = np.abs(full.friction_demand[:, branch] - known) / c
        np.testing.assert_allclose(np.log2(off[:-1] / off[1:]), 2.0, atol=0.05)


def test_rolling_without_slip_ends_at_a_frequency_in_closed_form():
    a0, c, kappa, mu = 0.065, 0.1, 0.75, 0.04
    nu = math.sqrt((a0 + mu) / (kappa * (a0 + c) - a0 - mu))
    needed = rolling_required_friction([nu, 1e6], a0, c=c, eta=0.0, inertia_ratio=kappa)
    np.testing.assert_allclose(needed.upper, [mu, kappa * c - (1.0 - kappa) * a0], rtol=1e-10)
    least = math.sqrt(a0 / (kappa * c - (1.0 - kappa) * a0))
    assert rolling_required_friction(least, a0, c=c, eta=0.0).upper == pytest.approx(0.0, abs=1e-15)


# Manners


def test_many_at_once_are_as_one_by_one():
    rng = np.random.default_rng(2)
    nu, mu = rng.uniform(1.0, 4.0, (3, 4)), rng.uniform(0.02, 0.12, (3, 4))
    patch, zeta = rng.choice([0.0, 0.05], (3, 4)), rng.choice([0.1, math.inf], (3, 4))
    every = slipping_rolling(nu, 0.3, **PAPER, zeta=zeta, mu=mu, patch=patch)
    assert every.eigenvalues.shape == (*every.exists.shape, 7)
    for cell in np.ndindex(3, 4):
        one = slipping_rolling(nu[cell], 0.3, **PAPER, zeta=zeta[cell], mu=mu[cell], patch=patch[cell])
        assert one.exists.sum() == every.exists[cell].sum()
        for name in ("amplitude", "slip_power", "stable"):
            chosen = getattr(every, name)[cell][every.exists[cell]]
            np.testing.assert_allclose(chosen, getattr(one, name)[one.exists], rtol=1e-12)


def test_nothing_holds_the_spin_of_a_point_without_spin_damping():
    found = slipping_rolling(3.0, 0.065, **PAPER, zeta=0.0, mu=[0.05, 0.08])
    assert found.amplitude.shape == (2, 1)
    assert not found.exists.any()
    assert not found.stable.any()
    assert np.isnan(found.amplitude).all()
    assert np.isnan(rolling_required_friction(3.0, 0.065, **PAPER, zeta=0.0).upper)


@pytest.mark.parametrize(
    ("change", "told"),
    [({"mu": 0.0}, "mu"), ({"zeta": -0.1}, "zeta"), ({"patch": -1.0}, "patch"), ({"spin": math.nan}, "spin")],
)
def test_bad_numbers_are_refused_by_name(change, told):
    with pytest.raises(ParameterError, match=told):
        slipping_rolling(**({"nu": 2.0, "a0": 0.05, "mu": 0.1, "c": 0.1, "eta": 0.1, "zeta": 0.1} | change))
