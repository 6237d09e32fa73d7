"""Lyapunov exponents: those of orbits are their multipliers', their sum is the rate at which volumes shrink."""

import re

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import EndedEarlyWarning, ParameterError, UnsupportedError

ETA = 0.1
MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=ETA)
RTOL = 1e-10


def straight(frequency):
    return sb.Harmonic.straight(acceleration=0.13, angular_frequency=frequency)


def circular(frequency):
    return sb.Harmonic.circular(acceleration=0.065, angular_frequency=frequency)


def exponents_on(orbit, **options):
    return sb.studies.lyapunov_exponents(
        orbit.model, orbit.motion, tilt=orbit.tilt, tilt_rate=orbit.tilt_rate, **options
    )


def test_of_an_orbit_they_are_the_logarithms_of_its_multipliers_over_its_period():
    # Just above the pitchfork at 1.6205 two multipliers are real.
    orbit = sb.orbits.periodic_orbit(MODEL, straight(1.622))
    expected = np.sort(np.log(np.abs(orbit.multipliers)))[::-1]
    real = np.abs(np.imag(orbit.multipliers)) == 0.0
    assert real.sum() == 2
    found = exponents_on(orbit, periods=400, skip=200)
    errors = np.abs(found["per_period"].values - expected)
    # Those of real multipliers that stand alone are right to the tolerance of the flow, some ten steps a period.
    alone = np.isin(expected, np.log(np.abs(orbit.multipliers[real])))
    assert (errors[alone] < 1e3 * RTOL).all()
    assert (errors <= found["per_period_error"].values + 1e3 * RTOL).all()
    np.testing.assert_allclose(found["lyapunov_exponent"], found["per_period"] / orbit.motion.period, rtol=1e-14)


@pytest.mark.parametrize("motion", [circular(1.8), straight(2.5)])
def test_the_sums_of_complex_pairs_settle_as_one_over_the_periods(motion):
    orbit = sb.orbits.periodic_orbit(MODEL, motion)
    expected = np.sort(np.log(np.abs(orbit.multipliers)))[::-1]
    for periods in (100, 1000):
        found = exponents_on(orbit, periods=periods, skip=0)
        errors = np.abs(found["per_period"].values - expected)
        # A direction that turns is stretched by no more than the condition of the eigenvectors, here below e⁴.
        assert (errors < 4.0 / periods).all()
        assert (errors <= found["per_period_error"].values).all()


@pytest.mark.parametrize("motion", [circular(1.8), circular(1.36), straight(2.5)])
def test_they_sum_to_minus_twice_the_friction(motion):
    start = sb.studies.steady_start(MODEL, motion)
    found = sb.studies.lyapunov_exponents(MODEL, motion, **start, periods=50, skip=0)
    # Liouville: the divergence of (1) is −2η everywhere. Errors of rtol of a step in each of 40 steps a period.
    assert float(found["lyapunov_exponent"].sum()) == pytest.approx(-2.0 * ETA, abs=40.0 * RTOL)


def test_they_are_in_seconds_of_the_column():
    column = sb.Column.solid(radius=0.5, height=10.0, density=2700.0)
    model = sb.Slender(column, damping=ETA)
    motion = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.2)
    found = sb.studies.lyapunov_exponents(model, motion, **sb.studies.steady_start(model, motion), periods=20)
    assert float(found["lyapunov_exponent"].sum()) == pytest.approx(-2.0 * ETA * column.frequency_scale, rel=1e-7)
    assert found["lyapunov_exponent"].attrs["units"] == "s-1"


def test_in_a_plane_they_sum_to_minus_the_friction():
    found = sb.studies.lyapunov_exponents(MODEL, straight(3.0), tilt=(0.02, 0.0), periods=100, skip=20)
    assert found.sizes["exponent"] == 2
    assert found.attrs["planar"] == 1
    # Crossing the upright the rate is kept and the acceleration jumps: areas are kept.
    assert float(found["lyapunov_exponent"].sum()) == pytest.approx(-ETA, abs=1e-7)


