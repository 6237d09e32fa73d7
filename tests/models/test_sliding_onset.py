"""How slip begins: with an error of the third power of its lapse, and a history that the plane allows."""

import math

import numpy as np
import pytest
from tests.reference import resting, switched

import stylobate as sb
from stylobate.models.sliding import Contact

SLENDER, SQUAT = (sb.Column.dimensionless(slenderness=c) for c in (0.1, 0.3))
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
SKEW = sb.Harmonic(amplitude=(0.08, 0.04, 0.2), phase=(0.0, 1.0, 2.0), angular_frequency=3.0)
LEANING = {"tilt": (0.05, 0.01), "tilt_rate": (0.01, 0.06)}

ONSETS = {
    "static friction above kinetic": (
        {"friction_coefficient": 0.02, "static_friction_coefficient": 0.025},
        CIRCLE,
        0.7,
    ),
    "far too little friction": ({"friction_coefficient": 0.02}, CIRCLE, 0.1),
    "a patch": ({"friction_coefficient": 0.03, "static_friction_coefficient": 0.05, "patch": 0.3}, CIRCLE, 0.5),
    "a base": ({"friction_coefficient": 0.03, "static_friction_coefficient": 0.05}, SKEW, 0.3),
}


@pytest.mark.parametrize("name", ONSETS)
def test_the_error_of_an_onset_is_of_the_third_power_of_its_time(name, monkeypatch):
    friction, motion, duration = ONSETS[name]
    start = {"tilt": (0.0, 0.0)} if name == "a base" else LEANING
    model = sb.Sliding(SLENDER, damping=0.02, **friction)

    def after(lapse):
        monkeypatch.setattr(resting, "_DEPARTURE", lapse)
        trajectory = switched(model, motion, duration=duration, rtol=1e-12, **start).trajectory
        return trajectory.states(np.array([trajectory.end]))[:10, 0]

    exact = after(2.5e-4)
    coarse, fine = (np.abs(after(lapse) - exact).max() for lapse in (1.6e-2, 8e-3))
    assert coarse > 1e-11  # well above the tolerance: the onset counts
    # Third power: 8 of it as the time is halved; second power: 4.
    assert coarse > 6.0 * fine


def test_slip_that_begins_after_an_impact_stays_on_the_plane():
    friction = 0.12  # stops the contact in the impact; the shaken base then makes it slip
    motion = sb.Harmonic(amplitude=(0.6, 0.0, 0.0), phase=(math.pi / 2.0, 0.0, 0.0), angular_frequency=1.0)
    start = {"tilt": (0.15, 0.0), "tilt_rate": (0.0, 0.06), "clearance": 0.01}
    run = sb.simulate(sb.Sliding(SQUAT, friction_coefficient=friction), motion, **start, duration=0.3, rtol=1e-9)
    assert [event.kind for event in run.events] == ["land", "slip"]
    landed = run.events[0].time
    assert run.measures["time_flying"] == pytest.approx(landed, abs=1e-12)
    assert run.measures["slips"] == 1.0
    shown = run.sample(landed + np.linspace(0.0, 1e-3, 21))
    assert shown["clearance"].to_numpy().min() >= 0.0
    assert (shown["contact"].to_numpy() != Contact.FLYING).all()
    # At a steady pace: energy changes by what the base does, in a thousandth of a unit of time.
    energy = shown["energy"].to_numpy()
    assert np.ptp(energy) < 0.01 * energy[0]
