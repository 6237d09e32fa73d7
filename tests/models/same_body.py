"""A model and the body held by constraint forces that is the same column: its states, frictions, rates and loads."""

import math

import numpy as np

import stylobate as sb
from stylobate.models.finite_tilt import FADING

from .constrained_body import ANGULAR, TURNING, UP, ConstrainedBody

# Random states of a column that rolls: θ, β [rad], w1, w2, w3 [ω0], accelerations of the base [g].
LOW = np.array([1e-3, -math.pi, -1.0, -1.0, -1.0, -0.5, -0.5, -0.5])
HIGH = np.array([1.4, math.pi, 1.0, 1.0, 1.0, 0.5, 0.5, 0.5])


def random_cases(count, seed):
    """Rows θ, β, w1, w2, w3, ax, ay, az."""
    return np.random.default_rng(seed).uniform(LOW, HIGH, (count, LOW.size))


def body_of(model):
    """The body of the oracle with the frictions of `model`."""
    column = model.column
    unit = column.frequency_scale * column.base_inertia
    axial = column.axial_inertia
    freedom = 1.0 + column.axial_ratio - column.inertia_ratio
    zeta = getattr(model, "spin_damping", 0.0)
    constraint = getattr(model, "constraint", None)
    return ConstrainedBody(
        column=column,
        hold={"pure_tilt": "wobbling", "rubber": "rubber", None: "free"}[constraint],
        viscous=model.damping * unit,
        spin_damping=zeta * column.frequency_scale * axial * freedom / column.axial_ratio,
        rolling_arm=model.rolling_resistance * column.radius,
        rolling_rate=FADING * column.frequency_scale,
    )


def state_of(model, theta, beta, w1, w2, w3):
    """The state of `model`; angular velocities in ω0."""
    around = -w1 / math.sin(theta)
    d, n = np.array([math.cos(beta), math.sin(beta)]), np.array([-math.sin(beta), math.cos(beta)])
    state = (*(theta * d), *(w2 * d + theta * around * n))
    return state if model.spin_state is None else (*state, w3)


def rates_of_body(model, theta, beta, w1, w2, w3, push):
    """Rates of tilt rate and spin, and N, |T|, |M_z|, as the oracle finds them, in the units of the model."""
    column, scale = model.column, model.column.frequency_scale
    body = body_of(model)
    spin = None if model.spin_state is None else w3 * scale
    state = body.state(theta=theta, beta=beta, w1=w1 * scale, w2=w2 * scale, w3=spin)
    motion, at = body.motion(state, np.asarray(push) * column.gravity), body.contact(state)
    # ë3 = ω̇ × e3 + ω × ė3, of which the azimuth and the tilt are read.
    turned = np.cross(motion.rates[7:][ANGULAR], at.e3) + np.cross(state[TURNING], at.e3_rate)
    sine, cosine, falling = math.sin(theta), math.cos(theta), w2 * scale
    around = -w1 * scale / sine
    tilting = at.u @ turned + sine * cosine * around**2
    swinging = (at.n @ turned - 2.0 * cosine * falling * around) / sine
    second = (tilting - theta * around**2) * at.d + (theta * swinging + 2.0 * falling * around) * at.n
    rates = [*second[:2], motion.rates[7:][ANGULAR] @ at.e3] if model.spin_state is not None else second[:2]
    weight = column.mass * column.gravity
    moment = motion.couple[2] - body.spin_damping * state[TURNING] @ UP
    loads = motion.force[2], np.hypot(*motion.force[:2]), abs(moment) / column.radius
    return np.array(rates) / scale**2, np.array(loads) / weight


def assert_same_rates_and_loads(model, cases):
    """Compare rates and what the contact bears at these `random_cases`; to 1e-9 of their size."""
    for theta, beta, w1, w2, w3, *push in cases:
        state = state_of(model, theta, beta, w1, w2, w3)
        found = np.array(model.rates(*state, *push, *model.parameters)[2:])
        loads = np.array(model.contact(*state, *push, *model.parameters))
        rates, borne = rates_of_body(model, theta, beta, w1, w2, w3, push)
        np.testing.assert_allclose(found, rates, rtol=0.0, atol=1e-9 * (1.0 + np.abs(rates).max()))
        np.testing.assert_allclose(loads, borne, rtol=0.0, atol=1e-9 * (1.0 + np.abs(borne).max()))


def shaken_in_space(column, size=1.0):
    """A base motion in all three directions and its acceleration [m/s²] written out, of `size` times 0.1 g."""
    level, up, rate = 0.1 * size * column.gravity, 0.05 * size * column.gravity, 2.3 * column.frequency_scale
    motion = sb.Harmonic.elliptic(
        amplitude=(level, 0.7 * level), phase=0.7, angular_frequency=rate
    ) + sb.Harmonic.vertical(acceleration=up, angular_frequency=1.5 * rate)

    def acceleration(t):
        return level * math.cos(rate * t), 0.7 * level * math.cos(rate * t + 0.7), up * math.cos(1.5 * rate * t)

    return motion, acceleration


def assert_same_run(model, start, duration, *, size=1.0, twist=0.0, position=(0.0, 0.0)):
    """Compare a run by `simulate` with the oracle's, all that both tell; return both.

    `start` is θ, β, w1, w2, w3 [rad, ω0]; the time is in 1/ω0.
    """
    column, scale = model.column, model.column.frequency_scale
    motion, acceleration = shaken_in_space(column, size)
    body, duration = body_of(model), duration / scale
    theta, beta, w1, w2, w3 = start
    begun = state_of(model, *start)
    spin = {} if model.spin_state is None else {"spin": w3 * scale}
    run = sb.simulate(
        model, motion, tilt=begun[:2], tilt_rate=np.array(begun[2:4]) * scale, **spin, twist=twist, position=position,
        duration=duration, rtol=1e-12, atol=1e-16, samples=21,
    )  # fmt: skip
    touching = np.array(position) + column.radius * np.array([math.cos(beta), math.sin(beta)])
    axial = spin.get("spin")
    first = body.state(
        theta=theta, beta=beta, twist=twist, w1=w1 * scale, w2=w2 * scale, w3=axial, contact=touching
    )  # fmt: skip
    times = run.data["time"].to_numpy()
    track = body.follow(first, duration=duration, acceleration=acceleration, times=times[1:-1])
    data = run.data
    length, loads = column.radius, column.mass * column.gravity
    close = {"rtol": 0.0, "atol": 1e-9}
    np.testing.assert_allclose(data["tilt"], track.tilt, **close)
    np.testing.assert_allclose(data["tilt_rate"] / scale, track.tilt_rate / scale, **close)
    np.testing.assert_allclose(data["azimuth"], track.beta, **close)
    np.testing.assert_allclose(data["twist"], track.twist, **close)
    np.testing.assert_allclose(data["footprint"] / length, track.base_centre / length, **close)
    np.testing.assert_allclose(data["contact_point"] / length, track.contact / length, **close)
    np.testing.assert_allclose(data["normal_force"] / loads, track.normal / loads, **close)
    np.testing.assert_allclose(data["friction_demand"], track.demand, **close)
    upright = loads * column.mass_height
    np.testing.assert_allclose(data["energy"] / upright, track.energy / upright - 1.0, **close)
    if spin:
        np.testing.assert_allclose(data["spin"] / scale, track.w3 / scale, **close)
    else:
        moment = np.abs(track.couple[:, 2]) / (track.normal * length)
        np.testing.assert_allclose(data["pivoting_demand"], moment, **close)
    return run, track
