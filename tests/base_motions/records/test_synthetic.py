"""Synthetic records have the statistics of their models."""

import math

import numpy as np
import pytest
from scipy.signal import welch

from stylobate.errors import ParameterError
from stylobate.records import CloughPenzien, EvolvingNoise, intensity_measures, random_vibration
from stylobate.records.intensities import arias_intensity, significant_duration

DENSITY = CloughPenzien(level=0.05)
MODEL = EvolvingNoise(
    arias=0.8, duration_5_95=10.0, middle_time=7.0, frequency=4.0, frequency_rate=-0.15, bandwidth=0.25
)


def test_random_vibration_has_its_mean_square_exactly_in_every_sample():
    for seed in range(3):
        record = random_vibration(DENSITY, duration=40.0, step=0.01, rng=np.random.default_rng(seed))
        count = len(record.samples)
        frequency = np.arange(1, count // 2) / (count * 0.01)
        power = np.sum(DENSITY(frequency)) / (count * 0.01)
        assert np.mean(record.samples[:, 0] ** 2) == pytest.approx(power, rel=1e-12)


def test_random_vibration_has_its_density_within_the_statistical_error():
    record = random_vibration(DENSITY, duration=2000.0, step=0.02, rng=np.random.default_rng(4))
    frequency, estimate = welch(record.samples[:, 0], fs=50.0, nperseg=1024)
    chosen = (frequency > 0.5) & (frequency < 20.0)
    ratio = estimate[chosen] / DENSITY(frequency[chosen])
    # some 190 segments that overlap by half: each estimate is off by 1/√(190/1.06) = 7.5 %, 389 of them by 4 σ at most
    assert np.abs(ratio - 1.0).max() < 4.5 * 0.075
    assert abs(ratio.mean() - 1.0) < 0.02


def test_components_of_random_vibration_are_independent_and_seeds_repeat():
    one, again = (
        random_vibration(DENSITY, duration=100.0, step=0.02, rng=np.random.default_rng(9), components=3) for _ in "12"
    )
    assert one == again
    correlation = np.corrcoef(one.samples.T)
    # bandwidth about 3 Hz, 100 s: 300 independent values, 1/√300 = 0.06
    assert np.abs(correlation - np.eye(3)).max() < 4 * 0.06


def test_the_density_is_kanai_tajimi_with_a_high_pass():
    assert DENSITY(np.array([0.0]))[0] == 0.0
    far = CloughPenzien(level=1.0, high_pass_frequency=1e-6)
    # at f = f_g: (1 + 4ζ²)/(4ζ²)
    assert far(np.array([2.5]))[0] == pytest.approx((1.0 + 1.44) / 1.44, rel=1e-9)


def test_the_envelope_has_the_intensity_and_the_times_that_are_asked_for():
    time = np.linspace(0.0, 60.0, 600001)
    power = MODEL.envelope(time) ** 2
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) * 1e-4)])
    assert math.pi / (2.0 * 9.80665) * energy[-1] == pytest.approx(0.8, rel=1e-5)
    begin, middle, end = np.interp([0.05, 0.45, 0.95], energy / energy[-1], time)
    assert middle == pytest.approx(7.0, abs=1e-3)
    assert end - begin == pytest.approx(10.0, abs=1e-3)


def test_realizations_have_the_intensity_and_duration_of_the_model():
    rng = np.random.default_rng(21)
    records = [MODEL.record(rng, step=0.02, components=3) for _ in range(25)]
    arias = np.array([arias_intensity(record) for record in records]).ravel()
    duration = np.array([significant_duration(record) for record in records]).ravel()
    error = arias.std() / math.sqrt(arias.size)
    # the high-pass takes a part below 2 % off
    assert 0.98 * 0.8 - 4.0 * error < arias.mean() < 0.8 + 4.0 * error
    assert duration.mean() == pytest.approx(10.0, rel=0.05)


def test_realizations_have_the_standard_deviation_of_the_envelope():
    rng = np.random.default_rng(22)
    samples = np.concatenate([MODEL.record(rng, step=0.02, components=3).samples for _ in range(30)], axis=1)
    times = 0.02 * np.arange(len(samples))
    for time in (3.0, 7.0, 11.0):
        near = np.abs(times - time) < 0.3
        spread = np.sqrt(np.mean(samples[near] ** 2))
        # 90 realizations, each some 2 independent values in 0.6 s: 1/√(2·180) = 5 %
        assert spread == pytest.approx(float(MODEL.envelope(np.array([time]))[0]), rel=4.0 * 0.05)


def test_a_realization_leaves_no_velocity_and_no_displacement():
    record = MODEL.record(np.random.default_rng(1), components=2)
    measures = intensity_measures(record)
    assert np.all(np.abs(record.residual_velocity[:2]) < 1e-4 * measures.pgv.values)
    end = record.displacement(record.duration)[:2]
    assert np.all(np.abs(end) < 1e-3 * measures.pgd.values)


def test_the_frequency_falls_as_the_model_says():
    rng = np.random.default_rng(5)
    early, late = [], []
    for _ in range(12):
        a = MODEL.record(rng, step=0.01, components=3).samples
        for times, crossings in (((3.0, 6.0), early), ((12.0, 15.0), late)):
            part = a[int(times[0] / 0.01) : int(times[1] / 0.01)]
            crossings.append(np.mean(np.sum(part[:-1] * part[1:] < 0.0, axis=0)) / 3.0 / 2.0)
    # f = 4 − 0.15 (t − 7): 4.4 at 4.5 s, 3.0 at 13.5 s; crossings of zero run a little beside it, the same for both
    assert np.mean(late) / np.mean(early) == pytest.approx(3.0 / 4.4, rel=0.1)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"arias": 0.0}, "arias must be positive, got 0.0 m/s"),
        ({"bandwidth": 1.0}, "bandwidth must be below 1"),
        ({"duration_5_95": 60.0}, "duration_5_95 must be between .* of middle_time = 7.0 s, got 60.0 s"),
    ],
)
def test_a_model_that_cannot_be_is_refused(change, message):
    numbers = {"arias": 0.8, "duration_5_95": 10.0, "middle_time": 7.0, "frequency": 4.0, **change}
    with pytest.raises(ParameterError, match=message):
        EvolvingNoise(**numbers)


def test_arguments_of_random_vibration_are_checked():
    rng = np.random.default_rng(0)
    with pytest.raises(ParameterError, match="components must be 1, 2 or 3, got 4"):
        random_vibration(DENSITY, duration=1.0, step=0.01, rng=rng, components=4)
    with pytest.raises(ParameterError, match="density must give finite numbers"):
        random_vibration(lambda f: -f, duration=1.0, step=0.01, rng=rng)


def test_realizations_have_names_of_their_own():
    rng = np.random.default_rng(1)
    first, second = MODEL.record(rng), MODEL.record(rng)
    assert first.name.startswith("synthetic ")
    assert first.name != second.name
    assert MODEL.record(np.random.default_rng(1)).name == first.name
    assert MODEL.record(rng, name="mine").name == "mine"
