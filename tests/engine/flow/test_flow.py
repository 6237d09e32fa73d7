"""The flow over a period with its derivatives: against differences, Liouville's formula, other integrators."""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions.base import ACCELERATION
from stylobate.engine.flow.integration import FlowStatus
from stylobate.engine.flow.periodic import PeriodicSystem, plane_of
from stylobate.errors import UnsupportedError

C, ETA = 0.1, 0.1
MODEL = sb.Slender(sb.Column.dimensionless(C), damping=ETA)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
ELLIPSE = sb.Harmonic(amplitude=(0.08, 0.04, 0.2), phase=(0.3, -1.2, 0.7), angular_frequency=2.2, start_phase=0.4)
STRAIGHT = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0, direction=0.4)
LINE = (math.cos(0.4), math.sin(0.4))
# Rolling through a turn; passing the upright twice in a turn.
IN_SPACE = np.array([0.03, 0.01, -0.02, 0.05])
IN_PLANE = np.array([0.02, 0.01])
SYSTEMS = [
    pytest.param(PeriodicSystem(MODEL, ELLIPSE), IN_SPACE, id="space"),
    pytest.param(PeriodicSystem(MODEL, STRAIGHT, LINE), IN_PLANE, id="plane"),
]
RTOL = 1e-12
# Errors of a flow at this tolerance: local ones add up over tens of steps and grow by as much as the derivatives.
GLOBAL = 100.0 * RTOL


def central(function, at, step):
    """Return the derivative by five points: errors of step⁴ and of rounding over step."""
    return (function(at - 2 * step) - 8 * function(at - step) + 8 * function(at + step) - function(at + 2 * step)) / (
        12.0 * step
    )


@pytest.mark.parametrize(("system", "state"), SYSTEMS)
def test_derivatives_by_the_start_equal_differences_of_the_flow(system, state):
    flow = system.carry(state, 0.0, 1.0)
    assert flow.status is FlowStatus.DONE
    step = 1e-3 * C
    for j, unit in enumerate(np.eye(system.order)):
        found = central(lambda h, unit=unit: system.carry(state + h * unit, 0.0, 1.0).end, 0.0, step)
        # Truncation falls with the step's fourth power: what is left at half of it tells how much there is.
        finer = central(lambda h, unit=unit: system.carry(state + h * unit, 0.0, 1.0).end, 0.0, 0.5 * step)
        error = np.abs(found - finer).max() / 15.0 + GLOBAL * C / step
        assert error < 1e-4 * np.abs(flow.by_start).max()
        np.testing.assert_allclose(flow.by_start[:, j], finer, rtol=0.0, atol=2.0 * error)


@pytest.mark.parametrize("turns", [0.37, 1.0, 1.6])
@pytest.mark.parametrize(("system", "state"), SYSTEMS)
def test_volumes_shrink_as_liouville_says(system, state, turns):
    """det = exp(∫ tr J): −2η in space, −η in a plane, where passing the upright leaves areas as they are."""
    flow = system.carry(state, 0.2, 0.2 + turns)
    assert flow.status is FlowStatus.DONE
    trace = -ETA * system.order / 2.0
    expected = math.exp(trace * turns * system.numbers.period)
    # δ ln det = tr(M⁻¹ δM)
    sensitivity = np.linalg.cond(flow.by_start)
    assert np.linalg.det(flow.by_start) == pytest.approx(expected, rel=GLOBAL * sensitivity)
    assert GLOBAL * sensitivity < 1e-3


@pytest.mark.parametrize(("system", "state"), SYSTEMS)
def test_derivatives_follow_the_chain_rule(system, state):
    whole, first = system.carry(state, 0.0, 1.0), system.carry(state, 0.0, 0.45)
    second = system.carry(first.end, 0.45, 1.0, side=first.side)
    size = np.abs(second.by_start).max() * np.abs(first.by_start).max()
    np.testing.assert_allclose(second.end, whole.end, rtol=0.0, atol=GLOBAL * C)
    np.testing.assert_allclose(second.by_start @ first.by_start, whole.by_start, rtol=0.0, atol=GLOBAL * size)
    assert whole.minimum_tilt <= min(first.minimum_tilt, second.minimum_tilt) * (1.0 + 1e-3)


