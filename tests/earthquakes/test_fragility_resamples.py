"""Resamples of records: each is the fit of the records drawn, and intervals are corrected percentiles of them."""

import numpy as np
import pytest
from scipy.stats import norm
from scipy.stats import t as student

from stylobate.earthquakes import fit_fragility
from stylobate.earthquakes.fragility.likelihood import FitStatus, Replicates, resampled
from stylobate.earthquakes.fragility.observations import Observations

SCALE, RECORDS, COUNT = np.geomspace(0.5, 8.0, 7), 9, 25


def runs(seed=1):
    """Return intensity, outcome and record of runs, a tenth of them not decided."""
    rng = np.random.default_rng(seed)
    capacity = rng.normal(0.7, 0.4, RECORDS)
    intensity, record = np.tile(SCALE, RECORDS), np.repeat(np.arange(RECORDS), SCALE.size)
    reached = (np.log(intensity) > capacity[record] + rng.normal(0.0, 0.3, intensity.size)).astype(int)
    return intensity, np.where(rng.random(reached.size) < 0.1, -1, reached), record


def test_a_resample_is_the_fit_of_the_records_drawn():
    intensity, reached, record = runs()
    (found,) = resampled(Observations.of(intensity, reached, record), COUNT, np.random.default_rng(3))
    # The draws are those of a multinomial; here each record is repeated as often as it was drawn.
    drawn = np.random.default_rng(3).multinomial(RECORDS, np.full(RECORDS, 1.0 / RECORDS), size=COUNT)
    whole = fit_fragility(intensity, reached)
    assert found.own == pytest.approx((np.log(whole["median"].item()), whole["dispersion"].item()), rel=1e-6)
    for place, times in enumerate(drawn):
        fit = fit_fragility(np.repeat(intensity, times[record]), np.repeat(reached, times[record]))
        if fit["status"] == FitStatus.SEPARATED:  # the middle of the gap, without dispersion
            held, fell = (np.log(intensity[(reached == state) & (times[record] > 0)]) for state in (0, 1))
            middle = 0.5 * (held.max() + fell.min())
            assert (found.log_median[place], found.dispersion[place]) == (pytest.approx(middle), 0.0)
            continue
        assert found.log_median[place] == pytest.approx(np.log(fit["median"].item()), rel=1e-6)
        assert found.dispersion[place] == pytest.approx(fit["dispersion"].item(), rel=1e-6)
    assert (found.records, found.without_fit()) == (RECORDS, 0)


def replicates(own, records=8, bend=0.0):
    """Return 4001 replicates, at evenly spaced levels of a lognormal distribution about 2."""
    z = norm.ppf((np.arange(4001) + 0.5) / 4001)
    return Replicates(log_median=np.log(2.0) + 0.2 * z, dispersion=np.exp(0.1 * z + bend), own=own, records=records)


@pytest.mark.parametrize("records", [4, 8, 40])
def test_ends_of_an_interval_are_percentiles_widened_as_by_student(records):
    low, high, narrow, wide = replicates((np.log(2.0), 1.0), records).ends(0.9)
    reach = student.ppf(0.95, records - 1) * np.sqrt(records / (records - 1))
    ends = np.log([low, high]) - np.log(2.0)
    # Replicates are spaced by 1 % of the reach there.
    np.testing.assert_allclose(ends, [-0.2 * reach, 0.2 * reach], rtol=1e-2)
    np.testing.assert_allclose(np.log([narrow, wide]), [-0.1 * reach, 0.1 * reach], rtol=1e-2)


@pytest.mark.parametrize("shift", [-0.5, 0.3])
def test_percentiles_are_corrected_for_the_bias_of_the_resamples(shift):
    # The median of the data lies `shift` deviations above that of the replicates: both ends move twice as far.
    low, high, _, _ = replicates((np.log(2.0) + 0.2 * shift, 1.0), 1000).ends(0.9)
    reach = student.ppf(0.95, 999) * np.sqrt(1000 / 999)
    ends = np.log(2.0) + 0.2 * (2.0 * shift + np.array([-reach, reach]))
    assert (np.log(low), np.log(high)) == pytest.approx(tuple(ends), abs=2e-3)


def test_the_interval_of_a_probability_is_that_of_the_curves_there():
    sure = Replicates(log_median=np.full(50, 0.4), dispersion=np.full(50, 0.3), own=(0.4, 0.3), records=8)
    u = np.array([-0.2, 0.4, 0.9])
    for ends in sure.band(u, 0.9):
        np.testing.assert_allclose(ends, norm.cdf((u - 0.4) / 0.3), rtol=1e-12)
    # Curves that differ by their median alone: the ends are those of the medians.
    moved = Replicates(
        log_median=replicates((0.0, 1.0)).log_median, dispersion=np.full(4001, 0.3), own=(np.log(2.0), 0.3), records=8
    )
    low, high = moved.band(u, 0.9)
    least, most, _, _ = moved.ends(0.9)
    np.testing.assert_allclose(low, norm.cdf((u - np.log(most)) / 0.3), rtol=1e-6)
    np.testing.assert_allclose(high, norm.cdf((u - np.log(least)) / 0.3), rtol=1e-6)


def test_resamples_without_a_fit_count_beyond_both_ends_and_in_no_covariance():
    z = np.linspace(-1.0, 1.0, 101)
    found = Replicates(
        log_median=np.where(z > 0.9, np.nan, z),
        dispersion=np.where(z > 0.9, np.nan, np.exp(z)),
        own=(0.0, 1.0),
        records=30,
    )
    lost = int(np.count_nonzero(z > 0.9))
    assert found.without_fit() == lost
    low, high, _, _ = found.ends(0.95)
    assert (low, high) == (0.0, np.inf)
    np.testing.assert_allclose(found.covariance(), np.cov(z[:-lost], z[:-lost]))
    separated = Replicates(log_median=z, dispersion=np.zeros(101), own=(0.0, 0.0), records=30)
    assert np.isnan(separated.covariance()).all()
