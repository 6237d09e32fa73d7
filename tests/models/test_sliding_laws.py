"""What every motion of the column that can slip obeys: Coulomb's law, a plane that only presses, energy that falls."""

import math
from itertools import pairwise

import numpy as np
import pytest
from tests.reference.forcing import Forcing
from tests.reference.resting import departure_lapse

import stylobate as sb
from stylobate.models.sliding import Contact

RTOL = 1e-9
LASTS = 4.0


def random_run(seed, *, shaken, patch=0.0, damping=0.0):
    """A run of a random column from a random start: on its rim, its base, or in the air."""
    rng = np.random.default_rng(seed)
    c, kappa, axial = rng.uniform([0.05, 0.6, 0.3], [0.4, 0.8, 0.6])
    mu = rng.uniform(0.03, 0.6)
    model = sb.Sliding(
        sb.Column.dimensionless(slenderness=c, inertia_ratio=kappa, axial_ratio=axial),
        friction_coefficient=mu, static_friction_coefficient=mu * rng.choice([1.0, 1.4]), patch=patch,
        normal_restitution=rng.choice([0.0, 0.5]), damping=damping, rolling_resistance=rng.choice([0.0, 0.02]),
    )  # fmt: skip
    beta, tilt = rng.uniform(0.0, 6.0), c * rng.uniform(0.1, 0.8)
    given = {
        "tilt": (tilt * math.cos(beta), tilt * math.sin(beta)),
        "tilt_rate": tuple(c * rng.normal(scale=0.3, size=2)),
        "spin": rng.normal(scale=0.3),
        "velocity": (*rng.normal(scale=0.1, size=2), 0.0),
        "clearance": rng.choice([0.0, 0.01]),
    }
    motion = None
    if shaken:
        amplitude, frequency = rng.uniform(0.1, 1.5) * c, rng.uniform(1.0, 4.0)
        motion = sb.Harmonic.circular(acceleration=amplitude, angular_frequency=frequency)
        motion += sb.Harmonic.vertical(acceleration=rng.uniform(0.0, 1.2), angular_frequency=frequency)
    run = sb.simulate(model, motion, **given, duration=LASTS, rtol=RTOL, samples=1000)
    return model, Forcing.of(model, motion or sb.Harmonic.straight(acceleration=0.0, angular_frequency=1e-6)), run


def settled(run, lapse):
    """Which samples lie in no lapse after an event, within which the new kind of contact begins."""
    time = run.data["time"].to_numpy()
    kept = np.ones(time.size, dtype=bool)
    for event in run.events:
        kept &= (time < event.time - 1e-9) | (time > event.time + 2.0 * lapse)
    kept[time < 2.0 * lapse] = False
    return kept


@pytest.mark.slow
@pytest.mark.parametrize("patch", [0.0, 0.2], ids=["point", "patch"])
@pytest.mark.parametrize("seed", range(5))
def test_the_plane_presses_and_friction_is_coulombs(seed, patch):
    model, forcing, run = random_run(seed, shaken=True, patch=patch)
    data = run.data.isel(time=settled(run, departure_lapse(forcing)))
    kind, normal = data["contact"].to_numpy(), data["normal_force"].to_numpy()
    friction, slip = data["friction_force"].to_numpy(), data["slip_velocity"].to_numpy()
    drag, speed = np.hypot(*friction.T), np.hypot(*slip.T)
    flies = kind == Contact.FLYING
    assert normal.min() >= -1e-9
    assert not normal[flies].any()
    assert not drag[flies].any()
    holds = (kind == Contact.RESTING) | (kind == Contact.ROLLING)
    assert not speed[holds].any()
    assert (drag[holds] <= model.numbers.static * normal[holds] + 1e-8).all()
    slips = kind == Contact.SLIPPING if patch == 0.0 else np.zeros(kind.size, dtype=bool)
    np.testing.assert_allclose(drag[slips], model.numbers.kinetic * normal[slips], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose((friction * slip).sum(axis=1)[slips], -(drag * speed)[slips], rtol=1e-6, atol=1e-12)
    turns = (kind == Contact.SLIPPING) | (kind == Contact.SLIDING)
    assert (drag[turns] <= model.numbers.kinetic * normal[turns] * (1.0 + 1e-9)).all()
    assert data["clearance"].min() >= -1e-12
    assert not data["clearance"].to_numpy()[~flies].any()


@pytest.mark.parametrize("patch", [0.0, 0.2], ids=["point", "patch"])
@pytest.mark.parametrize("seed", range(8))
def test_on_a_base_at_rest_energy_only_falls(seed, patch):
    model, forcing, run = random_run(seed, shaken=False, patch=patch, damping=0.05 * (seed % 2))
    data = run.data.isel(time=settled(run, departure_lapse(forcing)))
    energy = data["energy"].to_numpy()
    # Errors of the integration alone can raise it, by some of its tolerance of what there was.
    assert np.diff(energy).max() <= 1e2 * RTOL * energy[0]
    rolls = (data["contact"].to_numpy() == Contact.ROLLING) & (model.damping == model.rolling_resistance == 0.0)
    # Between two samples that both roll, with no event in between, it is kept.
    time = data["time"].to_numpy()
    passed = np.array([any(a < event.time < b for event in run.events) for a, b in pairwise(time)])
    kept = rolls[:-1] & rolls[1:] & ~passed
    np.testing.assert_allclose(np.diff(energy)[kept], 0.0, atol=1e2 * RTOL * energy[0])
