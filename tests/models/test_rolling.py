"""The rolling column at finite tilt: known motions, the oracle, integrals, work, passages, and what it refuses."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.models.finite_tilt import FADING

from .same_body import assert_same_rates_and_loads, assert_same_run, random_cases, state_of

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
FRICTIONS = {"damping": 0.1, "spin_damping": 0.2, "rolling_resistance": 0.05}
# (1.2 sin 9t, 0.8 sin(9t + 0.7), 0.5 cos 14t) m/s²
SHAKING = sb.Harmonic.elliptic(
    amplitude=(1.2, 0.8), phase=0.7, angular_frequency=9.0, start_phase=-math.pi / 2.0
) + sb.Harmonic.vertical(acceleration=0.5, angular_frequency=14.0)


def simulated(model, motion, *, theta, beta, w1, w2, w3, **options):
    """A run from angular velocities in rad/s."""
    scale = model.column.frequency_scale
    begun = state_of(model, theta, beta, w1 / scale, w2 / scale, w3 / scale)
    close = {"rtol": 1e-13, "atol": 1e-17} | options
    return sb.simulate(
        model, motion, tilt=begun[:2], tilt_rate=np.array(begun[2:4]) * scale, spin=w3, **close
    )  # fmt: skip


def rolled(run):
    """θ, β, χ, w1, w2, w3, C_x, C_y along a run."""
    data = run.data
    theta, beta = data["amplitude"].to_numpy(), data["azimuth"].to_numpy()
    w1 = -np.sin(theta) * data["rolling_rate"].to_numpy()
    contact = data["contact_point"].to_numpy()
    w2, w3 = data["amplitude_rate"].to_numpy(), data["spin"].to_numpy()
    return np.array([theta, beta, data["twist"].to_numpy(), w1, w2, w3, contact[:, 0], contact[:, 1]])


def assert_known(found, known, *, within):
    """Compare with numbers in which β and χ are known up to whole turns."""
    turns = np.round((found - known) / (2.0 * math.pi))
    turns[[0, 3, 4, 5, 6, 7]] = 0.0
    np.testing.assert_allclose(found - 2.0 * math.pi * turns, known, rtol=0.0, atol=within)


def integrated(model, state, duration, push=(0.0, 0.0, 0.0), rtol=1e-13, atol=1e-17):
    """The end of a motion under a constant push by SciPy, in the time of the model."""
    run = solve_ivp(
        lambda tau, y: model.rates(*y, *push, *model.parameters), (0.0, duration), state, "DOP853", rtol=rtol, atol=atol
    )  # fmt: skip
    return run.y[:, -1]


# Known trajectories were integrated elsewhere by two formulations, and rounded to the digits given.


def test_known_free_rolling():
    run = simulated(
        sb.Rolling(STOUT), None, theta=0.15, beta=0.3, w1=-0.037359533118399804, w2=0.0, w3=0.1, twist=0.4,
        duration=10.0,
    )  # fmt: skip
    known = (
        0.1444760235755, 2.546728174708, 1.416279304653, -0.03878190713697, 0.01854676917173, 0.09987449084528,
        -0.182066795485, 0.10196700064,
    )  # fmt: skip
    assert_known(rolled(run)[:, -1], known, within=2e-11)
    # The energy known is counted from the ground, that of runs from rest.
    np.testing.assert_allclose(run.data["energy"] + 1.0, 1.019148982252, rtol=0.0, atol=1e-11)
    # The minimum tilt was looked for on another grid than here: both are within ½θ̈(Δt/2)², θ̈ < 0.41, of it.
    assert run.measures["minimum_tilt"] == pytest.approx(0.0376824, abs=1.3e-4)


def test_known_shaken_rolling_with_the_forces_of_the_contact():
    run = simulated(
        sb.Rolling(SHAKEN), SHAKING, theta=0.05, beta=0.3, w1=-0.03, w2=0.1, w3=0.1, duration=2.0, samples=9
    )  # fmt: skip
    after_1_s = (
        0.1403872286385, -2.859976583901, 0.7629439534528, -0.02570888215081, 0.224076497214, 0.6315812016326,
        -0.08892959708129, 0.02054186680568,
    )  # fmt: skip
    after_2_s = (
        0.4298026709139, -2.976016677188, 1.615407759584, 0.07071653762442, 0.8936836814047, 1.135982112509,
        -0.1039183261956, 0.09155036913029,
    )  # fmt: skip
    assert_known(rolled(run)[:, 4], after_1_s, within=1e-10)
    assert_known(rolled(run)[:, 8], after_2_s, within=1e-10)
    normal = (19.21209507971, 20.26847859455, 19.7101176191, 19.02866039878, 17.15884530182)
    ratio = (0.1491349736486, 0.01105142608886, 0.01767545388293, 0.01687643777582, 0.2364091656408)
    np.testing.assert_allclose(run.data["normal_force"][[1, 2, 4, 6, 8]], normal, rtol=1e-10)
    np.testing.assert_allclose(run.data["friction_demand"][[1, 2, 4, 6, 8]], ratio, rtol=0.0, atol=1e-10)
    assert run.measures["peak_friction_demand"] == pytest.approx(0.2364091656408, abs=1e-9)


@pytest.mark.parametrize(
    ("turning", "apex", "turn", "least"),
    [
        (1e-2, 3.058216320024, 183.474357, 3.35786761e-4),
        (1e-3, 3.057802529426, 181.070093, 3.34431473e-5),
        (1e-4, 3.057797019334, 180.723985, 3.34295972e-6),
    ],
)
def test_known_turns_between_apexes_of_free_rolling(turning, apex, turn, least):
    run = simulated(
        sb.Rolling(SLIM), None, theta=0.05, beta=0.0, w1=-turning * math.sin(0.05), w2=0.0, w3=0.0, duration=apex
    )  # fmt: skip
    end = rolled(run)[:, -1]
    assert end[4] == pytest.approx(0.0, abs=1e-9)
    assert math.degrees(end[1]) == pytest.approx(turn, abs=1e-6)
    assert run.measures["least_passage"] == pytest.approx(least, rel=1e-8)
    assert end[5] == pytest.approx(0.0, abs=1e-13)


@pytest.mark.parametrize("column", [STOUT, SHAKEN], ids=["stout", "slim"])
@pytest.mark.parametrize("frictions", [{}, FRICTIONS], ids=["free", "with friction"])
def test_accelerations_and_loads_are_those_of_newton_and_euler(column, frictions):
    assert_same_rates_and_loads(sb.Rolling(column, **frictions), random_cases(200, seed=1))


@pytest.mark.parametrize("friction", FRICTIONS)
def test_each_friction_by_itself_is_that_of_newton_and_euler(friction):
    assert_same_rates_and_loads(sb.Rolling(STOUT, **{friction: 0.3}), random_cases(50, seed=2))


@pytest.mark.parametrize("frictions", [{}, FRICTIONS], ids=["free", "with friction"])
def test_shaken_runs_are_those_of_newton_and_euler(frictions):
    run, _ = assert_same_run(
        sb.Rolling(STOUT, **frictions), (0.07, 0.4, -0.05, 0.1, 0.1), 4.0, twist=0.5, position=(0.3, -0.1)
    )  # fmt: skip
    assert run.warnings == ()


def w1_and_w3(state):
    x, y, vx, vy, spin = state
    tilt = math.hypot(x, y)
    return np.array([-math.sin(tilt) * (x * vy - y * vx) / tilt**2, spin])


def crossings(model, state, tilt, duration):
    """(w1, w3) wherever a free motion has this tilt."""

    def at_tilt(_, y):
        return math.hypot(y[0], y[1]) - tilt

    run = solve_ivp(
        lambda tau, y: model.rates(*y, 0.0, 0.0, 0.0, *model.parameters), (0.0, duration), state, "DOP853",
        rtol=1e-13, atol=1e-16, events=at_tilt,
    )  # fmt: skip
    return [w1_and_w3(y) for y in run.y_events[0]]


def test_free_motion_comes_back_to_a_tilt_with_the_same_rolling_and_spin():
    # (w1, w3) is a linear function of its start with coefficients that depend on θ alone.
    model = sb.Rolling(STOUT)
    found = crossings(model, state_of(model, 0.12, 0.0, -0.05, 0.02, 0.3), 0.1, 30.0)
    assert len(found) > 8
    np.testing.assert_allclose(found, [found[0]] * len(found), rtol=1e-10)


def test_rolling_and_spin_at_a_tilt_are_linear_in_those_at_another():
    # Falls of other speeds and azimuths, too: the map from θ = 0.12 to θ = 0.1 is one matrix.
    model = sb.Rolling(STOUT)
    starts = np.array([(-0.05, 0.3), (0.08, -0.1), (0.02, 0.7)])
    ends = np.array([
        crossings(model, state_of(model, 0.12, beta, w1, w2, w3), 0.1, 3.0)[0]
        for (w1, w3), w2, beta in zip(starts, (-0.3, -0.1, -0.2), (0.0, 1.0, 2.5), strict=True)
    ])  # fmt: skip
    matrix = np.linalg.solve(starts[:2], ends[:2]).T
    np.testing.assert_allclose(ends[2], matrix @ starts[2], rtol=1e-10)


@pytest.mark.parametrize("spin", [0.0, 0.5])
def test_free_motion_conserves_energy(spin):
    run = sb.simulate(
        sb.Rolling(SHAKEN), tilt=(0.05, 0.02), tilt_rate=(0.1, 0.15), spin=spin, duration=5.0, rtol=1e-12
    )  # fmt: skip
    np.testing.assert_allclose(run.data["energy"], run.data["energy"][0], rtol=1e-10)


def energy(model, state):
    return model.energy(np.array(state)[:, np.newaxis])[0] / (
        model.column.mass * model.column.gravity * model.column.mass_height
    )


def power(model, state, push):
    """Rate of the energy, by a difference of fourth order along the rates of the model, in units of m g h ω0."""
    rates, step = np.array(model.rates(*state, *push, *model.parameters)), 1e-4
    far, near = (
        energy(model, state + size * step * rates) - energy(model, state - size * step * rates) for size in (2.0, 1.0)
    )
    return (8.0 * near - far) / (12.0 * step)


def test_energy_changes_by_the_work_of_the_base_and_of_each_friction():
    free = sb.Rolling(STOUT)
    c, kappa = STOUT.slenderness, STOUT.inertia_ratio
    freedom = 1.0 + STOUT.axial_ratio - kappa
    for theta, beta, w1, w2, w3, *push in random_cases(60, seed=3):
        state = state_of(free, max(theta, 0.05), beta, w1, w2, w3)
        tilt = math.hypot(*state[:2])
        sine, cos = math.sin(tilt), math.cos(tilt)
        # v_G = (ρ'w2, −w, z'w2) along d, n and Z, in units of h ω0.
        along, across = (push[0] * math.cos(beta) + push[1] * math.sin(beta),
                         push[1] * math.cos(beta) - push[0] * math.sin(beta))  # fmt: skip
        height, slope, rolling = cos + c * sine, c * cos - sine, c * w3 + w1
        base = -along * height * w2 + across * rolling - push[2] * slope * w2
        normal = {}
        for name in ("none", *FRICTIONS):
            model = replace(free, **({name: 0.3} if name in FRICTIONS else {}))
            normal[name] = model.contact(*state, *push, *model.parameters)[0]
            level = math.hypot(w1 * cos + w3 * sine, w2)
            lost = {
                "none": 0.0,
                "damping": 0.3 * (w1**2 + w2**2),
                "spin_damping": 0.3 * kappa * c**2 * freedom * (w3 * cos - w1 * sine) ** 2,
                "rolling_resistance": 0.3 * c * normal[name] * level**2 / math.hypot(level, FADING),
            }[name]
            assert power(model, state, push) == pytest.approx(base - lost, abs=1e-9)
            assert lost >= 0.0 or normal[name] < 0.0


def test_spin_damping_slows_a_column_that_spins_almost_upright_at_its_rate():
    model = sb.Rolling(SLIM, spin_damping=0.4)
    # Its lean is too small to matter: moments about the contact point are those of an upright column.
    rate = model.rates(1e-6, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, *model.parameters)[4]
    assert rate == pytest.approx(-0.4 * 2.0, rel=1e-4)


@pytest.mark.parametrize("column", [SLIM, STOUT], ids=["c=0.1", "c=0.2"])
@pytest.mark.parametrize("spin_ratio", [0.0, 5.0, -5.0])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_turn_near_the_upright_tends_to_that_of_theory(column, spin_ratio, sense):
    # From `far` and back, by ever closer passages: the turn lacks 2ℓ/(V far) of the whole, extrapolated away.
    model, far, speed = sb.Rolling(column), 1e-6, 0.05
    spin = sense * spin_ratio * speed
    turns = []
    for moment in (1e-9 * speed, 2e-9 * speed):
        state = (far, 0.0, -speed, sense * moment / far, spin)

        def azimuth_rate(tau, y, model=model):
            return (*model.rates(*y[:5], 0.0, 0.0, 0.0, *model.parameters), (y[0] * y[3] - y[1] * y[2])
                    / (y[0] ** 2 + y[1] ** 2))  # fmt: skip

        def back(_, y):
            return math.hypot(y[0], y[1]) - 1.0000001 * far

        back.terminal, back.direction = True, 1.0
        run = solve_ivp(azimuth_rate, (0.0, 1.0), (*state, 0.0), "DOP853", rtol=1e-12, atol=1e-18, events=back)
        turns.append(sense * run.y[5, -1])
    turn = 2.0 * turns[0] - turns[1]
    c, kappa = column.slenderness, column.inertia_ratio
    at_upright = math.sqrt(speed**2 + 2.0 * c * far / (1.0 + kappa * c**2))  # gravity draws it there
    known = sb.theory.angle_of_turn(c, inertia_ratio=kappa, spin_ratio=sense * spin / at_upright)
    assert turn == pytest.approx(float(known), abs=2e-5)


def test_a_solid_cylinder_without_spin_turns_as_known():
    assert math.degrees(sb.theory.angle_of_turn(0.1, inertia_ratio=SLIM.inertia_ratio)) == pytest.approx(
        180.6724805, abs=1e-7
    )


def back_at(model, start, push=(0.0, 0.0, 0.0)):
    """When and in which state a motion that passes the upright is back at the tilt at which it starts."""
    far = math.hypot(*start[:2])

    def back(_, y):
        return math.hypot(y[0], y[1]) - far

    back.terminal, back.direction = True, 1.0
    run = solve_ivp(
        lambda tau, y: model.rates(*y, *push, *model.parameters), (0.0, 1.0), start, "DOP853", rtol=1e-13, atol=1e-20,
        events=back,
    )  # fmt: skip
    return run.t[-1], run.y[:, -1]


@pytest.mark.parametrize("spin", [0.0, 0.3, -0.3, 2.0, -2.0])
@pytest.mark.parametrize("offset", [1e-4, -1e-4, 1e-2, -1e-2])
def test_a_passage_in_closed_form_is_the_orbit_integrated(spin, offset):
    # What is left out: gravity, which changes the speed by the part c far/V² = 8e-6, and the spin's gyroscopic pull on
    # a lean of finite size.
    model, far, speed = sb.Rolling(STOUT), 1e-7, 0.05
    start = (-far, offset * far, speed, 0.0, spin)
    elapsed, end = model.passage(*start, 0.0, 0.0, 0.0, *model.parameters)
    time, exact = back_at(model, start)
    np.testing.assert_allclose(end[:2], exact[:2], atol=5e-5 * far)
    np.testing.assert_allclose(end[2:4], exact[2:4], atol=5e-5 * speed)
    assert end[4] == pytest.approx(exact[4], abs=1e-6)
    # The orbit differs from the straight path within its closest approach, up to 12 offsets with this spin.
    assert elapsed == pytest.approx(time, rel=60.0 * abs(offset) + 1e-4)


def test_base_and_friction_act_during_a_passage():
    model, push = sb.Rolling(STOUT, damping=0.5, spin_damping=0.7), (0.4, 0.6, 0.1)
    quiet, far, speed = sb.Rolling(STOUT), 5e-8, 0.05
    start = (-far, 1e-10, speed, 0.0, 0.0)  # how far spin bends the path would change with the speed
    _, pushed = model.passage(*start, *push, *model.parameters)
    _, plain = quiet.passage(*start, 0.0, 0.0, 0.0, *quiet.parameters)
    elapsed = 2.0 * far / speed
    change = integrated(model, start, elapsed, push, atol=1e-20) - integrated(quiet, start, elapsed, atol=1e-20)
    # To the offset over the distance.
    np.testing.assert_allclose(np.subtract(pushed, plain)[2:4], change[2:4], atol=1e-2 * np.abs(change[2:4]).max())


def test_a_hop_keeps_the_energy():
    model = sb.Rolling(STOUT)
    start = (-1e-8, 1e-12, 0.05, 0.0, -0.4)
    _, end = model.passage(*start, 0.0, 0.0, 0.0, *model.parameters)
    # Rim and spin give the part −cκ w3 θβ̇, of the order of the offset over the distance.
    assert energy(model, end) == pytest.approx(energy(model, start), rel=1e-3)
    assert math.hypot(*end[:2]) == pytest.approx(math.hypot(*start[:2]), rel=1e-6)


@given(
    tilt=st.floats(1e-3, 1.4), rate=st.floats(-0.5, 0.5), a=st.floats(-0.5, 0.5), az=st.floats(-0.5, 0.5),
    side=st.sampled_from([1.0, -1.0]),
)  # fmt: skip
def test_planar_rates_are_those_in_space_along_any_line(tilt, rate, a, az, side):
    model = sb.Rolling(STOUT, **FRICTIONS)
    line = np.array([math.cos(1.1), math.sin(1.1)])
    found = model.rates(*(side * tilt * line), *(rate * line), 0.0, *(a * line), az, *model.parameters)
    planar = model.planar_rates(side * tilt, rate, side, a, az, *model.parameters)
    assert np.array(found[2:4]) == pytest.approx(planar[1] * line, rel=1e-12, abs=1e-13)
    assert found[4] == pytest.approx(0.0, abs=1e-12)


def test_the_motion_does_not_depend_on_units():
    # A column of another size, mass and gravity with the same ratios; times go with 1/ω0.
    big = sb.Column(
        mass=700.0, radius=0.5, mass_height=2.5, transverse_inertia=700.0 * 6.25 * 1.03 / 3.0,
        axial_inertia=700.0 * 6.25 * 0.02, gravity=3.7,
    )  # fmt: skip
    ends = []
    for column in (STOUT, big):
        motion = sb.Harmonic.circular(acceleration=0.1 * column.gravity, angular_frequency=2.0 * column.frequency_scale)
        scale = column.frequency_scale
        run = sb.simulate(
            sb.Rolling(column, **FRICTIONS), motion, tilt=(0.05, 0.01), tilt_rate=(0.0, 0.05 * scale), spin=0.2 * scale,
            duration=6.0 / scale, rtol=1e-11, samples=3,
        ).data.isel(time=-1)  # fmt: skip
        ends.append((*run["tilt"].values, float(run["spin"]) / scale, *(run["footprint"].values / column.radius)))
    np.testing.assert_allclose(ends[1], ends[0], rtol=1e-8)


def test_overturning_is_told_at_a_right_angle():
    run = sb.simulate(sb.Rolling(STOUT), tilt=(0.25, 0.0), tilt_rate=(0.0, 0.1), spin=0.1, duration=60.0)
    assert run.outcome is sb.Outcome.OVERTURNED
    assert run.measures["peak_tilt"] == pytest.approx(math.pi / 2.0, rel=1e-9)
    assert run.thresholds["no_return_tilt"] == math.inf


def test_a_spinning_column_stays_up_beyond_its_tipping_angle():
    # Steady rolling above the tipping angle needs spin; theory tells which.
    tilt, rate = 0.4, 6.0
    spin = float(sb.theory.free_rolling_spin(
        tilt, rate, c=STOUT.slenderness, inertia_ratio=STOUT.inertia_ratio, axial_ratio=STOUT.axial_ratio
    ))  # fmt: skip
    scale = STOUT.frequency_scale
    run = sb.simulate(
        sb.Rolling(STOUT), tilt=(tilt, 0.0), tilt_rate=(0.0, tilt * rate * scale), spin=spin * scale, duration=20.0,
        rtol=1e-12,
    )  # fmt: skip
    assert tilt > STOUT.tipping_angle
    assert run.outcome is sb.Outcome.STILL_MOVING
    np.testing.assert_allclose(run.data["amplitude"], tilt, rtol=1e-8)
    np.testing.assert_allclose(run.data["rolling_rate"], rate * scale, rtol=1e-8)


def test_it_can_be_described_and_saved_with_its_spin_and_place(tmp_path):
    model = sb.Rolling(STOUT, **FRICTIONS, restitution=0.9, passage_tilt=0.01)
    run = sb.simulate(
        model, SHAKING.scaled(0.05), tilt=(0.05, 0.0), spin=0.3, twist=0.2, position=(0.1, 0.2), duration=2.0,
        friction_coefficient=0.01,
    )  # fmt: skip
    loaded = sb.load(run.save(tmp_path / "run.nc"))
    assert loaded.provenance["model"]["kind"] == "rolling"
    assert loaded.warnings == run.warnings != ()
    setup = sb.config.config_of(loaded.provenance).build()
    again = sb.simulate(setup.model, setup.motion, **setup.options)
    assert setup.model == model
    for name in ("tilt", "spin", "twist", "footprint"):
        np.testing.assert_array_equal(again.data[name], run.data[name])


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"damping": math.nan}, "damping must be zero or positive, got nan"),
        ({"spin_damping": -1.0}, "spin_damping must be zero or positive, got -1.0"),
        ({"rolling_resistance": -0.1}, "rolling_resistance must be zero or positive, got -0.1"),
        ({"restitution": 1.1}, "restitution must lie between 0 and 1, 1 for no loss, got 1.1"),
        ({"restitution": -0.1}, "restitution must lie between 0 and 1, 1 for no loss, got -0.1"),
        ({"passage_tilt": -0.1}, "passage_tilt must lie between 0 and π/2, got -0.1"),
        ({"column": 3.0}, "column must be a Column"),
    ],
)
def test_bad_numbers_are_refused_in_one_line(change, told):
    with pytest.raises(ParameterError) as refusal:
        sb.Rolling(**({"column": STOUT} | change))
    assert str(refusal.value).startswith(told)
    assert "\n" not in str(refusal.value)
