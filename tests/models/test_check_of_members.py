"""A model of a user's own that cannot run is refused in one line, by `check` and before its first run."""

import math
from dataclasses import dataclass
from typing import ClassVar

import pytest

import stylobate as sb
from stylobate.errors import ModelError
from stylobate.models.consistency.check import check_once

COLUMN = sb.Column.dimensionless(0.2)
STATES = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")


@dataclass(frozen=True, slots=True)
class Parts(sb.Model):
    """All members but name, state_names and rates."""

    column: sb.Column
    damping: float = 0.1

    @property
    def parameters(self):
        return self.column.slenderness, self.damping

    def start(self, tilt, tilt_rate):
        scale = self.time_scale
        return tilt[0], tilt[1], tilt_rate[0] * scale, tilt_rate[1] * scale

    @staticmethod
    def tilt_of(x, y, vx, vy, *parameters):
        return x, y, vx, vy


class Named(Parts):
    name: ClassVar[str] = "own"
    state_names: ClassVar[tuple[str, ...]] = STATES


class Base(Named):
    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta):
        lean = (1.0 + az) * (1.0 - c / math.hypot(x, y))
        return vx, vy, lean * x - eta * vx - ax, lean * y - eta * vy - ay


def own(base=Base, **members):
    return type("Own", (base,), members)(COLUMN)


def runs(model):
    sb.simulate(model, tilt=(0.05, 0.0), duration=1.0)


def runs_many(model):
    sb.simulate_ensemble(model, tilt=[(0.05, 0.0), (0.06, 0.0)], duration=1.0)


def problem_of(use, model):
    with pytest.raises(ModelError) as caught:
        use(model)
    (line,) = caught.value.problems
    assert "\n" not in line
    return line


def not_static(self, x, y, vx, vy, ax, ay, az, c, eta):
    return Base.rates(x, y, vx, vy, ax, ay, az, c, self.damping)


def beyond(x, y, vx, vy, ax, ay, az, c, eta):
    bx = Base.rates(x, y, vx, vy, ax, ay, az, c, eta)[2]
    return vx, vy, bx, math.nan


def nothing(*_):
    pass


def turned(x, y, vx, vy, ax, ay, az, c, eta):
    return vx, vy, 1j * x, -y


MISTAKES = {
    "no self": (
        {"rates": not_static},
        r"rates: must be a static method \(got an instance method\)\. Put @staticmethod above it\.",
    ),
    "tilt_of with self": (
        {"tilt_of": lambda self, x, y, vx, vy, *_: (x, y, vx, vy)},
        r"tilt_of: must be a static method \(got an instance method\)\. Put @staticmethod above it\.",
    ),
    "rates of NaN": (
        {"rates": staticmethod(beyond)},
        r"rates: must return 4 finite numbers \(got \(.*, nan\) at tilt_x = .*\)\. Return a tuple of 4 .*",
    ),
    "rates of None": (
        {"rates": staticmethod(nothing)},
        r"rates: must return 4 finite numbers \(got None at tilt_x = .*\)\. Return a tuple of 4 .*",
    ),
    "complex rates": (
        {"rates": staticmethod(turned)},
        r"rates: must return 4 finite numbers \(got \(.*j, .*\) at tilt_x = .*\)\. Return a tuple of 4 .*",
    ),
    "tilt_of of None": (
        {"tilt_of": staticmethod(nothing)},
        r"tilt_of: must return 4 finite numbers \(got None at .*\)\. Return a tuple of 4 .*",
    ),
    "start of None": (
        {"start": nothing},
        r"start: must return 4 finite numbers \(got None at the tilt .*\)\. Return a tuple of 4 .*",
    ),
    "start of NaN": (
        {"start": lambda _, tilt, rate: (*tilt, rate[0], math.nan)},
        r"start: must return 4 finite numbers \(got \(.*, nan\) at the tilt .*\)\. Return a tuple of 4 .*",
    ),
    "parameters of NaN": (
        {"parameters": property(lambda self: (self.column.slenderness, math.nan))},
        r"parameters: must not contain NaN \(got \(.*, nan\)\)\. Return .*",
    ),
    "name of a number": ({"name": 3}, r"name: must be a text \(got 3\)\. State .*"),
    "one text for all states": (
        {"state_names": "abcd"},
        r"state_names: must be a tuple of texts \(got 'abcd'\)\. State .*",
    ),
    "equal states": ({"state_names": (*STATES[:3], "tilt_x")}, r"state_names: .* are equal \(got .*\)\. Give .*"),
}


