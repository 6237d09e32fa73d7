"""Poincaré sections: points for periodic orbits, closed curves for modulated rolling."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import EndedEarlyWarning, Outcome, ParameterError, UnsupportedError

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
RTOL = 1e-10


def circular(frequency, **options):
    return sb.Harmonic.circular(acceleration=0.065, angular_frequency=frequency, **options)


def section_of(motion, factor=1.0, **options):
    start = sb.studies.steady_start(MODEL, motion)
    tilt = factor * np.array(start["tilt"])
    return sb.studies.poincare_section(MODEL, motion, tilt=tilt, tilt_rate=start["tilt_rate"], **options)


def test_steady_rolling_is_one_point_at_any_start_phase():
    motion = circular(1.8, start_phase=0.7)
    start = sb.studies.steady_start(MODEL, motion)
    section = section_of(motion, periods=40, skip=20)
    assert section["period"].values.tolist() == list(range(20, 41))
    # Errors of rtol of a step, some hundred of them while they decay.
    for name in ("tilt", "tilt_rate"):
        expected = np.broadcast_to(start[name], section[f"section_{name}"].values[0].shape)
        np.testing.assert_allclose(section[f"section_{name}"].values[0], expected, atol=100.0 * RTOL * 0.1)


def test_an_orbit_is_met_where_it_is_known_to_be():
    motion = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
    orbit = sb.orbits.periodic_orbit(MODEL, motion)
    section = sb.studies.poincare_section(MODEL, motion, tilt=orbit.tilt, tilt_rate=orbit.tilt_rate, periods=30, skip=0)
    np.testing.assert_allclose(
        section["section_tilt"].values[0], np.tile(orbit.tilt, (31, 1)), atol=100.0 * RTOL * orbit.peak_tilt
    )


def test_modulated_rolling_fills_a_closed_curve_about_the_unstable_point():
    motion = circular(1.36)
    section = section_of(motion, 1.01, periods=800, skip=300)
    x, y = section["section_tilt"].values[0].T
    centre = sb.studies.steady_start(MODEL, motion)["tilt"]
    radius, angle = np.hypot(x - centre[0], y - centre[1]), np.arctan2(y - centre[1], x - centre[0])
    order = np.argsort(angle)
    gaps = np.diff(np.append(angle[order], angle[order][0] + 2.0 * np.pi))
    # A rotation puts its points at three distances at most (Steinhaus): 500 of them leave no wide gap.
    assert gaps.max() < 0.2
    # On a curve neighbours are as near as a curve of that size lets them be; a cloud would fill its width.
    steps = np.abs(np.diff(np.append(radius[order], radius[order][0])))
    assert (steps < radius.max() * np.tan(gaps + 1e-3) + 1e-6).all()
    assert radius.min() > 0.01


def test_a_start_on_the_curve_and_one_beside_it_come_to_the_same_curve():
    motion = circular(1.36)
    start = sb.studies.steady_start(MODEL, motion)
    tilt = np.outer([1.01, 1.1], start["tilt"])
    section = sb.studies.poincare_section(MODEL, motion, tilt=tilt, tilt_rate=start["tilt_rate"], periods=900, skip=300)
    first, second = section["section_tilt"].values
    apart = np.hypot(*np.moveaxis(first[:, None] - second[None], -1, 0)).min(axis=1)
    # Points of 600 on the curve, 0.15 rad long: the nearest is within a few of their mean distance.
    assert apart.max() < 10.0 * 0.15 / 600


def test_a_column_that_overturns_has_no_more_points():
    with pytest.warns(EndedEarlyWarning) as caught:
        section = section_of(circular(0.9), 1.3, periods=60, skip=0)
    assert f"1 overturned, at t = {section['decided_at'].item():.4g} s, of 1 run" in str(caught[0].message)
    assert section["outcome"].item() == Outcome.OVERTURNED
    known = np.isfinite(section["section_tilt"].values[0, :, 0])
    period = circular(0.9).period
    assert known.sum() == np.floor(section["decided_at"].item() / period) + 1
    assert known[: known.sum()].all()


def test_starts_on_a_grid_keep_their_dimensions():
    motion = circular(1.8)
    tilt = xr.DataArray(np.full((3, 2), 0.01), dims=("start", "axis"))
    section = sb.studies.poincare_section(MODEL, motion, tilt=tilt, periods=3, skip=2)
    assert section["section_tilt"].dims == ("start", "period", "axis")
    assert section["section_tilt"].attrs["units"] == "rad"
    assert section["section_tilt_rate"].attrs["units"] == "rad s-1"


def test_what_cannot_be_is_refused():
    with pytest.raises(ParameterError, match="skip must be at most periods"):
        section_of(circular(1.8), periods=5, skip=6)
    with pytest.raises(UnsupportedError, match="without ramp"):
        sb.studies.poincare_section(MODEL, circular(1.8, ramp=3.0), tilt=(0.03, 0.0))


def test_a_base_motion_that_is_none_is_told():
    model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
    with pytest.raises(ParameterError, match="motion must be a periodic base motion"):
        sb.studies.poincare_section(model, None, tilt=(0.01, 0.0))
