"""The claims of a model of a user's own are compared with its equations, in `check` and at its first run."""

import math
import time
from dataclasses import dataclass, fields, replace
from typing import ClassVar

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ModelError
from stylobate.models.consistency import equations
from stylobate.models.consistency.check import check_once
from stylobate.models.model import RollingLaw

COLUMN = sb.Column.dimensionless(0.1)
STOUT = sb.Column.solid(radius=0.4, height=1.2, density=2700.0)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)

slender_rates = sb.Slender.rates


def problems_of(model):
    with pytest.raises(ModelError) as caught:
        sb.models.check(model)
    return caught.value.problems


@dataclass(frozen=True, slots=True)
class Resisted(sb.Slender):
    """Quadratic drag in all equations; the claims about them are those of the slender column."""

    drag: float = 0.0
    name: ClassVar[str] = "resisted"

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
        return slender_rates(x, y, vx, vy, ax, ay, az, c, eta + k * math.hypot(vx, vy), kappa)

    @staticmethod
    def planar_rates(tilt, rate, side, horizontal, vertical, c, eta, kappa, k):
        return rate, (1.0 + vertical) * (tilt - c * side) - (eta + k * abs(rate)) * rate - horizontal

    @staticmethod
    def contact(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
        return sb.Slender.contact(x, y, vx, vy, ax, ay, az, c, eta + k * math.hypot(vx, vy), kappa)

    @property
    def parameters(self):
        return self.column.slenderness, self.damping, self.column.inertia_ratio, self.drag

    closed_form = sb.Slender.closed_form


def test_a_closed_form_that_ignores_a_term_of_the_equations_is_refused():
    sb.models.check(Resisted(COLUMN, damping=0.1))
    (line,) = problems_of(Resisted(COLUMN, damping=0.1, drag=4.0))
    # The drag of a tilt A that turns at ν is k(νA)², across it.
    assert line == (
        "Resisted.closed_form: its steady rolling does not solve rates (tilt acceleration across the tilt "
        f"{-4.0 * (1.5 * 0.03) ** 2:.4g}, not 0, at a tilt of 0.03 rad that turns at 1.5 ω0, by "
        "theory.steady_rolling). Define closed_form for these rates, or return None."
    )


LAWS = [
    sb.Slender(COLUMN, damping=0.1),
    sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.3),
    sb.Wobbling(STOUT, damping=0.1),
    sb.Wobbling(STOUT, damping=0.1, constraint="rubber"),
    sb.Rolling(STOUT, damping=0.1, spin_damping=0.3),
]


@pytest.mark.parametrize("model", LAWS, ids=lambda model: f"{model.name} {model.closed_form.law.value}")
def test_a_closed_form_with_a_damping_of_one_per_cent_more_is_refused(model):
    class Own(type(model)):
        pass

    numbers = {field.name: getattr(model, field.name) for field in fields(model)}
    sb.models.check(Own(**numbers))
    form = replace(model.closed_form, eta=1.01 * model.damping)
    Own.closed_form = property(lambda _: form)
    (line,) = problems_of(Own(**numbers))
    assert line.startswith("Own.closed_form: its steady rolling does not solve rates")
    assert f"theory.{form.law.value})" in line


def test_a_closed_form_without_its_spin_damping_is_refused_by_the_rate_of_the_spin():
    class Unwound(sb.SlenderRolling):
        @property
        def closed_form(self):
            return sb.SlenderRolling(self.column, damping=self.damping, spin_damping=0.2).closed_form

    (line,) = problems_of(Unwound(COLUMN, damping=0.1, spin_damping=0.3))
    assert RollingLaw.FREE_TWIST.value in line


class Undeclared(Resisted):
    """With drag, but `comes_to_rest` of the slender column, which has no drag."""

    closed_form = None


class Tireless(sb.Slender):
    """Comes to rest without any dissipation."""

    comes_to_rest = True


def test_a_column_that_loses_energy_has_to_come_to_rest():
    (line,) = problems_of(Undeclared(COLUMN, drag=5.0))
    assert line.startswith(
        "Undeclared.comes_to_rest: is False although rates lose energy in free motion, inherited from Slender, (they "
        f"slow the column by {5.0 * 0.1**2:.4g} per unit of time, not 0, at a tilt of {0.7 * math.atan(0.1):.4g} rad "
        "with the rate 0.1)."
    )
    for model in (Undeclared(COLUMN), Undeclared(COLUMN, damping=0.1, drag=5.0)):
        sb.models.check(model)

    class Restless(Undeclared):
        rest_energy = None

    sb.models.check(Restless(COLUMN, drag=5.0))  # makes no claim about rest


def test_a_column_that_loses_no_energy_cannot_come_to_rest():
    (line,) = problems_of(Tireless(COLUMN))
    assert line.startswith("Tireless.comes_to_rest: is True although rates lose no energy in free motion")
    sb.models.check(Tireless(COLUMN, damping=0.1))


class Crossed(sb.Slender):
    """vx twice."""

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa):
        _, _, bx, by = slender_rates(x, y, vx, vy, ax, ay, az, c, eta, kappa)
        return vx, vx, bx, by


