"""Random starts of a column that can slip, as the package and as `SlidingBody` take them; for tests."""

import math
from dataclasses import dataclass

import numpy as np

import stylobate as sb

from .constrained_body import ATTITUDE, PLACE, TURNING, _rotation
from .sliding_body import SlidingBody

# No base strikes the plane from above this tilt, so that passages of the upright are followed.
_NO_STROKE = 1e-9


@dataclass(frozen=True)
class Start:
    """A model on a moving base with a start, and the same as a body with its state."""

    model: sb.Sliding
    motion: sb.BaseMotion
    given: dict
    body: SlidingBody
    state: np.ndarray

    def push(self, time):
        """Return the acceleration of the base [m/s²], (3,)."""
        return self.motion.acceleration(time)


def random_start(seed, *, patch=0.0, airborne=False, restitution=0.0, static=1.0, friction=None):
    """Return a `Start` on a base that shakes in all directions; `static` is μs over μk, `friction` μk if not random."""
    rng = np.random.default_rng(seed)
    c, kappa, axial, mu = rng.uniform([0.1, 0.6, 0.4, 0.05], [0.4, 0.8, 0.8, 0.35])
    mu = mu if friction is None else friction
    length, gravity = rng.uniform([0.2, 1.0], [2.0, 10.0])
    inertia = length**2 / kappa
    column = sb.Column(
        mass=2.0, mass_height=length, radius=c * length, transverse_inertia=2.0 * (inertia - length**2),
        axial_inertia=2.0 * axial * (c * length) ** 2, gravity=gravity,
    )  # fmt: skip
    model = sb.Sliding(
        column, friction_coefficient=mu, static_friction_coefficient=static * mu, patch=patch,
        normal_restitution=restitution, passage_tilt=_NO_STROKE,
    )  # fmt: skip
    body = SlidingBody(
        column, kinetic=mu, static=static * mu, restitution=restitution, impact="dissipative",
        patch=patch * column.radius,
    )  # fmt: skip
    rate, speed = 1.0 / model.time_scale, length / model.time_scale
    ax, ay, az = gravity * rng.uniform(0.0, 0.2, 3)
    frequency, phase = rate * rng.uniform(1.0, 4.0), rng.uniform(0.0, 6.0)
    motion = sb.Harmonic.elliptic(amplitude=(ax, ay), phase=phase, angular_frequency=frequency)
    motion += sb.Harmonic.vertical(acceleration=az, angular_frequency=1.3 * frequency)
    theta, beta = rng.uniform(0.2, 0.9) * c, rng.uniform(-math.pi, math.pi)
    w1, w2, w3 = rate * rng.normal(scale=0.15, size=3)
    slip = speed * rng.normal(scale=0.05, size=2) * rng.integers(0, 2)
    gap, rise = (length * rng.uniform(1e-3, 0.02), speed * rng.uniform(-0.1, 0.1)) if airborne else (0.0, 0.0)
    d, n = np.array([math.cos(beta), math.sin(beta)]), np.array([-math.sin(beta), math.cos(beta)])
    given = {
        "tilt": tuple(theta * d),
        "tilt_rate": tuple(w2 * d - theta / math.sin(theta) * w1 * n),
        "spin": w3,
        "velocity": (*slip, rise),
        "clearance": gap,
    }
    state = body.state(theta=theta, beta=beta, w1=w1, w2=w2, w3=w3, slip=slip, rise=rise, gap=gap)
    return Start(model, motion, given, body, state)


def place_and_motion(body, state):
    """Return what a run tells of a state (G, q, v, ω), in its units but for lengths over h and rates over ω0.

    θ(cos β, sin β) and its rate, w3, cos χ, sin χ, the centre of the footprint, the height of the lowest point.
    """
    column = body.column
    turn, spin, length, rate = _rotation(state[ATTITUDE]), state[TURNING], column.mass_height, column.frequency_scale
    e3 = turn[:, 2]
    lean = math.hypot(e3[0], e3[1])
    theta, d = math.atan2(lean, e3[2]), e3[:2] / lean
    e3_rate = np.cross(spin, e3)
    fall, n = -e3_rate[2] / lean, np.array([-d[1], d[0]])
    tilt_rate = fall * d + theta / lean * (e3_rate[:2] @ n) * n
    twist = math.atan2(turn[2, 1], -turn[2, 0]) + math.atan2(d[1], d[0])
    centre = (state[PLACE] + body.arm(state))[:2] - column.radius * d
    return np.array(
        [*theta * d, *tilt_rate / rate, spin @ e3 / rate, math.cos(twist), math.sin(twist), *centre / length,
         body.gap(state) / length]
    )  # fmt: skip


def place_and_motion_told(run, time, column):
    """Return the same of a run of the package at a time."""
    data, length, rate = run.sample([time]), column.mass_height, column.frequency_scale
    twist = float(data["twist"][0])
    return np.array(
        [*data["tilt"].to_numpy()[0], *data["tilt_rate"].to_numpy()[0] / rate, float(data["spin"][0]) / rate,
         math.cos(twist), math.sin(twist), *data["footprint"].to_numpy()[0] / length,
         float(data["clearance"][0]) / length]
    )  # fmt: skip