NAMES = [
    "angular_frequency",
    "start_phase",
    "amplitude_x",
    "amplitude_y",
    "amplitude_z",
    "phase_difference",
    "acceleration",
    "rotation",
    "scale",
    "damping",
    "slenderness",
    "gravity",
]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize(("system", "state"), SYSTEMS)
def test_derivatives_by_a_parameter_equal_differences_of_the_flow(system, state, name):
    if system.planar and name in ("amplitude_x", "amplitude_y", "phase_difference", "rotation"):
        pytest.skip("turns the motion out of the plane")
    flow = system.carry(state, 0.0, 1.0, change=system.derivative(name))
    at = system.value_of(name)
    step = 1e-3 * (abs(at) or 1.0)

    def end(value):
        return system.changed(**{name: value}).carry(state, 0.0, 1.0).end

    coarse, fine = central(end, at, step), central(end, at, 0.5 * step)
    # The derivatives of the numbers by the parameter are right to 1e-11, see below.
    error = np.abs(coarse - fine).max() / 15.0 + GLOBAL * C / step + 1e-10 * np.abs(fine).max()
    assert error < 1e-4 * np.abs(fine).max()
    np.testing.assert_allclose(flow.by_parameter, fine, rtol=0.0, atol=2.0 * error)


@pytest.mark.parametrize("phase", [0.0, 1e-10, -1e-6, 1e-3, -1.5, 40.5])
def test_derivatives_of_the_terms_by_angles_equal_closed_forms(phase):
    motion = sb.Harmonic.elliptic(amplitude=(0.08, 0.04), phase=phase, angular_frequency=2.0)
    change = PeriodicSystem(MODEL, motion).derivative("phase_difference")
    # a2 cos(s + φ): coefficients a2 cos φ and −a2 sin φ.
    expected = [1.0, 0.0, 0.0, -0.04 * math.sin(phase), -0.04 * math.cos(phase), 0.0, 0.0]
    np.testing.assert_allclose(change.terms, [expected], rtol=0.0, atol=1e-11)
    assert change.period == pytest.approx(0.0, abs=1e-10)


def test_derivatives_of_period_and_numbers_equal_closed_forms():
    system = PeriodicSystem(MODEL, CIRCLE)
    assert system.derivative("angular_frequency").period == pytest.approx(-2.0 * math.pi / 1.8**2, rel=1e-11)
    np.testing.assert_allclose(system.derivative("damping").parameters, [0.0, 1.0, 0.0], atol=1e-11)
    np.testing.assert_allclose(system.derivative("slenderness").parameters, [1.0, 0.0, 0.0], atol=1e-11)
    np.testing.assert_allclose(
        system.derivative("acceleration").terms[:, 1:], system.numbers.terms[:, 1:] / 0.065, atol=1e-11
    )


def test_without_friction_there_is_a_derivative_by_friction():
    system = PeriodicSystem(replace(MODEL, damping=0.0), CIRCLE)
    np.testing.assert_allclose(system.derivative("damping").parameters, [0.0, 1.0, 0.0], atol=1e-11)


@pytest.mark.parametrize("begin", [0.0, 0.3])
def test_the_flow_ends_where_simulate_ends(begin):
    state = IN_SPACE
    system = PeriodicSystem(MODEL, ELLIPSE)
    flow = system.carry(state, begin, begin + 1.5)
    shifted = replace(ELLIPSE, start_phase=ELLIPSE.start_phase + 2.0 * math.pi * begin)
    run = sb.simulate(
        MODEL, shifted, tilt=state[:2], tilt_rate=state[2:], duration=1.5 * system.numbers.period, rtol=RTOL
    )
    end = run.data.isel(time=-1)
    found = np.concatenate([end["tilt"], end["tilt_rate"]])
    # Both integrate with this tolerance.
    np.testing.assert_allclose(flow.end, found, rtol=0.0, atol=2.0 * GLOBAL * np.abs(flow.by_start).max() * C)


