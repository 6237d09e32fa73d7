"""The motion of a floor: steady amplification, an oracle of SciPy, stiff and soft limits, and the response spectrum."""

import math

import numpy as np
import pytest
from scipy.signal import StateSpace, lsim

import stylobate as sb
from stylobate.base_motions import Record
from stylobate.config import RecordMotion
from stylobate.errors import ParameterError
from stylobate.records import response_spectra

STEP = 0.01
NOISE = Record(samples=np.random.default_rng(7).normal(size=(600, 3)), step=STEP, name="noise")


@pytest.mark.parametrize("ratio", [0.3, 0.9, 1.0, 1.7])
def test_steady_shaking_is_amplified_as_by_the_closed_form(ratio):
    period, damping = 0.5, 0.08
    rate = ratio * 2.0 * math.pi / period
    times = 0.002 * np.arange(15000)
    found = Record(samples=np.sin(rate * times), step=0.002, name="sine").floor_motion(period=period, damping=damping)
    late = found.samples[10000:15000, 0]
    tuned = (2.0 * damping * ratio) ** 2
    expected = math.sqrt((1.0 + tuned) / ((1.0 - ratio**2) ** 2 + tuned))
    assert np.abs(late).max() == pytest.approx(expected, rel=2e-4)


def test_a_random_motion_is_that_of_an_independent_integration():
    period, damping = 0.6, 0.03
    omega = 2.0 * math.pi / period
    found = NOISE.floor_motion(period=period, damping=damping)
    assert found.step == STEP  # 60 in a period
    system = StateSpace(
        [[0.0, 1.0], [-(omega**2), -2.0 * damping * omega]],
        [[0.0], [-1.0]],
        [[-(omega**2), -2.0 * damping * omega]],
        [[0.0]],
    )
    times = STEP * np.arange(len(found.samples))
    for axis in range(2):
        base = np.pad(NOISE.samples[:, axis], (0, len(times) - len(NOISE.samples)))
        _, expected, _ = lsim(system, base, times, interp=True)
        np.testing.assert_allclose(found.samples[:, axis], expected, atol=1e-10)
    np.testing.assert_array_equal(found.samples[: len(NOISE.samples), 2], NOISE.samples[:, 2])
    assert np.abs(found.samples[-1]).max() < 2e-3 * np.abs(found.samples).max()


def test_a_stiff_floor_moves_with_the_ground_and_a_soft_one_hardly():
    smooth = sb.sample_record().filtered(lowpass=5.0)
    stiff = smooth.floor_motion(period=0.005)
    count = round(smooth.step / stiff.step)
    late = slice(count * 50, count * len(smooth.samples), count)  # the ground jumps to its first sample
    np.testing.assert_allclose(stiff.samples[late], smooth.samples[50:], atol=0.01 * np.abs(smooth.samples).max())
    soft = smooth.floor_motion(period=40.0, damping=0.3)
    assert soft.peak_horizontal() < 0.1 * smooth.peak_horizontal()


def test_its_peak_is_the_spectral_acceleration_where_damping_is_small():
    record = sb.sample_record()
    psa = response_spectra(record, [0.4], damping=0.002).psa.sel(axis="x").item()
    floor = record.floor_motion(period=0.4, damping=0.002)
    assert np.abs(floor.samples[:, 0]).max() == pytest.approx(psa, rel=2e-3)


def test_it_is_described_refined_and_refused():
    record = sb.sample_record()
    floor = record.floor_motion(period=0.2, damping=0.05)
    assert floor.step == pytest.approx(0.005)  # 40 in a period
    assert floor.provenance[-1] == "motion of a floor of period 0.2 s and damping ratio 0.05"
    step = {"method": "floor_motion", "period": 0.2, "damping": 0.05}
    described = RecordMotion.parse({"kind": "record", "sample": "el centro 1940", "processing": [step]}).build()
    assert described == floor
    for numbers, line in (
        ({"period": 0.0}, "period must be positive"),
        ({"period": 0.5, "damping": 0.0}, "damping must be positive"),
        ({"period": 0.5, "damping": 1.0}, "damping must be below 1"),
        ({"period": 1e-6}, "period: .* samples are needed, 10,000,000 allowed"),
    ):
        with pytest.raises(ParameterError, match=line):
            record.floor_motion(**numbers)