@pytest.mark.parametrize("use", [sb.models.check, check_once, runs, runs_many])
@pytest.mark.parametrize("mistake", MISTAKES)
def test_a_model_that_cannot_run_is_refused_with_member_and_remedy(mistake, use):
    members, line = MISTAKES[mistake]
    runs(own())
    model = own(**members)
    with pytest.raises(ModelError, match=rf"^Own\.{line}$"):
        use(model)


@pytest.mark.parametrize("use", [sb.models.check, check_once])
def test_rates_that_are_numbers_at_some_states_only_are_refused(use):
    def failing(x, y, vx, vy, ax, ay, az, c, eta):
        bx, by = Base.rates(x, y, vx, vy, ax, ay, az, c, eta)[2:]
        return vx, vy, math.nan if math.hypot(x, y) > c else bx, by

    with pytest.raises(ModelError) as caught:
        use(own(rates=staticmethod(failing)))
    assert caught.value.problems[0].startswith("Own.rates: must return 4 finite numbers (got (")
    assert "nan" in caught.value.problems[0]


@pytest.mark.parametrize("use", [sb.models.check, check_once, runs, runs_many])
def test_a_missing_member_is_named_with_its_remedy(use):
    assert problem_of(use, own(Named)).startswith("Own.rates: missing. Define it as a static method")
    nameless = own(Parts, rates=Base.rates, state_names=STATES)
    assert problem_of(use, nameless) == "Own.name: missing. State a short text, as in name = 'own'."
    assert problem_of(use, own(Parts, rates=Base.rates, name="own")).startswith("Own.state_names: missing. State")


def test_a_check_names_the_member_of_the_model_in_which_an_error_arises():
    def deep(x):
        return math.sqrt(x)

    def shallow(*_):
        return 1.0, 2.0, 3.0, deep(-1.0)

    line = problem_of(sb.models.check, own(rates=staticmethod(shallow)))
    assert line == "Own.rates: raises ValueError at a random state (math domain error)."
    line = problem_of(sb.models.check, own(outputs=None, start=lambda self, *_: self.absent))
    assert line.startswith("Own.start: raises AttributeError")


def free(x, y, vx, vy, ax, ay, az, c, eta):
    return Base.rates(x, y, vx, vy, ax, ay, az, c, 0.0)


RESTING = {
    "rates": staticmethod(free),
    "comes_to_rest": property(lambda _: True),
    "rest_energy": staticmethod(lambda tilt, speed, lift, c, *_: 0.5 * speed * speed + c * (1.0 + lift) * tilt),
    "loss_tilt": property(lambda _: 1e-3),
}


def restituted(x, y, vx, vy, c, eta):
    return x, y, 0.9 * vx, 0.9 * vy


@pytest.mark.parametrize("use", [sb.models.check, check_once])
@pytest.mark.parametrize(
    ("impact", "reason"),
    [(None, "impact_map is missing"), (staticmethod(lambda x, y, vx, vy, *_: (x, y, vx, vy)), "takes no speed")],
)
def test_a_model_whose_impacts_lose_nothing_does_not_come_to_rest(use, impact, reason):
    use(own(**RESTING, impact_map=staticmethod(restituted)))
    line = problem_of(use, own(**RESTING, impact_map=impact))
    assert line.startswith("Own.comes_to_rest: is True although rates lose no energy in free motion (")
    assert reason in line
    assert line.endswith("Return False for these numbers, or define the loss in rates or impact_map.")
