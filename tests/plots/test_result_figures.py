"""Figures suit the page they are drawn for: its size, the caller's axes, the user's style; objects have figures too."""

import importlib.util
import sys
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_hex, to_rgba
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.text import Text
from PIL import Image

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.plots.kinds import _FIGURES, figure_for
from stylobate.plots.labels import what_varies
from stylobate.plots.style import AS_DRAWN, BLUE

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[2]
STONE = sb.Column.solid(radius=0.35, height=5.2, density=2700.0)
MODEL = sb.Wobbling(STONE, damping=0.05)
CIRCLE = sb.Harmonic.circular(acceleration=1.2, angular_frequency=4.0)


@pytest.fixture(scope="module")
def run():
    return sb.simulate(MODEL, CIRCLE, tilt=(0.03, 0.0), tilt_rate=(0.0, 0.05), duration=8.0)


@pytest.fixture(scope="module")
def line():
    scale = np.linspace(0.2, 2.0, 30)
    return sb.simulate_ensemble(MODEL, sb.sample_record(), duration=90.0, parameters={"scale": scale})


def texts(figure):
    figure.draw_without_rendering()
    return [one for one in figure.findobj(Text) if one.get_text() and one.get_visible()]


@pytest.mark.parametrize("size", [3.5, 5.0, 7.2, (3.5, 4.0), (13.3, 7.5)])
def test_a_figure_has_its_size_and_no_text_leaves_it(run, size):
    figure = sb.plot(run, size=size)
    width, height = figure.get_size_inches()
    assert width == pytest.approx(np.atleast_1d(size)[0])
    if np.size(size) > 1:
        assert height == pytest.approx(size[1])
    labels = [axes.get_xlabel() for axes in figure.axes] + [axes.get_ylabel() for axes in figure.axes]
    for text in texts(figure):
        box = text.get_window_extent()
        if text.get_text() in labels or text is figure._suptitle:
            assert box.x0 >= -1.0
            assert box.y0 >= -1.0
            assert box.x1 <= figure.bbox.x1 + 1.0
            assert box.y1 <= figure.bbox.y1 + 1.0


def test_the_panels_of_a_narrow_figure_stand_below_each_other(run):
    wide, narrow = sb.plot(run), sb.plot(run, size=3.5)
    for figure in (wide, narrow):
        figure.draw_without_rendering()
    assert len({round(axes.get_position().y1, 2) for axes in narrow.axes}) == len(narrow.axes)
    assert len({round(axes.get_position().y1, 2) for axes in wide.axes}) == len(wide.axes) - 1


def test_a_slide_enlarges_fonts_and_lines_alike(run):
    page, slide = sb.plot(run), sb.plot(run, size=14.4)
    for kind, measure in ((Line2D, "get_linewidth"), (Text, "get_fontsize")):
        small, large = (max(getattr(one, measure)() for one in figure.findobj(kind)) for figure in (page, slide))
        assert large == pytest.approx(2.0 * small, rel=1e-6)


@pytest.mark.parametrize("size", [0.0, -1.0, np.nan, "wide", (3.0, 0.0), (1.0, 2.0, 3.0)])
def test_a_size_that_is_none_is_refused(run, size):
    with pytest.raises(ParameterError, match="size must be a positive width"):
        sb.plot(run, size=size)


@pytest.mark.parametrize("draw", [sb.plot, sb.plots.plot_interactive])
def test_what_cannot_be_drawn_in_a_sequence_is_named(run, draw):
    with pytest.raises(ParameterError, match=r"^result: nothing is in it \(got \[\]\)\. Pass one run"):
        draw([])
    with pytest.raises(ParameterError, match=r"^result\[1\]: .*\(got int\)\. Remove it"):
        draw([run, 3])


