"""The dispersion split into records and properties."""

import numpy as np
import pytest
import xarray as xr
from scipy.stats import binom

from stylobate.earthquakes import SampleDesign, dispersion_parts
from stylobate.errors import ParameterError

DIMS = ("record", "property_sample", "scale")
NAMES = ("total_dispersion", "record_dispersion", "property_dispersion", "joint_dispersion")
BETAS = (0.4, 0.2, 0.1)


def series(rng, records, samples, *, scales=80, betas=BETAS, nested=False):
    """Return scales and what was reached, for capacities with these dispersions about 3."""
    part, shared, rest = betas
    shape = (records, samples)
    capacity = rng.normal(0.0, part, (records, 1)) + rng.normal(0.0, shared, shape if nested else (1, samples))
    capacity += rng.normal(0.0, rest, shape)
    scale = np.geomspace(0.1, 90.0, scales)
    return scale, xr.DataArray(np.log(scale / 3.0) > capacity[..., np.newaxis], dims=DIMS)


def test_variances_of_a_balanced_layout_are_those_of_its_rows_and_columns():
    rows, columns = np.array([-0.3, 0.1, 0.2, 0.0]), np.array([-0.1, 0.1])
    scale = np.geomspace(0.1, 10.0, 4001)
    capacity = rows[:, np.newaxis] + columns
    reached = xr.DataArray(np.log(scale) > capacity[..., np.newaxis], dims=DIMS)
    found = dispersion_parts(scale, reached, rng=np.random.default_rng(0))
    step = np.log(scale[1] / scale[0])
    assert found["record_dispersion"].item() == pytest.approx(rows.std(ddof=1), abs=2.0 * step)
    assert found["property_dispersion"].item() == pytest.approx(columns.std(ddof=1), abs=2.0 * step)
    assert found["joint_dispersion"].item() < step
    assert set(found.coords) == {"record", "property_sample"}
    np.testing.assert_allclose(found["log_capacity"], capacity, atol=0.5 * step * (1.0 + 1e-9))
    np.testing.assert_allclose(np.log(found["median_of_record"]), rows, atol=step)


def test_properties_that_move_no_capacity_show_no_dispersion():
    rng = np.random.default_rng(5)
    scale = np.geomspace(0.1, 90.0, 31)
    for records in range(3, 13):
        above = np.log(scale / 3.0) > rng.normal(0.0, 0.4, (records, 1, 1))
        states = np.repeat(above, 5, axis=1)
        # One capacity of its own: the mean squares of samples and of the rest are equal, but for rounding.
        states[1, 3] = np.roll(states[1, 3], 2)
        states[1, 3, :2] = False
        found = dispersion_parts(scale, xr.DataArray(states, dims=DIMS), rng=rng)
        assert found["property_dispersion"].item() == 0.0
        assert found["record_dispersion"].item() > 0.1
    # The result reports the dispersion that the steps between scales hide.
    assert found.attrs["resolution"] == pytest.approx(np.log(scale[1] / scale[0]) / np.sqrt(12.0))


@pytest.mark.parametrize("samples", SampleDesign)
def test_the_total_is_the_sum_of_the_variances(samples):
    rng = np.random.default_rng(2)
    found = dispersion_parts(*series(rng, 12, 6), samples=samples, rng=rng)
    parts = sum(found[name].item() ** 2 for name in NAMES[1:])
    assert found["total_dispersion"].item() == pytest.approx(np.sqrt(parts), rel=1e-12)


