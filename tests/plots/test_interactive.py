"""Interactive figures hold the numbers of their results and are pages without a network."""

import importlib
import sys

import matplotlib.pyplot as plt
import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.cli.main import run as command
from stylobate.errors import ParameterError, UnsupportedError
from stylobate.plots.cells import attractor_classes
from stylobate.plots.interactive import _extremes
from stylobate.plots.runs import ContactHistory
from stylobate.results.verdict import LABELS

STONE = sb.Column.solid(radius=0.35, height=5.2, density=2700.0)
MODEL = sb.Wobbling(STONE, damping=0.05)
CIRCLE = sb.Harmonic.circular(acceleration=1.2, angular_frequency=4.0)


@pytest.fixture(scope="module")
def run():
    return sb.simulate(MODEL, CIRCLE, tilt=(0.03, 0.0), tilt_rate=(0.0, 0.05), duration=8.0)


@pytest.fixture(scope="module")
def table():
    over = {"acceleration": np.array([0.5, 1.5, 3.0]), "angular_frequency": np.array([3.0, 4.0])}
    return sb.studies.overturning_map(MODEL, CIRCLE, over=over, duration=8.0)


def test_a_run_holds_its_samples(run):
    figure = sb.plots.plot_interactive(run)
    tilt, azimuth, base, path = (figure.data[place] for place in (0, 1, 2, 3))
    step = 1 + run.data.sizes["time"] // 4000
    np.testing.assert_array_equal(tilt.y, run.data["amplitude"][::step])
    np.testing.assert_allclose(2.0 * np.pi * azimuth.y, run.data["azimuth"][::step])
    np.testing.assert_allclose(base.y, 1.2)
    np.testing.assert_array_equal(np.hypot(path.x, path.y), tilt.y)
    assert run.outcome.label in figure.layout.title.text


def test_runs_are_named_by_what_varies_and_planar_ones_have_no_path(run):
    free = [sb.simulate(sb.PlanarRocking(STONE, damping=eta), tilt=(0.05, 0.0), duration=3.0) for eta in (0.02, 0.1)]
    figure = sb.plots.plot_interactive(free)
    assert {one.name for one in figure.data} == {"η = 0.02", "η = 0.1"}
    assert len(figure.data) == 2  # the base is at rest
    assert {one.name for one in sb.plots.plot_interactive([run, *free], labels=["a", "b", "c"]).data} == {"a", "b", "c"}


def test_a_map_states_each_run(table):
    (heat,) = sb.plots.plot_interactive(table).data
    names = heat.colorbar.ticktext
    for column, row in np.ndindex(table["outcome"].shape):
        one = table.isel(acceleration=column, angular_frequency=row)
        label = sb.Outcome(int(one["outcome"])).label
        assert names[int(heat.z[row][column])] == label
        assert f"outcome: {label}" in heat.hovertext[row][column]
        assert f"peak tilt: {float(one['peak_tilt']):.4g}" in heat.hovertext[row][column]
    colours = dict(heat.colorscale)
    assert len(set(colours.values())) == len(names)


@pytest.fixture(scope="module")
def basins():
    column = sb.Column.dimensionless(slenderness=0.1)
    over = {"tilt_x": np.linspace(0.03, 0.1, 5), "tilt_y": np.array([0.0, 0.02])}
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
    return sb.studies.basins(sb.Slender(column, damping=0.1), motion, over=over, periods=60)


def test_a_map_of_basins_has_the_attractors_of_the_static_figure(basins):
    (heat,) = sb.plots.plot_interactive(basins).data
    classes = {one.code: one for one in attractor_classes(basins)}
    colours = [heat.colorscale[2 * place][1] for place in range(len(heat.colorbar.ticktext))]
    for column, row in np.ndindex(basins["attractor"].shape):
        code = int(basins["attractor"][column, row])
        place = int(heat.z[row][column])
        assert heat.colorbar.ticktext[place] == classes[code].name
        assert colours[place] == classes[code].look.colour
    assert len(set(colours)) == len(np.unique(basins["attractor"])) > 1
    (points, *_) = sb.plots.plot_interactive(basins.isel(tilt_y=0)).data
    assert points.name in {one.name for one in classes.values()}


