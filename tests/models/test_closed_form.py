"""The closed form of steady rolling that a model states is that of its own equations."""

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import UnsupportedError
from stylobate.models.model import RollingLaw, closed_form_of
from stylobate.orbits.finding import rolling_form_of, steady_rolling_of

COLUMN = sb.Column.dimensionless(slenderness=0.2)
NU, A0, ETA, ZETA = 1.8, 0.13, 0.1, 0.3
ROLLING = [
    (sb.Slender(COLUMN, damping=ETA), RollingLaw.SLENDER),
    (sb.SlenderRolling(COLUMN, damping=ETA, spin_damping=ZETA), RollingLaw.FREE_TWIST),
    (sb.Wobbling(COLUMN, damping=ETA), RollingLaw.WOBBLING),
    (sb.Wobbling(COLUMN, damping=ETA, constraint="rubber"), RollingLaw.FULL),
    (sb.Rolling(COLUMN, damping=ETA, spin_damping=ZETA), RollingLaw.FULL),
]


@pytest.mark.parametrize(("model", "law"), ROLLING)
def test_the_closed_form_solves_the_equations_of_the_model(model, law):
    form = rolling_form_of(model)
    assert form.law is law
    assert callable(getattr(sb.theory, law.value))
    tilt, phase, spin = steady_rolling_of(form, COLUMN, NU, A0)
    x, y = tilt * math.cos(phase), tilt * math.sin(phase)
    state = np.array(model.start((x, y), (0.0, 0.0)))
    state[2:4] = -NU * y, NU * x
    if model.spin_state is not None:
        state[model.spin_state] = spin
    found = model.rates(*state, A0, 0.0, 0.0, *model.parameters)
    # Steady rolling turns with the base: its acceleration is −ν² times the tilt, and the spin stays.
    np.testing.assert_allclose(found[2:4], (-(NU**2) * x, -(NU**2) * y), rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(found[4:], 0.0, rtol=0.0, atol=1e-9)


@dataclass(frozen=True, slots=True)
class Sprung(sb.Slender):
    """A slender column on a spring −kα: other equations."""

    stiffness: Annotated[float, sb.Quantity(symbol="k", text="stiffness", ge=0.0)] = 0.0
    contact = None

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa, k):
        vx, vy, fx, fy = sb.Slender.rates(x, y, vx, vy, ax, ay, az, c, eta, kappa)
        return vx, vy, fx - k * x, fy - k * y

    @property
    def parameters(self):
        return self.column.slenderness, self.damping, self.column.inertia_ratio, self.stiffness


@dataclass(frozen=True, slots=True)
class Named(sb.Slender):
    """The slender column by another name: the same equations."""

    name = "named"


class Stated(Sprung):
    """A model whose author claims that the closed form still holds."""

    closed_form = sb.Slender.closed_form


def test_a_subclass_that_replaces_the_equations_has_no_closed_form_unless_it_states_one():
    assert closed_form_of(Sprung(COLUMN, damping=ETA, stiffness=0.5)) is None
    assert closed_form_of(Named(COLUMN, damping=ETA)) == closed_form_of(sb.Slender(COLUMN, damping=ETA))
    assert closed_form_of(Stated(COLUMN, damping=ETA)) == closed_form_of(sb.Slender(COLUMN, damping=ETA))
    assert closed_form_of(sb.PlanarRocking(COLUMN)) is None
    assert rolling_form_of(sb.Sliding(COLUMN)) is None


@pytest.mark.parametrize(
    ("model", "name"),
    [
        (sb.Wobbling(COLUMN, rolling_resistance=0.01), "rolling_resistance"),
        (sb.Rolling(COLUMN, rolling_resistance=0.01), "rolling_resistance"),
        (sb.SlenderRolling(COLUMN, couples="isotropic"), "couples"),
        (sb.Sliding(COLUMN, incline=0.1), "incline"),
        (sb.Sliding(COLUMN, patch=0.1), "patch"),
    ],
)
def test_a_closed_form_names_the_number_that_keeps_it_from_holding(model, name):
    assert closed_form_of(model).requires[0] == name


@pytest.mark.parametrize(
    ("model", "motion", "message"),
    [
        (Sprung(COLUMN), "circular", "Sprung states no closed form of steady rolling for its equations"),
        (
            sb.Rolling(COLUMN, rolling_resistance=0.01),
            "circular",
            "rolling_resistance must be 0 for the closed form of steady rolling, got 0.01",
        ),
        (sb.Slender(COLUMN), "vertical", "under horizontal Harmonic motion only, got Harmonic"),
    ],
)
def test_a_search_for_an_orbit_says_why_it_needs_a_guess(model, motion, message):
    shaken = getattr(sb.Harmonic, motion)(acceleration=0.1, angular_frequency=2.0)
    with pytest.raises(UnsupportedError, match=f"^guess must be given, such as a run that has settled: .*{message}"):
        sb.orbits.periodic_orbit(model, shaken)
