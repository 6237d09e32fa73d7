"""What would not end by itself ends: bounces and rocking die out, and the numbers that say so decide nothing else."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.models.sliding import equations, rim_and_base

# The numbers below which something counts as nothing, and where they are looked up.
SMALL = ("STILL", "REST_SPEED", "JAM")
HOMES = (equations, rim_and_base)
COLUMN = sb.Column.dimensionless(slenderness=0.2)


@pytest.mark.parametrize(
    "options",
    [
        {"normal_restitution": 0.0, "friction_coefficient": 0.5},
        {"normal_restitution": 0.6, "friction_coefficient": 0.5},
        {"normal_restitution": 0.0, "friction_coefficient": 0.1},
        {"normal_restitution": 0.3, "friction_coefficient": 0.1},
    ],
)
def test_rocking_comes_to_rest(options):
    run = sb.simulate(sb.Sliding(COLUMN, **options), tilt=(0.1, 0.0), duration=60.0, rtol=1e-7)
    assert run.outcome is sb.Outcome.AT_REST
    assert run.events[-1].time < 60.0
    assert run.data["energy"][-1] == 0.0


@pytest.mark.parametrize("restitution", [0.3, 0.7])
def test_bounces_come_to_rest_from_any_height_and_attitude(restitution):
    run = sb.simulate(
        sb.Sliding(COLUMN, normal_restitution=restitution, rolling_resistance=0.05, damping=0.05), tilt=(0.08, 0.03),
        tilt_rate=(0.02, 0.05), spin=0.2, clearance=0.02, duration=150.0, rtol=1e-6,
    )  # fmt: skip
    assert run.outcome is sb.Outcome.AT_REST


def halve(monkeypatch):
    for home in HOMES:
        for name in SMALL:
            if hasattr(home, name):
                monkeypatch.setattr(home, name, 0.5 * getattr(home, name))


def random_end(seed):
    rng = np.random.default_rng(100 + seed)
    c = rng.uniform(0.1, 0.4)
    model = sb.Sliding(
        sb.Column.dimensionless(slenderness=c), friction_coefficient=rng.uniform(0.05, 0.5),
        normal_restitution=rng.choice([0.0, 0.4]),
    )  # fmt: skip
    beta, tilt = rng.uniform(0.0, 6.0), c * rng.uniform(0.2, 0.8)
    motion = sb.Harmonic.circular(acceleration=rng.uniform(0.2, 1.0) * c, angular_frequency=rng.uniform(1.0, 4.0))
    run = sb.simulate(
        model, motion, tilt=(tilt * math.cos(beta), tilt * math.sin(beta)),
        tilt_rate=tuple(0.3 * c * rng.normal(size=2)), spin=0.2 * rng.normal(),
        velocity=(*0.1 * rng.normal(size=2), 0.0), clearance=rng.choice([0.0, 0.01]), duration=2.5, rtol=1e-10,
    )  # fmt: skip
    data = run.data.isel(time=-1)
    end = [data[name].to_numpy() for name in ("tilt", "tilt_rate", "footprint", "slip_velocity")]
    return run.outcome, np.concatenate([*end, [float(data["spin"])]])


@pytest.mark.slow
def test_halving_what_counts_as_nothing_changes_nothing(monkeypatch):
    ends = [random_end(seed) for seed in range(4)]
    halve(monkeypatch)
    changes = 0.0
    for seed, (outcome, end) in enumerate(ends):
        again, other = random_end(seed)
        assert again is outcome
        # Bounces end REST_SPEED earlier or later, which moves by as much at most what falls as e^τ.
        np.testing.assert_allclose(
            other, end, rtol=0.0, atol=rim_and_base.REST_SPEED * math.exp(2.5), err_msg=str(seed)
        )
        changes += np.abs(other - end).max()
    assert changes > 0.0  # the numbers were others
