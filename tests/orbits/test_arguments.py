"""What cannot be an orbit, a family of them or a step along it is refused at once, in one line that says why."""

import math
import time

import pytest

import stylobate as sb
from stylobate.base_motions import BASE_AT_REST
from stylobate.errors import NoOrbitError, ParameterError, UnsupportedError
from stylobate.orbits import (
    StepControl,
    bifurcation_curve,
    continue_branch,
    periodic_orbit,
    periodic_orbits,
    switch_branch,
)

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
LINE = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)


@pytest.fixture(scope="module")
def orbit():
    return periodic_orbit(MODEL, CIRCLE)


@pytest.fixture(scope="module")
def branch(orbit):
    return continue_branch(orbit, "angular_frequency", bounds=(1.3, 2.1))


def one_line(told):
    return "\n" not in str(told.value)


def test_a_column_that_stands_is_no_orbit():
    weak = sb.Harmonic.straight(acceleration=0.04, angular_frequency=2.0)
    run = sb.simulate(MODEL, weak, tilt=(0.0002, 0.0), duration=60.0)
    assert run.outcome is sb.Outcome.AT_REST
    periodic_orbit(MODEL, weak)  # the flow is compiled
    for guess in ((0.0, 0.0, 0.0, 0.0), run):
        begun = time.process_time()
        with pytest.raises(NoOrbitError, match=r"the column stands upright .* Give a tilt") as told:
            periodic_orbit(MODEL, weak, guess=guess)
        assert one_line(told)
        # No flow is carried, each of which takes milliseconds to seconds.
        assert time.process_time() - begun < 1.0


@pytest.mark.parametrize(
    ("name", "bounds", "words"),
    [
        ("angular_frequency", (-1.0, 4.0), "angular_frequency must be positive, got -1.0"),
        ("angular_frequency", (0.0, 4.0), "angular_frequency must be positive, got 0.0"),
        ("damping", (-0.1, 0.2), "damping must be zero or positive, got -0.1"),
        ("slenderness", (-0.1, 0.2), "slenderness must be positive, got -0.1"),
        ("slenderness", (0.0, 0.2), "slenderness must be positive, got 0.0"),
        ("gravity", (-1.0, 2.0), "gravity must be positive, got -1.0"),
        ("mass", (-1.0, 2.0), "mass must be positive, got -1.0"),
        ("acceleration", (-0.1, 0.2), "acceleration must be zero or positive, got -0.1"),
    ],
)
def test_bounds_are_numbers_that_can_be(orbit, branch, name, bounds, words):
    with pytest.raises(ParameterError, match=f"bounds: {words}") as told:
        continue_branch(orbit, name, bounds=bounds)
    assert one_line(told)
    if name != "angular_frequency":
        with pytest.raises(ParameterError, match=f"bounds: {words}"):
            bifurcation_curve(branch.bifurcations[0], name, bounds=((1.0, 2.0), bounds))


@pytest.mark.parametrize(
    ("numbers", "words"),
    [
        ({"largest": -1}, "largest must be positive, got -1.0"),
        ({"largest": math.nan}, "largest must be positive, got nan"),
        ({"first": -0.1}, "first must be positive, got -0.1"),
        ({"first": 0}, "first must be positive, got 0.0"),
        ({"least": math.inf}, "least must be positive, got inf"),
        ({"least": 1}, "least must not be above first"),
        ({"least": 0.01, "first": 0.02, "largest": 0.001}, "least must not be above largest"),
        ({"most": 0}, "most must be a whole number of at least 1, got 0"),
        ({"most": 2.5}, "most must be a whole number"),
    ],
)
def test_steps_are_as_long_and_as_many_as_steps_can_be(numbers, words):
    with pytest.raises(ParameterError, match=words) as told:
        StepControl(**numbers)
    assert one_line(told)


def test_the_first_step_is_no_longer_than_the_largest(orbit):
    control = StepControl(largest=1e-3, most=1)
    branch = continue_branch(orbit, "angular_frequency", bounds=(1.3, 2.5), control=control)
    lengths = [abs(float((point.u - branch.path[1].u) @ branch.path[1].tangent)) for point in branch.path]
    assert max(lengths) <= 1e-3 * (1.0 + 1e-9)


@pytest.mark.parametrize("find", [periodic_orbit, periodic_orbits])
@pytest.mark.parametrize(
    ("model", "motion", "words"),
    [
        (MODEL, None, "motion must be a periodic base motion .* got None"),
        (MODEL, BASE_AT_REST, "motion must be a periodic base motion"),
        (LINE, MODEL, "model must come before motion"),
        (MODEL.column, LINE, "model must be a model such as Slender"),
        (MODEL, "line", "motion must be a periodic base motion .* got 'line'"),
    ],
)
def test_model_and_motion_are_what_they_are_called(find, model, motion, words):
    with pytest.raises(ParameterError, match=words) as told:
        find(model, motion)
    assert one_line(told)


def test_a_motion_that_begins_late_is_not_periodic_from_the_start():
    ramped = sb.Harmonic(amplitude=(0.1, 0.0, 0.0), angular_frequency=2.0, ramp=1.0)
    for motion, words in ((LINE.delayed(1.0), "delay=1 s"), (ramped, "ramp=1 s")):
        with pytest.raises(UnsupportedError, match=f"without ramp or delay.*{words}") as told:
            periodic_orbit(MODEL, motion)
        assert one_line(told)


def test_only_orbits_are_followed_and_only_bifurcations_switched_at(orbit, branch):
    calls = [
        (lambda: continue_branch(LINE, "angular_frequency", bounds=(1, 2)), "orbit must be a PeriodicOrbit"),
        (lambda: switch_branch(branch, bounds=(1, 2)), "bifurcation must be one of a branch"),
        (lambda: bifurcation_curve(branch, "damping", bounds=((1, 2), (0, 1))), "bifurcation must be one of a branch"),
        (lambda: bifurcation_curve(branch.bifurcations[0], "damping", bounds=5), "bounds must be two pairs"),
        (lambda: continue_branch(orbit, "damping", bounds=(0.0, 1.0), control=0.1), "control must be a StepControl"),
        (lambda: branch.orbit(1000), "index must be a whole number from .* got 1000"),
        (lambda: branch.orbit(0.5), "index must be a whole number"),
        (lambda: branch.orbits_at("x"), "value must be a real number, got 'x'"),
        (lambda: branch.orbits_at(math.nan), "value must be finite"),
    ]
    for call, words in calls:
        with pytest.raises(ParameterError, match=words) as told:
            call()
        assert one_line(told)


def test_orbits_of_a_branch_are_counted_from_either_end(branch):
    assert branch.orbit(-1).period == branch.orbit(len(branch.path) - 1).period


def test_a_delay_is_no_parameter_to_follow(orbit, branch):
    for follow in (
        lambda: continue_branch(orbit, "delay", bounds=(0.0, 1.0)),
        lambda: bifurcation_curve(branch.bifurcations[0], "delay", bounds=((1.0, 2.0), (0.0, 1.0))),
    ):
        with pytest.raises(ParameterError, match="a delay shifts the base motion in time") as told:
            follow()
        assert one_line(told)