def test_the_flow_in_a_plane_ends_where_simulate_ends():
    system = PeriodicSystem(MODEL, STRAIGHT, LINE)
    flow = system.carry(IN_PLANE, 0.0, 2.0)
    assert flow.minimum_tilt == 0.0
    tilt, rate = (number * np.array(LINE) for number in IN_PLANE)
    run = sb.simulate(MODEL, STRAIGHT, tilt=tilt, tilt_rate=rate, duration=2.0 * system.numbers.period, rtol=RTOL)
    assert run.planar
    end = run.data.isel(time=-1)
    found = np.array([end["tilt"].to_numpy() @ LINE, end["tilt_rate"].to_numpy() @ LINE])
    np.testing.assert_allclose(flow.end, found, rtol=0.0, atol=2.0 * GLOBAL * np.abs(flow.by_start).max() * C)


@pytest.mark.parametrize("c", [1.0, 0.1])
def test_the_published_integration_is_met(c):
    """η = 0 in units of c: (0.5, 0.2, 0.1, 0.35) under (0.9 cos 1.7τ, 0.7 cos(1.7τ + 0.9)) until τ = 3, to 1e-11."""
    model = sb.Slender(sb.Column.dimensionless(c))
    motion = sb.Harmonic.elliptic(amplitude=(0.9 * c, 0.7 * c), phase=0.9, angular_frequency=1.7)
    system = PeriodicSystem(model, motion)
    flow = system.carry(c * np.array([0.5, 0.2, 0.1, 0.35]), 0.0, 3.0 * 1.7 / (2.0 * math.pi), peak_tilt=math.inf)
    expected = [0.033153473664, 0.6700240983541, 0.507152125059, -0.2563540126826]
    np.testing.assert_allclose(flow.end / c, expected, rtol=0.0, atol=1e-11)


def test_the_error_falls_with_the_tolerance():
    def end(rtol):
        return PeriodicSystem(MODEL, ELLIPSE, rtol=rtol).carry(IN_SPACE, 0.0, 1.0).end

    errors = [np.abs(end(rtol) - end(1e-13)).max() for rtol in (1e-6, 1e-8, 1e-10)]
    # DOP853 holds errors per step: two decades of the tolerance give at least one and a half.
    assert errors[0] < 1e-4 * C
    assert errors[1] < errors[0] * 10**-1.5
    assert errors[2] < errors[1] * 10**-1.5


def test_tilts_met_are_those_of_a_dense_run():
    """Between steps tilts are told by cubics, within (an eighth of a turn)⁴ of their change."""
    for system, state in ((p.values[0], p.values[1]) for p in SYSTEMS):
        flow = system.carry(state, 0.0, 1.0)
        here, tilts = state, []
        side = 0.0
        for k in range(2000):
            part = system.carry(here, k / 2000, (k + 1) / 2000, side=side)
            here, side = part.end, part.side if system.planar else 0.0
            tilts.append(np.hypot(*here[:2]) if not system.planar else abs(here[0]))
        assert flow.peak_tilt == pytest.approx(max(tilts), rel=1e-3)
        assert flow.minimum_tilt <= min(tilts) * (1.0 + 1e-3)


def test_a_run_through_the_upright_is_lost():
    system = PeriodicSystem(MODEL, STRAIGHT)
    flow = system.carry(np.array([0.02 * LINE[0], 0.02 * LINE[1], 0.0, 0.0]), 0.0, 1.0)
    assert flow.status is FlowStatus.LOST
    assert flow.minimum_tilt < 1e-6 * C


def test_a_run_that_never_returns_is_gone():
    system = PeriodicSystem(MODEL, CIRCLE)
    assert system.safe_tilt == pytest.approx(C + 0.065, rel=1e-14)
    flow = system.carry(np.array([0.16, 0.0, 0.05, 0.0]), 0.0, 1.0)
    assert flow.status is FlowStatus.GONE
    assert flow.peak_tilt > system.safe_tilt
    allowed = system.carry(np.array([0.16, 0.0, 0.05, 0.0]), 0.0, 0.1, peak_tilt=10.0)
    assert allowed.status is FlowStatus.DONE
    planar = PeriodicSystem(MODEL, STRAIGHT, LINE)
    assert planar.carry(np.array([0.3, 0.1]), 0.0, 1.0).status is FlowStatus.GONE