def test_classes_that_only_a_texture_tells_apart_have_different_colours(basins):
    names = [str(one) for one in basins["attractor_name"].values]
    twice = basins.isel(tilt_x=slice(0, 2), tilt_y=slice(0, 1)).copy(deep=True)
    twice["attractor"][:, 0] = [0, 1]
    kinds = twice["attractor_kind"].astype("U32").copy()
    kinds[:2] = "rocking"
    (heat,) = sb.plots.plot_interactive(twice.assign_coords(attractor_kind=kinds)).data
    assert list(heat.colorbar.ticktext) == names[:2]
    assert len({colour for _, colour in heat.colorscale}) == 2


@pytest.fixture(scope="module")
def conveyed():
    bottle = sb.Column.solid(radius=0.03, height=0.2, density=884.0)
    track = sb.Harmonic.stroke(stroke=0.0012, frequency=50.0, angle=0.436)
    return sb.simulate(sb.Sliding(bottle, friction_coefficient=0.35), track, tilt=(0.002, 0.001), duration=0.5)


def test_a_run_that_slides_has_the_panels_of_the_static_figure_with_units(conveyed):
    figure = sb.plots.plot_interactive(conveyed)
    panels = {str(axis.title.text).replace("<br>", " ") for axis in figure.select_yaxes()}
    static = {axes.get_ylabel().replace("\n", " ") for axes in sb.plot(conveyed).axes}
    for name in ("travel [mm]", "clearance [mm]", "twist [turns]", "base acceleration [m/s²]"):
        assert name in panels
        assert name in static
    curves = {
        one.hovertemplate.split("<br>")[1].split(":")[0]: one
        for one in figure.data
        if one.hovertemplate and "<br>" in one.hovertemplate
    }
    kept = np.isin(conveyed.data["time"].values, curves["travel along x"].x)
    np.testing.assert_allclose(curves["travel along x"].y, 1e3 * conveyed.data["footprint"].values[kept, 0])
    vertical = conveyed.data["base_acceleration"].values[:, 2]
    assert curves["vertical base acceleration"].y.max() == vertical.max()
    assert curves["vertical base acceleration"].y.min() == vertical.min()
    for name, unit in (("travel along x", "mm"), ("twist", "turns"), ("vertical base acceleration", "m/s²")):
        assert f"%{{y:.4g}} {unit}<" in curves[name].hovertemplate
    shown = {str(one.y[0]) for one in figure.data if one.hovertext is not None}
    assert shown == {one.name.lower() for one in ContactHistory.of(conveyed).shown}


def test_the_extremes_of_long_histories_are_drawn():
    rng = np.random.default_rng(1)
    values = rng.normal(size=50_001)
    values[[777, 40_000]] = 9.0, -9.0
    kept = _extremes(values)
    assert kept.size <= 4002
    assert {0, 777, 40_000, 50_000} <= set(kept.tolist())


def test_lines_of_titles_fit(conveyed):
    assert all(len(line) <= 90 for line in sb.plots.plot_interactive(conveyed).layout.title.text.split("<br>"))


def test_a_row_of_a_map_is_drawn_as_points(table):
    figure = sb.plots.plot_interactive(table.isel(angular_frequency=0))
    drawn = {x: y for one in figure.data for x, y in zip(one.x, one.y, strict=True)}
    row = table.isel(angular_frequency=0)
    assert drawn == dict(zip(row["acceleration"].values, row["peak_tilt"].values, strict=True))


