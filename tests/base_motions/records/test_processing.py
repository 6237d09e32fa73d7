"""Records made from records: each says what was done."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.records import intensity_measures

STEP = 0.01
TIME = STEP * np.arange(2001)
ENVELOPE = np.sin(np.pi * TIME / TIME[-1]) ** 2


def wave(frequency, size=1.0):
    return size * ENVELOPE * np.sin(2.0 * np.pi * frequency * TIME)


RECORD = sb.Record(samples=np.stack([wave(1.0), wave(2.5, 0.5), wave(4.0, 0.2)], axis=-1), step=STEP, name="waves")


def test_scaling_turning_and_delaying_are_those_of_any_motion():
    times = np.linspace(0.0, 21.0, 50)
    base = sb.BaseMotion
    for mine, generic in [
        (RECORD.scaled(1.5, vertical=0.2), base.scaled(RECORD, 1.5, vertical=0.2)),
        (2.0 * RECORD, base.scaled(RECORD, 2.0)),
        (RECORD.rotated(0.8), base.rotated(RECORD, 0.8)),
        (RECORD.delayed(1.37), base.delayed(RECORD, 1.37)),
        (RECORD.delayed(-1.37), base.delayed(RECORD, -1.37)),
    ]:
        assert isinstance(mine, sb.Record)
        np.testing.assert_allclose(mine.acceleration(times), generic.acceleration(times), rtol=0.0, atol=1e-12)
        assert len(mine.provenance) == 1


def test_history_is_told_in_order():
    made = RECORD.trimmed(1.0, 5.0).scaled(2.0).filtered(highpass=0.2).with_tail(3.0)
    words = [line.split()[0] for line in made.provenance]
    assert words == ["trimmed", "scaled", "Butterworth", "tail"]
    assert RECORD.provenance == ()


def test_scaling_to_a_peak_reaches_it():
    assert RECORD.scaled_to(3.0).peak_horizontal() == pytest.approx(3.0, rel=1e-14)
    with pytest.raises(ParameterError, match="must have a horizontal acceleration"):
        sb.Record.from_components(z=[1.0, 2.0], step=1.0).scaled_to(1.0)


def test_polarity_turns_the_horizontal_components_only():
    np.testing.assert_array_equal(RECORD.inverted().samples, RECORD.samples * [-1.0, -1.0, 1.0])
    assert RECORD.inverted().inverted() == RECORD


def test_trimming_keeps_the_samples_between():
    part = RECORD.trimmed(2.0, 3.0)
    np.testing.assert_array_equal(part.samples, RECORD.samples[200:301])
    assert part.start == RECORD.start
    with pytest.raises(ParameterError, match="must leave two samples"):
        RECORD.trimmed(2.0, 2.001)


def test_padding_is_whole_steps_of_zeros_and_a_tail_lengthens_the_duration():
    padded = RECORD.padded(before=1.0, after=0.501)
    np.testing.assert_array_equal(padded.samples[100:-51], RECORD.samples)
    assert not padded.samples[:100].any()
    assert not padded.samples[-51:].any()
    assert RECORD.with_tail(30.0).duration == pytest.approx(RECORD.duration + 30.0, rel=1e-14)


def test_resampling_keeps_what_both_steps_carry():
    for step in (0.005, 0.02, 0.025):
        fine = RECORD.resampled(step)
        inside = (fine.times > 1.0) & (fine.times < 19.0)
        expected = [np.interp(fine.times, TIME, column) for column in RECORD.samples.T]
        # linear interpolation of 4 Hz at 0.01 s is off by (2π 4 · 0.01)²/8 = 0.8 %, the filter's ripple by as much
        difference = np.abs(fine.samples - np.stack(expected, axis=-1))[inside]
        assert difference.max() < 0.02


def test_resampling_to_a_coarse_step_removes_what_it_cannot_carry():
    high = sb.Record(samples=wave(40.0), step=STEP).resampled(0.05)  # 10 Hz is the most
    assert np.abs(high.samples).max() < 0.01
    with pytest.raises(ParameterError, match="ratio of whole numbers"):
        RECORD.resampled(0.01 * math.pi)


def test_resampling_to_the_same_step_changes_nothing():
    assert RECORD.resampled(STEP) is RECORD


def test_baseline_correction_removes_the_derivative_of_a_polynomial_exactly():
    clean = RECORD.baseline_corrected(2)
    drift = np.stack([0.1 + 0.02 * TIME, -0.3 + 0.0 * TIME, 0.05 * TIME], axis=-1)
    spoilt = sb.Record(samples=RECORD.samples + drift, step=STEP)
    np.testing.assert_allclose(spoilt.baseline_corrected(2).samples, clean.samples, rtol=0.0, atol=1e-12)
    assert np.abs(spoilt.baseline_corrected(2).residual_velocity).max() < 0.1 * np.abs(spoilt.residual_velocity).max()


@pytest.mark.parametrize(("causal", "power"), [(False, 1), (True, 0.5)])
def test_a_butterworth_filter_has_its_gain(causal, power):
    for frequency in (0.5, 1.0, 2.0, 4.0, 8.0):
        tone = sb.Record(samples=wave(frequency), step=STEP)
        low = tone.filtered(lowpass=2.0, order=2, causal=causal)
        ratio = np.sqrt(np.mean(low.samples[:, 0] ** 2) / np.mean(tone.samples[:, 0] ** 2))
        # bilinear transform: frequencies are warped to tan(π f step)
        warped = math.tan(math.pi * frequency * STEP) / math.tan(math.pi * 2.0 * STEP)
        assert ratio == pytest.approx((1.0 + warped**4) ** -power, rel=0.02)


def test_filtering_both_ways_shifts_nothing_and_forwards_keeps_causes_first():
    pulse = np.zeros(801)
    pulse[400] = 1.0
    record = sb.Record(samples=pulse, step=STEP)
    both, forwards = record.filtered(lowpass=5.0), record.filtered(lowpass=5.0, causal=True)
    np.testing.assert_allclose(both.samples, both.samples[::-1], rtol=0.0, atol=1e-12)
    assert not forwards.samples[:400].any()


def test_a_high_pass_takes_the_velocity_off_that_remains():
    shifted = sb.Record(samples=RECORD.samples + 0.05, step=STEP).padded(before=20.0, after=20.0)
    clean = shifted.filtered(highpass=0.2)
    assert np.abs(clean.residual_velocity).max() < 1e-3 * np.abs(shifted.residual_velocity).max()


@pytest.mark.parametrize(
    ("corners", "message"),
    [
        ({}, "highpass or lowpass must be given"),
        ({"lowpass": 50.0}, "lowpass must be below half the sampling rate, 50.0 Hz"),
        ({"highpass": 5.0, "lowpass": 2.0}, "highpass must be below lowpass = 2.0 Hz"),
        ({"highpass": -1.0}, "highpass must be positive"),
    ],
)
def test_corners_out_of_range_are_refused(corners, message):
    with pytest.raises(ParameterError, match=message):
        RECORD.filtered(**corners)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda: RECORD.filtered(highpass=1e-6), "highpass: 6e+08 samples are needed, 10,000,000 allowed"),
        (lambda: RECORD.filtered(lowpass=1e-6), "lowpass: 6e+08 samples are needed"),
        (lambda: RECORD.padded(before=1e6), "before: 1e+08 samples are needed"),
        (lambda: RECORD.with_tail(1e6), "length: 1e+08 samples are needed"),
        (lambda: RECORD.with_tail(1e5).resampled(1e-3), "step: 1e+08 samples are needed"),
    ],
)
def test_a_change_that_needs_too_many_samples_is_refused_in_one_line(change, message):
    with pytest.raises(ParameterError) as refusal:
        change()
    text = str(refusal.value)
    assert message in text
    assert "(got 1" in text or "(got 0.001 s)" in text
    assert "\n" not in text


def test_a_corner_forwards_only_needs_no_zeros():
    assert len(RECORD.filtered(highpass=1e-6, causal=True).samples) == len(RECORD.samples)


def test_the_sample_record_drifts_as_its_documentation_says_and_its_corrected_version_does_not():
    raw, clean = sb.sample_record("el centro 1940"), sb.sample_record("el centro 1940 corrected")
    before, after = intensity_measures(raw), intensity_measures(clean)
    assert before.pgd.values == pytest.approx([2.50, 6.35, 1.59], abs=0.005)
    assert before.residual_velocity.values == pytest.approx([0.041, 0.114, -0.022], abs=0.0005)
    assert np.all(before.residual_velocity_ratio > 0.1)
    assert np.all(after.residual_velocity_ratio < 1e-4)
    # what the ground moved by is no metres, and its strong motion is the same
    assert np.all(after.pgd < 0.2)
    assert after.pga.values == pytest.approx(before.pga.values, rel=0.005)
    assert after.arias.values == pytest.approx(before.arias.values, rel=0.01)
    again = raw.padded(before=20.0, after=20.0).filtered(highpass=0.1, order=2)
    assert (clean, clean.provenance) == (again, again.provenance)
