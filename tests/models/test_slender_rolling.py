"""The slender column whose twist is free: its equations, limits, passages, and runs of all kinds."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.models.model import Push

C = 0.1
COLUMN = sb.Column.dimensionless(C)
numbers = st.floats(-0.5, 0.5)


def integrated(model, state, duration, push=lambda _: (0.0, 0.0, 0.0), rtol=1e-13):
    """The end of a run by SciPy, in the time of the model."""
    run = solve_ivp(
        lambda tau, y: model.rates(*y, *push(tau), *model.parameters), (0.0, duration), state, "DOP853",
        rtol=rtol, atol=1e-15,
    )  # fmt: skip
    return run.y[:, -1]


def in_units_of_c(state):
    return [*(np.asarray(state[:4]) / C), state[4]]


def two_cosines(tau):
    return C * 0.9 * math.cos(1.7 * tau), C * 0.7 * math.cos(1.7 * tau + 0.9), 0.0


@pytest.mark.parametrize(
    ("damping", "known"),
    [
        (0.0, (0.4633016599434, 0.1755082287947, 0.5698194394444, 0.2406820463709, 0.5924421271062)),
        (0.05, (0.4713118434379, 0.1900416448556, 0.507231945812, 0.197028335823, 0.6017591369853)),
    ],
)
def test_known_trajectories(damping, known):
    # Integrated elsewhere, by another formulation; with damping that of isotropic couples.
    model = sb.SlenderRolling(COLUMN, damping=damping, couples="isotropic")
    start = [C * 0.5, C * 0.2, C * 0.1, C * 0.35, 0.3]
    assert in_units_of_c(integrated(model, start, 3.0, two_cosines)) == pytest.approx(known, abs=1e-9)


@given(x=numbers, y=numbers, vx=numbers, vy=numbers, spin=numbers, ax=numbers, ay=numbers, az=numbers)
def test_rates_are_the_equations_written_with_vectors(x, y, vx, vy, spin, ax, ay, az):
    if math.hypot(x, y) < 1e-6:
        return
    eta, zeta, kappa, i_a = 0.2, 0.3, 0.75, 0.5
    model = sb.SlenderRolling(COLUMN, damping=eta, spin_damping=zeta)
    alpha, v, a = np.array([x, y]), np.array([vx, vy]), np.array([ax, ay])
    u = alpha / np.hypot(x, y)
    n = np.array([-u[1], u[0]])
    freedom = 1.0 + i_a - kappa
    turning = (v @ n) / np.hypot(x, y)
    expected = (
        (1.0 + az) * (alpha - C * u)
        - a
        + n * (a @ n) * (1.0 - kappa) / freedom
        - C * kappa * spin * turning * u
        - eta * ((v @ u) * u + (1.0 + i_a) / freedom * (v @ n) * n)
        - C * kappa * zeta * spin * n
    )
    spin_up = (a @ n) * (1.0 - kappa) / (C * kappa * freedom) - eta / (C * freedom) * (v @ n) - zeta * spin
    found = model.rates(x, y, vx, vy, spin, ax, ay, az, *model.parameters)
    assert found == pytest.approx((vx, vy, *expected, spin_up), rel=1e-11, abs=1e-12 * (1.0 + abs(turning)))


def test_a_column_that_is_hard_to_turn_is_the_slender_one():
    # No body has such an i_a, but the equations have; deviations go as 1/i_a.
    start = [0.05, 0.02, 0.01, 0.035, 0.0]
    held = sb.Slender(COLUMN, damping=0.1)
    exact = np.array(
        solve_ivp(
            lambda tau, y: held.rates(*y, *two_cosines(tau), *held.parameters), (0.0, 3.0), start[:4], "DOP853",
            rtol=1e-12, atol=1e-14,
        ).y[:, -1]
    )  # fmt: skip
    off = []
    for axial in (1e2, 1e3, 1e4):
        parameters = (C, 0.1, 0.0, 0.75, axial, 1.0)
        run = solve_ivp(
            lambda tau, y, p=parameters: sb.SlenderRolling.rates(*y, *two_cosines(tau), *p), (0.0, 3.0), start,
            "DOP853", rtol=1e-12, atol=1e-14,
        )  # fmt: skip
        off.append(np.abs(run.y[:4, -1] - exact).max())
    np.testing.assert_allclose(np.array(off[:-1]) / off[1:], 10.0, rtol=0.1)


def test_without_friction_and_base_motion_three_integrals_stay():
    # Spin, A²β̇, and the energy ½|α̇|² + cA − ½A² − cκσAβ̇, of which the last is due to the rim that rolls.
    model = sb.SlenderRolling(COLUMN)
    start = np.array([0.05, 0.01, 0.02, 0.03, 0.4])
    end = integrated(model, start, 20.0)

    def kept(state):
        x, y, vx, vy, spin = state
        tilt, momentum = math.hypot(x, y), x * vy - y * vx
        energy = 0.5 * (vx**2 + vy**2) + C * tilt - 0.5 * tilt**2 - C * 0.75 * spin * momentum / tilt
        return energy, spin, momentum

    np.testing.assert_allclose(kept(end), kept(start), rtol=1e-10)


@pytest.mark.parametrize("spin", [0.0, 0.4, -0.7])
def test_the_path_turns_near_the_upright_by_what_the_spin_says(spin):
    # By 2 atan(κcσ/V), V the speed there; corrections are of the order of the offset over the distance.
    model = sb.SlenderRolling(COLUMN)
    speed, offset, far = 0.05, 1e-7, 2e-3
    start = np.array([-far, offset, speed, 0.0, spin])
    # Gravity draws it to the upright, and holds it back as much afterwards.
    at_upright = math.sqrt(speed**2 + 2.0 * C * far - far**2)
    end = integrated(model, start, 2.0 * far / (0.5 * (speed + at_upright)))
    turned = math.atan2(end[3], end[2])
    assert turned == pytest.approx(2.0 * math.atan(0.75 * C * spin / at_upright), abs=1e-3)


@pytest.mark.parametrize("spin", [0.0, 0.4, -2.0])
def test_a_passage_in_closed_form_is_the_one_integrated(spin):
    model = sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.2)
    far, speed = 1e-5, 0.05
    start = (-far, 1e-9, speed, 1e-6, spin)
    push = (0.02, 0.03, 0.0)
    elapsed, end = model.passage(*start, *push, *model.parameters)
    exact = integrated(model, start, elapsed, lambda _: push)
    # Gravity changes the speed by c far/V meanwhile, which is left out: a part 4e-4 of it, and of the turn.
    np.testing.assert_allclose(end[:2], exact[:2], atol=3e-3 * far)
    np.testing.assert_allclose(end[2:4], exact[2:4], atol=3e-3 * speed)
    assert end[4] == pytest.approx(exact[4], abs=1e-3)


def test_departure_goes_over_into_the_motion_integrated():
    model = sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.2)
    nu, a0 = 2.0, 0.13
    # Released while a circular motion grows: a_h = a0 (1 + 0.1 τ)(cos ντ, sin ντ), beyond c already by 0.03.
    push = Push((-1.0, 0.0), a0, a0 - C, 0.1 * a0, nu)
    late = 1e-2
    early = 1e-4

    def pushed(tau):
        size = a0 * (1.0 + 0.1 * tau)
        return size * math.cos(nu * tau), size * math.sin(nu * tau), 0.0

    begun = model.departure(push, early, *model.parameters)
    run = solve_ivp(
        lambda tau, y: model.rates(*y, *pushed(tau), *model.parameters), (early, late), begun, "DOP853",
        rtol=1e-12, atol=1e-20,
    )  # fmt: skip
    np.testing.assert_allclose(model.departure(push, late, *model.parameters), run.y[:, -1], rtol=3e-2)


@pytest.mark.parametrize("method", ["dop853", pytest.param("taylor", marks=pytest.mark.slow)])
def test_runs_and_ensembles_agree(method):
    model = sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.1)
    circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
    start = {"tilt": (0.016, 0.0), "tilt_rate": (0.0, 0.048), "duration": 60.0}
    single = sb.simulate(model, circle, **start)
    together = sb.simulate_ensemble(model, circle, **start, method=method)
    assert sb.Outcome(int(together["outcome"].item())) is single.outcome
    assert float(together["peak_tilt"].item()) == pytest.approx(single.measures["peak_tilt"], rel=1e-6)
    np.testing.assert_allclose(together["end_tilt"].squeeze(), single.data["tilt"][-1], atol=1e-7)


def settled(nu, spin_damping):
    """A run that has settled on steady rolling, and what theory knows of it."""
    model = sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=spin_damping)
    circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=nu)
    known = sb.theory.free_twist_rolling(nu, 0.065, c=C, eta=0.1, zeta=spin_damping)
    size = float(known.amplitude)
    run = sb.simulate(
        model, circle, tilt=(size, 0.0), tilt_rate=(0.0, nu * size), duration=320.0 * circle.period
    )  # fmt: skip
    return run, known, model, circle


def test_a_run_settles_on_steady_rolling_with_a_free_twist():
    run, known, _, circle = settled(3.0, 0.1)
    assert run.outcome is sb.Outcome.ROLLING
    left = math.exp(float(known.eigenvalues.real.max()) * 320.0 * circle.period)
    tilt = np.hypot(*run.data["tilt"].to_numpy()[-1])
    assert tilt == pytest.approx(float(known.amplitude), rel=10.0 * left + 1e-7)
    assert float(run.data["spin"][-1]) == pytest.approx(float(known.spin), rel=10.0 * left + 1e-7)


@pytest.mark.slow  # a flow of its own; that of theory is checked beside its closed forms
def test_its_orbits_have_the_eigenvalues_of_theory():
    run, known, model, circle = settled(2.0, 0.3)
    orbit = sb.orbits.periodic_orbit(model, circle, guess=run)
    expected = np.sort_complex(np.exp(known.eigenvalues * circle.period))
    np.testing.assert_allclose(np.sort_complex(orbit.multipliers), expected, atol=1e-8)
    assert orbit.stable


def test_a_column_pushed_along_a_line_keeps_to_it_without_spin():
    model = sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.1)
    line = sb.Harmonic.straight(acceleration=0.11, angular_frequency=6.0)
    run = sb.simulate(model, line, duration=20.0)
    same = sb.simulate(sb.Slender(COLUMN, damping=0.1), line, duration=20.0)
    assert run.planar
    assert run.outcome is same.outcome
    np.testing.assert_array_equal(run.data["spin"], 0.0)
    assert run.measures["peak_tilt"] == pytest.approx(same.measures["peak_tilt"], rel=1e-9)


def test_it_can_be_described_and_saved(tmp_path):
    model = sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.2, couples="isotropic")
    circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
    run = sb.simulate(model, circle, tilt=(0.01, 0.0), duration=5.0)
    again = sb.load(run.save(tmp_path / "run.nc"))
    assert again.provenance["model"]["kind"] == "slender_rolling"
    np.testing.assert_array_equal(again.data["tilt"], run.data["tilt"])


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"spin_damping": -1.0}, "spin_damping"),
        ({"damping": math.nan}, "damping"),
        ({"couples": "both"}, "couples must be 'contact' or 'isotropic', got 'both'"),
        ({"column": 3.0}, "column must be a Column"),
    ],
)
def test_bad_numbers_are_refused_by_name(change, told):
    with pytest.raises(ParameterError, match=told):
        sb.SlenderRolling(**({"column": COLUMN} | change))