def test_a_result_of_one_panel_is_drawn_in_the_axes_of_the_caller(run, line):
    figure, axes = plt.subplots(1, 3)
    try:
        assert sb.plot(run, axes=axes[0]) is figure
        sb.plot(line, axes=axes[1])
        sb.plot(STONE, axes=axes[2])
        np.testing.assert_array_equal(axes[0].lines[0].get_ydata(), run.data["amplitude"])
        assert axes[1].get_legend() is not None
        assert len(figure.axes) == 3
        curves = sb.studies.response_curves(sb.Slender(STONE), CIRCLE, angular_frequency=[3.0, 4.0])
        with pytest.raises(ParameterError, match=r"several panels.*Leave axes out and pass size; runs, ensembles"):
            sb.plot(curves, axes=axes[0])
        with pytest.raises(ParameterError, match="axes must be Matplotlib's Axes, got ndarray"):
            sb.plot(run, axes=axes)
        with pytest.raises(ParameterError, match="Leave size or axes out"):
            sb.plot(run, axes=axes[0], size=3.5)
    finally:
        plt.close(figure)


def luminance(colour):
    return to_rgba(colour)[:3] @ np.array([0.3, 0.59, 0.11])


def test_on_a_dark_ground_every_text_and_line_is_light(run, line):
    with plt.style.context("dark_background"):
        figures = [sb.plot(one) for one in (run, [run, run], line, STONE, CIRCLE, sb.sample_record())]
    for figure in figures:
        assert to_hex(figure.get_facecolor()) == "#000000"
        assert all(to_hex(axes.get_facecolor()) == "#000000" for axes in figure.axes)
        for one in texts(figure):
            assert one.get_gid() == AS_DRAWN or luminance(one.get_color()) > 0.4, one
        drawn = [one for axes in figure.axes for one in axes.lines if one.get_linestyle() != "None"]
        assert all(luminance(one.get_color()) > 0.3 for one in drawn)
        grid = [one for axes in figure.axes for one in (*axes.get_xgridlines(), *axes.get_ygridlines())]
        assert all(luminance(one.get_color()) < 0.3 for one in grid)


def test_settings_of_the_user_stay(run):
    with plt.rc_context({"font.size": 17.0, "axes.spines.top": True, "axes.grid": True, "font.family": "serif"}):
        figure = sb.plot(run)
        (label,) = {axes.get_xlabel() for axes in figure.axes} - {"", r"tilt $\theta_x$ [rad]"}
        shown = next(text for text in texts(figure) if text.get_text() == label)
    assert shown.get_fontsize() == 17.0
    assert shown.get_fontfamily() == ["serif"]
    assert plt.rcParams["font.size"] == plt.rcParamsDefault["font.size"]


def test_a_notebook_shows_the_figure_itself(run):
    figure = sb.plot(run)
    png, size = figure._repr_png_()
    assert png.startswith(b"\x89PNG")
    assert size["width"] == round(96.0 * figure.get_figwidth())


def test_show_displays_in_a_notebook_and_warns_where_no_window_opens(run, monkeypatch):
    figure = sb.plot(run)
    before = plt.get_fignums()
    with pytest.warns(UserWarning, match="no window can be opened here"):
        figure.show()
    assert plt.get_fignums() == before
    shown = []
    shell = SimpleNamespace(kernel=object())
    notebook = SimpleNamespace(get_ipython=lambda: shell, display=SimpleNamespace(display=shown.append))
    monkeypatch.setitem(sys.modules, "IPython", notebook)
    figure.show()
    assert shown == [figure]


def test_several_runs_are_named_by_what_varies(run):
    runs = [sb.simulate(sb.Wobbling(STONE, damping=eta), tilt=(0.05, 0.0), duration=2.0) for eta in (0.02, 0.05)]
    assert what_varies(runs) == ["η = 0.02", "η = 0.05"]
    laws = [sb.simulate(law(STONE, damping=0.05), tilt=(0.05, 0.0), duration=2.0) for law in (sb.Wobbling, sb.Rolling)]
    assert what_varies(laws) == ["wobbling", "rolling"]
    tall = sb.simulate(sb.Wobbling(STONE.with_slenderness(0.1), damping=0.02), tilt=(0.05, 0.0), duration=2.0)
    assert what_varies([runs[0], tall]) == ["c = 0.1346", "c = 0.1"]
    assert what_varies([run, run]) == [run.outcome.label] * 2


