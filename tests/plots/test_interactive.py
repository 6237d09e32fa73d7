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
    assert len(figure.data) == 4
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
    assert figure.layout.title.text == str(verdict)
    counts = {one.name.split(":")[0]: len(one.x) for one in figure.data}
    assert counts.get("overturned", 0) == int((verdict.data["overturned"] == 1).sum())
    assert sum(counts.values()) == 60
    most = figure.layout.updatemenus[0].buttons[0].label
    largest = verdict.data["influence"].idxmax().item()
    assert verdict.data.attrs["deciding"] in ("", largest)
    assert most == largest.replace("_", " ")


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