class Halved(sb.Slender):
    """Keeps twice the tilt rate, in `start` and `tilt_of`, but not in `rates`."""

    def start(self, tilt, tilt_rate):
        return sb.Slender.start(self, tilt, (2.0 * tilt_rate[0], 2.0 * tilt_rate[1]))

    @staticmethod
    def tilt_of(x, y, vx, vy, *numbers):
        return x, y, 0.5 * vx, 0.5 * vy


@pytest.mark.parametrize(("kind", "origin"), [(Crossed, ", inherited from TiltVectorModel,"), (Halved, "")])
def test_the_tilt_has_to_change_at_the_rate_that_tilt_of_returns(kind, origin):
    line = problems_of(kind(COLUMN, damping=0.1))[0]
    assert line.startswith(f"{kind.__name__}.rates: the tilt along ")
    assert f" changes at another rate than tilt_of returns{origin or ' ('}" in line
    assert "tilt_x = " in line
    assert "base acceleration 0.02, -0.01, 0.1 g" in line


class Polar(sb.Slender):
    """The slender column in polar coordinates of the tilt: A, β and their rates."""

    planar_rates = from_plane = contact = departure = passage = rest_energy = None

    def start(self, tilt, tilt_rate):
        x, y, vx, vy = sb.Slender.start(self, tilt, tilt_rate)
        size = math.hypot(x, y)
        return size, math.atan2(y, x), (x * vx + y * vy) / size, (x * vy - y * vx) / size**2

    @staticmethod
    def tilt_of(size, azimuth, growth, turning, *numbers):
        ux, uy = np.cos(azimuth), np.sin(azimuth)
        return size * ux, size * uy, growth * ux - size * turning * uy, growth * uy + size * turning * ux

    @staticmethod
    def rates(size, azimuth, growth, turning, ax, ay, az, c, eta, kappa):
        ux, uy = math.cos(azimuth), math.sin(azimuth)
        vx, vy = growth * ux - size * turning * uy, growth * uy + size * turning * ux
        _, _, bx, by = slender_rates(size * ux, size * uy, vx, vy, ax, ay, az, c, eta, kappa)
        outwards, around = bx * ux + by * uy, by * ux - bx * uy
        return growth, turning, outwards + size * turning**2, (around - 2.0 * growth * turning) / size


def test_other_coordinates_of_the_tilt_make_no_contradiction():
    report = sb.models.check(Polar(COLUMN, damping=0.1))
    assert "tilt_of: returns the derivative of the tilt along rates" in report.findings


def pushed(*signs, lift=1.0):
    """Return a slender column on which the base acts with this matrix, and with this factor upwards."""
    xx, xy, yx, yy = signs

    class Pushed(sb.Slender):
        planar_rates = contact = departure = passage = no_return_tilt = None

        @staticmethod
        def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa):
            return slender_rates(x, y, vx, vy, xx * ax + xy * ay, yx * ax + yy * ay, lift * az, c, eta, kappa)

    return Pushed(COLUMN)


@pytest.mark.parametrize(
    ("signs", "along", "text"),
    [
        ((-1.0, 0.0, 0.0, -1.0), "x", "leans with the acceleration of the base instead of against it"),
        ((1.0, 0.0, 0.0, -1.0), "y", "leans with the acceleration of the base instead of against it"),
        ((0.0, 1.0, -1.0, 0.0), "x", "does not act along x"),
        ((0.0, 1.0, 1.0, 0.0), "x", "does not act along x"),
        ((1.0, 0.0, 1.0, 0.0), "y", "does not act along y"),
        ((1.0, 3.0, 3.0, 1.0), "(y − x)/√2", "leans with the acceleration of the base instead of against it"),
    ],
)
def test_the_column_has_to_lean_against_the_acceleration_of_the_base(signs, along, text):
    line = problems_of(pushed(*signs))[0]
    assert line.startswith("Pushed.rates: ")
    assert text in line
    assert f" g along {along} changes the tilt acceleration by " in line


def test_the_weight_has_to_grow_if_the_base_accelerates_upwards():
    (line,) = problems_of(pushed(1.0, 0.0, 0.0, 1.0, lift=-1.0))
    # At the tilt A the weight accelerates the slender column by A − c.
    tilt = 0.5 * math.atan(0.1)
    assert line.startswith("Pushed.rates: an upward acceleration of the base reduces the weight")
    assert f"by {0.1 * (0.1 - tilt):+.4g}, at a tilt of {tilt:.4g} rad" in line


def test_the_report_states_the_side_to_which_the_column_leans():
    lean = "rates: if the base accelerates to +x, the column leans to −x"
    lift = "rates: if the base accelerates upwards, "
    report = sb.models.check(sb.Slender(COLUMN, damping=0.1))
    assert {lean, f"{lift}the weight grows"} <= set(report.findings)
    assert repr(report).splitlines() == ["Slender: no contradictions", *(f"  {line}" for line in report.findings)]
    level = sb.models.check(pushed(1.0, 0.0, 0.0, 1.0, lift=0.0))
    assert {lean, f"{lift}nothing changes"} <= set(level.findings)
    free = sb.models.check(pushed(0.0, 0.0, 0.0, 0.0))
    assert "rates: the acceleration of the base does not act on the column" in free.findings