def test_many_runs_have_colours_of_their_own():
    runs = [sb.simulate(MODEL, tilt=(0.01 * k, 0.0), duration=1.0) for k in range(1, 11)]
    colours = {to_hex(entry.get_color()) for entry in sb.plot(runs).legends[0].get_lines()}
    assert len(colours) == len(runs)


def test_a_run_that_never_moves_has_no_empty_panel():
    figure = sb.plot(sb.simulate(MODEL, CIRCLE.scaled(0.1), duration=5.0))
    assert [axes.get_ylabel() for axes in figure.axes] == ["base acceleration\n[m/s²]"]


def test_a_conveyed_part_shows_its_travel_and_its_flight():
    part = sb.Sliding(sb.Column.solid(radius=0.03, height=0.2, density=884.0), friction_coefficient=0.2)
    run = sb.simulate(part, sb.Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=0.44), duration=0.5)
    shown = {axes.get_ylabel(): axes for axes in sb.plot(run).axes}
    assert {"travel\n[mm]", "clearance\n[mm]"} <= set(shown)
    np.testing.assert_allclose(shown["travel\n[mm]"].lines[0].get_ydata(), 1e3 * run.data["footprint"].sel(axis="x"))


def test_a_curve_that_would_be_a_block_is_drawn_between_its_extremes():
    run = sb.simulate(MODEL, sb.Harmonic.straight(acceleration=2.0, angular_frequency=90.0), duration=30.0)
    base = sb.plot(run).axes[-1]
    (filled,) = base.collections
    heights = filled.get_paths()[0].vertices[:, 1]
    acceleration = run.data["base_acceleration"].sel(direction="x")
    assert heights.min() == pytest.approx(float(acceleration.min()))
    assert heights.max() == pytest.approx(float(acceleration.max()))


def test_a_sketch_is_to_scale_and_states_what_decides():
    figure = sb.plot(MODEL)
    (outline,) = [patch for patch in figure.axes[0].patches if isinstance(patch, Polygon)]
    width, height = np.ptp(outline.get_xy(), axis=0)
    assert (width, height) == (0.7, 5.2)
    assert figure.axes[0].get_aspect() == 1.0
    words = figure._suptitle.get_text()
    assert f"c = {STONE.slenderness:.4g}" in words
    assert f"p = {STONE.frequency_parameter:.4g} rad/s" in words


def test_a_motion_is_drawn_for_four_periods_with_its_path():
    figure = sb.plot(CIRCLE)
    rows = {axes.get_ylabel(): axes for axes in figure.axes}
    assert {"acceleration\n[m/s²]", "velocity\n[m/s]", "displacement\n[mm]", "y [mm]"} == set(rows)
    time, x = rows["acceleration\n[m/s²]"].lines[0].get_data()
    assert time[-1] == pytest.approx(4.0 * CIRCLE.period)
    np.testing.assert_allclose(x, CIRCLE.acceleration(time)[:, 0])
    path = rows["y [mm]"].lines[0].get_xydata()
    radius = 1e3 * 1.2 / 4.0**2
    np.testing.assert_allclose(np.hypot(*path.T), radius, rtol=1e-9)


def test_a_record_is_drawn_with_its_spectrum():
    record = sb.sample_record()
    figure = sb.plot(record)
    assert figure._suptitle.get_text() == record.name
    spectrum = figure.axes[-1] if figure.axes[-1].get_xlabel() == "period [s]" else figure.axes[1]
    curves = {curve.get_label(): curve.get_xydata() for curve in spectrum.lines}
    found = sb.records.response_spectra(record, [1.0], damping=0.05)
    at = np.interp(1.0, *curves["RotD50"].T)
    assert at == pytest.approx(float(found["rotd50"][0]), rel=0.03)


