"""Starts on a branch of steady rolling lie on the motion, or say that they do not."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.config import SimulationConfig
from stylobate.errors import NoOrbitError
from stylobate.lab import curves
from stylobate.lab.grids import OFF_BRANCH
from stylobate.lab.options import presets

# Numbers are sent in nine digits.
SENT = 2e-8

STRAIGHT = next(one for one in presets() if one.identity == "line-strong").description


def case(motion, **more):
    return {name: STRAIGHT[name] for name in ("column", "model")} | {"motion": motion} | more


def straight(angular_frequency, **more):
    return case({**STRAIGHT["motion"], "angular_frequency": angular_frequency}, **more)


def elliptic(angular_frequency, phase):
    amplitude = [0.13, 0.05]
    return case({"kind": "elliptic", "amplitude": amplitude, "phase": phase, "angular_frequency": angular_frequency})


def start(values):
    return curves.start(values, lambda _: None).model_dump()


def last_state(values, begun, periods=5):
    """Return where a run from a start is some periods of the base later."""
    setup = SimulationConfig.parse({**values, "duration": 1.0}).build()
    begun = {name: begun[name] for name in ("tilt", "tilt_rate")}
    end = periods * setup.motion.period
    run = sb.simulate(setup.model, setup.motion, **begun, duration=end)
    return np.concatenate([run.sample(end)[name].to_numpy().ravel() for name in ("tilt", "tilt_rate")])


@pytest.mark.parametrize(
    "values", [straight(3.0), straight(2.5), straight(2.0), straight(1.9), elliptic(2.0, -1.2), elliptic(2.0, 1.2)]
)
def test_the_upper_branch_of_straight_and_elliptic_shaking_starts_on_its_exact_orbit(values):
    begun = start(values)
    assert begun["warnings"] == []
    state = np.concatenate([begun["tilt"], begun["tilt_rate"]])
    assert last_state(values, begun) == pytest.approx(state, rel=1e-6, abs=1e-7)


def test_the_start_of_a_frequency_is_the_same_after_others_and_that_of_the_preset():
    first, _, again = (start(straight(frequency)) for frequency in (3.0, 2.5, 3.0))
    assert first == again
    assert np.multiply(first["tilt"], 1.0 + OFF_BRANCH) == pytest.approx(STRAIGHT["tilt"], rel=SENT)
    assert first["tilt_rate"] == pytest.approx(STRAIGHT["tilt_rate"], rel=SENT)


@pytest.mark.parametrize(
    ("values", "remark"),
    [
        (straight(1.4), "start: the exact orbit is unstable"),
        (straight(1.6), "start: the exact orbit has bifurcated from the branch"),
        (straight(3.0, branch="lower"), "start: averaged branch, approximate"),
    ],
)
def test_a_start_that_is_not_on_a_stable_orbit_of_the_branch_says_so_in_one_line(values, remark):
    (line,) = start(values)["warnings"]
    assert line.startswith(remark)


def test_without_an_exact_orbit_the_averaged_start_is_kept_and_said_to_be_approximate(monkeypatch):
    def none_found(*_):
        message = "no periodic orbit was reached"
        raise NoOrbitError(message)

    monkeypatch.setattr(sb.orbits, "periodic_orbit", none_found)
    begun = start(straight(2.0))
    setup = SimulationConfig.parse({**straight(2.0), "duration": 1.0}).build()
    averaged = sb.studies.steady_start(setup.model, setup.motion)
    assert begun["tilt"] == pytest.approx(averaged["tilt"], rel=SENT)
    assert begun["warnings"] == ["start: averaged branch, approximate; no exact orbit was found from it"]


def test_under_circular_shaking_the_closed_form_is_the_start():
    values = case({"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8})
    begun = start(values)
    assert begun["warnings"] == []
    state = np.concatenate([begun["tilt"], begun["tilt_rate"]])
    assert last_state(values, begun) == pytest.approx(state, rel=1e-6, abs=1e-7)