def test_the_report_names_the_claims_that_a_model_with_other_equations_does_not_inherit():
    class Own(Resisted):
        closed_form = sb.Slender.closed_form

        @property
        def parameters(self):
            return Resisted.parameters.fget(self)

    class Further(Own):
        @property
        def parameters(self):
            return Own.parameters.fget(self)

    findings = sb.models.check(Further(COLUMN, damping=0.1, drag=5.0)).findings
    assert "closed_form: not used, inherited from Own, because the equations are replaced" in findings
    assert "balance: not used, inherited from Slender, because the equations are replaced" in findings


class Fused(sb.Slender):
    """Differences of products that a compiler fuses: their rounding errors depend on it."""

    planar_rates = contact = departure = passage = no_return_tilt = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa):
        _, _, bx, by = slender_rates(x, y, vx, vy, ax, ay, az, c, eta, kappa)
        turning = 1e6 * ((x + 1.0) * (vy + 1.0) - (x + vy) - (x * vy + 1.0))  # zero but for rounding
        return vx, vy, bx + turning * y, by - turning * x


def test_rounding_is_no_difference_between_compiled_and_plain_code():
    report = sb.models.check(Fused(COLUMN))
    assert "rates: compiled code and Python agree (rates)" in report.findings


def test_compiled_code_of_other_equations_is_refused(monkeypatch):
    class Own(sb.Slender):
        @staticmethod
        def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa):
            return slender_rates(x, y, vx, vy, ax, ay, az, c, eta, kappa)

    def wrong(x, y, vx, vy, ax, ay, az, c, eta, kappa):
        _, _, bx, by = slender_rates(x, y, vx, vy, ax, ay, az, c, eta, kappa)
        return vx, vy, bx, by * (1.0 + 1e-9)

    program = equations._program
    changed = {Own.rates: wrong}
    monkeypatch.setattr(equations, "_program", lambda function, *rest: program(changed.get(function, function), *rest))
    with pytest.raises(ModelError, match=r"^Own\.rates: compiled code gives other results than Python") as caught:
        check_once(Own(COLUMN, damping=0.1))
    assert caught.value.problems == problems_of(Own(COLUMN, damping=0.1))
    assert "(result 4 is " in caught.value.problems[0]


def test_code_that_cannot_be_compiled_is_not_compared():
    class Uncompiled(sb.Slender):
        @staticmethod
        def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa):
            numbers = {"x": x, "y": y}
            return slender_rates(numbers["x"], numbers["y"], vx, vy, ax, ay, az, c, eta, kappa)

    report = sb.models.check(Uncompiled(COLUMN, damping=0.1))
    assert "rates: not compared with compiled code, because rates is not compiled" in report.findings


RUNS = [
    lambda model: sb.simulate(model, tilt=(0.02, 0.0), duration=1.0),
    lambda model: sb.simulate_ensemble(model, tilt=(0.02, 0.0), duration=1.0),
    lambda model: sb.orbits.periodic_orbit(model, CIRCLE, guess=(0.04, 0.0, 0.0, 0.07)),
]


@pytest.mark.parametrize("run", RUNS, ids=["simulate", "simulate_ensemble", "periodic_orbit"])
@pytest.mark.parametrize(
    ("model", "member"),
    [
        (Resisted(COLUMN, damping=0.1, drag=5.0), "closed_form"),
        (Undeclared(COLUMN, drag=5.0), "comes_to_rest"),
        (Crossed(COLUMN), "rates"),
        (pushed(-1.0, 0.0, 0.0, -1.0), "rates"),
    ],
    ids=["closed_form", "comes_to_rest", "tilt rate", "push"],
)
def test_the_first_run_of_a_model_refuses_a_claim_that_contradicts_its_equations(model, member, run):
    with pytest.raises(ModelError, match=rf"^{type(model).__name__}\.{member}: "):
        run(model)


def test_equations_that_replace_those_of_a_class_are_checked_again():
    class Own(sb.Slender):
        pass

    check_once(Own(COLUMN, damping=0.1))
    Own.rates = staticmethod(Crossed.rates)
    with pytest.raises(ModelError, match=r"^Own\.rates: the tilt along "):
        check_once(Own(COLUMN, damping=0.1))


def test_further_numbers_of_a_model_are_checked_in_a_few_milliseconds():
    class Own(sb.Rolling):
        @staticmethod
        def rates(*numbers):
            return sb.Rolling.rates(*numbers)

        contact, closed_form = None, sb.Rolling.closed_form

    check_once(Own(COLUMN, damping=0.1, spin_damping=0.3))
    spent = []
    for damping in np.linspace(0.2, 0.3, 9):
        begun = time.process_time()
        check_once(Own(COLUMN, damping=float(damping), spin_damping=0.3))
        spent.append(time.process_time() - begun)
    assert min(spent) < 0.005