def test_an_orbit_is_drawn_with_its_multipliers():
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    orbit = sb.orbits.periodic_orbit(model, sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8))
    tilt, path, circle = sb.plot(orbit).axes
    np.testing.assert_allclose(np.hypot(*path.lines[0].get_xydata().T), tilt.lines[0].get_ydata())
    drawn = np.sort_complex(np.concatenate([line.get_xydata() @ (1.0, 1.0j) for line in circle.lines]))
    np.testing.assert_allclose(drawn, np.sort_complex(orbit.multipliers))
    assert tilt.lines[0].get_linestyle() == ("-" if orbit.stable else "--")


def test_an_ensemble_over_one_number_shows_peak_tilts_and_outcomes(line):
    (axes,) = sb.plot(line).axes
    assert axes.get_xlabel() == "scale"
    drawn = {curve.get_label().split("  ")[0]: curve.get_xydata() for curve in axes.lines}
    stood = line.where(line["outcome"] == sb.Outcome.SURVIVED, drop=True)
    assert stood.sizes["run"] > 3
    np.testing.assert_array_equal(drawn["survived"], np.stack([stood["scale"], stood["peak_tilt"]], axis=1))
    fallen = line.where(line["outcome"] == sb.Outcome.OVERTURNED, drop=True)
    np.testing.assert_array_equal(drawn["overturned"][:, 0], fallen["scale"])
    others = line["peak_tilt"].where(line["outcome"] != sb.Outcome.OVERTURNED)
    assert drawn["overturned"][:, 1].min() > float(others.max())


def test_two_numbers_that_vary_together_span_a_plane_and_three_dimensions_are_refused(line):
    runs = line.assign_coords(damping=("run", np.linspace(0.02, 0.1, line.sizes["run"])))
    (axes,) = sb.plot(runs).axes
    points = np.concatenate([curve.get_xydata() for curve in axes.lines])
    assert {tuple(point) for point in points} == set(zip(runs["scale"].values, runs["damping"].values, strict=True))
    cube = xr.concat([line, line], dim="size").expand_dims(x=[1.0])
    with pytest.raises(ParameterError, match=r"one or two dimensions, got .* by .isel"):
        sb.plot(cube)


def test_wide_areas_of_a_map_have_their_names_within():
    x, y = np.linspace(0.0, 1.0, 60), np.linspace(0.0, 1.0, 60)
    codes = np.where(x[:, np.newaxis] + 0.0 * y < 0.5, int(sb.Outcome.AT_REST), int(sb.Outcome.OVERTURNED))
    codes[40:42, :] = int(sb.Outcome.ROLLING)  # too narrow for its name
    found = xr.Dataset({"outcome": (("x", "y"), codes)}, {"x": x, "y": y}, {"kind": "ensemble"})
    figure = sb.plot(found)
    named = {text.get_text(): text.xy for text in figure.axes[0].texts}
    assert set(named) == {sb.Outcome.AT_REST.label, sb.Outcome.OVERTURNED.label}
    assert named[sb.Outcome.AT_REST.label][0] < 0.5 < named[sb.Outcome.OVERTURNED.label][0]
    assert {text.get_text().split("  ")[0] for text in figure.legends[0].get_texts()} == {*named, "rolling"}


def test_a_picture_of_the_dark_style_is_dark(run, tmp_path):
    with plt.style.context("dark_background"):
        figure = sb.plot(run)
    figure.savefig(tmp_path / "run.png", dpi=50)
    grey = np.asarray(Image.open(tmp_path / "run.png").convert("L"))
    assert np.median(grey) < 10
    assert grey.max() > 200
    assert BLUE not in {to_hex(one.get_color()) for one in figure.findobj(Line2D)}


