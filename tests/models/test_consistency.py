"""A model of a user's own whose members contradict each other is refused; the package's models keep their promises."""

import math
import re
import time
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ModelError, ParameterError
from stylobate.models.consistency.check import check_once

COLUMN = sb.Column.dimensionless(0.1)
BODIES = [COLUMN, sb.Column.solid(radius=0.5, height=4.0, density=2700.0)]
STOUT = sb.Column.solid(radius=0.4, height=1.2, density=2700.0)
HALF = sb.Column.dimensionless(0.5)
FLAT = sb.Column.solid(radius=1.5, height=1.0, density=2700.0)

slender_rates, slender_contact, slender_planar = sb.Slender.rates, sb.Slender.contact, sb.Slender.planar_rates


def levels(column):
    loss = {"damping": 0.1, "rolling_resistance": 0.01, "restitution": 0.8}
    return [
        sb.Slender(column),
        sb.Slender(column, damping=0.1),
        sb.SlenderRolling(column, damping=0.1, spin_damping=0.2),
        sb.SlenderRolling(column, damping=0.1, couples="isotropic"),
        sb.Wobbling(column),
        sb.Wobbling(column, **loss, constraint="rubber"),
        sb.Wobbling(column, constraint="rubber"),
        sb.Rolling(column),
        sb.Rolling(column, **loss, spin_damping=0.2),
        sb.PlanarRocking(column, damping=0.1, rolling_resistance=0.01),
        sb.PlanarRocking(column, restitution=1.0),
        sb.Sliding(column, damping=0.1),
    ]


@pytest.mark.parametrize("column", [*BODIES, HALF, STOUT, FLAT], ids=["c=0.1", "c=0.25", "c=0.5", "c=0.67", "c=3"])
def test_the_models_of_the_package_keep_their_promises(column):
    for model in levels(column):
        sb.models.check(model)


class Sprung(sb.Slender):
    """The slender column with a spring k at its base; a subclass must be a dataclass to have the field."""

    k = 0.9

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
        _, _, bx, by = slender_rates(x, y, vx, vy, ax, ay, az, c, eta, kappa)
        return vx, vy, bx - k * x, by - k * y

    @property
    def parameters(self):
        return (*sb.Slender.parameters.fget(self), self.k)

    @staticmethod
    def contact(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
        return slender_contact(x, y, vx, vy, ax + k * x, ay + k * y, az, c, eta, kappa)


class Whole(Sprung):
    """The same with all that the spring changes: an overturning column must be beyond c/(1 − k)."""

    @staticmethod
    def planar_rates(tilt, rate, side, horizontal, vertical, c, eta, kappa, k):
        return rate, slender_planar(tilt, rate, side, horizontal, vertical, c, eta)[1] - k * tilt

    @staticmethod
    def no_return_tilt(largest, least, c, eta, kappa, k):
        return math.inf if 1.0 + least <= k else (c * (1.0 + least) + largest) / (1.0 + least - k)


def problems_of(model):
    with pytest.raises(ModelError) as caught:
        sb.models.check(model)
    assert str(caught.value) == "\n".join(caught.value.problems)
    for line in caught.value.problems:
        assert re.match(rf"^{type(model).__name__}\.\w+: .*\.$", line)
    return caught.value.problems


def test_a_spring_without_equations_for_the_plane_is_refused_by_every_function_that_it_makes_wrong():
    planar, no_return = problems_of(Sprung(COLUMN))
    assert planar.startswith("Sprung.planar_rates: does not agree with rates, inherited from Slender,")
    assert planar.endswith("Define planar_rates with the terms of rates, or set planar_rates = None.")
    assert no_return.startswith("Sprung.no_return_tilt: is not a point of no return, inherited from Slender,")


@pytest.mark.parametrize("run", [sb.simulate, sb.simulate_ensemble])
def test_a_run_refuses_a_model_that_contradicts_itself(run):
    with pytest.raises(ModelError, match=r"^Sprung\.planar_rates: .*\nSprung\.no_return_tilt: "):
        run(Sprung(COLUMN), tilt=(0.05, 0.0), duration=1.0)


@pytest.mark.slow
def test_a_soft_spring_with_all_that_it_changes_is_followed_to_the_right_end():
    # (1 − k) x − c from x = 0.42 on: beyond the bare column's point of no return, 0.1, and below its own, 1.0.
    sb.models.check(Whole(COLUMN))
    run = sb.simulate(Whole(COLUMN), tilt=(0.42, 0.0), duration=2.0)
    assert run.outcome is sb.Outcome.STILL_MOVING
    rate = math.sqrt(1.0 - Whole.k)
    assert float(run.data["tilt"][-1, 0]) == pytest.approx(1.0 - 0.58 * math.cosh(2.0 * rate), abs=1e-7)


def test_a_stiff_spring_acts_in_a_plane_too():
    class Stiff(Whole):
        k = 1.5

    sb.models.check(Stiff(COLUMN))
    run = sb.simulate(Stiff(COLUMN), tilt=(0.05, 0.0), duration=1.0)
    # α̈ = −k'α − c, k' = k − 1, up to the passage: then the mirror image with the speed of the passage.
    w = math.sqrt(0.5)
    crossing = math.acos(0.2 / 0.25) / w
    speed = 0.25 * w * math.sin(w * crossing)
    later = 1.0 - crossing
    expected = -(speed / w * math.sin(w * later) - 0.2 * (1.0 - math.cos(w * later)))
    assert run.planar
    assert float(run.data["tilt"][-1, 0]) == pytest.approx(expected, abs=1e-8)


class Extra(sb.Slender):
    """One more number in its equations, which the contact does not take."""

    k = 2.0
    planar_rates = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
        return slender_rates(x, y, vx, vy, ax, ay, az, c, eta + k, kappa)

    parameters = Sprung.parameters


def test_a_function_that_does_not_take_all_parameters_is_named_with_its_numbers():
    (line,) = problems_of(Extra(COLUMN))
    assert line == (
        "Extra.contact: takes 10 numbers, inherited from Slender, but is called with 11, 4 of them parameters. "
        "Define it with an argument for each of `parameters`, or set contact = None."
    )
    with pytest.raises(ModelError, match=r"^Extra\.contact: takes 10 numbers"):
        sb.simulate(Extra(COLUMN), tilt=(0.05, 0.0), tilt_rate=(0.0, 0.01), duration=1.0)


class Short(sb.Slender):
    planar_rates = contact = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa):
        return vx, vy, -x


