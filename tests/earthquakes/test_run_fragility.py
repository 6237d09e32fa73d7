"""A fragility of runs is that of their intensities, records and samples; a known truth is recovered."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.earthquakes import (
    Counting,
    dispersion_parts,
    fit_fragility,
    fragility_of_runs,
    incremental_dynamic_analysis,
)

MODEL = sb.Slender(sb.Column.solid(radius=0.4, height=4.0, density=2700.0), damping=0.05)
MEDIAN, OF_RECORDS, OF_SAMPLES = 4.5, 0.35, 0.15


def made_up(rng, records=60, samples=8):
    """Return runs of a column whose capacities are known."""
    pga = np.geomspace(0.7, 30.0, 16)
    capacity = MEDIAN * np.exp(
        rng.normal(0.0, OF_RECORDS, (records, 1, 1)) + rng.normal(0.0, OF_SAMPLES, (1, samples, 1))
    )
    reached = (pga > capacity).astype(np.int8)
    dims = ("record", "property_sample", "scale")
    return xr.Dataset(
        {
            "reached": (("limit_state", *dims), reached[np.newaxis]),
            "intensity": (("record", "scale"), np.tile(pga, (records, 1)), {"units": "m s-2", "long_name": "PGA"}),
        },
        coords={"limit_state": ["overturning"], "record": [f"{place}" for place in range(records)], "scale": pga},
        attrs={"kind": "incremental dynamic analysis", "provenance": "{}"},
    )


def test_median_and_dispersion_of_made_up_capacities_are_recovered():
    runs = made_up(np.random.default_rng(3))
    found = fragility_of_runs(runs, resamples=200, rng=np.random.default_rng(0)).isel(limit_state=0)
    assert float(found["median_low"]) < MEDIAN < float(found["median_high"])
    assert float(found["dispersion"]) == pytest.approx(np.hypot(OF_RECORDS, OF_SAMPLES), rel=0.2)
    assert int(found["non_monotone_records"]) == 0
    parts = dispersion_parts(
        runs["intensity"], runs["reached"].sel(limit_state="overturning"), rng=np.random.default_rng(0)
    )
    for name, truth in (("record", OF_RECORDS), ("property", OF_SAMPLES)):
        low, high = (float(parts[f"{name}_dispersion_{end}"]) for end in ("low", "high"))
        assert low < truth < high


def test_it_is_the_fit_to_the_same_runs():
    pulses = [sb.Pulse.one_sine(acceleration=1.0, angular_frequency=w) for w in (3.0, 4.0, 5.0, 6.5, 8.0)]
    runs = incremental_dynamic_analysis(MODEL, pulses, scales=np.linspace(2.0, 8.0, 13), rotations=(0.0, 0.4))
    found = fragility_of_runs(runs)
    shape = runs["outcome"].shape
    intensity = np.broadcast_to(runs["intensity"].to_numpy()[:, np.newaxis], shape)
    record = np.broadcast_to(np.arange(5)[:, np.newaxis, np.newaxis], shape)
    turned = np.broadcast_to(np.arange(2)[:, np.newaxis], shape)
    for state in ("tilt 0.001 α", "tilt 0.5 α", "overturning"):
        reached = runs["reached"].sel(limit_state=state).to_numpy()
        same = fit_fragility(intensity, reached, record=record, property_sample=turned)
        for name in ("median", "dispersion", "status", "runs", "non_monotone_records"):
            np.testing.assert_array_equal(found[name].sel(limit_state=state), same[name][0])
    assert found["median"].attrs["units"] == "m s-2"


def test_safe_again_is_counted_as_said():
    runs = made_up(np.random.default_rng(1), records=20, samples=1).isel(property_sample=0)
    last = int(np.argmax(runs["intensity"][0].to_numpy() > 20.0))
    runs["reached"][0, :5, last] = 0
    as_computed, first = (
        fragility_of_runs(runs, counting=counting) for counting in (Counting.AS_COMPUTED, Counting.FIRST)
    )
    assert int(as_computed["non_monotone_records"][0]) == 5
    assert float(first["dispersion"][0]) < float(as_computed["dispersion"][0])


def test_other_results_are_refused():
    with pytest.raises(sb.errors.ParameterError, match="runs must be an incremental dynamic analysis, got None"):
        fragility_of_runs(xr.Dataset())