def test_the_sheet_of_figures_has_every_kind():
    spec = importlib.util.spec_from_file_location("figure_sheet", ROOT / "tools" / "figure_sheet.py")
    sheet = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sheet)
    figure_for("ensemble")
    assert set(_FIGURES) - {"sweep"} <= set(sheet.RESULTS)  # a sweep is drawn as an ensemble


QUAKE = sb.sample_record()


@pytest.fixture(scope="module")
def slid():
    """A run with all panels: it tilts, slides and turns about its axis, on a base that moves along three axes."""
    return sb.simulate(sb.Sliding(STONE, friction_coefficient=0.2, damping=0.05), QUAKE)


def boxes(figure, chosen):
    figure.draw_without_rendering()
    return [one.get_window_extent() for one in chosen if one.get_text() and one.get_visible()]


def overlap(first, second, tolerance=1.0):
    across = min(first.x1, second.x1) - max(first.x0, second.x0)
    along = min(first.y1, second.y1) - max(first.y0, second.y0)
    return across > tolerance and along > tolerance


@pytest.mark.parametrize("size", [3.5, 7.2, (13.3, 7.5), (3.5, 4.0), (7.2, 3.0)])
def test_titles_labels_and_numbers_of_a_run_do_not_overlap(slid, size):
    figure = sb.plot(slid, size=size)
    figure.draw_without_rendering()
    words = [figure._suptitle]
    for axes in figure.axes:
        words += [axes.xaxis.label, axes.yaxis.label, axes.title, axes._left_title, *axes.texts]
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            words += [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
    found = [box for box in boxes(figure, words) if box.width > 0.0]
    for place, first in enumerate(found):
        assert not any(overlap(first, second) for second in found[:place]), first
        assert first.x0 >= -1.0
        assert first.x1 <= figure.bbox.x1 + 1.0


def test_a_low_figure_of_a_run_has_the_most_important_panels_or_is_refused(slid):
    low = sb.plot(slid, size=(3.5, 2.5))
    assert [axes.get_ylabel().splitlines()[0] for axes in low.axes] == [r"tilt $\theta$ [rad]", "base"]
    assert len(sb.plot(slid, size=(3.5, 12.0)).axes) == len(sb.plot(slid).axes)
    with pytest.raises(ParameterError, match=r"must be (.*) inches high or more, got 0\.8") as refused:
        sb.plot(slid, size=(3.5, 0.8))
    least = float(str(refused.value).split("must be ")[1].split()[0])
    assert len(sb.plot(slid, size=(3.5, least + 0.01)).axes) == 1


def test_titles_break_within_the_figure_and_grow_with_the_font(slid):
    part = sb.Sliding(sb.Column.solid(radius=0.03, height=0.2, density=884.0), friction_coefficient=0.25)
    feeder = sb.Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=0.44)
    posture = sb.conveying.upright(part, feeder, phases=2, periods=5)
    for size, font in ((3.5, 8.0), (7.2, 9.5), (13.3, 9.5 * 13.3 / 7.2)):
        figure = sb.plot(posture, size=size)
        (box,) = boxes(figure, [figure._suptitle])
        assert box.x1 <= figure.bbox.x1
        assert figure._suptitle.get_fontsize() == pytest.approx(font)


@pytest.mark.parametrize("size", [3.5, 7.2, (13.3, 7.5)])
def test_the_numbers_of_an_orbit_do_not_overlap(size):
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    orbit = sb.orbits.periodic_orbit(model, sb.Harmonic.straight(acceleration=0.13, angular_frequency=1.6))
    figure = sb.plot(orbit, size=size)
    for axes in figure.axes:
        figure.draw_without_rendering()
        low, high = sorted(axes.get_xlim())
        shown = [tick.label1 for tick in axes.xaxis.get_major_ticks() if low <= tick.get_loc() <= high]
        found = boxes(figure, shown)
        assert not any(overlap(a, b) for a, b in pairwise(found))
    path = figure.axes[1].get_window_extent()
    assert path.width > 0.2 * figure.bbox.width


