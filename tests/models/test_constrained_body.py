"""The body held by constraint forces: numbers known from elsewhere, its laws, and motions in closed form."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import stylobate as sb

from .constrained_body import UP, ConstrainedBody

pytestmark = pytest.mark.long

HOLDS = ("free", "wobbling", "rubber")
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
D1, D0, ARM, RATE = 0.02, 0.005, 0.003, 0.05
FRICTIONS = {
    "viscous": {"viscous": D1},
    "spin": {"spin_damping": D0},
    "rolling": {"rolling_arm": ARM, "rolling_rate": RATE},
}

speeds = st.floats(-2.0, 2.0)
tilts, azimuths = st.floats(1e-3, 1.4), st.floats(-math.pi, math.pi)


def shaking(time):
    return 1.2 * math.sin(9.0 * time), 0.8 * math.sin(9.0 * time + 0.7), 0.5 * math.cos(14.0 * time)


def turned(known, *, within):
    """What e^{i angle} is compared with, for an angle known up to whole turns."""
    return pytest.approx(np.exp(1j * known), abs=within)


def assert_state(track, index, known, *, within):
    """Compare with (θ, β, χ, w1, w2, w3, C_x, C_y)."""
    theta, beta, twist, *others = known
    found = [track.w1[index], track.w2[index], track.w3[index], *track.contact[index]]
    assert track.theta[index] == pytest.approx(theta, abs=within)
    assert np.exp(1j * track.beta[index]) == turned(beta, within=within)
    assert np.exp(1j * track.twist[index]) == turned(twist, within=within)
    assert found == pytest.approx(others, abs=within)


# Known trajectories were integrated elsewhere by two formulations, and rounded to the digits given.


def test_known_free_rolling():
    body = ConstrainedBody(column=STOUT)
    start = body.state(theta=0.15, beta=0.3, twist=0.4, w1=-0.037359533118399804, w3=0.1)
    times = np.linspace(0.05, 9.95, 199)
    track = body.follow(start, duration=10.0, times=times)
    known = (
        0.1444760235755, 2.546728174708, 1.416279304653, -0.03878190713697, 0.01854676917173, 0.09987449084528,
        -0.182066795485, 0.10196700064,
    )  # fmt: skip
    assert_state(track, -1, known, within=2e-12)
    np.testing.assert_allclose(track.energy, 1.019148982252, rtol=0.0, atol=2e-12)
    # The minimum tilt was looked for on another grid than here: both are within ½θ̈(Δt/2)², θ̈ < 0.41, of it.
    assert track.theta.min() == pytest.approx(0.0376824, abs=1.3e-4)


def test_known_shaken_rolling():
    body = ConstrainedBody(column=SHAKEN)
    start = body.state(theta=0.05, beta=0.3, w1=-0.03, w2=0.1, w3=0.1)
    track = body.follow(start, duration=2.0, acceleration=shaking, times=[0.25, 0.5, 1.0, 1.5])
    after_1_s = (
        0.1403872286385, -2.859976583901, 0.7629439534528, -0.02570888215081, 0.224076497214, 0.6315812016326,
        -0.08892959708129, 0.02054186680568,
    )  # fmt: skip
    after_2_s = (
        0.4298026709139, -2.976016677188, 1.615407759584, 0.07071653762442, 0.8936836814047, 1.135982112509,
        -0.1039183261956, 0.09155036913029,
    )  # fmt: skip
    forces = [
        (19.21209507971, -2.857401138306, 0.2111937603364),
        (20.26847859455, 0.2096861917858, 0.07877643500527),
        (19.7101176191, -0.3280343398187, 0.1173276256425),
        (19.02866039878, -0.2377028680704, -0.2159298012034),
        (17.15884530182, 4.056503349325, -0.006338322028297),
    ]
    ratios = (0.1491349736486, 0.01105142608886, 0.01767545388293, 0.01687643777582, 0.2364091656408)
    assert_state(track, 3, after_1_s, within=2e-12)
    assert_state(track, -1, after_2_s, within=2e-12)
    found = np.stack([track.normal, track.friction_d, track.friction_n], axis=1)
    np.testing.assert_allclose(found[1:], forces, rtol=0.0, atol=2e-11)
    np.testing.assert_allclose(track.demand[1:], ratios, rtol=0.0, atol=1e-12)
    assert track.peak_demand == track.demand[-1]


@pytest.mark.parametrize(
    ("hold", "state", "force", "couple"),
    [
        (
            "wobbling",
            (0.1907781084558, 2.987210531662, 0.0, -0.106419435802, 0.3882938296209, -0.01018215078905,
             -0.07410800476861, 0.01153271994004),
            (19.5430592268, 0.3526778705038, 0.07031092045046),
            -0.00516216837485,
        ),
        (
            "rubber",
            (0.1906724596719, 2.989374053816, 0.004304983312038, -0.1050532673092, 0.3882105363717, -0.02027709378279,
             -0.07417105672395, 0.0116402198736),
            (19.54339851899, 0.3510993896538, 0.06939396791184),
            -0.005076369471362,
        ),
    ],
)  # fmt: skip
def test_known_shaken_motion_without_twist(hold, state, force, couple):
    body = ConstrainedBody(column=SHAKEN, hold=hold)
    track = body.follow(body.state(theta=0.05, beta=0.3, w1=-0.03, w2=0.1), duration=1.0, acceleration=shaking)
    assert_state(track, -1, state, within=2e-12)
    assert (track.normal[-1], track.friction_d[-1], track.friction_n[-1]) == pytest.approx(force, abs=2e-11)
    assert track.couple[-1, 2] == pytest.approx(couple, abs=1e-13)


@pytest.mark.parametrize(
    ("turning", "apex", "turn", "least", "ratio"),
    [
        (1e-2, 3.058216320024, 183.474357, 3.35786761e-4, 0.0746429281),
        (1e-3, 3.057802529426, 181.070093, 3.34431473e-5, 0.0748460288),
        (1e-4, 3.057797019334, 180.723985, 3.34295972e-6, 0.0748589874),
    ],
)
def test_known_turns_between_apexes_of_free_rolling(turning, apex, turn, least, ratio):
    # Released at θ = c/2 with β̇ = `turning`. Time can be reversed, so the middle is the closest passage.
    body = ConstrainedBody(column=SLIM)
    start = body.state(theta=0.05, w1=-turning * math.sin(0.05))
    track = body.follow(start, duration=apex, times=[apex / 2.0])
    assert track.w2[1:] == pytest.approx((0.0, 0.0), abs=1e-9)
    assert track.theta[1:] == pytest.approx((least, 0.05), rel=5e-9)
    assert math.degrees(track.beta[-1]) == pytest.approx(turn, abs=1e-6)
    assert track.demand[1] == pytest.approx(ratio, abs=1e-10)
    assert track.w3[-1] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("hold", HOLDS)
def test_what_the_ground_holds_stays_held(hold):
    # Forces are found from accelerations; that their integrals keep to the constraints is not put in.
    body = ConstrainedBody(column=SHAKEN, hold=hold)
    start = body.state(theta=0.1, beta=2.0, w1=-0.1, w2=-0.2, contact=(0.3, -0.1))
    track = body.follow(start, duration=1.5, acceleration=shaking, times=np.linspace(0.01, 1.49, 149))
    np.testing.assert_allclose(track.gap, 0.0, atol=1e-12)
    np.testing.assert_allclose(track.slip, 0.0, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(track.state[:, 3:7], axis=1), 1.0, rtol=1e-13)
    # C is on the circle about B0, and what B0 does is the twist: Ḃ0 = −r χ̇ n, none if that is held.
    np.testing.assert_allclose(np.linalg.norm(track.contact - track.base_centre, axis=1), SHAKEN.radius, rtol=1e-13)
    if hold == "wobbling":
        np.testing.assert_allclose(track.base_centre, track.base_centre[[0]].repeat(151, axis=0), atol=1e-12)
        np.testing.assert_allclose(track.twist, 0.0, atol=1e-12)
        np.testing.assert_allclose(track.w3, np.tan(track.theta / 2.0) * track.w1, atol=1e-12)
    if hold == "rubber":
        np.testing.assert_allclose(track.w3, np.tan(track.theta) * track.w1, atol=1e-12)


@pytest.mark.parametrize("hold", HOLDS)
def test_free_motion_conserves_energy(hold):
    body = ConstrainedBody(column=STOUT, hold=hold)
    spin = {"w3": 0.2} if hold == "free" else {}
    track = body.follow(body.state(theta=0.1, w1=-0.05, w2=0.03, **spin), duration=20.0, times=np.arange(1.0, 20.0))
    np.testing.assert_allclose(track.energy, track.energy[0], rtol=1e-12)


@pytest.mark.parametrize("hold", HOLDS)
@given(theta=tilts, beta=azimuths, w1=speeds, w2=speeds, w3=speeds, ax=speeds, ay=speeds, az=speeds)
@settings(max_examples=50)
def test_energy_changes_by_the_work_of_the_base_and_of_each_friction(hold, theta, beta, w1, w2, w3, ax, ay, az):
    free = ConstrainedBody(column=SHAKEN, hold=hold)
    state = free.state(theta=theta, beta=beta, w1=w1, w2=w2, w3=w3 if hold == "free" else None)
    at, spin, push = free.contact(state), state[10:], np.array([ax, ay, az])
    rounding = 1e-12 * (1.0 + np.abs(spin).max() ** 3 / math.sin(theta))  # β̇ = −w1/sin θ enters the forces
    work = -SHAKEN.mass * push @ state[7:10]
    assert free.power(state, push) == pytest.approx(work, abs=rounding)
    tilting = np.hypot(spin @ at.u, spin @ at.n)
    level = np.hypot(*spin[:2])
    for name, lost in {
        "viscous": lambda _: D1 * tilting**2,
        "spin": lambda _: D0 * spin[2] ** 2,
        "rolling": lambda normal: ARM * normal * level**2 / math.sqrt(level**2 + RATE**2),
    }.items():
        body = replace(free, **FRICTIONS[name])
        normal = body.motion(state, push).force[2]
        assert body.power(state, push) == pytest.approx(work - lost(normal), abs=rounding)


@pytest.mark.parametrize("hold", HOLDS)
@pytest.mark.parametrize("friction", FRICTIONS)
def test_friction_takes_energy_all_the_time(friction, hold):
    body = ConstrainedBody(column=SHAKEN, hold=hold, **FRICTIONS[friction])
    spin = {"w3": 0.5} if hold == "free" else {}
    start = body.state(theta=0.1, w1=-0.05, w2=0.1, **spin)
    track = body.follow(start, duration=0.6, times=np.linspace(0.01, 0.59, 59))
    assert track.normal.min() > 0.0
    change = np.diff(track.energy)
    if (friction, hold) == ("spin", "rubber"):
        np.testing.assert_allclose(change, 0.0, atol=1e-13)  # what is held still rubs nothing
    else:
        assert change.max() < 0.0


def test_much_spin_damping_is_rubber():
    # ω·Z follows −(couple that rubber needs)/D0, so deviations go with 1/D0.
    start = {"theta": 0.1, "beta": 0.3, "w1": -0.1, "w2": 0.1, "w3": -0.1 * math.tan(0.1)}

    def end(**friction):
        body = ConstrainedBody(column=SHAKEN, **friction)
        track = body.follow(body.state(**start), duration=0.4, acceleration=shaking, rtol=1e-10)
        return np.append(track.tilt[-1], track.twist[-1])

    off = [np.abs(end(spin_damping=friction) - end(hold="rubber")).max() for friction in (2.0, 4.0)]
    assert off[1] < 1e-3
    assert off[0] / off[1] == pytest.approx(2.0, rel=0.05)


@given(theta=tilts, w1=speeds, w2=speeds, w3=speeds, az=speeds)
def test_vertical_acceleration_is_a_change_of_gravity(theta, w1, w2, w3, az):
    shaken = ConstrainedBody(column=SHAKEN)
    heavy = ConstrainedBody(column=replace(SHAKEN, gravity=SHAKEN.gravity + az))
    state = shaken.state(theta=theta, w1=w1, w2=w2, w3=w3)
    found, expected = shaken.motion(state, az * UP), heavy.motion(state)
    scale = 1.0 + np.abs(expected.rates).max()
    np.testing.assert_allclose(found.rates, expected.rates, atol=1e-12 * scale)
    np.testing.assert_allclose(found.force, expected.force, atol=1e-12 * scale)


@pytest.mark.slow
@pytest.mark.parametrize(("theta", "rate"), [(0.1, 1.5), (0.3, -6.0), (1.2, 10.0)])
def test_steady_rolling_is_steady(theta, rate):
    m, r, h, g = SHAKEN.mass, SHAKEN.radius, SHAKEN.mass_height, SHAKEN.gravity
    sine, cosine = math.sin(theta), math.cos(theta)
    w1 = -rate * sine
    # The centre of mass, (x, z) from C, runs with r w3 + h w1 along −n, which T_d = m rate (r w3 + h w1) bends into a
    # circle; the angular momentum I_t w1 u + I_a w3 e3 turns too, by the couple m g x − T_d z along n. Hence w3.
    x, z = h * sine - r * cosine, h * cosine + r * sine
    transverse, axial = SHAKEN.transverse_inertia, SHAKEN.axial_inertia
    w3 = (m * g * x - rate * w1 * (transverse * cosine + m * h * z)) / (rate * (axial * sine + m * r * z))
    body = ConstrainedBody(column=SHAKEN)
    track = body.follow(body.state(theta=theta, w1=w1, w3=w3), duration=1.0)
    np.testing.assert_allclose(track.theta, theta, rtol=1e-10)
    assert track.beta[-1] == pytest.approx(rate, rel=1e-10)
    assert track.twist[-1] == pytest.approx(w3 - w1 * math.tan(theta / 2.0), rel=1e-10)
    assert track.normal[-1] == pytest.approx(m * g, rel=1e-10)
    assert track.friction_n[-1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("spin", [0.0, 0.5, -0.5])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_close_passage_turns_by_what_inertia_and_spin_say(spin, sense):
    # Close to the upright K θ̈ = J0 ℓ²/θ³ − m h r w3 ℓ/θ² with θ²β̇ = ℓ, an orbit in closed form. From `far` and back
    # there it lacks, of the turn of the whole orbit, an angle of the order of ℓ/(V far).
    far, speed = 1e-3, 0.05
    moment = sense * 1e-6 * speed
    lacking = 2.0 * abs(moment) / (speed * far)
    body = ConstrainedBody(column=SLIM)
    start = body.state(theta=far, w1=-moment * math.sin(far) / far**2, w2=-speed, w3=spin)
    rim, base = SLIM.rim_inertia, SLIM.base_inertia
    weight = SLIM.mass * SLIM.gravity * SLIM.radius / rim  # draws it to the upright meanwhile
    at_upright = math.sqrt(speed**2 + 2.0 * weight * far)
    track = body.follow(start, duration=4.0 * far / (speed + at_upright), rtol=1e-12)
    bend = SLIM.mass * SLIM.mass_height * SLIM.radius * spin / (math.sqrt(rim * base) * at_upright)
    turn = (math.pi + 2.0 * sense * math.atan(bend)) * math.sqrt(rim / base)
    assert spin == 0.0 or abs(bend) > 0.5
    assert sense * track.beta[-1] == pytest.approx(turn, abs=lacking)


@given(theta=tilts, beta=azimuths, twist=azimuths, w1=speeds, w2=speeds, w3=speeds)
def test_a_start_is_what_it_was_said_to_be(theta, beta, twist, w1, w2, w3):
    body = ConstrainedBody(column=SHAKEN)
    track = body.follow(body.state(theta=theta, beta=beta, twist=twist, w1=w1, w2=w2, w3=w3), duration=1e-9)
    radius = SHAKEN.radius
    known = (theta, beta, twist, w1, w2, w3, radius * math.cos(beta), radius * math.sin(beta))
    assert_state(track, 0, known, within=1e-12)
    heading = np.array([math.cos(beta), math.sin(beta)])
    across = np.array([-heading[1], heading[0]])
    np.testing.assert_allclose(track.tilt[0], theta * heading, atol=1e-15)
    rate = w2 * heading - w1 * theta / math.sin(theta) * across
    np.testing.assert_allclose(track.tilt_rate[0], rate, atol=1e-12)