def test_a_branch_is_bold_where_it_is_stable():
    model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    orbit = sb.orbits.periodic_orbit(model, sb.Harmonic.straight(acceleration=0.13, angular_frequency=1.6))
    branch = sb.orbits.continue_branch(orbit, "angular_frequency", bounds=(1.58, 1.65))
    stable, unstable, marks = sb.plots.plot_interactive(branch).data
    inside = branch.points["stable"].values.astype(bool)
    np.testing.assert_array_equal(np.isfinite(stable.y), inside)
    np.testing.assert_array_equal(np.isfinite(unstable.y), ~inside)
    np.testing.assert_array_equal(marks.x, branch.points["bifurcation_parameter"])


def test_a_verdict_counts_its_variations():
    verdict = sb.verdict(MODEL, sb.sample_record(), runs=60)
    figure = sb.plots.plot_interactive(verdict)
    assert figure.layout.title.text.replace("<br>", " ") == str(verdict)
    counts = {one.name.split(":")[0]: len(one.x) for one in figure.data}
    assert counts.get("overturned", 0) == int((verdict.data["overturned"] == 1).sum())
    assert sum(counts.values()) == 60
    assert verdict.data.attrs["deciding"] in ("", verdict.data["influence"].idxmax().item())
    influence = {
        LABELS.get(name, name): float(verdict.data["influence"].sel(variation=name))
        for name in map(str, verdict.data["variation"].values)
    }
    order = [influence[button.label] for button in figure.layout.updatemenus[0].buttons]
    assert order == sorted(influence.values(), reverse=True)
    (law,) = [button for button in figure.layout.updatemenus[0].buttons if button.label == "contact law"]
    x, axis = law.args
    assert list(axis["xaxis.ticktext"]) == [str(one) for one in verdict.data["model"].values]
    placed = np.sort(np.round(np.concatenate([np.asarray(one) for one in x["x"]])))
    np.testing.assert_array_equal(placed, np.sort(verdict.data["law"].values))
    assert all("contact law: " in text for one in figure.data for text in one.hovertext)


def test_what_has_no_interactive_figure_is_refused(table):
    with pytest.raises(ParameterError, match=r"got 3.*Draw it by plot|got int"):
        sb.plots.plot_interactive(3)
    with pytest.raises(ParameterError, match="one or two dimensions"):
        sb.plots.plot_interactive(xr.concat([table, table], dim="size"))


def test_without_plotly_the_extra_is_named(run, monkeypatch):
    monkeypatch.setitem(sys.modules, "plotly", None)
    monkeypatch.setitem(sys.modules, "plotly.graph_objects", None)
    with pytest.raises(UnsupportedError, match=r"pip install stylobate\[interactive\]"):
        sb.plots.plot_interactive(run)
    importlib.invalidate_caches()


def test_a_dark_style_gives_a_dark_figure(run):
    dark, light = "#111111", "white"
    assert sb.plots.plot_interactive(run).layout.template.layout.paper_bgcolor == light
    with plt.style.context("dark_background"):
        assert sb.plots.plot_interactive(run).layout.template.layout.paper_bgcolor.startswith(("rgb(17", dark))


def test_the_command_line_writes_a_page_that_needs_no_network(tmp_path):
    path = tmp_path / "run.html"
    column = ["--radius", "0.35", "--height", "5.2", "--density", "2700"]
    assert command(["simulate", *column, "--tilt", "0.05", "0", "--duration", "2", "--figure", str(path)]) == 0
    text = path.read_text()
    assert "Plotly.newPlot" in text
    assert "<script src=" not in text


def test_a_result_without_interactive_figure_is_a_page_with_its_picture(tmp_path):
    path = tmp_path / "curves.html"
    shaken = ["--motion", "circular", "--acceleration", "0.065", "--angular-frequency-range", "1", "2"]
    assert command(["response", "--slenderness", "0.1", *shaken, "--points", "20", "--figure", str(path)]) == 0
    assert "data:image/png;base64," in path.read_text()