class Doubled(sb.Slender):
    """Contact forces of other equations, although they take as many numbers."""

    planar_rates = departure = passage = no_return_tilt = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa):
        return slender_rates(x, y, vx, vy, 2.0 * ax, 2.0 * ay, az, c, eta, kappa)


class Stuck(sb.Slender):
    """Glued to its base by a moment that departure does not know."""

    planar_rates = passage = contact = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa):
        return slender_rates(x, y, vx, vy, ax, ay, az, 1.1 * c, eta, kappa)

    @staticmethod
    def no_return_tilt(largest, least, c, eta, kappa):
        return math.inf


class Away(sb.Slender):
    @staticmethod
    def from_plane(tilt, rate, ux, uy, *numbers):
        return tilt * uy, tilt * ux, rate * ux, rate * uy


class Mirrored(sb.Slender):
    @staticmethod
    def tilt_of(x, y, vx, vy, *numbers):
        return x, -y, vx, -vy


class Fed(sb.Slender):
    """Negative friction feeds the energy that it claims to lose."""

    planar_rates = no_return_tilt = departure = contact = passage = rest_energy = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa):
        return slender_rates(x, y, vx, vy, ax, ay, az, c, -0.1, kappa)

    balance = sb.Slender.balance


class High(sb.Slender):
    """Its balance lies higher than its energy there."""

    @property
    def balance(self):
        own = sb.Slender.balance.fget(self)
        return own._replace(energy=1.1 * own.energy)


class Fast(sb.Rolling):
    """Faster after a loss."""

    @staticmethod
    def impact_map(x, y, vx, vy, spin, *numbers):
        return x, y, 1.1 * vx, vy, spin


class Slanted(sb.Slender):
    @staticmethod
    def jacobian(x, y, vx, vy, ax, ay, az, c, eta, kappa):
        return ((0.0,) * 10,) * 4


class Warm(sb.Slender):
    """Its energy of rest counts the speed twice."""

    @staticmethod
    def rest_energy(tilt, speed, vertical, c, *numbers):
        return speed * speed + c * (1.0 + vertical) * tilt


class Straight(sb.Slender):
    """Passes the upright without the kick of the weight, and loses half its speed."""

    @staticmethod
    def passage(x, y, vx, vy, ax, ay, az, c, eta, kappa):
        return -2.0 * x / vx, (-x, y, 0.5 * vx, vy)


@pytest.mark.parametrize(
    ("model", "line"),
    [
        (Short(COLUMN), r"rates: returns 3 numbers where 4 are needed"),
        (Doubled(COLUMN), r"contact: inherited from Slender, returns forces of the equations of Slender"),
        (Stuck(COLUMN, damping=0.1), r"departure: does not follow rates, inherited from Slender,"),
        (Away(COLUMN), r"from_plane: does not return a state with the tilt"),
        (Mirrored(COLUMN), r"tilt_of: does not return the tilt and the rate from which start made the state"),
        (Fed(COLUMN), r"energy: grows in free motion"),
        (High(COLUMN), r"balance: a column at the tilt 0\.1 rad can have less than the energy of the balance"),
        (Fast(COLUMN, restitution=0.9), r"impact_map: moves the column or makes it faster"),
        (Slanted(COLUMN), r"jacobian: entry \(\d, \d\) is not the derivative of rates"),
        (Warm(COLUMN, damping=0.1), r"rest_energy: grows in free motion near the vertical"),
        (Straight(COLUMN), r"passage: ends in another state than rates"),
    ],
    ids=lambda given: type(given).__name__ if isinstance(given, sb.models.Model) else "",
)
def test_each_broken_promise_is_found(model, line):
    assert any(re.match(rf"{type(model).__name__}\.{line}", one) for one in problems_of(model))


