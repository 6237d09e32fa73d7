"""Figures suit the page they are drawn for: its size, the caller's axes, the user's style; objects have figures too."""

import importlib.util
import sys
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
from stylobate.plots.style import AS_DRAWN, BLUE
from stylobate.plots.varied import what_varies

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
