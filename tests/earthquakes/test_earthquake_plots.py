"""Figures of shaken columns show tilts as tilts and overturning as overturning."""

from io import BytesIO

import numpy as np
import pytest
import xarray as xr
from matplotlib import rc_context

import stylobate as sb
from stylobate.records import response_spectra

NAN, INF = np.nan, np.inf


def analysis(tilt, intensity, **coords):
    """Return an incremental dynamic analysis of these peak tilts over α, (record, scale)."""
    tilt, intensity = np.asarray(tilt, dtype=float), np.asarray(intensity, dtype=float)
    names = [f"quake {place}" for place in range(len(tilt))]
    return xr.Dataset(
        {
            "tilt_ratio": (("record", "scale"), tilt),
            "intensity": (("record", "scale"), np.broadcast_to(intensity, tilt.shape), {"units": "m s-2"}),
        },
        coords={"record": names, "scale": np.arange(1.0, 1.0 + tilt.shape[1]), **coords},
        attrs={"kind": "incremental dynamic analysis"},
    )


TILTS = [[0.1, 0.3, INF, INF], [0.2, INF, 0.5, INF], [0.0, 0.2, 0.4, NAN]]


def lines_of(axes):
    return [(np.asarray(line.get_xdata(), float), np.asarray(line.get_ydata(), float)) for line in axes.lines]


def test_tilts_are_drawn_and_overturned_runs_stand_apart():
    figure = sb.plot(analysis(TILTS, [1.0, 2.0, 3.0, 4.0]))
    strip, tilts = figure.axes
    for row, (x, y) in zip(TILTS, lines_of(tilts)[:3], strict=True):
        np.testing.assert_array_equal(x, [1.0, 2.0, 3.0, 4.0])
        np.testing.assert_array_equal(y, np.where(np.isfinite(row), row, NAN))
    fallen = [set(x) for x, _ in lines_of(strip)[0::2]]
    back = [set(x) for x, _ in lines_of(strip)[1::2]]
    assert fallen == [{3.0, 4.0}, {2.0, 4.0}, set()]
    assert back == [set(), {3.0}, set()]
    # A median of runs of which one does not tell is not drawn; overturned runs count as above all.
    median = lines_of(tilts)[4][1]
    np.testing.assert_array_equal(median, [0.1, 0.3, 0.5, NAN])
    assert tilts.get_xlabel() == "intensity [m/s²]"


@pytest.mark.parametrize("name", [r"$\frac{1$", "$x$ and $y", "a$b"])
def test_the_name_of_a_record_is_printed_as_it_is(name):
    found = analysis(TILTS, [1.0, 2.0, 3.0, 4.0]).assign_coords(record=[name, "b", "c"])
    text = BytesIO()
    with rc_context({"svg.fonttype": "none"}):
        sb.plot(found).savefig(text, format="svg")
    assert f">{name}</text>" in text.getvalue().decode()


def test_there_are_no_quantiles_where_intensities_differ():
    figure = sb.plot(analysis(TILTS, [[1.0, 2.0, 3.0, 4.0], [2.0, 3.0, 4.0, 5.0], [1.0, 2.0, 3.0, 4.0]]))
    strip, tilts = figure.axes
    assert len(tilts.lines) == 3
    assert "no quantiles" in strip.get_title(loc="left")


def test_many_records_and_other_dimensions_are_drawn_too():
    many = analysis(np.linspace(0.0, 0.9, 40).reshape(10, 4), [1.0, 2.0, 3.0, 4.0])
    figure = sb.plot(many)
    assert len(figure.axes[1].lines) == 13
    assert figure.legends[0].get_texts()[0].get_text() == "10 records"
    sampled = many.expand_dims(property_sample=3).transpose("record", "property_sample", "scale")
    assert len(sb.plot(sampled.assign(intensity=many["intensity"])).axes[1].lines) == 33
    assert len(sb.plot(many.isel(record=0)).axes[1].lines) == 1
    with pytest.raises(sb.errors.ParameterError, match="must have the dimension scale"):
        sb.plot(many.isel(scale=0))


