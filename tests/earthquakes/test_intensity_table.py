"""Intensity measures of several records in one table."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import cumulative_simpson

import stylobate as sb
from stylobate.records import intensity_measures, intensity_table, response_spectra, sample_record
from stylobate.records.intensities import HorizontalComponent
from stylobate.records.intensity_table import filtered_incremental_velocity

RECORD = sample_record()
MEASURES = ("pga", "pgv", "pgv_over_pga", "sa", "sa_avg", "fiv3", "cav", "arias", "duration_5_95")


def along_x(acceleration, step=0.01):
    """Return a record along x."""
    return sb.Record(samples=np.column_stack([acceleration, 0 * acceleration, 0 * acceleration]), step=step)


def test_a_record_along_a_line_has_its_own_measures_in_every_definition():
    line = along_x(RECORD.samples[:, 0], RECORD.step)
    own = intensity_measures(line).sel(axis="x")
    spectrum = response_spectra(line, [1.0])["psa"].sel(axis="x")
    for turned in (line, line.rotated(0.7)):
        for component in HorizontalComponent:
            found = intensity_table(turned, component=component).isel(record=0)
            for name in ("pga", "pgv", "pgv_over_pga", "cav", "arias", "duration_5_95"):
                assert_allclose(found[name], own[name], rtol=1e-3, err_msg=name)  # velocities of eight values a step
            assert_allclose(found["sa"], spectrum[0], rtol=1e-9)


@pytest.mark.parametrize("component", ["RotD50", "RotD100"])
def test_rotating_a_record_changes_no_measure_over_all_directions(component):
    found = intensity_table([RECORD, RECORD.rotated(math.radians(35.0))], component=component)
    for name in MEASURES:
        assert_allclose(found[name][1], found[name][0], rtol=2e-3, err_msg=name)


def test_measures_of_scaled_records_are_those_of_the_records_scaled():
    scales = [0.5, 2.0]
    found = intensity_table(RECORD, scales=scales).isel(record=0)
    for place, scale in enumerate(scales):
        own = intensity_table(RECORD.scaled(scale)).isel(record=0)
        for name in MEASURES:
            assert_allclose(found[name][place], own[name], rtol=1e-9, err_msg=name)


def test_the_median_direction_lies_between_the_components():
    small, large = sorted(
        intensity_table(along_x(RECORD.samples[:, axis], RECORD.step))["fiv3"].item() for axis in (0, 1)
    )
    table = {name: intensity_table(RECORD, component=name)["fiv3"].item() for name in ("RotD50", "RotD100", "larger")}
    assert table["larger"] == pytest.approx(large)
    assert 0.8 * small < table["RotD50"] <= table["RotD100"]
    assert table["larger"] <= 1.02 * table["RotD100"]


def test_the_average_spectral_acceleration_is_the_geometric_mean_of_ten_periods():
    periods = 0.8 * np.geomspace(0.2, 3.0, 10)
    line = along_x(RECORD.samples[:, 0], RECORD.step)
    psa = response_spectra(line, periods, damping=0.03)["psa"].sel(axis="x")
    found = intensity_table(line, period=0.8, damping=0.03)
    assert_allclose(found["sa_avg"][0], np.prod(psa) ** 0.1, rtol=1e-9)


def test_the_filtered_incremental_velocity_of_slow_pulses_is_that_of_their_middle():
    # Far below the filter's corner of 1 Hz the filter changes little; a window of 5 s holds the middle of each pulse.
    t = np.arange(0.0, 400.0, 0.01)
    pulses = np.zeros_like(t)
    for begin, size in ((50.0, 1.0), (150.0, 3.0), (250.0, 2.0), (350.0, 0.5)):
        inside = (t > begin) & (t < begin + 10.0)
        pulses[inside] += size * np.sin(np.pi * (t[inside] - begin) / 10.0)
    gains = np.array([1.0, 3.0, 2.0]) * 20.0 / np.pi * np.sin(np.pi / 4.0)
    assert filtered_incremental_velocity(pulses, 0.01, 5.0 / 0.7) == pytest.approx(gains.sum(), rel=2e-3)


def test_the_filtered_incremental_velocity_is_that_of_another_integration():
    a = RECORD.samples[:, 0]
    period, step = 1.0, RECORD.step
    fine = np.arange(0.0, step * (len(a) - 1), 1e-3)
    dense = np.interp(fine, step * np.arange(len(a)), a)
    rest = np.zeros(3000)
    dense = np.concatenate([rest, dense, rest])
    # the analogue filter s² + √2 ωs + ω², integrated as an oscillator of the damping ratio √½
    from stylobate.base_motions.oscillator import oscillator_response

    omega = 2.0 * np.pi
    filtered = -(omega**2) * oscillator_response(dense[:, np.newaxis], 1e-3, 1.0, math.sqrt(0.5))[0][:, 0]
    velocity = cumulative_simpson(filtered, dx=1e-3, initial=0.0)
    gained = velocity[700:] - velocity[:-700]
    inner = gained[1:-1]
    sums = []
    for sign in (1.0, -1.0):
        tops = (sign * inner > sign * gained[:-2]) & (sign * inner >= sign * gained[2:])
        sums.append(np.sort(sign * inner[tops])[-3:].sum())
    assert filtered_incremental_velocity(a, step, period) == pytest.approx(max(sums), rel=5e-3)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"records": []}, "records: must be a Record or several"),
        ({"records": [1.0]}, "records: must be a Record or several"),
        ({"records": along_x(np.ones(9), 0.6)}, "records: must have steps below 0.5 s for FIV3"),
        ({"records": sb.Record(samples=[[0, 0, 1.0]] * 9, step=0.1)}, "records: must move horizontally"),
        ({"records": RECORD, "period": -1.0}, "period"),
        ({"records": RECORD, "component": "north"}, "component"),
    ],
)
def test_what_has_no_measures_is_refused(given, message):
    with pytest.raises(sb.errors.ParameterError, match=message):
        intensity_table(**given)
