"""Components of different lengths: what is cut off the longer ones is nothing, or is named."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import UnlikelyInputWarning
from stylobate.records import Lengths, Steps
from stylobate.records.intensities import arias_intensity
from stylobate.records.joining import lost_intensity

STEP = 0.01
COUNT = 201


def table(folder, name, values, step=STEP):
    path = folder / name
    path.write_text("".join(f"{step * at:.5f} {value}\n" for at, value in enumerate(values)))
    return path


def constant_pair(folder, cut):
    """Return files of constant acceleration, whose ∫ a² dt grows with the time: cut/(COUNT − 1) of it is lost."""
    return [table(folder, "a_NS.txt", [1.0] * COUNT), table(folder, "a_EW.txt", [1.0] * (COUNT - cut))]


@pytest.mark.parametrize("cut", [0, 1])
def test_trimming_less_than_a_hundredth_of_the_intensity_is_silent(tmp_path, cut):
    (record,) = sb.read_records(constant_pair(tmp_path, cut), "m/s2")  # warnings are errors
    assert len(record.samples) == COUNT - cut


@pytest.mark.parametrize(("cut", "percent"), [(3, "1.5"), (50, "25"), (199, "99.5")])
def test_trimming_more_is_remarked_on_with_file_fraction_and_remedy(tmp_path, cut, percent):
    paths = constant_pair(tmp_path, cut)
    with pytest.warns(UnlikelyInputWarning) as warned:
        (record,) = sb.read_records(paths, "m/s2")
    (message,) = (str(one.message) for one in warned)
    lengths = f"from 2 s to {STEP * (COUNT - 1 - cut):g} s"
    assert message.startswith(
        f"a: a_NS.txt is trimmed {lengths} and loses {percent} % of its Arias intensity. Set lengths to"
    )
    assert len(record.samples) == COUNT - cut
    sb.read_records(paths, "m/s2", lengths=Lengths.PAD)


def test_the_fraction_that_is_named_is_that_of_the_arias_intensity(tmp_path):
    values = np.random.default_rng(2).normal(size=(2, 300))
    paths = [table(tmp_path, "b_NS.txt", values[0]), table(tmp_path, "b_EW.txt", values[1][:180])]
    (whole,) = sb.read_records(paths, "m/s2", lengths=Lengths.PAD)
    with pytest.warns(UnlikelyInputWarning) as warned:
        (trimmed,) = sb.read_records(paths, "m/s2")
    lost = 1.0 - arias_intensity(trimmed)[0] / arias_intensity(whole)[0]
    assert f"loses {100.0 * lost:.3g} % of its Arias intensity" in str(warned[0].message)


def test_components_of_different_steps_are_compared_after_they_are_resampled(tmp_path):
    smooth = np.sin(np.linspace(0.0, 40.0, 400))
    paths = [table(tmp_path, "c_NS.txt", smooth, 0.005), table(tmp_path, "c_EW.txt", smooth, 0.01)]
    with pytest.warns(
        UnlikelyInputWarning, match=r"c: c_EW\.txt is trimmed from 3\.995 s to 1\.995 s and loses 5\d\.?\d* %"
    ):
        (record,) = sb.read_records(paths, "m/s2", steps=Steps.RESAMPLE)
    assert (record.step, len(record.samples)) == (0.005, 400)
    # the samples of the coarser component stand where they stood
    np.testing.assert_allclose(record.samples[20:-20:2, 1], -smooth[10:190], atol=0.01)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("kept", [1, 60, 199, 200])
def test_the_fraction_lost_counts_all_components_and_does_not_depend_on_their_size(scale, kept):
    samples = np.random.default_rng(4).normal(size=(200, 2))
    record = sb.Record(samples=scale * samples, step=STEP)
    # ∫ a² dt of a function that is linear between samples.
    pieces = (samples[:-1] ** 2 + samples[:-1] * samples[1:] + samples[1:] ** 2).sum(axis=1)
    assert lost_intensity(record, kept) == pytest.approx(pieces[kept - 1 :].sum() / pieces.sum(), abs=1e-14)


def test_a_component_at_rest_loses_nothing():
    assert lost_intensity(sb.Record(samples=np.zeros((20, 2)), step=STEP), 5) == 0.0