def test_no_text_is_smaller_than_6_points_or_than_the_font_of_the_user(run):
    for context, least in (({}, 6.0), ({"font.size": 5.0}, 5.0)):
        with plt.rc_context(context):
            figure = sb.plot(run, size=3.5)
        assert min(text.get_fontsize() for text in texts(figure)) >= least


def test_a_legend_covers_neither_a_map_nor_curves_of_given_axes():
    x, y = np.linspace(0.0, 1.0, 40), np.linspace(0.0, 1.0, 40)
    codes = np.where(x[:, np.newaxis] + 0.0 * y < 0.5, int(sb.Outcome.AT_REST), int(sb.Outcome.OVERTURNED))
    found = xr.Dataset({"outcome": (("x", "y"), codes)}, {"x": x, "y": y}, {"kind": "ensemble"})
    for layout in ("constrained", None):
        figure, axes = plt.subplots(1, 2, figsize=(7.2, 3.0), layout=layout)
        try:
            axes[0].plot([0.0, 1.0], color="black")
            sb.plot(found, axes=axes[1])
            figure.draw_without_rendering()
            legend, label = axes[1].get_legend(), axes[1].xaxis.label
            assert {text.get_text().split("  ")[0] for text in legend.get_texts()} == {"at rest", "overturned"}
            if layout:
                assert legend.get_window_extent().y1 <= label.get_window_extent().y0 + 1.0
                assert legend.get_window_extent().y0 >= 0.0
            else:
                assert legend.get_frame_on()
                assert legend.get_frame().get_alpha() >= 0.9
        finally:
            plt.close(figure)


def test_axes_of_a_dark_page_have_light_lines_and_the_others_stay(run):
    with plt.style.context("dark_background"):
        figure, (other, mine) = plt.subplots(1, 2)
        try:
            kept = other.plot([0.0, 1.0], color="#111111")[0]
            sb.plot([run, run], axes=mine, labels=["a", "b"])
            assert kept.get_color() == "#111111"
            assert luminance(mine.yaxis.label.get_color()) > 0.4
            assert all(luminance(text.get_color()) > 0.4 for text in mine.get_legend().get_texts())
        finally:
            plt.close(figure)


def test_names_of_events_stand_above_the_curves(slid):
    tilt = sb.plot(slid).axes[0]
    named = {text.get_text(): text for text in tilt.texts}
    assert {"uplift", "overturned"} <= set(named)
    tilt.get_figure().draw_without_rendering()
    for name in ("uplift", "overturned"):
        assert named[name].get_bbox_patch() is None
        assert named[name].get_window_extent().y0 >= tilt.get_window_extent().y1


def test_several_slendernesses_label_each_limit():
    runs = [
        sb.simulate(sb.Wobbling(STONE.with_slenderness(c), damping=0.05), tilt=(0.05, 0.0), duration=2.0)
        for c in (0.1, 0.15)
    ]
    words = [text.get_text() for text in sb.plot(runs).axes[0].texts]
    assert [word.partition("$c$ = ")[2] for word in words] == ["0.1", "0.15"]


def test_changes_of_a_motion_name_runs():
    def names(motions):
        return what_varies([sb.simulate(MODEL, one, duration=1.0) for one in motions])

    assert names([QUAKE.scaled(0.5), QUAKE]) == ["0.5 × El Centro 1940", "El Centro 1940"]
    assert names([QUAKE.rotated(0.3), QUAKE.rotated(0.7)]) == ["rotated by 0.3 rad", "rotated by 0.7 rad"]
    assert names([CIRCLE.scaled(2.0), CIRCLE.scaled(3.0)]) == ["2 × circular", "3 × circular"]
    assert names([CIRCLE.scaled(2.0, vertical=1.0), CIRCLE]) == ["2 × circular, vertical 1 ×", "circular"]
    own = sb.Record(samples=QUAKE.samples[:200], step=QUAKE.step, name="own")
    assert names([own.scaled(0.5), own.scaled(0.6)]) == ["scaled by 0.5", "scaled by 0.6"]


