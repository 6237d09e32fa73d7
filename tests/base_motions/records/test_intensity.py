"""Intensity measures against independent integration and identities."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

import stylobate as sb
from stylobate.column.numbers import STANDARD_GRAVITY
from stylobate.records import intensity_measures, rocking_measures
from stylobate.records.intensities import arias_intensity, cumulative_absolute_velocity, significant_duration

STEP = 0.1
RECORD = sb.Record(samples=np.random.default_rng(5).normal(size=(60, 2)), step=STEP, name="noise")
FINE = np.linspace(0.0, RECORD.duration, 590001)  # 1e-5 s


def test_arias_intensity_and_cav_are_the_integrals():
    for axis in (0, 1):
        energy, _ = quad(
            lambda t, i=axis: RECORD.derivative(t, 2)[i] ** 2, 0.0, RECORD.duration, points=RECORD.times, limit=200
        )
        assert arias_intensity(RECORD)[axis] == pytest.approx(math.pi / (2.0 * STANDARD_GRAVITY) * energy, rel=1e-10)
        # the trapezium rule is exact but where a changes its sign, some 40 times, by ½ slope·dt² each
        absolute = np.trapezoid(np.abs(RECORD.derivative(FINE, 2)[axis]), FINE)
        assert cumulative_absolute_velocity(RECORD)[axis] == pytest.approx(absolute, abs=40 * 0.5 * 50.0 * 1e-10)


def test_arias_intensity_is_the_energy_of_the_spectrum():
    # Parseval for a(t) linear between samples, zero at the ends: A(f) = step sinc²(f step) Σ a_k e^{−2πi f k step}
    samples = RECORD.samples[:, 0].copy()
    samples[[0, -1]] = 0.0
    record = sb.Record(samples=samples, step=STEP)
    frequency = np.arange(-200000, 200001) * (1.0 / (STEP * 128))  # all aliases up to 15 kHz
    spectrum = np.fft.fft(samples, 128)[np.arange(-200000, 200001) % 128]
    density = STEP**2 * np.sinc(frequency * STEP) ** 4 * np.abs(spectrum) ** 2
    energy = density.sum() / (STEP * 128)
    assert arias_intensity(record)[0] == pytest.approx(math.pi / (2.0 * STANDARD_GRAVITY) * energy, rel=1e-9)


def test_peaks_are_the_largest_values_of_the_interpolation():
    measures = intensity_measures(RECORD)
    for name, order, curvature in (("pga", 2, 0.0), ("pgv", 1, 100.0), ("pgd", 0, 5.0)):
        values = np.abs(np.stack(RECORD.derivative(FINE, order)))[:2].max(axis=1)
        # between times 1e-5 s apart a peak is higher by ⅛ curvature·dt² at most
        np.testing.assert_allclose(measures[name], values, rtol=1e-12, atol=curvature * 1e-10)
        assert np.all(measures[name] >= values * (1.0 - 1e-14))
    largest = np.hypot(*np.stack(RECORD.derivative(FINE, 2))[:2]).max()
    assert float(measures.horizontal_pga.sel(component="RotD100")) == pytest.approx(largest, rel=1e-12)


@pytest.mark.parametrize(("begin", "end"), [(0.05, 0.75), (0.05, 0.95), (0.0, 1.0)])
def test_significant_duration_is_between_parts_of_the_energy(begin, end):
    a = RECORD.derivative(FINE, 2)[0]
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (a[1:] ** 2 + a[:-1] ** 2))])
    reached = np.interp([begin, end], energy / energy[-1], FINE)
    assert significant_duration(RECORD, begin, end)[0] == pytest.approx(
        reached[1] - reached[0], abs=2e-4 if end == 1.0 else 2e-5
    )
    assert significant_duration(RECORD)[2] == 0.0


def test_measures_scale_as_they_must():
    once, twice = intensity_measures(RECORD), intensity_measures(RECORD.scaled(2.0))
    for name, power in {
        "pga": 1,
        "pgv": 1,
        "pgd": 1,
        "arias": 2,
        "cav": 1,
        "duration_5_95": 0,
        "pgv_over_pga": 0,
    }.items():
        np.testing.assert_allclose(twice[name], 2.0**power * once[name], rtol=1e-12)
    assert twice.pga.attrs["units"] == "m s-2"


def test_only_axes_that_move_are_measured():
    assert list(intensity_measures(RECORD).axis.values) == ["x", "y"]


def test_a_column_at_its_tipping_acceleration_has_the_ratio_one():
    column = sb.Column.solid(radius=0.4, height=4.0, density=2500.0)
    record = sb.Record(samples=[0.0, 1.0, 0.0], step=0.5).scaled(column.gravity * column.slenderness)
    measures = rocking_measures(record, column)
    assert float(measures.acceleration_ratio[0]) == pytest.approx(1.0, rel=1e-14)
    # v = ½ · 1 s · peak
    assert float(measures.velocity_ratio[0]) == pytest.approx(0.5 * column.frequency_parameter, rel=1e-14)