# Base motions of a user's own.


@dataclass(frozen=True)
class Wave(sb.BaseMotion):
    """a (cos(Ωt + φ), ε exp(sin Ωt), 0): smooth, not a sum of Harmonic motions."""

    acceleration_x: float
    angular_frequency: float
    shape: float = 0.0

    def derivative(self, time, order):
        angle = self.angular_frequency * np.asarray(time, dtype=float)
        if order != ACCELERATION:
            return angle * 0.0, angle * 0.0, angle * 0.0
        return self.acceleration_x * np.cos(angle + 0.3), self.shape * np.exp(np.sin(angle)), angle * 0.0

    def peak_horizontal(self, since=0.0):
        return math.hypot(self.acceleration_x, math.e * self.shape)

    def vertical_range(self, since=0.0):
        return 0.0, 0.0

    def directions(self):
        return ((self.acceleration_x, 0.0), (0.0, self.shape)) if self.shape else ((self.acceleration_x, 0.0),)

    @property
    def period(self):
        return 2.0 * math.pi / self.angular_frequency

    @property
    def highest_frequency(self):
        return 4.0 * self.angular_frequency


@dataclass(frozen=True)
class Jerky(Wave):
    """The same with corners, at which nobody said that it breaks."""

    def derivative(self, time, order):
        x, y, z = super().derivative(time, order)
        return np.abs(x), y, z


def test_a_motion_of_a_users_own_equals_the_harmonic_one_that_it_imitates():
    imitated = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0, start_phase=0.3)
    own, usual = PeriodicSystem(MODEL, Wave(0.13, 3.0)), PeriodicSystem(MODEL, imitated)
    flow, expected = own.carry(IN_SPACE, 0.0, 1.0), usual.carry(IN_SPACE, 0.0, 1.0)
    # Rounding of the Fourier transform: a few hundred terms of 1e-16.
    np.testing.assert_allclose(flow.end, expected.end, rtol=0.0, atol=GLOBAL * C)
    np.testing.assert_allclose(flow.by_start, expected.by_start, rtol=0.0, atol=GLOBAL * 10.0)


def test_the_orbit_of_a_motion_of_a_users_own_is_that_of_simulate():
    motion = Wave(0.05, 2.0, shape=0.01)
    orbit = sb.orbits.periodic_orbit(MODEL, motion, guess=[0.02, 0.0, 0.0, 0.04])
    run = sb.simulate(
        MODEL, motion, tilt=orbit.tilt, tilt_rate=orbit.tilt_rate, duration=3.0 * orbit.period, rtol=1e-11
    )
    end = run.data.isel(time=-1)
    np.testing.assert_allclose(end["tilt"], orbit.tilt, rtol=0.0, atol=1e-9 * C)
    np.testing.assert_allclose(end["tilt_rate"], orbit.tilt_rate, rtol=0.0, atol=1e-9 * C)


def test_motions_that_add_up_are_taken_with_their_common_period():
    motion = sb.Harmonic.straight(acceleration=0.05, angular_frequency=2.0) + sb.Harmonic.vertical(
        acceleration=0.1, angular_frequency=3.0
    )
    system = PeriodicSystem(MODEL, motion)
    assert system.numbers.period == pytest.approx(2.0 * math.pi, rel=1e-14)
    assert sorted(system.numbers.terms[:, 0]) == [2.0, 3.0]
    flow = system.carry(IN_SPACE, 0.0, 1.0)
    run = sb.simulate(
        MODEL, motion, tilt=IN_SPACE[:2], tilt_rate=IN_SPACE[2:], duration=system.numbers.period, rtol=RTOL
    )
    np.testing.assert_allclose(
        flow.end[:2], run.data["tilt"].isel(time=-1), atol=2.0 * GLOBAL * np.abs(flow.by_start).max() * C
    )


