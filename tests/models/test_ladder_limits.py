"""The models of the hierarchy against each other: what tends to what, how fast, and what does not."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stylobate as sb

KAPPA, AXIAL = 0.75, 0.5
START, SPIN, DURATION = (0.5, 0.2, 0.1, 0.35), 0.3, 3.0
SLENDERNESS = (0.04, 0.02, 0.01)


def column(c):
    return sb.Column.dimensionless(c, KAPPA, AXIAL)


def scaled_end(model, *, size=1.0):
    """The end of the scaled problem θ = c x, a = c g A: x, y, ẋ, ẏ and, of models that know it, the spin."""
    c = model.column.slenderness
    start = [c * value for value in START]
    if model.spin_state is not None:
        start.append(SPIN)

    def rates(tau, y):
        push = c * size * 0.9 * math.cos(1.7 * tau), c * size * 0.7 * math.cos(1.7 * tau + 0.9), 0.0
        return model.rates(*y, *push, *model.parameters)

    run = solve_ivp(rates, (0.0, DURATION), start, "DOP853", rtol=1e-12, atol=1e-14 * c)
    end = run.y[:, -1]
    end[:4] /= c
    return end


def errors(make, limit):
    """How far `make` of a column of each slenderness is from `limit` of it."""
    return np.array([np.abs(scaled_end(make(column(c))) - scaled_end(limit(column(c)))).max() for c in SLENDERNESS])


def slopes(off):
    return np.log2(off[:-1] / off[1:])


def test_the_slender_models_do_not_depend_on_the_slenderness():
    for make in (
        lambda body: sb.Slender(body, damping=0.1),
        lambda body: sb.SlenderRolling(body, damping=0.1, spin_damping=0.2),
    ):
        np.testing.assert_allclose(scaled_end(make(column(0.04))), scaled_end(make(column(0.01))), atol=1e-10)


@pytest.mark.parametrize("damping", [0.0, 0.1])
@pytest.mark.parametrize("constraint", ["pure_tilt", "rubber"])
def test_wobbling_tends_to_the_slender_column_as_the_square_of_the_slenderness(damping, constraint):
    off = errors(
        lambda body: sb.Wobbling(body, damping=damping, constraint=constraint),
        lambda body: sb.Slender(body, damping=damping),
    )
    assert off[-1] < 1e-3
    np.testing.assert_allclose(slopes(off), 2.0, atol=0.05)


@pytest.mark.parametrize("frictions", [{}, {"damping": 0.1}, {"damping": 0.1, "spin_damping": 0.4}])
def test_rolling_tends_to_the_slender_rolling_column_as_the_square_of_the_slenderness(frictions):
    off = errors(lambda body: sb.Rolling(body, **frictions), lambda body: sb.SlenderRolling(body, **frictions))
    assert off[-1] < 1e-3
    np.testing.assert_allclose(slopes(off), 2.0, atol=0.05)


def test_rolling_with_friction_does_not_tend_to_isotropic_couples():
    off = errors(
        lambda body: sb.Rolling(body, damping=0.1),
        lambda body: sb.SlenderRolling(body, damping=0.1, couples="isotropic"),
    )
    assert off.min() > 0.01
    np.testing.assert_allclose(slopes(off), 0.0, atol=0.05)


def test_the_two_constraints_of_wobbling_differ_by_the_square_of_the_slenderness():
    off = errors(sb.Wobbling, lambda body: sb.Wobbling(body, constraint="rubber"))
    assert off[0] > 1e-6
    np.testing.assert_allclose(slopes(off), 2.0, atol=0.05)


def test_shaken_rolling_does_not_tend_to_the_slender_column_that_cannot_turn():
    # In units of c the limit of the difference is that of the two slender models: here 0.64 in the tilt.
    c = SLENDERNESS[-1]
    rolling = scaled_end(sb.Rolling(column(c)))[:4]
    held, free = scaled_end(sb.Slender(column(c))), scaled_end(sb.SlenderRolling(column(c)))[:4]
    between = math.hypot(*(free - held)[:2])
    assert between > 0.3
    assert math.hypot(*(rolling - held)[:2]) == pytest.approx(between, rel=2e-3)


def test_a_base_acceleration_across_the_lean_meets_a_half_instead_of_three_quarters():
    # A centre of mass that may follow: −i_a/D of the acceleration, for a solid cylinder ½ over ¾ of it.
    c = 1e-3
    body = column(c)
    held, free = sb.Wobbling(body), sb.Rolling(body)
    push = (0.0, 1e-4, 0.0)
    across_held = held.rates(0.5 * c, 0.0, 0.0, 0.0, *push, *held.parameters)[3]
    rates = free.rates(0.5 * c, 0.0, 0.0, 0.0, 0.0, *push, *free.parameters)
    assert rates[3] / across_held == pytest.approx(0.5 / 0.75, rel=1e-5)
    # ẇ3 = a_n/(3r), in units 4/9 of a_n/c.
    assert rates[4] == pytest.approx(4.0 / 9.0 * 1e-4 / c, rel=1e-5)


def test_much_spin_damping_makes_rolling_rubber():
    # What is left of ω·Z goes with 1/ζ; started on the constraint.
    body = sb.Column.dimensionless(0.2, KAPPA, AXIAL)
    rubber = sb.Wobbling(body, constraint="rubber")
    tilt = 0.2 * math.hypot(*START[:2])
    around = 0.2**2 * (START[0] * START[3] - START[1] * START[2]) / tilt**2
    spin = -around * math.sin(tilt) * math.tan(tilt)
    state = [0.2 * value for value in START]

    def end(model, start):
        run = solve_ivp(
            lambda tau, y: model.rates(*y, 0.1 * math.cos(1.7 * tau), 0.06 * math.sin(tau), 0.0, *model.parameters),
            (0.0, 2.0), start, "Radau", rtol=1e-10, atol=1e-12,
        )  # fmt: skip
        return run.y[:4, -1]

    exact = end(rubber, state)
    off = [
        np.abs(end(sb.Rolling(body, spin_damping=friction), [*state, spin]) - exact).max()
        for friction in (200.0, 400.0)
    ]
    assert off[1] < 2e-3
    assert off[0] / off[1] == pytest.approx(2.0, rel=0.05)


def in_plane(model, motion, **start):
    return sb.simulate(model, motion, duration=15.0, rtol=1e-10, **start)


def test_in_a_plane_all_levels_at_finite_tilt_are_one():
    body = sb.Column.solid(radius=0.3, height=2.0, density=2000.0)
    motion = sb.Harmonic.straight(
        acceleration=0.15 * body.gravity, angular_frequency=1.5 * body.frequency_scale, direction=0.4
    )
    start = {"tilt": (0.1 * math.cos(0.4), 0.1 * math.sin(0.4)), "damping": 0.05, "rolling_resistance": 0.02}
    frictions = {name: start.pop(name) for name in ("damping", "rolling_resistance")}
    runs = [
        in_plane(model, motion, **start)
        for model in (
            sb.Rolling(body, **frictions, spin_damping=0.3),
            sb.Wobbling(body, **frictions),
            sb.Wobbling(body, **frictions, constraint="rubber"),
            sb.PlanarRocking(body, **frictions, restitution=1.0),
        )
    ]
    first = runs[0]
    assert all(run.planar for run in runs)
    assert len(np.unique(np.sign(first.data["tilt"][:, 0]))) > 1
    for run in runs[1:]:
        assert run.outcome is first.outcome
        for name in ("tilt", "tilt_rate", "energy", "normal_force", "friction_demand"):
            np.testing.assert_allclose(run.data[name], first.data[name], rtol=1e-12, atol=1e-12)
    np.testing.assert_array_equal(first.data["spin"], 0.0)
    np.testing.assert_array_equal(first.data["twist"], 0.0)


@pytest.mark.parametrize("model_type", [sb.Wobbling, sb.Rolling])
def test_slightly_out_of_its_plane_a_column_tilts_as_in_it_and_turns_by_more(model_type):
    # Tilts over time agree to the square root of the energy that goes round; azimuths do not: π√(K/J0) at each passage.
    body = sb.Column.dimensionless(0.2, 0.745, AXIAL)
    model = model_type(body)
    plane = sb.simulate(model, tilt=(0.1, 0.0), duration=12.0, rtol=1e-11, samples=401)
    space = sb.simulate(model, tilt=(0.1, 0.0), tilt_rate=(0.0, 1e-9), duration=12.0, rtol=1e-11, samples=401)
    assert plane.planar
    assert not space.planar
    np.testing.assert_allclose(space.data["amplitude"], plane.data["amplitude"], atol=1e-6)
    signed = plane.data["tilt"][:, 0].to_numpy()
    passages = np.count_nonzero(np.diff(np.sign(signed[signed != 0.0])))
    turn = float(sb.theory.angle_of_turn(0.2, inertia_ratio=0.745))
    assert passages >= 3
    assert float(space.data["azimuth"][-1] - space.data["azimuth"][0]) == pytest.approx(passages * turn, abs=1e-3)


def test_the_friction_that_slender_rolling_needs_is_the_limit_of_that_of_the_rolling_body():
    # The centre of mass moves with the footprint too; differences go as c².
    rng = np.random.default_rng(5)
    draws = rng.normal(size=(40, 7)) * 0.5
    largest = []
    for c in (0.04, 0.02, 0.01):
        column = sb.Column.dimensionless(c)
        frictions = {"damping": 0.1, "spin_damping": 0.1}
        small, finite = sb.SlenderRolling(column, **frictions), sb.Rolling(column, **frictions)
        differences = []
        for draw in draws:
            state, push = [*(c * draw[:4]), draw[4]], [*(c * draw[5:]), 0.0]
            loads = [model.contact(*state, *push, *model.parameters) for model in (small, finite)]
            differences.append([abs(a - b) / c for a, b in zip(loads[0][1:], loads[1][1:], strict=True)])
        largest.append(np.max(differences, axis=0))
    slopes = np.log2(np.array(largest[:-1]) / np.array(largest[1:]))
    np.testing.assert_allclose(slopes, 2.0, atol=0.05)
