"""The column at finite tilt that cannot turn: known motions, the oracle, integrals, passages, and no return."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.models.finite_tilt import FADING

from .same_body import assert_same_rates_and_loads, assert_same_run, random_cases, state_of

CONSTRAINTS = ("pure_tilt", "rubber")
STOUT = sb.Column(
    mass=1.0, radius=0.2, mass_height=1.0, transverse_inertia=1.03 / 3.0, axial_inertia=0.02, gravity=1.0
)  # fmt: skip
SHAKEN = sb.Column(
    mass=2.0, radius=0.075, mass_height=0.5, transverse_inertia=0.16947916666666665, axial_inertia=0.005625,
    gravity=9.81,
)  # fmt: skip
SLIM = sb.Column(
    mass=1.0, radius=0.1, mass_height=1.0, transverse_inertia=0.3358333333333333, axial_inertia=0.005, gravity=1.0
)  # fmt: skip
FRICTIONS = {"damping": 0.1, "rolling_resistance": 0.05}
# (1.2 sin 9t, 0.8 sin(9t + 0.7), 0.5 cos 14t) m/s²
SHAKING = sb.Harmonic.elliptic(
    amplitude=(1.2, 0.8), phase=0.7, angular_frequency=9.0, start_phase=-math.pi / 2.0
) + sb.Harmonic.vertical(acceleration=0.5, angular_frequency=14.0)


# Integrated elsewhere by two formulations, and rounded to the digits given.
@pytest.mark.parametrize(
    ("constraint", "state", "force", "couple"),
    [
        (
            "pure_tilt",
            (0.1907781084558, 2.987210531662, 0.0, -0.106419435802, 0.3882938296209, -0.07410800476861,
             0.01153271994004),
            (19.5430592268, 0.3526778705038, 0.07031092045046),
            0.00516216837485,
        ),
        (
            "rubber",
            (0.1906724596719, 2.989374053816, 0.004304983312038, -0.1050532673092, 0.3882105363717, -0.07417105672395,
             0.0116402198736),
            (19.54339851899, 0.3510993896538, 0.06939396791184),
            0.005076369471362,
        ),
    ],
)  # fmt: skip
def test_known_shaken_motion_without_twist(constraint, state, force, couple):
    model, scale = sb.Wobbling(SHAKEN, constraint=constraint), SHAKEN.frequency_scale
    begun = state_of(model, 0.05, 0.3, -0.03 / scale, 0.1 / scale, None)
    run = sb.simulate(
        model, SHAKING, tilt=begun[:2], tilt_rate=np.array(begun[2:]) * scale, duration=1.0, rtol=1e-13, atol=1e-17
    )
    end = run.data.isel(time=-1)
    theta = float(end["amplitude"])
    found = (
        theta, float(end["azimuth"]) % (2.0 * math.pi), float(end["twist"]),
        -math.sin(theta) * float(end["rolling_rate"]), float(end["amplitude_rate"]), *end["contact_point"].values,
    )  # fmt: skip
    assert found == pytest.approx(state, abs=2e-11)
    normal = float(end["normal_force"])
    assert normal == pytest.approx(force[0], abs=1e-9)
    assert float(end["friction_demand"]) * normal == pytest.approx(math.hypot(*force[1:]), abs=1e-9)
    assert float(end["pivoting_demand"]) * normal * SHAKEN.radius == pytest.approx(couple, abs=1e-11)


@pytest.mark.parametrize("constraint", CONSTRAINTS)
@pytest.mark.parametrize("column", [STOUT, SHAKEN], ids=["stout", "slim"])
@pytest.mark.parametrize("frictions", [{}, FRICTIONS], ids=["free", "with friction"])
def test_accelerations_and_loads_are_those_of_newton_and_euler(column, constraint, frictions):
    assert_same_rates_and_loads(sb.Wobbling(column, constraint=constraint, **frictions), random_cases(200, seed=1))


@pytest.mark.parametrize("constraint", CONSTRAINTS)
@pytest.mark.parametrize("frictions", [{}, FRICTIONS], ids=["free", "with friction"])
def test_shaken_runs_are_those_of_newton_and_euler(constraint, frictions):
    run, _ = assert_same_run(
        sb.Wobbling(STOUT, constraint=constraint, **frictions), (0.07, 0.4, -0.05, 0.1, 0.0), 4.0, twist=0.5,
        position=(0.3, -0.1),
    )  # fmt: skip
    wandered = np.ptp(run.data["footprint"].to_numpy(), axis=0).max()
    assert (wandered > 0.0) == (constraint == "rubber")


@given(
    theta=st.floats(0.05, 1.4), beta=st.floats(-3.0, 3.0), w1=st.floats(-0.5, 0.5), w2=st.floats(-0.5, 0.5),
    ax=st.floats(-0.5, 0.5), ay=st.floats(-0.5, 0.5), az=st.floats(-0.5, 0.5),
)  # fmt: skip
def test_rates_are_those_of_the_lagrangian(theta, beta, w1, w2, ax, ay, az):
    # K θ̈ = ½M'β̇² − (1 + a_z) z' − ρ'a_d − ηθ̇ and (Mβ̇)˙ = −ρ a_n − η sin²θ β̇, M' and ρ' by hand.
    eta = 0.1
    model = sb.Wobbling(STOUT, damping=eta)
    c, kappa, inertia = STOUT.slenderness, STOUT.inertia_ratio, STOUT.inertia_ratio * STOUT.axial_ratio * 0.04
    sine, cos = math.sin(theta), math.cos(theta)
    sway, height, slope = sine + c * (1.0 - cos), cos + c * sine, c * cos - sine
    mass = kappa * sway**2 + (1.0 - kappa) * sine**2 + inertia * (1.0 - cos) ** 2
    mass_rate = 2.0 * (kappa * sway * height + (1.0 - kappa) * sine * cos + inertia * (1.0 - cos) * sine)
    along, across = ax * math.cos(beta) + ay * math.sin(beta), ay * math.cos(beta) - ax * math.sin(beta)
    around = -w1 / sine
    tilting = (0.5 * mass_rate * around**2 - (1.0 + az) * slope - height * along - eta * w2) / (1.0 + kappa * c**2)
    swinging = (-sway * across - eta * sine**2 * around - mass_rate * w2 * around) / mass
    d, n = np.array([math.cos(beta), math.sin(beta)]), np.array([-math.sin(beta), math.cos(beta)])
    expected = (tilting - theta * around**2) * d + (theta * swinging + 2.0 * w2 * around) * n
    found = model.rates(*state_of(model, theta, beta, w1, w2, None), ax, ay, az, *model.parameters)
    np.testing.assert_allclose(found[2:], expected, rtol=0.0, atol=1e-12 * (1.0 + around**2))


def test_free_motion_conserves_energy_and_angular_momentum():
    run = sb.simulate(sb.Wobbling(SHAKEN), tilt=(0.06, 0.02), tilt_rate=(-0.1, 0.2), duration=8.0, rtol=1e-12)
    assert run.measures["turns"] > 1.0
    for name in ("energy", "angular_momentum"):
        np.testing.assert_allclose(run.data[name], run.data[name][0], rtol=1e-10)


def test_rubber_conserves_energy_and_tells_no_angular_momentum():
    model = sb.Wobbling(SHAKEN, constraint="rubber")
    data = sb.simulate(model, tilt=(0.06, 0.02), tilt_rate=(-0.1, 0.2), duration=8.0, rtol=1e-12).data
    np.testing.assert_allclose(data["energy"], data["energy"][0], rtol=1e-10)
    assert "angular_momentum" not in data


@pytest.mark.parametrize("friction", FRICTIONS)
def test_friction_takes_energy_at_its_rate(friction):
    model = sb.Wobbling(STOUT, **{friction: 0.2})
    run = sb.simulate(model, tilt=(0.1, 0.0), tilt_rate=(0.0, 0.2), duration=4.0, rtol=1e-12, samples=4001)
    data = run.data
    scale, unit = STOUT.frequency_scale, STOUT.mass * STOUT.gravity * STOUT.mass_height
    theta, w2 = data["amplitude"].to_numpy(), data["amplitude_rate"].to_numpy() / scale
    w1 = -np.sin(theta) * data["rolling_rate"].to_numpy() / scale
    w3 = w1 * np.tan(theta / 2.0)
    level = np.hypot(w1 * np.cos(theta) + w3 * np.sin(theta), w2)
    normal = data["normal_force"].to_numpy() / (STOUT.mass * STOUT.gravity)
    lost = {
        "damping": 0.2 * (w1**2 + w2**2),
        "rolling_resistance": 0.2 * STOUT.slenderness * normal * level**2 / np.hypot(level, FADING),
    }[friction]
    tau = data["time"].to_numpy() * scale
    # Simpson's rule over 4000 intervals.
    work = (tau[2] - tau[0]) / 6.0 * (lost[0:-2:2] + 4.0 * lost[1:-1:2] + lost[2::2]).sum()
    energy = data["energy"].to_numpy() / unit
    assert work > 1e-3
    assert energy[0] - energy[-1] == pytest.approx(work, rel=1e-7)
    assert np.diff(energy).max() <= 0.0


def test_the_work_of_the_base_is_that_of_its_inertial_force():
    motion = sb.Harmonic.elliptic(amplitude=(0.08, 0.05), phase=0.7, angular_frequency=2.3)
    motion += sb.Harmonic.vertical(acceleration=0.05, angular_frequency=3.1)
    run = sb.simulate(
        sb.Wobbling(STOUT), motion, tilt=(0.1, 0.0), tilt_rate=(0.0, 0.1), duration=4.0, rtol=1e-12, samples=8001
    )
    data, c = run.data, STOUT.slenderness
    theta, beta = data["amplitude"].to_numpy(), data["azimuth"].to_numpy()
    w2, w1 = data["amplitude_rate"].to_numpy(), -np.sin(theta) * data["rolling_rate"].to_numpy()
    ax, ay, az = data["base_acceleration"].to_numpy().T
    along, across = ax * np.cos(beta) + ay * np.sin(beta), ay * np.cos(beta) - ax * np.sin(beta)
    height, slope = np.cos(theta) + c * np.sin(theta), c * np.cos(theta) - np.sin(theta)
    across_speed = -w1 * (1.0 + c * np.tan(theta / 2.0))  # ρβ̇
    power = -STOUT.mass * STOUT.mass_height * (along * height * w2 + across * across_speed + az * slope * w2)
    time = data["time"].to_numpy()
    work = (time[2] - time[0]) / 6.0 * (power[0:-2:2] + 4.0 * power[1:-1:2] + power[2::2]).sum()
    change = float(data["energy"][-1] - data["energy"][0])
    assert abs(change) > 1e-4
    assert change == pytest.approx(work, rel=1e-6)


@pytest.mark.parametrize("offset", [1e-4, -1e-4, 1e-2, -1e-2])
@pytest.mark.parametrize("constraint", CONSTRAINTS)
def test_a_passage_in_closed_form_is_the_orbit_integrated(offset, constraint):
    # Gravity, left out, changes the speed by the part c far/V² = 8e-6.
    model, far, speed = sb.Wobbling(STOUT, constraint=constraint), 1e-7, 0.05
    start = (-far, offset * far, speed, 0.0)

    def back(_, y):
        return math.hypot(y[0], y[1]) - math.hypot(*start[:2])

    back.terminal, back.direction = True, 1.0
    run = solve_ivp(
        lambda tau, y: model.rates(*y, 0.0, 0.0, 0.0, *model.parameters), (0.0, 1.0), start, "DOP853", rtol=1e-13,
        atol=1e-20, events=back,
    )  # fmt: skip
    elapsed, end = model.passage(*start, 0.0, 0.0, 0.0, *model.parameters)
    np.testing.assert_allclose(end[:2], run.y[:2, -1], atol=2e-5 * far)
    np.testing.assert_allclose(end[2:], run.y[2:, -1], atol=2e-5 * speed)
    assert elapsed == pytest.approx(run.t[-1], rel=1e-4)


@pytest.mark.parametrize("model_type", [sb.Wobbling, sb.Rolling])
def test_a_column_that_seems_to_bounce_flat_turns_as_theory_says(model_type):
    # Released at half the tipping angle with little turning: the azimuth between apexes tends to π√(K/J0), linearly but
    # for a logarithm.
    turns = []
    for turning in (2e-6, 1e-6):
        run = sb.simulate(
            model_type(SLIM), tilt=(0.05, 0.0), tilt_rate=(0.0, 0.05 * turning * SLIM.frequency_scale),
            duration=3.0578, rtol=1e-12, atol=1e-17,
        )  # fmt: skip
        turns.append(float(run.data["azimuth"][-1]))
    limit = math.degrees(2.0 * turns[1] - turns[0])
    assert limit == pytest.approx(180.6724805, abs=2e-4)
    assert limit == pytest.approx(
        math.degrees(sb.theory.angle_of_turn(0.1, inertia_ratio=SLIM.inertia_ratio)), abs=2e-4
    )


@given(
    tilt=st.floats(1e-3, 1.4), rate=st.floats(-0.5, 0.5), a=st.floats(-0.5, 0.5), az=st.floats(-0.5, 0.5),
    side=st.sampled_from([1.0, -1.0]), constraint=st.sampled_from(CONSTRAINTS),
)  # fmt: skip
def test_planar_rates_are_those_in_space_along_any_line(tilt, rate, a, az, side, constraint):
    model = sb.Wobbling(STOUT, **FRICTIONS, constraint=constraint)
    line = np.array([math.cos(1.1), math.sin(1.1)])
    found = model.rates(*(side * tilt * line), *(rate * line), *(a * line), az, *model.parameters)
    planar = model.planar_rates(side * tilt, rate, side, a, az, *model.parameters)
    assert np.array(found[2:]) == pytest.approx(planar[1] * line, rel=1e-12, abs=1e-13)


@settings(max_examples=25)
@given(
    a=st.floats(0.0, 0.3), theta=st.floats(0.5, 5.0), phase=st.floats(0.0, 6.3), beta=st.floats(0.0, 6.3),
    beyond=st.floats(1e-6, 0.1), turning=st.floats(-0.3, 0.3), constraint=st.sampled_from(CONSTRAINTS),
)  # fmt: skip
def test_starts_beyond_the_tilt_of_no_return_fall(a, theta, phase, beta, beyond, turning, constraint):
    model = sb.Wobbling(STOUT, constraint=constraint)
    tilt = model.no_return_tilt(a, 0.0, *model.parameters) + beyond
    lean = tilt * np.array([math.cos(beta), math.sin(beta)])
    motion = sb.Harmonic.circular(acceleration=a, angular_frequency=theta * STOUT.frequency_scale, start_phase=phase)
    start = {"tilt": lean, "tilt_rate": (-turning * lean[1], turning * lean[0])}
    run = sb.simulate(model, motion, **start, duration=50.0)
    assert run.outcome is sb.Outcome.OVERTURNED
    # Not by that criterion alone: followed on, it lies down.
    state = np.array(model.start(lean, start["tilt_rate"]))
    scale, gravity = model.time_scale, STOUT.gravity

    def rates(tau, y):
        push = motion.acceleration(tau * scale) / gravity
        return model.rates(*y, *push, *model.parameters)

    def lies(_, y):
        return math.hypot(y[0], y[1]) - 1.5

    lies.terminal = True
    fallen = solve_ivp(rates, (0.0, 100.0), state, "DOP853", rtol=1e-8, atol=1e-10, events=lies)
    sizes = np.hypot(*fallen.y[:2])
    assert fallen.status == 1
    assert sizes.min() >= tilt * (1.0 - 1e-9)


def test_a_column_that_lies_is_overturned_whatever_the_base_may_do():
    # Twenty times gravity could lift it from any tilt below a right angle.
    motion = sb.Harmonic.straight(acceleration=20.0, angular_frequency=30.0, direction=1.0)
    for constraint in CONSTRAINTS:
        model = sb.Wobbling(STOUT, constraint=constraint)
        run = sb.simulate(model, motion, tilt=(0.3, 0.0), tilt_rate=(3.0, 0.0), duration=5.0)
        assert run.outcome is sb.Outcome.OVERTURNED
        assert run.measures["peak_tilt"] <= math.pi / 2.0 * (1.0 + 1e-9)


def test_it_can_be_described_and_saved(tmp_path):
    model = sb.Wobbling(STOUT, **FRICTIONS, restitution=0.9, passage_tilt=0.01, constraint="rubber")
    run = sb.simulate(
        model, SHAKING.scaled(0.05), tilt=(0.05, 0.0), twist=0.2, position=(0.1, 0.2), duration=2.0
    )  # fmt: skip
    loaded = sb.load(run.save(tmp_path / "run.nc"))
    setup = sb.config.config_of(loaded.provenance).build()
    again = sb.simulate(setup.model, setup.motion, **setup.options)
    assert setup.model == model
    for name in ("tilt", "twist", "footprint"):
        np.testing.assert_array_equal(again.data[name], run.data[name])


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"constraint": "both"}, "constraint must be 'pure_tilt' or 'rubber', got 'both'"),
        ({"damping": -1.0}, "damping must be zero or positive, got -1.0"),
        ({"rolling_resistance": math.inf}, "rolling_resistance must be zero or positive, got inf"),
        ({"restitution": 1.1}, "restitution must lie between 0 and 1, 1 for no loss, got 1.1"),
        ({"passage_tilt": math.nan}, "passage_tilt must lie between 0 and π/2, got nan"),
        ({"column": None}, "column must be a Column"),
    ],
)
def test_bad_numbers_are_refused_in_one_line(change, told):
    with pytest.raises(ParameterError) as refusal:
        sb.Wobbling(**({"column": STOUT} | change))
    assert str(refusal.value).startswith(told)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("constraint", ["pure_tilt", "rubber"])
@pytest.mark.parametrize("slenderness", [0.02, 0.1, 0.3, 0.7, 1.5, 3.0])
@pytest.mark.parametrize("inner", [0.3, 0.9])
def test_rolling_round_the_rim_never_holds_a_falling_column_back(constraint, slenderness, inner):
    # The proof of no return drops what β̇ adds to the acceleration of the tilt.
    column = sb.Column.hollow(radius=slenderness, inner_radius=inner * slenderness, height=2.0, density=1000.0)
    model = sb.Wobbling(column, constraint=constraint)
    for theta in np.linspace(math.atan(slenderness), 0.5 * math.pi - 1e-3, 40):
        still, turning = (
            model.rates(theta, 0.0, 0.0, theta * rate, 0.0, 0.0, 0.0, *model.parameters)[2] + theta * rate**2
            for rate in (0.0, 1.0)
        )
        assert turning > still