@pytest.mark.parametrize(
    "motion",
    [
        replace(CIRCLE, ramp=3.0),
        CIRCLE.delayed(1.0),
        CIRCLE + sb.Harmonic.straight(acceleration=0.1, angular_frequency=1.8 * math.sqrt(2.0)),
        CIRCLE + sb.Harmonic.straight(acceleration=0.1, angular_frequency=1.8).delayed(0.5),
        Jerky(0.13, 3.0),
    ],
    ids=["ramp", "delay", "no period", "part delayed", "corners"],
)
def test_motions_that_are_not_periodic_and_smooth_are_refused_in_one_line(motion):
    with pytest.raises(UnsupportedError, match="periodic orbits need") as told:
        PeriodicSystem(MODEL, motion)
    assert "\n" not in str(told.value)


def test_the_plane_of_a_motion_is_found():
    along = np.array([0.02 * LINE[0], 0.02 * LINE[1], 0.1 * LINE[0], 0.1 * LINE[1]])
    found = plane_of(MODEL, STRAIGHT, along)
    assert found is not None
    assert abs(found[0] * LINE[1] - found[1] * LINE[0]) < 1e-15
    assert plane_of(MODEL, STRAIGHT, along + np.array([1e-6, 0.0, 0.0, 0.0])) is None
    assert plane_of(MODEL, CIRCLE, along) is None


def test_units_do_not_matter():
    """A stone column in SI units does what the dimensionless one does."""
    stone = sb.Column.solid(radius=0.5, height=10.0, density=2700.0)
    model = sb.Slender(stone, damping=ETA)
    scale, gravity = stone.frequency_scale, stone.gravity
    si = sb.Harmonic.circular(acceleration=0.065 * gravity, angular_frequency=1.8 * scale)
    ours = PeriodicSystem(model, si)
    plain = PeriodicSystem(sb.Slender(sb.Column.dimensionless(stone.slenderness), damping=ETA), CIRCLE)
    np.testing.assert_allclose(ours.numbers.terms, plain.numbers.terms, rtol=1e-14, atol=1e-17)
    flow, expected = ours.carry(IN_SPACE, 0.0, 1.0), plain.carry(IN_SPACE, 0.0, 1.0)
    np.testing.assert_allclose(flow.end, expected.end, rtol=0.0, atol=GLOBAL * C)


@pytest.mark.parametrize("broken", [math.nan, math.inf])
def test_a_state_that_is_no_number_fails(broken):
    system = PeriodicSystem(MODEL, CIRCLE)
    assert system.carry(np.array([broken, 0.0, 0.0, 0.0]), 0.0, 1.0).status is FlowStatus.FAILED


class LossyByItsSpeed(sb.Slender):
    """The slender column that loses more of a faster passage: e = 0.9 − 2 |v|."""

    name = "lossy by its speed"

    @property
    def loss_tilt(self):
        return 1e-4

    @staticmethod
    def impact_map(x, y, vx, vy, _c, _eta, _kappa):
        left = 0.9 - 2.0 * math.sqrt(vx * vx + vy * vy)
        return x, y, left * vx, left * vy


def test_a_loss_that_is_not_proportional_to_the_speed_has_right_derivatives():
    system = PeriodicSystem(LossyByItsSpeed(MODEL.column, damping=ETA), STRAIGHT, LINE)
    flow = system.carry(IN_PLANE, 0.0, 1.0)
    assert flow.status is FlowStatus.DONE
    assert flow.minimum_tilt == 0.0
    for j, unit in enumerate(np.eye(2)):
        found = central(lambda h, unit=unit: system.carry(IN_PLANE + h * unit, 0.0, 1.0).end, 0.0, 1e-5)
        np.testing.assert_allclose(flow.by_start[:, j], found, rtol=1e-5, atol=1e-6 * np.abs(flow.by_start).max())


class WithNumPy(sb.Slender):
    """The slender column with an array in its equations."""

    name = "with NumPy"

    @staticmethod
    def rates(x, y, vx, vy, ax, ay, az, c, eta, kappa):
        lean = float(np.linalg.norm(np.array([x, y])))
        return vx, vy, x - c * x / lean - eta * vx - ax, y - c * y / lean - eta * vy - ay


def test_equations_with_arrays_are_refused_by_what_to_write():
    with pytest.raises(UnsupportedError, match=r"cannot be differentiated: .*functions of math"):
        PeriodicSystem(WithNumPy(MODEL.column), CIRCLE).carry(IN_SPACE, 0.0, 1.0)