def test_a_duration_that_follows_from_other_inputs_is_not_named_and_units_are():
    tall = [sb.Wobbling(STONE.with_slenderness(c), damping=0.05) for c in (0.1, 0.12)]
    runs = [sb.simulate(model, QUAKE.scaled(0.3)) for model in tall]
    assert runs[0].provenance["duration"] != runs[1].provenance["duration"]
    assert what_varies(runs) == ["c = 0.1", "c = 0.12"]
    tilted = [sb.simulate(MODEL, tilt=(tilt, 0.0), duration=1.0) for tilt in (0.03, 0.04)]
    assert what_varies(tilted) == ["tilt 0.03 rad", "tilt 0.04 rad"]
    longer = [sb.simulate(MODEL, tilt=(0.03, 0.0), duration=duration) for duration in (1.0, 2.0)]
    assert what_varies(longer) == ["duration 1 s", "duration 2 s"]


def test_labels_keep_their_letters_and_are_checked(run):
    assert sb.plot([run], labels=["c = 0.1"]).get_suptitle().startswith("c = 0.1: ")
    with pytest.raises(ParameterError, match="labels must have one name for each of 2 results, got 1"):
        sb.plot([run, run], labels=["a"])
    with pytest.raises(ParameterError, match="labels must have one name for each of 1 result, got 'ab'"):
        sb.plot(run, labels="ab")
    with pytest.raises(ParameterError, match="labels name runs, branches or curves"):
        sb.plot(STONE, labels=["a"])
    figure, axes = plt.subplots()
    try:
        sb.plot(run, labels=["mine"], axes=axes)
        assert [text.get_text() for text in axes.get_legend().get_texts()] == ["mine"]
    finally:
        plt.close(figure)


def test_files_keep_their_texts_unless_the_user_decides_otherwise(run, tmp_path):
    figure = sb.plot(run)
    figure.savefig(tmp_path / "run.svg")
    assert ">time [s]<" in (tmp_path / "run.svg").read_text()
    figure.savefig(tmp_path / "run.pdf")
    assert b"/Type3" not in (tmp_path / "run.pdf").read_bytes().replace(b" ", b"")
    with plt.rc_context({"svg.fonttype": "none", "svg.hashsalt": "a", "pdf.fonttype": 42}):
        assert plt.rcParams["svg.fonttype"] == "none"
        figure.savefig(tmp_path / "own.svg")
    assert plt.rcParams["svg.fonttype"] == plt.rcParamsDefault["svg.fonttype"]


def test_short_lengths_are_in_millimetres():
    part = sb.Sliding(sb.Column.solid(radius=0.03, height=0.2, density=884.0), friction_coefficient=0.25)
    feeder = sb.Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=0.44)
    found = sb.conveying.drift(part, feeder, over={"stroke": np.linspace(2e-4, 1.2e-3, 3)}, periods=10, late=5)
    axes = sb.plot(found).axes[-1]
    axes.get_figure().draw_without_rendering()
    assert axes.get_xlabel().endswith("[mm]")
    for tick in axes.xaxis.get_major_ticks():
        assert float(tick.label1.get_text().replace("−", "-")) == pytest.approx(1e3 * tick.get_loc(), abs=1e-9)


def test_a_steady_roll_is_a_line_and_the_acceleration_lies_within_its_panel():
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    rolling = sb.simulate(model, circle, duration=600.0, **sb.studies.steady_start(model, circle))
    figure = sb.plot(rolling)
    tilt, base = figure.axes[0], figure.axes[2]
    assert not tilt.collections
    assert tilt.lines[0].get_xdata().size == rolling.data.sizes["time"]
    low, high = base.get_ylim()
    assert 0.1 < (0.065 - low) / (high - low) < 0.9