def test_isotropic_couples_make_no_claim_about_the_energy_because_the_spin_can_feed_it():
    class Claiming(sb.SlenderRolling):
        @property
        def balance(self):
            return sb.Slender(self.column).balance

    assert sb.SlenderRolling(COLUMN, couples="isotropic").balance is None
    (line,) = problems_of(Claiming(COLUMN, damping=0.3, couples="isotropic"))
    assert line.startswith("Claiming.energy: grows in free motion")


@dataclass(frozen=True, slots=True)
class Dragged(sb.Slender):
    """As the page on models teaches it."""

    drag: float = 0.0
    name: ClassVar[str] = "slender, dragged"

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
        return slender_rates(x, y, vx, vy, ax, ay, az, c, eta + k * math.hypot(vx, vy), kappa)

    @property
    def parameters(self):
        return self.column.slenderness, self.damping, self.column.inertia_ratio, self.drag

    @staticmethod
    def planar_rates(tilt, rate, side, horizontal, vertical, c, eta, kappa, k):
        return rate, (1.0 + vertical) * (tilt - c * side) - (eta + k * abs(rate)) * rate - horizontal


def test_inherited_contact_forces_are_refused_at_the_parameters_at_which_the_equations_differ():
    class Kept(Dragged):
        @staticmethod
        def contact(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
            return slender_contact(x, y, vx, vy, ax, ay, az, c, eta + k * math.hypot(vx, vy), kappa)

        balance = sb.Slender.balance

    sb.models.check(Kept(COLUMN, damping=0.1, drag=5.0))

    class Stale(Dragged):
        @staticmethod
        def planar_rates(tilt, rate, side, horizontal, vertical, c, eta, kappa, k):
            return rate, (1.0 + vertical) * (tilt - c * side) - eta * rate - horizontal

        contact = None

    check_once(Stale(COLUMN, damping=0.1, drag=0.0))
    # A term that is zero in the model at hand is met where an ensemble varies it.
    with pytest.raises(ModelError, match=r"^Stale\.planar_rates: does not agree with rates"):
        sb.simulate_ensemble(
            Stale(COLUMN, damping=0.1), tilt=(0.05, 0.0), duration=1.0, parameters={"drag": [0.0, 5.0]}
        )


def test_a_model_is_checked_once_for_its_parameters_and_quickly():
    def watched():
        calls = []

        class Watched(Whole):
            @staticmethod
            def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
                calls.append(k)
                return Sprung.rates(x, y, vx, vy, ax, ay, az, c, eta, kappa, k)

        return Watched, calls

    spent = []
    for _ in range(3):  # a busy computer can slow down one of them
        model, calls = watched()
        begun = time.process_time()
        check_once(model(COLUMN))
        spent.append(time.process_time() - begun)
    first = len(calls)
    check_once(model(COLUMN))
    assert 0 < first == len(calls) < 200
    assert min(spent) < 0.05
    check_once(model(COLUMN, damping=0.1))
    assert len(calls) > first


def test_a_function_that_raises_is_a_problem_of_a_check_and_left_to_the_run_otherwise():
    class Raising(sb.Slender):
        planar_rates = None

        @staticmethod
        def rest_energy(tilt, speed, vertical, c, *numbers):
            return 1.0 / 0.0

    model = Raising(COLUMN, damping=0.1)
    check_once(model)
    assert problems_of(model) == (
        "Raising.rest_energy: raises ZeroDivisionError at a random state (float division by zero).",
    )


def test_what_is_not_a_model_is_refused():
    with pytest.raises(ParameterError, match=r"^model: must be a model .* Pass an instance\.$"):
        sb.models.check(sb.Slender)
    assert issubclass(ModelError, ParameterError)
    assert np.isfinite(sb.Slender(COLUMN).balance.energy)


@pytest.mark.parametrize("numbers", [None, 5, (0.1, None), ("stiff",)])
def test_parameters_that_are_no_numbers_are_refused_in_one_line(numbers):
    vague = type("Vague", (sb.Slender,), {"parameters": property(lambda _: numbers)})(COLUMN)
    for use in (sb.models.check, check_once, lambda model: sb.simulate(model, tilt=(0.02, 0.0), duration=1.0)):
        with pytest.raises(ModelError, match=r"^Vague\.parameters: must be numbers \(got [^\n]*\)\. Return [^\n]*$"):
            use(vague)