def bias(flat, space):
    """Return a planar bias: planar tilts (record, direction, scale), those in space (record, scale)."""
    flat, space = np.asarray(flat, dtype=float), np.asarray(space, dtype=float)
    dims = ("record", "direction", "scale")
    angles = np.linspace(0.0, np.pi, flat.shape[1], endpoint=False)
    return xr.Dataset(
        {
            "planar_tilt_ratio": (dims, flat),
            "worst_planar_tilt_ratio": (("record", "scale"), flat.max(axis=1)),
            "tilt_ratio": (("record", "scale"), space),
            **{f"overall_{name}": ((), 0.1) for name in ("bias", "scatter", "standard_error")},
            "overall_compared": ((), 2),
        },
        coords={
            "record": [f"quake {place}" for place in range(len(flat))],
            "direction": angles,
            "scale": np.arange(1.0, 1.0 + flat.shape[2]),
        },
        attrs={"kind": "planar bias"},
    )


FLAT = [[[0.1, 0.2, INF], [0.3, INF, INF]], [[0.0, 0.4, 0.8], [0.2, 0.1, 0.9]]]
SPACE = [[0.4, INF, INF], [0.3, 0.5, INF]]


def test_overturned_columns_lie_in_the_margins():
    figure = sb.plot(bias(FLAT, SPACE))
    axes = figure.axes[0]
    points = np.asarray(axes.collections[0].get_offsets())
    end = axes.lines[1].get_xdata()[0]
    worst, space = np.max(FLAT, axis=1).ravel(), np.ravel(SPACE)
    np.testing.assert_array_equal(points[:, 0] > end, np.isinf(worst))
    np.testing.assert_array_equal(points[:, 1] > end, np.isinf(space))
    inside = np.isfinite(worst) & np.isfinite(space)
    np.testing.assert_allclose(points[inside], np.stack([worst, space], axis=-1)[inside])
    assert "in three dimensions only: 1, planar only: 0, both: 2" in axes.get_title(loc="left")


def test_directions_are_drawn_by_the_least_scale_that_overturns():
    figure = sb.earthquakes.plot_directions(bias(FLAT, SPACE))
    first, second = figure.axes
    angle, radius = lines_of(first)[0]
    np.testing.assert_allclose(angle[:4], [0.0, np.pi / 2, np.pi, 3 * np.pi / 2])
    np.testing.assert_array_equal(radius[:4], [3.0, 2.0, 3.0, 2.0])
    np.testing.assert_array_equal(np.unique(lines_of(first)[-1][1]), [2.0])
    # Beyond all scales: open marks on the rim.
    rim = lines_of(second)[2]
    assert rim[1].size == 4
    assert rim[1].min() > 3.0
    single = sb.earthquakes.plot_directions(bias(FLAT, SPACE).isel(scale=[0]))
    np.testing.assert_allclose(lines_of(single.axes[0])[0][1][:2], [0.1, 0.3])
    turned = analysis(TILTS, [1.0, 2.0, 3.0, 4.0]).rename(record="rotation").drop_vars("rotation")
    turned = turned.assign_coords(rotation=[0.0, 1.0, 2.0], record="quake")
    angle, radius = lines_of(sb.earthquakes.plot_directions(turned).axes[0])[0]
    np.testing.assert_array_equal(angle, [0.0, 1.0, 2.0, 0.0])
    np.testing.assert_array_equal(radius[:2], [3.0, 2.0])
    assert radius[2] > 4.0
    with pytest.raises(sb.errors.ParameterError, match="must have the dimension direction"):
        sb.earthquakes.plot_directions(bias(FLAT, SPACE).isel(direction=0))


def test_records_are_drawn_over_time_and_period():
    records = [sb.sample_record(), sb.Record(samples=np.sin(0.1 * np.arange(80)), step=0.02, name="one component")]
    spectra = {one.name: response_spectra(one, [0.2, 0.5, 1.0]) for one in records}
    figure = sb.earthquakes.plot_records(records, spectra)
    for place, record in enumerate(records):
        left, right = figure.axes[2 * place : 2 * place + 2]
        drawn = lines_of(left)
        assert len(drawn) == len(record.axes)
        for axis, (time, acceleration) in zip(record.axes, drawn, strict=True):
            np.testing.assert_array_equal(time, record.times)
            np.testing.assert_array_equal(acceleration, record.samples[:, "xyz".index(axis)])
        curves = {line.get_label(): line.get_ydata() for line in right.lines}
        for axis in record.axes:
            np.testing.assert_array_equal(curves[axis], spectra[record.name]["psa"].sel(axis=axis))
        assert ("RotD50" in curves) == ("rotd50" in spectra[record.name])
        if "RotD50" in curves:
            np.testing.assert_array_equal(curves["RotD50"], spectra[record.name]["rotd50"])
        assert left.get_title(loc="left") == record.name
        assert right.get_title(loc="left") == "response spectrum, 5 % damping"
