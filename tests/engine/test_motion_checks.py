"""A base motion of a user's own that breaks a promise is refused in one line; those of the package keep theirs."""

import math
from dataclasses import dataclass

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.forcing import check_motion, own_motions
from stylobate.errors import ParameterError

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)


@dataclass(frozen=True)
class Own(sb.BaseMotion):
    """a_x = 0.3 sin 0.7t, half waves of it, or a circle; what it says of itself is given."""

    shape: str = "sine"
    frequency: float = 0.7
    times: tuple[float, ...] = ()
    lasts: float = math.inf
    repeats: float | None = None
    vertical: float = 0.0
    vertical_bound: float = 0.0
    spans: tuple[tuple[float, float], ...] = ((1.0, 0.0),)

    def derivative(self, time, order):
        t = np.asarray(time, dtype=float)
        x, y, z = 0.3 * np.sin(0.7 * t), 0.0 * t, self.vertical * np.cos(0.7 * t)
        if self.shape == "half":
            x = np.maximum(x, 0.0)
        elif self.shape == "circle":
            y = 0.3 * np.cos(0.7 * t)
        elif self.shape == "jump":
            x = x + 0.05 * (t > 10.123)
        return (x, y, z) if order == 2 else (0.0 * t,) * 3

    def peak_horizontal(self, since=0.0):
        return 0.35

    def vertical_range(self, since=0.0):
        return -self.vertical_bound, self.vertical_bound

    def directions(self):
        return self.spans

    @property
    def highest_frequency(self):
        return self.frequency

    @property
    def breaks(self):
        return self.times

    @property
    def duration(self):
        return self.lasts

    @property
    def period(self):
        return self.repeats


PERIODS = 2.0 * math.pi / 0.7


@pytest.mark.parametrize("shape", ["sine", "half"])
@pytest.mark.parametrize("frequency", [0.0, 0.001, 0.01])
@pytest.mark.parametrize("periods", [3.0, 3.3, 4.0, 16.0])
def test_a_frequency_that_is_missing_or_much_too_low_is_refused(shape, frequency, periods):
    with pytest.raises(
        ParameterError, match=rf"^Own\.highest_frequency: .*got {frequency:g} rad/s, .* of 0\.7\d* rad/s"
    ):
        sb.simulate(MODEL, Own(shape, frequency), duration=periods * PERIODS)


@pytest.mark.parametrize("shape", ["sine", "half"])
def test_a_motion_that_gives_its_frequency_releases_as_the_same_motion_of_the_package(shape):
    run = sb.simulate(MODEL, Own(shape), duration=3.0 * PERIODS)
    assert run.events[0].kind == "uplift"
    assert run.events[0].time == pytest.approx(math.asin(1.0 / 3.0) / 0.7, rel=1e-9)
    assert run.outcome is sb.Outcome.OVERTURNED


LIES = [
    (Own(spans=((1.0, 0.0),), shape="circle"), r"directions: means a line along \(1, 0\) .* 0\.3 m/s² across it"),
    (Own(spans=()), r"directions: means no horizontal motion \(got \(\)\)"),
    (Own(vertical=1.5, vertical_bound=0.1), r"vertical_range: does not bound a_z from t = 0 s on .*from -1\.5 to 1\.5"),
    (Own("jump"), r"breaks: the acceleration jumps by 0\.05 m/s² at t = 10\.123 s, .*got 0 breaks\)\. Add that time"),
    (Own("jump", times=(9.0,)), r"breaks: .* \(got 1 breaks\)"),
    (Own(repeats=9.0), r"period: the acceleration does not repeat after it \(got 9 s"),
    (Own(repeats=-1.0), r"period: must be positive"),
    (Own(lasts=5.0), r"duration: the base still accelerates after it \(got 5 s"),
    (Own(frequency=math.nan), r"highest_frequency: must be zero or positive"),
]


@pytest.mark.parametrize(("motion", "told"), LIES)
@pytest.mark.parametrize("run", [sb.simulate, sb.simulate_ensemble])
def test_a_broken_promise_is_refused_in_one_line_that_names_it(run, motion, told):
    with pytest.raises(ParameterError, match=rf"^Own\.{told}") as caught:
        run(MODEL, motion, tilt=(0.02, 0.0), duration=30.0)
    assert "\n" not in str(caught.value)


PROPERTIES = ("highest_frequency", "duration", "period", "breaks")
METHODS = ("derivative", "peak_horizontal", "vertical_range", "directions")


@pytest.mark.parametrize("run", [sb.simulate, sb.simulate_ensemble])
@pytest.mark.parametrize("name", [*PROPERTIES, *METHODS])
def test_a_member_that_returns_no_numbers_is_refused_in_one_line_that_names_it(run, name):
    for value in (None, "much") if name != "period" else ("much",):
        member = property(lambda _, value=value: value) if name in PROPERTIES else lambda *_, value=value: value
        wrong = type("Wrong", (Own,), {name: member})()
        told = rf"^Wrong\.{name}: not of the right kind \(got {value!r}\)\. Return [^\n]*\.$"
        for motion in (wrong, wrong + Own()):
            with pytest.raises(ParameterError, match=told):
                run(MODEL, motion, duration=5.0)


@pytest.mark.parametrize(
    "combine",
    [
        lambda own: own + sb.Harmonic.straight(acceleration=0.1, angular_frequency=2.0),
        lambda own: 0.5 * own.rotated(1.0).delayed(2.0),
        lambda own: sb.OneOf(motions=(sb.base_motions.BASE_AT_REST, own), chosen=1),
    ],
)
def test_a_broken_promise_is_found_within_other_motions(combine):
    with pytest.raises(ParameterError, match=r"^Own\.highest_frequency: "):
        sb.simulate(MODEL, combine(Own(frequency=0.0)), duration=30.0)


def test_a_motion_that_keeps_its_promises_passes_with_breaks_and_bounds():
    circle = Own("circle", spans=((1.0, 0.0), (0.0, 1.0)), vertical=0.2, vertical_bound=0.2, repeats=PERIODS)
    for motion in (Own(repeats=PERIODS), Own("jump", times=(10.123,)), circle):
        for duration in (0.1, 10.0, 1000.0):
            check_motion(motion, duration)


OF_THE_PACKAGE = (
    sb.Harmonic.elliptic(amplitude=(1.0, 0.4), phase=1.0, angular_frequency=3.0, ramp=2.0),
    sb.Harmonic.oblique(acceleration=1.0, angle=0.3, angular_frequency=5.0),
    sb.Pulse.half_sine(acceleration=1.0, angular_frequency=3.0, start=0.5),
    sb.Pulse.ricker(acceleration=1.0, angular_frequency=3.0),
    sb.Pulse.gabor(velocity=1.0, frequency=0.5, phase=0.3, oscillations=2.0),
    sb.Pulse.mavroeidis_papageorgiou(velocity=0.9, frequency=0.5, phase=0.0, oscillations=1.8, start=1.0),
    sb.SineSweep.logarithmic(acceleration=0.5, frequencies=(0.5, 8.0), length=20.0),
    sb.records.sample_record(),
)


@pytest.mark.parametrize("motion", OF_THE_PACKAGE, ids=lambda motion: type(motion).__name__)
def test_the_motions_of_the_package_keep_what_is_asked_of_a_users(motion, monkeypatch):
    assert list(own_motions(motion)) == []
    monkeypatch.setattr("stylobate.engine.forcing._is_of_the_package", lambda _: False)
    check_motion(motion, 25.0)
