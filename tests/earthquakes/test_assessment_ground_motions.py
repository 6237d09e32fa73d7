"""Intensities, spectra and drawn histories of the records of an assessment."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions.base import VELOCITY
from stylobate.earthquakes.assessment.inputs import Parts
from stylobate.earthquakes.assessment.records import (
    ONE_COMPONENT,
    ROTD50,
    as_record,
    ground_motions,
    horizontal_peaks,
    spectra_of,
)
from stylobate.records import response_spectra

RECORD = sb.sample_record("el centro 1940")


def of(**records):
    """Return inputs that hold these records, sorted by name."""
    return SimpleNamespace(records=dict(sorted(records.items())))


def silent(*_):
    """Take no notice of progress."""


def spectra(period, store=None, **records):
    return spectra_of(of(**records), Parts(store, 1, silent), period)["spectral_acceleration"]


def test_intensities_do_not_depend_on_how_the_record_is_turned():
    # A turn by whole degrees maps the directions of RotD50 on themselves.
    turned = RECORD.rotated(math.radians(37.0))
    np.testing.assert_allclose(horizontal_peaks(turned)[1:], horizontal_peaks(RECORD)[1:], rtol=1e-12)
    found = spectra(0.5, given=RECORD, turned=turned)
    np.testing.assert_allclose(found.sel(record="turned"), found.sel(record="given"), rtol=1e-9)


def test_peaks_are_the_median_of_the_peaks_along_all_directions():
    definition, acceleration, velocity = horizontal_peaks(RECORD)
    assert definition == ROTD50
    angles = np.radians(np.arange(180))
    along = np.stack([np.cos(angles), np.sin(angles)])
    # |a| is convex between samples; v is looked at eight times a step, of which the peaks are 1e-3 low at most.
    assert acceleration == pytest.approx(np.median(np.abs(RECORD.samples[:, :2] @ along).max(axis=0)), rel=1e-12)
    times = np.linspace(0.0, RECORD.end, 8 * (len(RECORD.samples) - 1) + 1)
    x, y, _ = RECORD.derivative(times, VELOCITY)
    assert velocity == pytest.approx(np.median(np.abs(np.stack([x, y], axis=-1) @ along).max(axis=0)), rel=1e-3)
    assert acceleration <= RECORD.peak_horizontal(0.0)


def test_a_motion_on_a_circle_has_one_peak_in_all_directions():
    angle = np.linspace(0.0, 6.0 * np.pi, 3001)
    circle = sb.Record(samples=2.5 * np.stack([np.cos(angle), np.sin(angle)], axis=-1), step=0.01)
    # Between directions and samples, a degree and π/500 apart, a cosine falls by 5e-6.
    assert horizontal_peaks(circle)[1] == pytest.approx(2.5, rel=1e-5)


def test_a_record_along_one_axis_has_the_intensities_of_its_component():
    single = sb.Record(samples=RECORD.samples[:, 0], step=RECORD.step)
    definition, acceleration, _ = horizontal_peaks(single)
    assert (definition, acceleration) == (ONE_COMPONENT, float(np.abs(RECORD.samples[:, 0]).max()))
    expected = response_spectra(single, [0.8])["psa"].sel(axis="x").item()
    assert spectra(0.8, single=single).sel(period=0.8).item() == pytest.approx(expected, rel=1e-12)


def test_a_record_along_an_oblique_line_has_the_intensities_of_its_component():
    single = sb.Record(samples=RECORD.samples[:, 0], step=RECORD.step)
    oblique = single.rotated(math.radians(31.0))
    assert np.abs(oblique.samples[:, 1]).max() > 1.0
    assert horizontal_peaks(oblique)[0] == ONE_COMPONENT
    np.testing.assert_allclose(horizontal_peaks(oblique)[1:], horizontal_peaks(single)[1:], rtol=1e-12)
    found = spectra(0.8, single=single, oblique=oblique)
    np.testing.assert_allclose(found.sel(record="oblique"), found.sel(record="single"), rtol=1e-9)


def test_a_record_that_moves_up_and_down_only_has_no_median_over_directions():
    samples = np.zeros((len(RECORD.samples), 3))
    samples[:, 2] = RECORD.samples[:, 2]
    assert horizontal_peaks(sb.Record(samples=samples, step=RECORD.step)) == (ONE_COMPONENT, 0.0, 0.0)


def test_spectra_hold_the_stated_period_and_are_kept(tmp_path):
    found = spectra(0.77, store=tmp_path, pulse=sb.Pulse.one_sine(acceleration=2.0, angular_frequency=4.0))
    assert 0.77 in found["period"]
    known = Parts(tmp_path, 1, silent)
    again = spectra_of(of(pulse=sb.Pulse.one_sine(acceleration=2.0, angular_frequency=4.0)), known, 0.77)[
        "spectral_acceleration"
    ]
    np.testing.assert_array_equal(again, found)
    assert known._known == ["records: response spectra"]


def test_spectra_are_drawn_from_a_twentieth_of_a_second_to_five_seconds_without_gaps():
    periods = spectra(0.77, given=RECORD)["period"].to_numpy()
    assert (periods[0], periods[-1]) == (0.05, 5.0)
    ratios = periods[1:] / periods[:-1]
    assert np.all((ratios > 1.0) & (ratios <= 1.5))
    # Steps grow with the period: those of a table, not of a slip.
    known = np.setdiff1d(periods, 0.77)
    assert np.all(np.diff(known)[1:] >= 0.6 * np.diff(known)[:-1])


def test_a_pulse_is_sampled_up_to_its_end():
    pulse = sb.Pulse.one_sine(acceleration=2.0, angular_frequency=4.0)
    sampled = as_record(pulse)
    assert sampled.end == pytest.approx(pulse.duration, rel=1e-12)
    # A velocity changes by 2 A/ω in half a period; the trapezium rule on 2000 steps loses 2e-7 of that.
    assert horizontal_peaks(pulse)[2] == pytest.approx(2.0 * 2.0 / 4.0, rel=1e-5)


def test_drawn_histories_are_short_and_keep_the_peaks():
    time = 0.001 * np.arange(30_001)
    long = sb.Record(samples=np.stack([np.sin(9.0 * time), np.cos(7.0 * time)], axis=-1) * time[:, None], step=0.001)
    drawn = ground_motions(of(long=long, short=RECORD.trimmed(end=10.0)))
    assert drawn.sizes["instant"] <= 2000
    acceleration = drawn["acceleration"].sel(record="long")
    for extreme in ("min", "max"):
        expected = getattr(long.samples, extreme)(axis=0)
        np.testing.assert_array_equal(getattr(acceleration, extreme)("instant"), expected)
    times = drawn["time"].sel(record="short").dropna("instant")
    assert times.size == 501
    np.testing.assert_array_equal(drawn["acceleration"].sel(record="short")[:501], RECORD.samples[:501])
