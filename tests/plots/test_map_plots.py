"""Figures of maps, basins, exponents and integrity show what their results hold, in colour and in grey."""

from itertools import combinations

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_rgb
from matplotlib.patches import Ellipse, PathPatch

import stylobate as sb
from stylobate.errors import Outcome, ParameterError
from stylobate.plots.cells import (
    KIND_LOOKS,
    OUTCOME_LOOKS,
    UNFINISHED,
    Look,
    MapClass,
    attractor_classes,
    cell_edges,
    draw_cells,
)
from stylobate.plots.labels import axis_label
from stylobate.plots.style import new_figure
from stylobate.studies.maps.attractor_search import KINDS
from stylobate.studies.maps.uncertainty_exponent import exponent_of

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
REST, OVERTURNED, ROLLING = (one for one in (Outcome.AT_REST, Outcome.OVERTURNED, Outcome.ROLLING))


def a_map(codes, uncertain=None, **axes):
    axes = axes or {
        "angular_frequency": ("angular_frequency", [1.0, 2.0, 3.0], {"units": "rad s-1"}),
        "acceleration": ("acceleration", [0.1, 0.2], {"units": "m s-2", "long_name": "peak acceleration"}),
    }
    codes = np.array(codes, dtype=np.int8)
    flags = np.zeros(codes.shape, bool) if uncertain is None else np.array(uncertain)
    data = {"outcome": (tuple(axes), codes), "uncertain": (tuple(axes), flags)}
    return xr.Dataset(data, coords=axes, attrs={"kind": "overturning map"})