def test_modulated_rolling_has_one_exponent_zero_and_the_others_negative():
    motion = circular(1.36)
    start = sb.studies.steady_start(MODEL, motion)
    tilt = 1.01 * np.array(start["tilt"])
    found = sb.studies.lyapunov_exponents(
        MODEL, motion, tilt=tilt, tilt_rate=start["tilt_rate"], periods=1000, skip=300
    )
    value, error = found["lyapunov_exponent"].values, found["error"].values
    # Along the limit cycle of (7) nothing grows in the mean.
    assert abs(value[0]) < error[0] < 1e-3
    assert (value[1:] < -10.0 * error[1:]).all()
    # The period's mean is the last of the running ones.
    np.testing.assert_allclose(found["running"].values[-1], value, rtol=1e-9, atol=1e-12)


def test_the_largest_is_the_first_of_all():
    motion = circular(1.36)
    start = sb.studies.steady_start(MODEL, motion)
    one, every = (
        sb.studies.lyapunov_exponents(MODEL, motion, **start, periods=50, skip=10, count=count) for count in (1, None)
    )
    assert one.sizes["exponent"] == 1
    np.testing.assert_allclose(one["lyapunov_exponent"], every["lyapunov_exponent"][:1], rtol=1e-9)


def test_on_the_unstable_steady_rolling_the_largest_is_the_real_part_of_its_eigenvalue():
    # Short enough for the motion to stay there: errors of 1e-12 grow by e^0.66 in each of 15 periods.
    orbit = sb.orbits.periodic_orbit(MODEL, circular(1.36))
    steady = sb.theory.steady_rolling(1.36, 0.065, c=0.1, eta=ETA).upper
    found = exponents_on(orbit, periods=15, skip=0, rtol=1e-12)
    assert found["lyapunov_exponent"].values[0] == pytest.approx(
        np.real(steady.eigenvalues).max(), abs=found["error"].values[0]
    )
    assert found["lyapunov_exponent"].values[0] > 0.0


def test_a_motion_that_overturns_tells_so_and_has_none():
    with pytest.warns(EndedEarlyWarning, match="overturned between t = .* exponents are NaN") as caught:
        found = sb.studies.lyapunov_exponents(MODEL, circular(0.9), tilt=(0.08, 0.0), periods=50, skip=0)
    start, end = map(float, re.findall(r"[\d.]+(?= s)", str(caught[0].message)))
    run = sb.simulate(MODEL, circular(0.9), tilt=(0.08, 0.0), duration=50.0 * circular(0.9).period)
    assert 0.999 * start < run.decided_at  # the column is past its point of no return before it falls
    assert end - start == pytest.approx(circular(0.9).period, rel=1e-3)
    assert found.attrs["ending"] == "overturned"
    assert found["periods_counted"] < 50
    assert found["lyapunov_exponent"].isnull().all()
    assert found.sizes["period"] == found["periods_counted"]


def test_what_cannot_be_is_refused():
    given = {"tilt": (0.03, 0.0), "periods": 20}
    with pytest.raises(ParameterError, match="count must be at most 4"):
        sb.studies.lyapunov_exponents(MODEL, circular(1.8), **given, count=5)
    with pytest.raises(ParameterError, match="periods must be a whole number of at least 30"):
        sb.studies.lyapunov_exponents(MODEL, circular(1.8), **given, blocks=30)
    with pytest.raises(ParameterError, match="tilt must have 2 numbers"):
        sb.studies.lyapunov_exponents(MODEL, circular(1.8), tilt=(0.1, 0.0, 0.0))
    ramped = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8, ramp=3.0)
    with pytest.raises(UnsupportedError, match="without ramp"):
        sb.studies.lyapunov_exponents(MODEL, ramped, tilt=(0.03, 0.0))