def held(seed, replications, *, nested=False, **options):
    """Return how many intervals of each dispersion hold the truth, and the mean of the squared estimates."""
    rng = np.random.default_rng(seed)
    part, shared, rest = BETAS
    truth = (np.linalg.norm(BETAS), part, np.hypot(shared, rest), 0.0) if nested else (np.linalg.norm(BETAS), *BETAS)
    counts, squares = np.zeros(4), np.zeros((replications, 4))
    samples = SampleDesign.NESTED if nested else SampleDesign.CROSSED
    for place in range(replications):
        data = series(rng, 15, 8, nested=nested, **options)
        found = dispersion_parts(*data, samples=samples, resamples=1000, rng=rng)
        counts += [
            found[f"{name}_low"].item() <= true <= found[f"{name}_high"].item()
            for name, true in zip(NAMES, truth, strict=True)
        ]
        squares[place] = [found[name].item() ** 2 for name in NAMES]
    return counts, squares, truth


@pytest.mark.parametrize("nested", [False, True])
def test_known_dispersions_lie_in_their_intervals_as_often_as_these_say(nested):
    counts, squares, truth = held(7, 200, nested=nested)
    assert np.all(counts >= binom.ppf(1e-4, 200, 0.94))
    error = squares.std(axis=0, ddof=1) / np.sqrt(200)
    assert np.all(np.abs(squares.mean(axis=0) - np.square(truth)) <= 4.0 * error + 1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("scales", [40, 80])
def test_known_dispersions_lie_in_their_intervals_as_often_as_these_say_of_many(scales):
    counts, _, _ = held(9, 2000, scales=scales)
    assert np.all(counts >= binom.ppf(1e-4, 2000, 0.93))


def test_capacities_beyond_the_scales_leave_the_dispersions_open_and_say_so():
    rng = np.random.default_rng(1)
    scale, reached = series(rng, 6, 3)
    reached[0, 0] = False
    reached[1, 1] = True
    found = dispersion_parts(scale, reached, rng=rng)
    assert (found.attrs["never_reached"], found.attrs["reached_at_once"]) == (1, 1)
    assert all(np.isnan(found[name]) for name in NAMES)
    assert np.count_nonzero(np.isnan(found["log_capacity"])) == 2
    assert np.isfinite(found["median_of_record"][2:]).all()


def test_series_safe_again_above_their_capacity_are_flagged_and_do_not_change_it():
    rng = np.random.default_rng(1)
    scale, reached = series(rng, 6, 3)
    again = reached.copy()
    again[0, 0, -1] = False
    one, other = (dispersion_parts(scale, data, rng=np.random.default_rng(0)) for data in (reached, again))
    assert (one.attrs["non_monotone_share"], other.attrs["non_monotone_share"]) == (0.0, 1.0 / 18.0)
    xr.testing.assert_equal(one, other)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda x, y: (x[::-1], y), "scale must be positive and increase"),
        (lambda x, y: (np.r_[x[:4], x[3:-1]], y), "scale must be positive and increase"),
        (lambda x, y: (np.r_[0.0, x[1:]], y), "scale must be positive and increase"),
        (lambda x, y: (np.r_[x[:-1], np.inf], y), "scale must be positive and increase"),
        (lambda x, y: (np.r_[np.nan, x[1:]], y), "scale must be positive and increase"),
        (lambda x, y: (x[1:], y), "scale must have as many numbers as reached along scale"),
        (lambda x, y: (x, y.isel(record=[0])), "reached must have two or more along record, got 1"),
        (lambda x, y: (x, y.isel(record=0)), "reached must be a DataArray over record, property_sample, scale"),
        (lambda x, y: (x, y + 2), "reached must hold True or False"),
    ],
)
def test_mistakes_are_told(change, message):
    rng = np.random.default_rng(0)
    with pytest.raises(ParameterError, match=message):
        dispersion_parts(*change(*series(rng, 3, 3)), rng=rng)


def test_draws_need_a_seed_or_a_generator():
    seen = series(np.random.default_rng(0), 3, 3)
    with pytest.raises(ParameterError, match=r"rng must be a whole number of at least 0, got 0\.5"):
        dispersion_parts(*seen, rng=0.5)
    xr.testing.assert_equal(dispersion_parts(*seen, rng=3), dispersion_parts(*seen, rng=np.random.default_rng(3)))