def legend_of(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def lightness(colour):
    """CIE L* of an sRGB colour: what is left of it in grey print."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in to_rgb(colour)]
    luminance = np.dot([0.2126, 0.7152, 0.0722], linear)
    return 116.0 * np.cbrt(luminance) - 16.0 if luminance > 0.008856 else 903.3 * luminance


@pytest.mark.parametrize("looks", [[*OUTCOME_LOOKS.values(), UNFINISHED], [*KIND_LOOKS.values(), UNFINISHED]])
def test_classes_differ_in_grey_by_lightness_or_texture(looks):
    # Steps of 9 in L* are told apart side by side; closer ones need another texture.
    for first, second in combinations(looks, 2):
        assert abs(lightness(first.colour) - lightness(second.colour)) > 9.0 or first.texture != second.texture


def test_the_usual_outcomes_differ_in_grey_by_lightness_alone():
    usual = (Outcome.AT_REST, Outcome.STILL_MOVING, Outcome.ROCKING, Outcome.ROLLING, Outcome.MODULATED)
    levels = [lightness(OUTCOME_LOOKS[one].colour) for one in (*usual, Outcome.OVERTURNED)]
    assert (np.diff(levels) < -9.0).all()


def test_every_outcome_and_kind_has_a_look():
    assert set(OUTCOME_LOOKS) == set(Outcome)
    assert set(KIND_LOOKS) == set(KINDS)


def test_a_map_shows_each_run_in_its_cell_with_units_and_shares():
    figure = sb.plot(a_map([[REST, OVERTURNED], [REST, ROLLING], [REST, OVERTURNED]]))
    axes = figure.axes[0]
    assert axes.get_xlabel() == "angular frequency [rad/s]"
    assert axes.get_ylabel() == "peak acceleration [m/s²]"
    assert legend_of(figure) == ["at rest  50.0 %", "rolling  16.7 %", "overturned  33.3 %"]
    (mesh,) = [one for one in axes.collections if isinstance(one, QuadMesh)]
    colours = mesh.to_rgba(mesh.get_array())[..., :3]
    expected = [
        [OUTCOME_LOOKS[one].colour for one in row]
        for row in ([Outcome.AT_REST] * 3, [Outcome.OVERTURNED, Outcome.ROLLING, Outcome.OVERTURNED])
    ]
    np.testing.assert_allclose(colours, [[to_rgb(colour) for colour in row] for row in expected], atol=1e-12)
    np.testing.assert_allclose(mesh.get_coordinates()[0, :, 0], [0.5, 1.5, 2.5, 3.5])


def test_an_unfinished_map_is_drawn_with_what_is_missing_hatched_and_named():
    figure = sb.plot(a_map([[REST, -1], [OVERTURNED, -1], [REST, -1]]))
    assert legend_of(figure) == ["at rest  33.3 %", "overturned  16.7 %", "not computed  50.0 %"]
    hatched = [one for one in figure.axes[0].patches if isinstance(one, PathPatch)]
    assert [one.get_hatch() for one in hatched] == [UNFINISHED.texture]
    corners = hatched[0].get_path().vertices
    np.testing.assert_allclose([corners.min(axis=0), corners.max(axis=0)], [[0.5, 0.15], [3.5, 0.25]])
    figure.canvas.draw()


def test_a_map_of_which_nothing_is_computed_is_drawn():
    figure = sb.plot(a_map(np.full((3, 2), -1)))
    assert legend_of(figure) == ["not computed  100.0 %"]
    figure.canvas.draw()


def test_uncertain_runs_are_dotted_where_they_are():
    figure = sb.plot(a_map([[REST, REST]] * 3, uncertain=[[False, False], [False, True], [False, False]]))
    assert legend_of(figure)[-1] == "uncertain  1 run"
    np.testing.assert_allclose(figure.axes[0].lines[0].get_xydata(), [[2.0, 0.2]])


def test_runs_in_any_order_are_drawn_in_that_of_their_values():
    given = a_map([[REST, OVERTURNED], [ROLLING, OVERTURNED]], tilt_x=[0.2, 0.1], tilt_y=[0.0, 0.1])
    first, second = (sb.plot(one).axes[0].collections[0] for one in (given, given.sortby("tilt_x")))
    np.testing.assert_array_equal(first.get_array(), second.get_array())


def test_runs_that_are_over_no_plane_are_refused():
    with pytest.raises(ParameterError, match="two dimensions"):
        sb.plot(a_map([REST, REST], tilt_x=[0.1, 0.2]))


def test_a_map_without_runs_says_so():
    with pytest.raises(ParameterError, match="a map needs at least one run, got sizes"):
        sb.plot(a_map(np.empty((0, 2)), tilt_x=[], tilt_y=[0.0, 0.1]))


def test_cells_meet_midway_between_their_values():
    np.testing.assert_allclose(cell_edges([1.0, 2.0, 4.0, 5.0]), [0.5, 1.5, 3.0, 4.5, 5.5])
    np.testing.assert_allclose(cell_edges([1.0, 10.0, 100.0]), np.sqrt(10.0) ** np.array([-1.0, 1.0, 3.0, 5.0]))
    low, high = cell_edges([0.0])
    assert low < 0.0 < high


@pytest.mark.parametrize(
    ("units", "written"),
    [("rad s-1", "x [rad/s]"), ("m s-2", "x [m/s²]"), ("kg m2", "x [kg m²]"), ("1", "x"), ("s-1", "x [1/s]")],
)
def test_units_are_written_as_one_reads_them(units, written):
    assert axis_label(xr.DataArray(0.0, attrs={"units": units, "long_name": "x"})) == written


@pytest.fixture(scope="module")
def free_basins():
    return sb.studies.basins(MODEL, over={"tilt_x": [-0.12, 0.05, 0.12], "tilt_rate_y": [0.0, 0.001]}, duration=200.0)


def test_a_map_of_basins_names_and_marks_its_attractors(free_basins):
    figure = sb.plot(free_basins)
    assert legend_of(figure) == ["at rest  33.3 %", "overturned  66.7 %", "attractors (stroboscopic samples)"]
    # Overturning has no state.
    np.testing.assert_array_equal(figure.axes[0].lines[0].get_xydata(), [[0.0, 0.0]])


def test_a_sample_is_drawn_as_fractions_with_their_intervals():
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
    start = sb.studies.steady_start(MODEL, motion)
    over = {"tilt_x": (0.9 * start["tilt"][0], 1.1 * start["tilt"][0])}
    found = sb.studies.attractors(
        MODEL, motion, over=over, count=3, tilt=start["tilt"], tilt_rate=start["tilt_rate"], periods=100
    )
    bars, orbits = sb.plot(found).axes
    assert [text.get_text() for text in bars.get_yticklabels()] == ["rolling anticlockwise"]
    assert bars.patches[0].get_width() == 1.0
    path = orbits.lines[0].get_xydata()
    np.testing.assert_allclose(np.hypot(*path.T), found["attractor_peak_tilt"].item(), rtol=1e-5)


def test_fractions_along_a_parameter_fill_the_height():
    box = {"tilt_x": (-0.1, 0.1), "tilt_rate_x": (-0.1, 0.1)}
    along = {"damping": [0.1, 1.0, 2.0]}
    found = sb.studies.basin_fractions(MODEL, along=along, over=box, count=8, duration=200.0)
    figure = sb.plot(found)
    bands = [one.get_paths()[0].vertices for one in figure.axes[0].collections if one.get_paths()]
    assert max(band[:, 1].max() for band in bands) == pytest.approx(1.0)
    assert legend_of(figure)[1:] == ["overturned", "at rest"]
    assert figure.axes[0].get_xlabel() == "damping of tilting"


def a_share(along):
    """Half of the starts overturn, half come to rest, at each value of friction."""
    dims, size = ("damping", "attractor_index"), (len(along), 2)
    attractors = {"attractor_kind": ["at rest", "overturned"], "attractor_name": ["at rest", "overturned"]}
    return xr.Dataset(
        {
            "fraction": (dims, np.full(size, 0.5)),
            "fraction_low": (dims, np.full(size, 0.4)),
            "fraction_high": (dims, np.full(size, 0.6)),
            "computed": ("damping", np.full(len(along), 60)),
            "unsettled": ("damping", np.zeros(len(along), dtype=int)),
            **{name: ("attractor_index", values) for name, values in attractors.items()},
        },
        coords={"damping": along},
        attrs={"kind": "basin fractions", "starts": 60, "confidence": 0.95},
    )


def test_fractions_at_a_single_value_are_bars():
    (axes,) = sb.plot(a_share([0.1])).axes
    lower, upper = axes.patches
    assert (lower.get_y(), lower.get_height(), upper.get_y(), upper.get_height()) == (0.0, 0.5, 0.5, 0.5)
    low, high = axes.get_xlim()
    assert low < lower.get_x() < 0.1 < lower.get_x() + lower.get_width() < high
    assert axes.get_xticks().tolist() == [0.1]


def rockings(count):
    """As many attractors that rock, with equal fractions."""
    dims, share = ("damping", "attractor_index"), np.full((2, count), 1.0 / count)
    named = dict.fromkeys(("attractor_kind", "attractor_name"), ("attractor_index", ["rocking"] * count))
    return a_share([0.1, 0.2])[["computed", "unsettled"]].assign(
        dict.fromkeys(("fraction", "fraction_low", "fraction_high"), (dims, share)) | named
    )


def test_every_band_of_fractions_is_named_inside_the_figure():
    count = 14
    figure = sb.plot(rockings(count))
    figure.canvas.draw()
    (legend,) = figure.legends
    box, whole = legend.get_window_extent(), figure.bbox
    assert len(legend.get_texts()) == count + 1
    assert whole.y0 <= box.y0 < box.y1 <= whole.y1


def test_many_narrow_bands_of_a_kind_are_one():
    figure = sb.plot(rockings(26))
    assert legend_of(figure)[1:] == ["rocking, 26"]
    (band,) = [one for one in figure.axes[0].collections if one.get_paths()]
    assert band.get_paths()[0].vertices[:, 1].max() == pytest.approx(1.0)


def test_on_a_fine_map_textures_are_left_out_where_classes_mix():
    axes = new_figure(3.0).subplots()
    codes = np.zeros((80, 80), dtype=int)
    codes[:, 60:] = np.arange(80)[:, None] % 2  # mixed on the right
    looks = [MapClass(0, "one", Look("#ffffff", "///")), MapClass(1, "other", Look("#000000", "..."))]
    draw_cells(axes, np.arange(80.0), np.arange(80.0), codes, looks)
    (texture,) = axes.patches
    assert texture.get_path().vertices[:, 0].max() < 61.0


def test_what_has_not_settled_looks_like_what_still_moves():
    names = ["at rest", "not settled"]
    named = dict.fromkeys(("attractor_kind", "attractor_name"), ("attractor_index", names))
    shares = a_share([0.1, 0.2]).assign(named)
    *known, unfinished = attractor_classes(shares)
    assert [one.name for one in known] == names
    assert known[-1].look == OUTCOME_LOOKS[Outcome.STILL_MOVING]
    assert known[-1].look.texture
    assert unfinished.code == -1
    (legend,) = sb.plot(shares).legends
    assert "not settled" in [text.get_text() for text in legend.get_texts()]


@pytest.mark.parametrize("along", [[0.1, 0.2, 0.5], [0.01, 0.1, 1.0]])
def test_the_first_and_last_intervals_of_fractions_have_room(along):
    low, high = sb.plot(a_share(along)).axes[0].get_xlim()
    assert 0.0 < low < along[0]
    assert along[-1] < high


def orbits_of_six():
    """Two rollings on one path, two aperiodic motions, standing, and overturning."""
    kinds = ["at rest", "rolling anticlockwise", "rolling clockwise", "aperiodic anticlockwise"]
    kinds += ["aperiodic clockwise", "overturned"]
    turn = np.linspace(0.0, 2.0 * np.pi, 65)
    circle = 0.01 * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    paths = np.stack([0.0 * circle, circle, circle[::-1], 3.0 * circle, 4.0 * circle, np.nan * circle])
    share = ("attractor_index", np.full(6, 1.0 / 6.0))
    return xr.Dataset(
        {
            "attractor_kind": ("attractor_index", kinds),
            "attractor_name": ("attractor_index", kinds),
            "attractor_period": ("attractor_index", [0, 1, 1, 0, 0, 0]),
            "attractor_tilt": (("attractor_index", "orbit_point", "axis"), paths[:, :1]),
            "orbit_tilt": (("attractor_index", "orbit_sample", "axis"), paths),
            **dict.fromkeys(("fraction", "fraction_low", "fraction_high"), share),
            "count": ("attractor_index", np.full(6, 10)),
            "computed": ((), 60),
            "unsettled": ((), 0),
        },
        coords={"axis": ["x", "y"]},
        attrs={"kind": "attractors", "confidence": 0.95},
    )


def test_orbits_on_one_path_and_of_one_kind_are_told_apart():
    figure = sb.plot(orbits_of_six())
    orbits = figure.axes[1]
    named = {line.get_label(): line for line in orbits.lines if not line.get_label().startswith("_")}
    assert list(named) == [text.get_text() for text in figure.legends[0].get_texts()]
    assert len(named) == 4
    assert len({line.get_color() for line in named.values()}) == 4
    assert named["rolling anticlockwise"].get_linestyle() == named["aperiodic anticlockwise"].get_linestyle() == "-"
    assert named["rolling clockwise"].get_linestyle() == named["aperiodic clockwise"].get_linestyle() == "--"
    figure.canvas.draw()


def test_only_what_repeats_has_circles_at_the_strobe():
    circles = [line for line in sb.plot(orbits_of_six()).axes[1].lines if line.get_marker() == "o"]
    states = [line.get_xydata().round(9).tolist() for line in circles]
    assert states == [[[0.0, 0.0]], [[0.01, 0.0]], [[0.01, 0.0]]]
    sizes = [line.get_markersize() for line in circles]
    assert sizes == sorted(set(sizes), reverse=True)


@pytest.mark.slow
def test_an_exponent_is_drawn_with_counts_limits_and_fit():
    base = np.zeros((5, 400), dtype=int)
    lower = (np.arange(400) < np.array([0, 4, 16, 64, 300])[:, np.newaxis]).astype(int)
    epsilon = np.array([0.01, 0.02, 0.08, 0.32, 0.9])
    found = exponent_of(np.concatenate([base, lower, base]).ravel(), epsilon, dimension=2)
    figure = sb.plot(found)
    names = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert len(names) == 4
    assert "none found" in names[0] + names[1]
    assert "dimension of the boundary" in figure.axes[0].get_title(loc="left")
    empty = sb.plot(exponent_of(np.zeros(30, dtype=int), epsilon, dimension=2))
    assert "too few" in empty.axes[0].get_title(loc="left")
    empty.canvas.draw()


def test_arrows_stand_clear_of_the_bottom_of_the_axes():
    base = np.zeros((5, 400), dtype=int)
    lower = (np.arange(400) < np.array([0, 0, 0, 0, 100])[:, np.newaxis]).astype(int)
    states = np.concatenate([base, lower, base]).ravel()
    (axes,) = sb.plot(exponent_of(states, np.geomspace(1e-5, 1e-2, 5), dimension=2)).axes
    (arrows,) = [line for line in axes.lines if line.get_marker() == "v"]
    assert axes.get_ylim()[0] < 0.5 * arrows.get_ydata().min()


def test_an_exponent_says_how_many_starts_it_dropped():
    states = np.where(np.arange(400) % 5 == 0, -2, 0)
    figure = sb.plot(exponent_of(np.tile(states, 6), np.array([0.1, 0.2]), dimension=2))
    assert "dropped: 20 % of 800 starts" in figure.axes[0].get_title(loc="left")


def test_integrity_is_an_ellipse_through_the_nearest_overturning_start():
    column = sb.Column.solid(radius=0.5, height=10.0, density=2700.0)
    model, axis = sb.Slender(column), column.slenderness * np.linspace(-0.93, 0.93, 8)
    over = {"tilt_x": axis, "tilt_rate_x": column.frequency_scale * axis}
    found = sb.studies.integrity(model, over=over, duration=20.0)
    figure = sb.plot(found)
    ellipse = next(one for one in figure.axes[0].patches if isinstance(one, Ellipse))
    x, v = found["nearest"].values
    assert (2.0 * x / ellipse.width) ** 2 + (2.0 * v / ellipse.height) ** 2 == pytest.approx(1.0, rel=1e-12)


def test_erosion_tells_bounds_from_distances():
    dims = ("acceleration",)
    found = xr.Dataset(
        {
            "distance": (dims, [0.9, 0.6, 0.3]),
            "distance_low": (dims, [0.7, 0.4, 0.1]),
            "at_least": (dims, [True, False, False]),
            "integrity": (dims, [1.0, 0.67, 0.33]),
        },
        coords={"acceleration": ("acceleration", [0.1, 0.2, 0.4], {"units": "m s-2"})},
        attrs={"kind": "erosion"},
    )
    figure = sb.plot(found)
    line, exact, bound = figure.axes[0].lines
    assert line.get_ydata().tolist() == [0.9, 0.6, 0.3]
    assert exact.get_xdata().tolist() == [0.2, 0.4]
    assert bound.get_xdata().tolist() == [0.1]
    figure.canvas.draw()


def test_uncertain_runs_are_only_counted_where_their_dots_would_hide_the_map():
    figure = sb.plot(a_map([[REST, REST]] * 3, uncertain=[[True, False], [False, True], [False, False]]))
    assert legend_of(figure)[-1] == "uncertain  2 runs, not marked"
    assert not figure.axes[0].lines
