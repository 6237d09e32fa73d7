"""Figures of fragility show what was fitted, what was observed, and what the data leave open."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.earthquakes import HazardCurve, annual_rate, fit_fragility, lognormal_fragility, reached_intervals

SCALE = xr.DataArray(
    np.geomspace(1.0, 9.0, 9), dims="scale", attrs={"units": "m s-2", "long_name": "peak ground acceleration"}
)


@pytest.fixture(scope="module")
def reached():
    rng = np.random.default_rng(4)
    capacity = rng.normal(0.0, 0.4, (20, 1))
    states = [np.log(SCALE.values / median) > capacity for median in (2.0, 4.0)]
    states.append(np.zeros_like(states[0]))
    labels = {"limit_state": ["tilt 0.001 α", "overturning", "never"]}
    found = xr.DataArray(states, dims=("limit_state", "record", "scale"), coords=labels)
    found[1, 0] = [0, 0, 1, 0, 0, 1, 1, 1, 1]
    return found


def legend_of(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def test_curves_and_points_are_those_of_the_result(reached):
    found = fit_fragility(SCALE, reached)
    figure = sb.plot(found)
    (axes,) = figure.axes
    curves = [line for line in axes.lines if len(line.get_xdata()) == found.sizes["curve"]]
    assert len(curves) == 3
    for place, curve in enumerate(curves):
        np.testing.assert_array_equal(curve.get_ydata(), found["probability"][place])
    assert axes.get_xlabel() == "peak ground acceleration [m/s²]"
    points = [container.lines[0] for container in axes.containers]
    for place, point in enumerate(points):
        np.testing.assert_array_equal(point.get_ydata(), found["stripe_share"][place])


def test_curves_differ_in_more_than_colour(reached):
    (axes,) = sb.plot(fit_fragility(SCALE, reached)).axes
    marks = {container.lines[0].get_marker() for container in axes.containers}
    assert len(marks) == 3


def test_what_is_not_fitted_or_not_monotone_is_said(reached):
    figure = sb.plot(fit_fragility(SCALE, reached))
    names = legend_of(figure)
    assert any("never\nno fit: none reached\nmedian above" in name for name in names)
    title = figure.axes[0].get_title(loc="left")
    assert "not monotonic: 1 of 20 records" in title
    assert "runs counted as computed" in title
    assert "runs taken as independent" in title


@pytest.mark.parametrize(
    ("first", "median"), [(0, "below 1 m/s²"), (4, "from 2.28 to 3 m/s²"), (9, "above 9 m/s²"), (None, "open m/s²")]
)
def test_the_median_of_what_is_not_fitted_is_bounded_by_the_runs(first, median):
    """Every record reaches the limit state from the same scale on; None: none is decided."""
    states = np.full((6, 9), -1) if first is None else np.tile(np.arange(9) >= first, (6, 1)).astype(int)
    found = fit_fragility(SCALE, xr.DataArray(states, dims=("record", "scale")))
    assert f"\nmedian {median}" in legend_of(sb.plot(found))[0]


def test_what_is_reached_less_often_at_higher_intensities_is_not_taken_for_a_gap():
    falling = xr.DataArray(np.tile(np.arange(9) < 4, (6, 1)).astype(int), dims=("record", "scale"))
    found = fit_fragility(SCALE, falling)
    assert "no fit: not increasing\n" in legend_of(sb.plot(found))[0]


def test_a_title_stays_clear_of_the_legend(reached):
    figure = sb.plot(fit_fragility(SCALE, reached, resamples=20, rng=np.random.default_rng(0)))
    figure.canvas.draw()
    (legend,) = figure.legends
    (title,) = [text for text in figure.axes[0].get_children() if getattr(text, "get_text", str)().startswith("band")]
    assert title.get_window_extent().x1 <= legend.get_window_extent().x0


def test_a_curve_known_from_elsewhere_has_no_points():
    (axes,) = sb.plot(lognormal_fragility(3.0, 0.4, units="m s-2")).axes
    assert not axes.containers
    assert len(axes.lines) == 1


def test_areas_of_the_contributions_are_shares_of_the_rate():
    hazard = HazardCurve(intensity=[0.1, 1.0, 10.0], rate=[0.1, 1e-2, 1e-4])
    found = annual_rate(lognormal_fragility(3.0, 0.4), hazard)
    _, below = sb.plot(found).axes
    (steps,) = below.patches
    values, edges, _ = steps.get_data()
    assert np.sum(values * np.diff(np.log(edges))) == pytest.approx(1.0 - found["share_beyond"].item(), rel=1e-9)


def test_a_rate_mostly_from_beyond_the_hazard_is_not_drawn_as_a_fact():
    hazard = HazardCurve(intensity=[0.1, 1.0, 10.0], rate=[0.1, 1e-2, 1e-4])
    found = annual_rate(lognormal_fragility(60.0, 0.3), hazard)
    (entry,) = legend_of(sb.plot(found))
    plain = " ".join(entry.split())
    assert "withheld: the hazard curve ends at 10, and all of the rate lies beyond bounds" in plain
    assert f"{found['annual_rate'].item():.2e} /a" not in plain


@pytest.mark.parametrize("records", [20, 100])
def test_intervals_of_records_that_are_not_monotone_are_named(reached, records):
    one = reached.sel(limit_state="overturning")
    many = xr.concat([one.isel(record=0), *[one.isel(record=1)] * (records - 1)], dim="record")
    many = many.assign_coords(record=[f"r{place}" for place in range(records)])
    figure = sb.plot(reached_intervals(SCALE, many))
    (axes,) = figure.axes
    labels = [label.get_text() for label in axes.get_yticklabels()]
    assert [label for label in labels if label.endswith("*")] == ["r0 *"]
    assert figure.get_figheight() <= 9.0
    assert legend_of(figure) == ["survives", "reached", "survives again"]
