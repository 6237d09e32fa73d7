"""Figures of spectra show each interval where it is, and say what is not known."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.patches import PathPatch

import stylobate as sb
from stylobate.earthquakes.figures.overturning_intervals import UNDECIDED
from stylobate.earthquakes.overturning_scales import Cases, Edges, Ends, interval_table
from stylobate.errors import Outcome, ParameterError
from stylobate.plots.cells import OUTCOME_LOOKS, cell_edges
from stylobate.plots.style import VERMILION

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
PULSE = sb.Pulse.one_sine(acceleration=0.1, angular_frequency=5.0)
FALLEN, SAFE, LIFTED = (Outcome.OVERTURNED, Outcome.AT_REST, Outcome.LIFTED_OFF)
STATES = {FALLEN: 1, SAFE: 0, LIFTED: -2}


def intervals(over, codes, motion=PULSE, uncertain=()):
    """Return the intervals of a scan that came to these outcomes, at the scales 1, 2, 3 …"""
    cases = Cases.of(MODEL, motion, over)
    codes = np.broadcast_to(np.array(codes), (cases.count, len(codes)))
    scales = np.arange(1.0, codes.shape[1] + 1.0)
    unsure = np.zeros(codes.shape, dtype=bool)
    unsure[:, list(uncertain)] = True
    states = np.vectorize(STATES.get)(codes).astype(np.int64)
    scan = Ends(np.broadcast_to(scales, codes.shape), states, np.zeros(codes.shape), unsure)
    dims = (*cases.axes, "scale")
    shape = (*cases.shape, scales.size)
    found = interval_table(
        cases, scan, Edges.between(np.repeat(np.arange(cases.count), scan.scale.shape[-1]), scan.reshaped(-1))
    )
    found = found.assign(outcome=(dims, codes.reshape(shape)), uncertain=(dims, unsure.reshape(shape)))
    found = found.assign(peak_tilt=(dims, np.broadcast_to(0.01 * scales, shape)))
    coords = {**cases.coordinates(), "scale": ("scale", scales, {"long_name": "factor of the base motion"})}
    return found.assign_coords(coords).assign_attrs(kind="overturning intervals", width=1e-3)


def legend_of(figure):
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


def boxes(axes, colour):
    """Return left, right, bottom and top of all boxes of this colour."""
    found = []
    for patch in axes.patches:
        if isinstance(patch, PathPatch) and np.allclose(patch.get_facecolor()[:3], colour):
            corners = patch.get_path().vertices.reshape(-1, 5, 2)
            found += [(c[0, 0], c[1, 0], c[0, 1], c[2, 1]) for c in corners]
    return sorted(found)


def heights(axes, colour):
    """Return bottom and top of all boxes of this colour, each once."""
    return {(round(float(low), 9), round(float(high), 9)) for *_, low, high in boxes(axes, colour)}


def rgb(text):
    return [int(text[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]


DARK = rgb(OUTCOME_LOOKS[Outcome.OVERTURNED].colour)
PATTERN = [SAFE, FALLEN, FALLEN, SAFE, FALLEN]


def test_intervals_of_a_pulse_stand_over_the_frequency_ratio_in_units_of_g_tan_alpha():
    found = intervals({"angular_frequency": [2.0, 3.0, 4.0]}, PATTERN)
    (axes,) = sb.plot(found).axes
    ratio, unit = found["frequency_ratio"].values, found["acceleration_ratio"].values
    edges = cell_edges(ratio)
    expected = [
        (edges[k], edges[k + 1], low * unit[k], high * unit[k]) for k in range(3) for low, high in ((2, 3), (5, 5))
    ]
    drawn = boxes(axes, DARK)
    np.testing.assert_allclose(drawn, [box for box in sorted(expected) if box[3] > box[2]], rtol=1e-12)
    assert axes.get_xlabel() == "ω / p"
    assert axes.get_ylabel() == r"peak base acceleration $a/(c\,g)$"
    assert axes.get_ylim() == pytest.approx((1.0 * unit[0], 5.0 * unit[0]))


def test_the_order_of_the_values_does_not_matter():
    first = intervals({"angular_frequency": [2.0, 3.0, 4.0]}, PATTERN)
    second = first.isel(angular_frequency=[2, 0, 1])
    one, other = (boxes(sb.plot(found).axes[0], DARK) for found in (first, second))
    np.testing.assert_allclose(one, other)


def test_what_is_undecided_is_drawn_by_itself_and_neither_safe_nor_overturned():
    # Safe, overturned, undecided, safe again, overturned, undecided, at the scales 1, 2 ... 6.
    figure = sb.plot(intervals({"damping": [0.1, 0.2]}, [SAFE, FALLEN, LIFTED, SAFE, FALLEN, LIFTED], uncertain=[0]))
    assert {"not decided: lifted off", "not decided: 4 runs", "uncertain: 2 runs"} <= set(legend_of(figure))
    (axes,) = figure.axes
    grey, again = rgb(UNDECIDED.colour), rgb("#DCEBF5")
    assert heights(axes, grey) == {(2.0, 4.0), (5.0, 6.0)}
    assert not heights(axes, again)
    assert all(low == high for *_, low, high in boxes(axes, DARK))


def test_what_stands_above_an_undecided_stretch_is_safe_again_if_something_overturned_below():
    (axes,) = sb.plot(intervals({"damping": [0.1, 0.2]}, [FALLEN, LIFTED, SAFE, SAFE])).axes
    assert heights(axes, rgb("#DCEBF5")) == {(3.0, 4.0)}
    (axes,) = sb.plot(intervals({"damping": [0.1, 0.2]}, [SAFE, LIFTED, SAFE, FALLEN])).axes
    assert not boxes(axes, rgb("#DCEBF5"))


def test_a_record_is_drawn_by_its_scale_over_the_size_a_panel_for_each_slenderness():
    record = sb.Record(samples=[0.0, 0.3, 0.0], step=0.1, name="short")
    over = {"size": [1.0, 2.0, 4.0, 8.0], "slenderness": [0.1, 0.2]}
    figure = sb.plot(intervals(over, PATTERN, record))
    assert [axes.get_title(loc="left") for axes in figure.axes] == ["slenderness 0.1", "slenderness 0.2"]
    first, second = figure.axes
    assert first.get_xlabel() == second.get_xlabel() == "size 2R [m]"
    assert first.get_ylabel() == "factor of the base motion"
    assert first.get_xscale() == "log"
    assert r"peak acceleration $c\,g$" in legend_of(figure)
    np.testing.assert_allclose(first.lines[-1].get_ydata(), 0.1 / 0.3)


def test_motions_stand_side_by_side_under_their_names():
    records = tuple(sb.Record(samples=[0.0, 0.3, 0.0], step=0.1, name=name) for name in ("Aigio", "Bam"))
    (axes,) = sb.plot(intervals({"motion": [0, 1]}, PATTERN, sb.OneOf(motions=records))).axes
    assert [text.get_text() for text in axes.get_xticklabels()] == ["Aigio", "Bam"]


def test_intervals_of_one_column_lie_along_the_amplitude_with_the_peak_tilts_between_them():
    found = intervals(None, PATTERN, uncertain=[0])
    figure = sb.plot(found)
    (axes,) = figure.axes
    unit = float(found["acceleration_ratio"])
    (patch,) = [one for one in axes.patches if np.allclose(one.get_facecolor()[:3], DARK)]
    corners = patch.get_path().vertices
    np.testing.assert_allclose([corners[:, 0].min(), corners[:, 0].max()], [2.0 * unit, 3.0 * unit], rtol=1e-12)
    assert axes.get_xlabel() == r"peak base acceleration $a/(c\,g)$"
    assert "ω / p = 5" in axes.get_title(loc="left")
    (tilts,) = [line for line in axes.lines if line.get_marker() == "." and len(line.get_xdata()) == 5]
    expected = np.array([0.01, np.nan, np.nan, 0.04, np.nan]) / float(found["tipping_angle"])
    np.testing.assert_allclose(tilts.get_ydata(), expected, rtol=1e-12)
    assert {"peak tilt where it survives", "uncertain: 1 run"} <= set(legend_of(figure))


def test_a_single_value_of_a_parameter_is_drawn_as_one_column():
    (axes,) = sb.plot(intervals({"size": [2.0], "damping": [0.1]}, PATTERN)).axes
    assert axes.get_ylabel() == r"peak tilt $\theta/\alpha_c$"


@pytest.mark.parametrize("over", [None, {"size": [1.0, 2.0, 4.0]}])
def test_an_interval_too_narrow_to_be_seen_is_drawn_and_counted_as_such(over):
    record = sb.Record(samples=[0.0, 0.3, 0.0], step=0.1, name="short")
    found = intervals(over, [SAFE, SAFE, FALLEN, SAFE, SAFE], record)
    narrow = found.assign(
        interval_from=0.0 * found["interval_from"] + 3.0, interval_to=0.0 * found["interval_to"] + 3.001
    )
    count = 1 if over is None else 3
    label = f"overturns, narrower than drawn: {count} interval{'s' if count > 1 else ''}"
    figure = sb.plot(narrow)
    assert label in legend_of(figure)
    (axes,) = figure.axes
    lines = [line for line in axes.lines if line.get_color() == VERMILION and line.get_linestyle() == "-"]
    along = [np.mean(line.get_xdata() if over is None else line.get_ydata()) for line in lines]
    np.testing.assert_allclose(along, [3.0005] * count, rtol=1e-12)
    wide = found.assign(interval_to=0.0 * found["interval_to"] + 3.5)
    assert not [text for text in legend_of(sb.plot(wide)) if "narrower" in text]


@pytest.mark.parametrize("over", [None, {"size": [1.0, 2.0, 4.0]}])
def test_an_edge_is_in_the_legend_if_it_is_wide_enough_to_be_seen(over):
    found = intervals(
        over, [SAFE, SAFE, FALLEN, FALLEN, SAFE], sb.Record(samples=[0.0, 0.3, 0.0], step=0.1, name="short")
    )
    for width, seen in ((0.02, True), (0.002, False)):  # on an axis from 1 to 5, in scales
        edges = {"safe_below": found["interval_from"] - width, "safe_above": found["interval_to"] + width}
        assert ("edge, not resolved" in legend_of(sb.plot(found.assign(edges)))) is seen


def test_too_many_parameters_are_refused():
    crowded = intervals({"size": np.arange(1.0, 7.0), "damping": np.arange(0.1, 0.6, 0.1)}, PATTERN)
    with pytest.raises(ParameterError, match="two with up to 4 values along one of them"):
        sb.plot(crowded)
    with pytest.raises(ParameterError, match="one dimension, or two"):
        sb.plot(intervals({"size": [1.0], "damping": [0.1], "slenderness": [0.1]}, PATTERN))


@pytest.fixture
def rocking():
    cases = Cases.of(MODEL, PULSE, {"size": [1.0, 2.0, 4.0], "slenderness": [0.1, 0.2]})
    dims = tuple(cases.axes)
    peaks = np.array([[np.nan, 0.5], [0.4, 0.3], [0.2, 0.1]])
    codes = np.where(np.isnan(peaks), FALLEN, SAFE)
    period = 2.0 * np.pi / cases.over_axes(cases.numbers["frequency_parameter"])
    data = {
        "peak_tilt_ratio": (dims, peaks, {"long_name": "peak tilt / α_c", "units": "1"}),
        "peak_rate_ratio": (dims, 2.0 * peaks, {"long_name": "peak rate of tilt / p", "units": "rad"}),
        "outcome": (dims, codes),
        "uncertain": (dims, np.zeros((3, 2), dtype=bool)),
    }
    period = (dims, period, {"long_name": "period 2π/p", "units": "s"})
    return xr.Dataset(data, {**cases.coordinates(), "rocking_period": period}, {"kind": "rocking spectrum"})


def test_a_rocking_spectrum_is_drawn_against_the_period(rocking):
    figure = sb.plot(rocking)
    above, below = figure.axes
    assert below.get_xlabel() == "period 2π/p [s]"
    assert above.get_ylabel() == r"peak tilt / $α_c$"
    curves = [line for line in above.lines if len(line.get_xdata()) == 3]
    for place, curve in enumerate(curves):
        np.testing.assert_allclose(curve.get_xdata(), rocking["rocking_period"][:, place])
        np.testing.assert_array_equal(curve.get_ydata(), rocking["peak_tilt_ratio"][:, place])
    assert len({(curve.get_color(), curve.get_linestyle(), curve.get_marker()) for curve in curves}) == 2
    assert legend_of(figure) == ["slenderness 0.1", "slenderness 0.2", "overturned"]
    for axes, largest in ((above, 0.5), (below, 1.0)):
        assert axes.get_ylim()[0] == 0.0
        assert largest < axes.get_ylim()[1] < 1.5 * largest


def test_a_mark_hangs_where_the_column_overturned(rocking):
    above, _ = sb.plot(rocking).axes
    (marked,) = [line for line in above.lines if line.get_transform() != above.transData and len(line.get_xdata())]
    np.testing.assert_allclose(marked.get_xdata(), rocking["rocking_period"][0, 0])
