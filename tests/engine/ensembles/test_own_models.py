"""Models of a user's own, written in a file of theirs: compiled as they stand, or refused in one line."""

import importlib.util
import sys
from itertools import count

import numpy as np
import pytest

import stylobate as sb
from stylobate.compiler.reads import fingerprint
from stylobate.engine.flow.periodic import PeriodicSystem
from stylobate.errors import UnsupportedError

COLUMN = sb.Column.dimensionless(0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
STRAIGHT = sb.Harmonic.straight(acceleration=0.15, angular_frequency=4.0)
TURNING = {"tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.07), "duration": 20.0, "rtol": 1e-11}
FROM_REST = {"tilt": (0.0, 0.0), "duration": 10.0, "rtol": 1e-11}

HEAD = """
import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

import stylobate as sb
"""

# The two models of the page "models".
DRAGGED = """
@dataclass(frozen=True, slots=True)
class Dragged(sb.Model):
    column: sb.Column
    drag: float = 0.0
    name: ClassVar[str] = "dragged"
    state_names: ClassVar[tuple[str, ...]] = ("tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, k):
        lean = (1.0 + az) * (1.0 - c / math.hypot(x, y))
        drag = RESISTANCE
        return vx, vy, lean * x - drag * vx - ax, lean * y - drag * vy - ay

    @property
    def parameters(self):
        return self.column.slenderness, self.drag

    def start(self, tilt, tilt_rate):
        scale = self.time_scale
        return tilt[0], tilt[1], tilt_rate[0] * scale, tilt_rate[1] * scale

    @staticmethod
    def tilt_of(x, y, vx, vy, *parameters):
        return x, y, vx, vy
"""
SLENDER_DRAGGED = """
@dataclass(frozen=True, slots=True)
class SlenderDragged(sb.Slender):
    drag: float = 0.0
    name: ClassVar[str] = "slender, dragged"
    contact: ClassVar = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, k):
        slowing = eta + k * math.hypot(vx, vy)
        return sb.Slender.rates(x, y, vx, vy, ax, ay, az, c, slowing, 0.75)

    @property
    def parameters(self):
        return self.column.slenderness, self.damping, self.drag

    @staticmethod
    def planar_rates(tilt, rate, side, horizontal, vertical, c, eta, k):
        slowing = eta + k * abs(rate)
        return rate, (1.0 + vertical) * (tilt - c * side) - slowing * rate - horizontal
"""


@pytest.fixture
def written(tmp_path, monkeypatch):
    """Write a module of a user's and import it; returns a function of its text."""
    number = count()

    def write(text):
        name = f"of_a_user_{tmp_path.name}_{next(number)}".replace("-", "_")
        path = tmp_path / f"{name}.py"
        path.write_text(HEAD + text)
        spec = importlib.util.spec_from_file_location(name, path)
        module = importlib.util.module_from_spec(spec)
        monkeypatch.setitem(sys.modules, name, module)
        spec.loader.exec_module(module)
        return module

    return write


def dragged(resistance="k * math.hypot(vx, vy)", before=""):
    return before + DRAGGED.replace("RESISTANCE", resistance)


def expect_as_alone(model, motion, **arguments):
    data = sb.simulate_ensemble(model, motion, **arguments).isel(run=0)
    single = sb.simulate(model, motion, **arguments, samples=2, recheck=False)
    assert int(data["outcome"]) == single.outcome
    assert bool(data["planar"]) is single.planar
    assert float(data["decided_at"]) == pytest.approx(single.decided_at, abs=1e-7)
    np.testing.assert_allclose(data["end_tilt"], single.data["tilt"][-1], rtol=0.0, atol=1e-8)
    np.testing.assert_allclose(data["end_tilt_rate"], single.data["tilt_rate"][-1], rtol=0.0, atol=1e-8)
    return data


def test_a_model_with_the_required_members_only(written):
    model = written(dragged()).Dragged(COLUMN, drag=5.0)
    expect_as_alone(model, CIRCLE, **TURNING)
    # Its own number differs between runs like any other; without drag it is the slender column without friction.
    runs = sb.simulate_ensemble(model, CIRCLE, **TURNING, parameters={"drag": [0.0, 5.0]})
    plain = sb.simulate_ensemble(sb.Slender(COLUMN), CIRCLE, **TURNING)
    np.testing.assert_allclose(runs["end_tilt"][0], plain["end_tilt"][0], rtol=0.0, atol=1e-9)
    assert np.abs(runs["end_tilt"][1] - runs["end_tilt"][0]).max() > 1e-4
    # No proof of overturning: it counts at π/2.
    fallen = expect_as_alone(model, CIRCLE.scaled(0.0), **{**TURNING, "tilt": (0.12, 0.0)})
    assert float(fallen["peak_tilt"]) == pytest.approx(np.pi / 2.0, abs=1e-9)
    with pytest.raises(UnsupportedError, match="does not say how a column departs"):
        sb.simulate_ensemble(model, CIRCLE.scaled(3.0), duration=5.0)


def test_rates_that_are_no_numbers_end_a_run_as_failed_and_leave_others_alone(written):
    overflowing = "k * math.hypot(vx, vy) + (k / 1e14) ** 400.0"  # infinite for 1e15, zero for the others
    model = written(dragged(overflowing)).Dragged(COLUMN)
    runs = sb.simulate_ensemble(model, CIRCLE, **TURNING, parameters={"drag": [0.0, 1e15, 5.0]})
    beside = sb.simulate_ensemble(model, CIRCLE, **TURNING, parameters={"drag": [0.0, 5.0]})
    assert [sb.Outcome(int(code)) is sb.Outcome.FAILED for code in runs["outcome"]] == [False, True, False]
    np.testing.assert_array_equal(runs["end_tilt"][[0, 2]], beside["end_tilt"])


def test_a_model_that_calls_another_models_functions(written):
    model = written(SLENDER_DRAGGED).SlenderDragged(COLUMN, damping=0.1, drag=5.0)
    expect_as_alone(model, CIRCLE, **TURNING)
    pushed = expect_as_alone(model, STRAIGHT, **FROM_REST)
    assert bool(pushed["planar"])
    assert int(pushed["uplifts"]) == 1
    resting = {"tilt": (0.02, 0.0), "tilt_rate": (0.0, 0.01), "duration": 200.0}
    at_rest = sb.simulate_ensemble(model, CIRCLE.scaled(0.0), **resting)
    assert int(at_rest["outcome"][0]) == sb.Outcome.AT_REST


HELPERS = """
POWER = 1.5


class Law:
    @staticmethod
    def of(speed, k):
        return POWER * k * speed


def speed_of(vx, vy):
    return math.sqrt(vx * vx + vy * vy)


def resistance(vx, vy, k):
    return Law.of(speed_of(vx, vy), k)
"""


@pytest.mark.slow
def test_a_model_whose_functions_call_helpers_and_read_constants_of_their_module(written):
    text = dragged("resistance(vx, vy, k)", HELPERS)
    model = written(text).Dragged(COLUMN, drag=5.0)
    data = expect_as_alone(model, CIRCLE, **TURNING)
    # A change of the constant is a change of the model, in the next process and in this one.
    other = written(text.replace("POWER = 1.5", "POWER = 2.5")).Dragged(COLUMN, drag=5.0)
    changed = expect_as_alone(other, CIRCLE, **TURNING)
    assert np.abs(changed["end_tilt"] - data["end_tilt"]).max() > 1e-5


CHANGING = """
K = 2.0
WEIGHTS = (0.75, 1.75)
CFG = sb.Column.dimensionless(0.1)  # an object with a number


def law(vx, vy, k):
    return sum(K * w for w in WEIGHTS) * math.sqrt(vx * vx + vy * vy) + 0.0 * CFG.radius
"""


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["ensemble", "single run", "taylor", "flow"])
def test_a_constant_that_changes_after_a_run_is_seen_by_the_next(written, kind):
    def result(module):
        model = module.Dragged(COLUMN)
        if kind == "flow":
            return PeriodicSystem(model, CIRCLE).carry(np.array([0.04, 0.0, 0.0, 0.07]), 0.0, 1.0).by_start
        if kind == "single run":
            return sb.simulate(model, CIRCLE, **TURNING).data["tilt"].values
        method = {"method": "taylor"} if kind == "taylor" else {}
        return sb.simulate_ensemble(model, CIRCLE, **TURNING, **method)["end_tilt"].values

    text = dragged("law(vx, vy, k)", CHANGING).replace("c / math.hypot(x, y)", "c / math.sqrt(x * x + y * y)")
    module, other = written(text), written(text.replace("K = 2.0", "K = 40.0"))
    before = result(module)
    expected = result(other)  # its code is not that of the first module
    module.K = 40.0
    np.testing.assert_array_equal(result(module), expected)
    assert np.abs(expected - before).max() > 1e-5


@pytest.mark.slow
def test_a_model_whose_functions_branch(written):
    before = (
        "def resistance(vx, vy, k):\n    speed = math.hypot(vx, vy)\n    if speed > 0.05:\n        return k * speed\n"
    )
    before += "    return 0.0\n"
    model = written(dragged("resistance(vx, vy, k)", before)).Dragged(COLUMN, drag=5.0)
    chosen = written(dragged("(k * math.hypot(vx, vy) if math.hypot(vx, vy) > 0.05 else 0.0)")).Dragged(
        COLUMN, drag=5.0
    )
    runs, expected = (sb.simulate_ensemble(one, CIRCLE, **TURNING) for one in (model, chosen))
    np.testing.assert_allclose(runs["end_tilt"], expected["end_tilt"], rtol=0.0, atol=1e-9)


FURTHER = """
@dataclass(frozen=True, slots=True)
class Counted(sb.Slender):
    name: ClassVar[str] = "slender with its way"
    state_names: ClassVar[tuple[str, ...]] = ("way", "tilt_x", "tilt_y", "tilt_rate_x", "tilt_rate_y")
    planar_rates: ClassVar = None
    passage: ClassVar = None
    contact: ClassVar = None

    @staticmethod
    def rates(way, x, y, vx, vy, ax, ay, az, c, eta, kappa):
        return math.sqrt(vx * vx + vy * vy), *sb.Slender.rates(x, y, vx, vy, ax, ay, az, c, eta, kappa)

    def start(self, tilt, tilt_rate):
        return 0.0 * tilt[0], tilt[0], tilt[1], tilt_rate[0] * self.time_scale, tilt_rate[1] * self.time_scale

    @staticmethod
    def tilt_of(way, x, y, vx, vy, *_):
        return x, y, vx, vy

    @staticmethod
    def at_rest(way, x, y, vx, vy, *_):
        return way, 0.0, 0.0, 0.0, 0.0

    @staticmethod
    def departure(push, elapsed, c, eta, kappa):
        return 0.0, *sb.Slender.departure(push, elapsed, c, eta, kappa)

    def outputs(self, states, accelerations, resting):
        return {}
"""


@pytest.mark.slow
def test_a_model_whose_tilt_is_not_its_first_state(written):
    model = written(FURTHER).Counted(COLUMN, damping=0.1)
    data = expect_as_alone(model, CIRCLE, **{**TURNING, "rtol": 1e-10})
    plain = sb.simulate_ensemble(sb.Slender(COLUMN, damping=0.1), CIRCLE, **TURNING).isel(run=0)
    for name in ("end_tilt", "peak_tilt", "minimum_tilt", "turns"):
        np.testing.assert_allclose(data[name], plain[name], rtol=1e-4, atol=1e-7)


@pytest.mark.parametrize(
    ("resistance", "before", "told"),
    [
        ("TABLE['k']", "TABLE = {'k': object()}", "TABLE"),
        ("deep(k)", "def deep(k):\n    return k if k < 1.0 else deep(k - 1.0)\n", "deep calls itself"),
        ("open('k')", "", "open"),
        ("k * nothing_here", "", "nothing_here"),
        ("'k'", "", ""),
    ],
)
def test_a_model_that_cannot_be_compiled_is_told_in_one_line(written, resistance, before, told):
    model = written(dragged(resistance, before)).Dragged(COLUMN, drag=5.0)
    with pytest.raises(UnsupportedError, match=f"model dragged cannot be compiled; .*{told}") as caught:
        sb.simulate_ensemble(model, CIRCLE, **TURNING)
    assert "\n" not in str(caught.value)


def test_the_same_text_in_another_file_is_the_same_model(written):
    one, two = (written(dragged("resistance(vx, vy, k)", HELPERS)).Dragged for _ in range(2))
    assert fingerprint(one.rates) == fingerprint(two.rates)
    assert fingerprint(one.tilt_of) == fingerprint(two.tilt_of) != fingerprint(one.rates)


BEFORE = """
K = 2.0
SMALL = np.float32(1.5)
WHOLE = np.int64(3)
PAIR = (1.0, (2.0, 3.0))
ARRAY = np.arange(3000.0)


def make(power):
    def inner(v, shift=0.25):
        return v * power + shift

    return inner


class Law:
    factor = 1.0

    @staticmethod
    def of(v):
        return v * 7.0


def helper(v):
    return helper_of_helper(v) + Law.of(v)


def helper_of_helper(v):
    return v + 11.0


law = make(13.0)


def told(v):
    return K * SMALL * WHOLE * PAIR[1][0] * ARRAY[2] * law(v) + helper(v) + sb.Slender.no_return_tilt(v, v, v)
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("K = 2.0", "K = 2.5"),
        ("np.float32(1.5)", "np.float32(1.75)"),
        ("np.int64(3)", "np.int64(4)"),
        ("(2.0, 3.0)", "(2.0, 3.5)"),
        ("np.arange(3000.0)", "np.where(np.arange(3000) == 1500, 0.0, np.arange(3000.0))"),
        ("shift=0.25", "shift=0.5"),
        ("make(13.0)", "make(17.0)"),
        ("v * 7.0", "v * 8.0"),
        ("v + 11.0", "v + 12.0"),
        ("K * SMALL", "K + SMALL"),
        ("no_return_tilt(v, v, v)", "no_return_tilt(v, v, K)"),
    ],
)
def test_whatever_changes_what_a_function_computes_changes_its_fingerprint(written, old, new):
    assert BEFORE.count(old) == 1
    one, two = written(BEFORE), written(BEFORE.replace(old, new))
    assert fingerprint(one.told) != fingerprint(two.told)
    assert fingerprint(one.told) == fingerprint(written(BEFORE).told)


def test_a_change_of_another_models_function_changes_the_fingerprint_of_what_calls_it(written, monkeypatch):
    told = written(BEFORE).told
    before = fingerprint(told)
    monkeypatch.setattr(sb.Slender, "no_return_tilt", staticmethod(lambda a, b, c: a + b + c))
    assert fingerprint(told) != before


@pytest.mark.slow
def test_functions_that_the_user_compiled_already_are_taken_and_told_apart(written):
    # As other compilers do it.
    before = "class Jit:\n    def __init__(self, function):\n        self.py_func = function\n\n"
    before += "    def __call__(self, *values):\n        return self.py_func(*values)\n\n\n"
    before += "@Jit\ndef resistance(vx, vy, k):\n    return k * math.sqrt(vx * vx + vy * vy)\n"
    one = written(dragged("resistance(vx, vy, k)", before)).Dragged
    other = written(dragged("resistance(vx, vy, k)", before.replace("return k", "return 2.0 * k"))).Dragged
    assert fingerprint(one.rates) != fingerprint(other.rates)
    data = expect_as_alone(one(COLUMN, drag=5.0), CIRCLE, **TURNING)
    same = sb.simulate_ensemble(written(dragged()).Dragged(COLUMN, drag=5.0), CIRCLE, **TURNING)
    np.testing.assert_allclose(data["end_tilt"], same["end_tilt"][0], atol=1e-9)


MORE = """
from collections import namedtuple
from enum import IntEnum
from types import SimpleNamespace

from stylobate.compiler.marks import fast

SCALE, NESTED = 1.25, [SimpleNamespace(k=6.0)]
CFG = SimpleNamespace(k=7.0)


class Law:
    G = 1.0

    class Deep:
        K = 2.0


class Color(IntEnum):
    RED = 3


Pair = namedtuple("Pair", "one other", defaults=(0.5,))
COUNTED = range(3)


def made(factor):
    return lambda v: v * factor


def made_of(numbers):
    return lambda v: v * numbers.k


def of(law, v):
    return law.FACTOR * v


class Passed:
    FACTOR = 9.0


low, high, of_object = made(1.0), made(3.0), made_of(SimpleNamespace(k=8.0))


def plain(v):
    return v


def shown(v, *, shift=0.25):
    pair = Pair(v)
    v = sum(SCALE * w for w in (v, shift)) + NESTED[0].k + of_object(v) + of(Passed, v)
    config = CFG
    v += config.k
    return Law.G * Law.Deep.K + Color.RED * pair.one + shift + low(v) * high(v) + plain(v) + len(COUNTED)
"""


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("1.25", "1.5"),
        ("k=6.0", "k=6.5"),
        ("k=7.0", "k=7.5"),
        ("k=8.0", "k=8.5"),
        ("FACTOR = 9.0", "FACTOR = 9.5"),
        ("G = 1.0", "G = 1.5"),
        ("K = 2.0", "K = 2.5"),
        ("RED = 3", "RED = 4"),
        ('"one other"', '"other one"'),
        ("defaults=(0.5,)", "defaults=(0.75,)"),
        ("range(3)", "range(4)"),
        ("made(3.0)", "made(4.0)"),
        ("shift=0.25", "shift=0.5"),
        ("def plain", "@fast\ndef plain"),
    ],
)
def test_constants_of_classes_and_marks_are_part_of_the_fingerprint(written, old, new):
    assert MORE.count(old) == 1
    assert fingerprint(written(MORE).shown) != fingerprint(written(MORE.replace(old, new)).shown)
    assert fingerprint(written(MORE).shown) == fingerprint(written(MORE).shown)
