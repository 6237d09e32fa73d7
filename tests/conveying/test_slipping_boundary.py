"""Where friction ends steady rolling, and where slip goes on: against closed forms, and runs of the whole model."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.conveying.slip_limits import RollingRegime
from stylobate.errors import ParameterError, UnsupportedError
from stylobate.theory import full_rolling, rolling_required_friction, slipping_rolling

C, ETA = 0.1, 0.1
COLUMN = sb.Column.dimensionless(slenderness=C)
HELD = sb.Wobbling(COLUMN, damping=ETA, constraint="rubber")
GENTLE, HARD = 0.065, 0.5
# Of a start beside steady rolling, and how near a run is that stayed, or how far one that left.
PERTURBED, NEAR, FAR = 1e-3, 2e-4, 0.05
# Runs last as many times as the slowest deviation needs to change by e.
_TIMES = 9.0


def circle(acceleration, frequency=1.0):
    return sb.Harmonic.circular(acceleration=acceleration, angular_frequency=frequency)


def sliding(zeta, mu=0.5):
    return sb.Sliding(COLUMN, friction_coefficient=mu, damping=ETA, spin_damping=zeta)


@pytest.fixture(scope="module")
def gentle():
    mu, frequency = [0.03, 0.04, 0.05, 0.1], np.linspace(0.5, 8.0, 46)
    return sb.conveying.slipping_boundary(HELD, circle(GENTLE), friction_coefficient=mu, angular_frequency=frequency)


@pytest.fixture(scope="module")
def hard():
    mu, frequency = [0.03, 0.05, 0.1], np.linspace(1.0, 8.0, 36)
    model, motion = sliding(1.0), circle(HARD)
    return sb.conveying.slipping_boundary(model, motion, friction_coefficient=mu, angular_frequency=frequency)


@pytest.mark.slow
def test_friction_leaves_where_stability_begins_and_ends_it_where_rolling_needs_more(gentle):
    np.testing.assert_allclose(gentle["rolling_from"], gentle["rolling_from"][0], rtol=1e-9)
    ends = gentle["rolling_to"].to_numpy()[:-1]
    assert np.all(np.diff(ends) > 0.0)
    # A slender column needs that, but for a part of the order c².
    needed = rolling_required_friction(ends, GENTLE, c=C, eta=ETA).upper
    np.testing.assert_allclose(needed, gentle["friction_coefficient"][:-1], rtol=C**2)
    exact = full_rolling(ends, GENTLE, c=C, eta=ETA, zeta=math.inf)
    np.testing.assert_allclose(exact.friction_demand[:, 1], gentle["friction_coefficient"][:-1], rtol=1e-7)
    assert gentle["rolling_to"][-1] == 8.0


@pytest.mark.slow
def test_no_slip_is_stable_on_a_gentle_base_and_slip_takes_over_on_a_hard_one(gentle, hard):
    assert gentle["slipping_from"].isnull().all()
    assert not gentle["slipping_stable"].any()
    assert (hard["steady_rolling"].sel(friction_coefficient=0.03) == RollingRegime.WITH_SLIP).any()
    # Slip begins where the rolling that was stable needs more than there is: nothing is lost there.
    takes_over = hard.sel(friction_coefficient=0.05)
    assert takes_over["slipping_to"] == pytest.approx(float(takes_over["rolling_from"]), rel=1e-3)
    assert np.isnan(hard["slipping_from"].sel(friction_coefficient=0.1))


def test_classes_are_told_by_what_exists_and_what_is_stable(gentle, hard):
    for found in (gentle, hard):
        classes = found["steady_rolling"]
        sticks = ~found["slips"] & found["rolling_amplitude"].notnull()
        rolls = (sticks & found["rolling_stable"]).any("branch")
        slides = found["slipping_stable"].any("slipping_branch")
        none = ~sticks.any("branch") & found["slipping_amplitude"].isnull().all("slipping_branch")
        np.testing.assert_array_equal(classes == RollingRegime.NONE, none)
        np.testing.assert_array_equal(rolls, classes.isin([RollingRegime.WITHOUT_SLIP, RollingRegime.BOTH]))
        np.testing.assert_array_equal(slides, classes.isin([RollingRegime.WITH_SLIP, RollingRegime.BOTH]))
        np.testing.assert_array_equal(found["slip_speed"] > 0.0, found["slipping_amplitude"].notnull())


def begun(found, branch, nu):
    """Return the start on a branch of theory, its tilt a part larger."""
    tilt = (1.0 + PERTURBED) * float(found.amplitude[branch])
    phase = float(found.phase[branch])
    d, n = (np.array([math.cos(phase + turn), math.sin(phase + turn)]) for turn in (0.0, 0.5 * math.pi))
    slip = np.zeros(2)
    if hasattr(found, "slip_along"):
        slip = float(found.slip_along[branch]) * d + float(found.slip_across[branch]) * n
    spin = float(found.spin[branch])
    return {"tilt": tilt * d, "tilt_rate": nu * tilt * n, "spin": spin, "velocity": (*slip, 0.0)}


def departure(zeta, mu, acceleration, nu, found, branch):
    """Return how far the tilt is from that of steady rolling in the end of a run begun beside it."""
    start, slowest = begun(found, branch, nu), float(found.eigenvalues[branch].real.max())
    run = sb.simulate(sliding(zeta, mu), circle(acceleration, nu), **start, duration=_TIMES / abs(slowest))
    end = float(run.data["time"][-1])
    last = run.sample(np.linspace(0.9 * end, end, 100))["amplitude"].to_numpy()
    return np.abs(last / float(found.amplitude[branch]) - 1.0).max()


@pytest.mark.parametrize(("mu", "nu"), [(0.03, 3.0), (0.05, 3.0), (0.05, 4.6)])
def test_runs_stay_at_stable_slip_and_leave_the_unstable_one(hard, mu, nu):
    found = slipping_rolling(nu, HARD, mu=mu, c=C, eta=ETA, zeta=1.0)
    assert hard["steady_rolling"].sel(friction_coefficient=mu, angular_frequency=nu) == RollingRegime.WITH_SLIP
    saddle, node = 0, 1
    assert departure(1.0, mu, HARD, nu, found, node) < NEAR
    assert departure(1.0, mu, HARD, nu, found, saddle) > FAR


@pytest.mark.slow
@pytest.mark.parametrize(("zeta", "acceleration", "mu"), [(0.1, GENTLE, 0.07), (1.0, HARD, 0.05)])
def test_runs_stay_at_rolling_without_slip_as_far_as_its_border(zeta, acceleration, mu):
    found = sb.conveying.slipping_boundary(
        sliding(zeta), circle(acceleration), friction_coefficient=[mu], angular_frequency=np.linspace(0.5, 8.0, 16)
    )
    slips_to = found["slipping_to"].item()
    edge = slips_to if acceleration == HARD else found["rolling_to"].item()
    outwards = -1.0 if acceleration == HARD else 1.0  # in which sense friction ends it
    for side in (-1.0, 1.0):
        nu = edge * (1.0 + 0.03 * side * outwards)
        steady = full_rolling(nu, acceleration, c=C, eta=ETA, zeta=zeta)
        branch = int(steady.exists.sum()) - 1
        left = departure(zeta, mu, acceleration, nu, steady, branch)
        if side < 0.0:
            assert left < NEAR
        elif acceleration == GENTLE:
            assert left > FAR
        else:  # it comes to roll with slip, beside
            slipping = slipping_rolling(nu, HARD, mu=mu, c=C, eta=ETA, zeta=zeta)
            beside = slipping.amplitude[-1] / steady.amplitude[branch] - 1.0
            assert left == pytest.approx(abs(beside), rel=0.01)


def test_its_figure_draws_stable_parts_bold_and_marks_where_friction_ends_rolling(gentle):
    tilt, plane = sb.plot(gentle).axes[:2]
    marks = [line for line in tilt.lines if line.get_marker() not in ("None", "") and len(line.get_xdata()) == 1]
    at = sorted(float(line.get_xdata()[0]) for line in marks)
    np.testing.assert_allclose(at, gentle["rolling_to"].to_numpy()[:-1], rtol=1e-2)
    assert plane.get_xlabel() == r"base frequency $\Omega/\omega_0$"
    dashed = [line for line in tilt.lines if line.get_linestyle() == "--" and np.isfinite(line.get_ydata()).any()]
    assert dashed
    assert max(line.get_linewidth() for line in dashed) < 1.0


@pytest.mark.parametrize(
    ("change", "error", "told"),
    [
        ({"model": sb.Slender(COLUMN, damping=ETA)}, UnsupportedError, "got model slender"),
        ({"model": sb.Wobbling(COLUMN, damping=ETA)}, UnsupportedError, "got model wobbling"),
        ({"model": sb.Sliding(COLUMN, damping=ETA, spin_damping=0.1, patch=0.1)}, UnsupportedError, "patch must be 0"),
        ({"model": sb.Sliding(COLUMN, damping=ETA)}, ParameterError, "spin_damping must be above zero"),
        ({"motion": sb.Harmonic.straight(acceleration=0.1, angular_frequency=1.0)}, UnsupportedError, "circular"),
        ({"friction_coefficient": [0.1, 0.05]}, ParameterError, "rising"),
        ({"angular_frequency": [2.0, 1.0]}, ParameterError, "rise"),
    ],
)
def test_bad_questions_are_told(change, error, told):
    asked = {"model": HELD, "motion": circle(GENTLE), "friction_coefficient": [0.05], "angular_frequency": [1.0, 2.0]}
    with pytest.raises(error, match=told):
        sb.conveying.slipping_boundary(**(asked | change))
