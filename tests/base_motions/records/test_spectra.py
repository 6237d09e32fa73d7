"""Response spectra against independent integration."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate.base_motions.oscillator import oscillator_response
from stylobate.errors import ParameterError
from stylobate.records import response_spectra
from stylobate.records.intensities import over_directions

STEP = 0.02
SAMPLES = np.random.default_rng(11).normal(size=(101, 2))
RECORD = sb.Record(samples=SAMPLES, step=STEP)
PERIODS = [0.05, 0.4, 3.0]


def integrated(axis, period, damping, end, count):
    """Return d and ḋ at times from an independent integrator, knot by knot."""
    omega = 2.0 * math.pi / period
    times, states, state = [0.0], [np.zeros(2)], np.zeros(2)
    knots = [*RECORD.times, end] if end > RECORD.duration else RECORD.times
    for begin, stop in pairwise(knots):
        middle = 0.5 * (begin + stop)
        low, high = (float(RECORD.derivative(t, 2)[axis]) for t in (0.5 * (begin + middle), 0.5 * (stop + middle)))
        slope = (high - low) / (0.5 * (stop - begin))

        def rates(t, y, low=low, slope=slope, at=0.5 * (begin + middle)):
            return [y[1], -2.0 * damping * omega * y[1] - omega**2 * y[0] - (low + slope * (t - at))]

        leg = solve_ivp(
            rates, (begin, stop), state, method="DOP853", rtol=1e-11, atol=1e-14, t_eval=np.linspace(begin, stop, count)
        )
        state = leg.y[:, -1]
        times += leg.t[1:].tolist()
        states += leg.y.T[1:].tolist()
    return np.array(times), np.array(states)


@pytest.mark.parametrize("period", PERIODS)
@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_the_oscillator_is_that_of_an_independent_integration(period, damping):
    d, v = oscillator_response(SAMPLES[:, 0], STEP, period, damping)
    _, states = integrated(0, period, damping, RECORD.duration, 2)
    omega = 2.0 * math.pi / period
    scale = np.abs(states).max(axis=0)
    np.testing.assert_allclose(d, states[:, 0], rtol=0.0, atol=1e-8 * scale[0])
    np.testing.assert_allclose(v, states[:, 1], rtol=0.0, atol=1e-8 * scale[1] * max(1.0, omega * STEP))


@pytest.mark.parametrize("period", PERIODS)
def test_a_spectrum_is_the_largest_response_the_swing_afterwards_included(period):
    spectra = response_spectra(RECORD, [period], damping=0.02)
    _, states = integrated(1, period, 0.02, RECORD.duration + period, 400)
    sd, sv = np.abs(states).max(axis=0)
    assert float(spectra.sd.sel(axis="y")[0]) == pytest.approx(sd, rel=5e-4)
    assert float(spectra.sv.sel(axis="y")[0]) == pytest.approx(sv, rel=5e-4)
    assert float(spectra.psa.sel(axis="y")[0]) == pytest.approx((2.0 * math.pi / period) ** 2 * sd, rel=5e-4)


def test_a_stiff_oscillator_follows_the_ground_and_a_soft_one_stays_behind():
    smooth = sb.Record(samples=np.sin(np.linspace(0.0, np.pi, 201)) ** 2, step=0.01)
    stiff = response_spectra(smooth, [0.02])
    assert float(stiff.psa[0, 0]) == pytest.approx(1.0, rel=1e-3)
    soft = response_spectra(smooth, [400.0])
    # d = −(ground displacement) while the spring does not act; at most the swing from the velocity that remains
    assert float(soft.sv[0, 0]) == pytest.approx(float(smooth.residual_velocity[0]), rel=0.02)


def test_rotd_is_ordered_and_does_not_depend_on_the_orientation():
    spectra = response_spectra(RECORD, PERIODS)
    turned = response_spectra(RECORD.rotated(math.radians(37.0)), PERIODS)
    assert np.all(spectra.rotd00 <= spectra.rotd50)
    assert np.all(spectra.rotd50 <= spectra.rotd100)
    assert np.all(spectra.psa <= spectra.rotd100 * (1.0 + 1e-12))
    assert np.all(spectra.psa >= spectra.rotd00 * (1.0 - 1e-12))
    for name in ("rotd00", "rotd50", "rotd100"):
        np.testing.assert_allclose(turned[name], spectra[name], rtol=1e-9)
    expected = np.sqrt(spectra.psa.sel(axis="x") * spectra.psa.sel(axis="y"))
    np.testing.assert_allclose(spectra.geometric_mean, expected, rtol=1e-13)


def test_the_hull_tells_the_projections_of_all_points():
    x, y = np.random.default_rng(2).normal(size=(2, 500))
    angles = np.radians(np.arange(180))
    largest = np.abs(np.outer(x, np.cos(angles)) + np.outer(y, np.sin(angles))).max(axis=0)
    np.testing.assert_allclose(
        over_directions(x, y, (0.0, 50.0, 100.0)), np.percentile(largest, [0, 50, 100]), rtol=1e-14
    )
    assert over_directions(x, 2.0 * x, (100.0,))[0] == pytest.approx(math.sqrt(5.0) * np.abs(x).max(), rel=2e-4)


def test_a_record_at_rest_and_one_along_a_line_have_spectra():
    assert response_spectra(sb.Record(samples=[0.0, 0.0], step=0.1), [1.0]).sd.shape == (1, 0)
    line = response_spectra(sb.Record(samples=SAMPLES[:, :1], step=STEP).rotated(math.pi / 4.0), PERIODS)
    alone = response_spectra(sb.Record(samples=SAMPLES[:, :1], step=STEP), PERIODS)
    np.testing.assert_allclose(line.rotd100, alone.psa.sel(axis="x"), rtol=1e-12)
    np.testing.assert_allclose(line.rotd00, 0.0, atol=1e-12)


def test_one_component_has_no_orientation():
    assert "rotd50" not in response_spectra(sb.Record(samples=[0.0, 1.0, 0.0], step=0.1), [1.0])


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"periods": [1.0, 0.0]}, r"periods\[1\] must be positive, got 0.0 s"),
        ({"periods": [1.0], "damping": 1.0}, "damping must be below 1, got 1.0"),
        ({"periods": [1.0], "damping": -0.1}, "damping must be zero or positive"),
    ],
)
def test_what_no_oscillator_has_is_refused(arguments, message):
    with pytest.raises(ParameterError, match=message):
        response_spectra(RECORD, **arguments)
