"""Definitions of the horizontal component: against rotation one degree at a time, and closed forms."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions.base import ACCELERATION, VELOCITY
from stylobate.errors import ParameterError
from stylobate.records import intensity_measures
from stylobate.records.intensities import HorizontalComponent, horizontal_peak, peak_velocity

ROTD50, ROTD100, GEOMETRIC_MEAN, LARGER = HorizontalComponent
RECORD = sb.Record(samples=np.random.default_rng(5).normal(size=(60, 2)) * (1.5, 1.0), step=0.1, name="noise")
TURN = np.linspace(0.0, 2.0 * np.pi, 100001)


def test_rotd_is_the_percentile_of_peaks_rotated_degree_by_degree():
    turned = [RECORD.rotated(math.radians(angle)) for angle in range(180)]
    peaks = {
        ACCELERATION: [np.abs(record.samples[:, 0]).max() for record in turned],
        VELOCITY: [peak_velocity(record)[0] for record in turned],  # exact between samples too
    }
    # A slope of the acceleration is at most 2 sup |a|/step; of eight parabolas a step each rises by step·sup |a|/256.
    low = RECORD.step * RECORD.peak_horizontal() / 256.0
    for order, tolerance in ((ACCELERATION, 1e-12), (VELOCITY, low)):
        assert horizontal_peak(RECORD, order, ROTD50) == pytest.approx(np.median(peaks[order]), abs=tolerance)
        # The largest vector lies between two directions 1° apart, at most half a degree from one.
        most = horizontal_peak(RECORD, order, ROTD100)
        assert most * math.cos(math.radians(0.5)) <= max(peaks[order]) <= most + tolerance


def test_all_directions_are_alike_in_circular_motion():
    x, y = 3.0 * np.cos(TURN), 3.0 * np.sin(TURN)
    for one in HorizontalComponent:
        assert one.peak(x, y) == pytest.approx(3.0, rel=1e-8)


@pytest.mark.parametrize("azimuth", [0.0, 0.3, 0.25 * math.pi, 1.2])
def test_along_a_line_half_of_the_directions_see_less_than_cos_45_degrees(azimuth):
    x, y = math.cos(azimuth) * np.cos(TURN), math.sin(azimuth) * np.cos(TURN)
    # A direction is at most half a degree from one of the 180, where |cos| changes by sin 45° of that.
    assert ROTD50.peak(x, y) == pytest.approx(math.sqrt(0.5), abs=math.radians(0.5))
    assert ROTD100.peak(x, y) == pytest.approx(1.0, rel=1e-12)
    assert GEOMETRIC_MEAN.peak(x, y) == pytest.approx(math.sqrt(math.cos(azimuth) * math.sin(azimuth)), rel=1e-12)
    assert LARGER.peak(x, y) == pytest.approx(max(math.cos(azimuth), math.sin(azimuth)), rel=1e-12)


def test_definitions_are_ordered_and_only_rotd_does_not_depend_on_the_axes():
    rng = np.random.default_rng(0)
    for _ in range(20):
        x, y = rng.normal(size=(2, 50))
        turned = [math.cos(0.6) * x - math.sin(0.6) * y, math.sin(0.6) * x + math.cos(0.6) * y]
        assert GEOMETRIC_MEAN.peak(x, y) <= LARGER.peak(x, y) <= ROTD100.peak(x, y)
        # Half of the directions are within 45° of the largest vector.
        assert ROTD100.peak(x, y) * (math.sqrt(0.5) - 0.01) <= ROTD50.peak(x, y) <= ROTD100.peak(x, y)
        assert ROTD100.peak(*turned) == pytest.approx(ROTD100.peak(x, y), rel=1e-12)
        assert ROTD50.peak(*turned) == pytest.approx(ROTD50.peak(x, y), rel=5e-3)
        assert GEOMETRIC_MEAN.peak(*turned) != pytest.approx(GEOMETRIC_MEAN.peak(x, y), rel=5e-3)


def test_a_record_along_one_line_has_one_component_in_every_definition():
    lone = sb.Record(samples=RECORD.samples[:, :1], step=0.1)
    for record in (lone, lone.rotated(0.7)):
        for order, peak in ((ACCELERATION, np.abs(lone.samples).max()), (VELOCITY, peak_velocity(lone)[0])):
            found = [horizontal_peak(record, order, one) for one in HorizontalComponent]
            np.testing.assert_allclose(found, peak, atol=lone.step * lone.peak_horizontal() / 256.0)
            np.testing.assert_allclose(found, found[0], rtol=1e-15)


def test_measures_of_a_record_name_the_definitions():
    measures = intensity_measures(RECORD)
    assert measures["component"].values.tolist() == ["RotD50", "RotD100", "geometric mean", "larger component"]
    assert float(measures.horizontal_pga.sel(component="larger component")) == float(measures.pga.max())
    expected = float(np.sqrt(measures.pga.prod()))
    assert float(measures.horizontal_pga.sel(component="geometric mean")) == pytest.approx(expected, rel=1e-14)


def test_names_are_known_in_any_case_and_unknown_ones_are_refused_with_the_known():
    for name, one in (
        ("ROTD50", ROTD50),
        ("rotd 100", ROTD100),
        ("vector", ROTD100),
        ("GeometricMean", GEOMETRIC_MEAN),
    ):
        assert HorizontalComponent.named(name) is one
    with pytest.raises(ParameterError, match=r"component: .* \(got 'GMRotI50'\). Use one of 'RotD50'"):
        HorizontalComponent.named("GMRotI50")
