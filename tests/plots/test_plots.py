"""Figures show what their results hold."""

import numpy as np
import pytest
from matplotlib.patches import Circle

import stylobate as sb
from stylobate.errors import FileError, ParameterError
from stylobate.plots.page import PageSection, PageTable, Picture, page
from stylobate.plots.responses import draw_branch
from stylobate.plots.style import STABLE_WIDTH, UNSTABLE_WIDTH, new_figure
from stylobate.results.findings import PaperCheck

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
MOTION = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)


@pytest.fixture(scope="module")
def run():
    return sb.simulate(MODEL, MOTION, tilt=(0.04, 0.0), tilt_rate=(0.0, 0.07), duration=20.0)


def test_a_run_shows_tilt_azimuth_and_orbit_with_units(run):
    figure = sb.plot(run)
    labels = {axes.get_ylabel() for axes in figure.axes} | {axes.get_xlabel() for axes in figure.axes}
    tilt = {r"tilt $\theta$ [rad]", "azimuth $\\beta$\n[turns]", r"tilt $\theta_x$ [rad]", r"tilt $\theta_y$ [rad]"}
    assert tilt | {"base acceleration\n$a/g$", r"time $\omega_0 t$"} <= labels
    drawn = figure.axes[0].lines[0].get_xydata()
    np.testing.assert_array_equal(drawn[:, 1], run.data["amplitude"])
    circles = [patch for axes in figure.axes for patch in axes.patches if isinstance(patch, Circle)]
    assert [circle.get_radius() for circle in circles] == [pytest.approx(0.1)]


@pytest.mark.parametrize(("direction", "positive"), [(0.0, 1), (2.5, -1), (0.5 * np.pi, 1), (-0.5 * np.pi, -1)])
@pytest.mark.parametrize("sign", [1, -1])
def test_the_tilt_along_its_line_is_positive_towards_x_or_else_y(direction, positive, sign):
    motion = sb.Harmonic.straight(acceleration=0.15, angular_frequency=3.0, direction=direction)
    tilt = (0.05 * sign * np.cos(direction), 0.05 * sign * np.sin(direction))
    figure = sb.plot(sb.simulate(MODEL, motion, tilt=tilt, duration=10.0))
    shown = next(axes for axes in figure.axes if axes.get_ylabel() == "tilt [rad]")
    assert shown.lines[0].get_ydata()[0] == pytest.approx(0.05 * sign * positive)


def test_several_runs_are_compared_with_a_legend(run):
    other = sb.simulate(MODEL, tilt=(0.05, 0.0), duration=20.0)
    figure = sb.plot([run, other], labels=["forced", "free"])
    named = [f"forced: {run.outcome.label}", f"free: {other.outcome.label}"]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == named


def test_a_released_and_overturned_column_is_marked():
    motion = sb.Harmonic.straight(acceleration=0.15, angular_frequency=1.0, start_phase=-1.2)
    figure = sb.plot(sb.simulate(MODEL, motion, duration=60.0))
    assert {"uplift", "overturned"} <= {text.get_text() for text in figure.axes[0].texts}


def test_stable_parts_are_bold_and_meet_the_thin_ones():
    curves = sb.studies.response_curves(MODEL, MOTION, angular_frequency=np.linspace(0.5, 3.0, 200))
    upper = curves.isel(sense=0).sel(branch="upper")
    axes = new_figure(3.0).subplots()
    draw_branch(axes, curves["angular_frequency"], upper["amplitude"], upper["stable"])
    thin, bold = axes.lines
    assert (thin.get_linewidth(), bold.get_linewidth()) == (UNSTABLE_WIDTH, STABLE_WIDTH)
    shown = np.isfinite(bold.get_ydata())
    # All that is stable, and one sample more, where the bold part begins on the thin one.
    assert shown.sum() == int(upper["stable"].sum()) + 1


def test_response_curves_are_drawn_with_their_backbone():
    curves = sb.studies.response_curves(MODEL, MOTION, angular_frequency=[0.5, 1.0, 2.0])
    amplitude = sb.plot(curves).axes[0]
    np.testing.assert_allclose(amplitude.lines[0].get_ydata(), sb.theory.rolling_backbone(np.array([0.5, 1, 2]), 0.1))


def test_curves_that_coincide_are_drawn_once():
    straight = sb.Harmonic.straight(acceleration=0.1, angular_frequency=1.0)
    curves = sb.studies.response_curves(MODEL, straight, angular_frequency=[0.5, 1.0, 2.0])
    names = [text.get_text() for text in sb.plot(curves).axes[0].get_legend().get_texts()]
    assert any("either sense" in name for name in names)


@pytest.mark.parametrize("result", [3.0, [], ["run"]])
def test_what_has_no_picture_is_refused(result):
    with pytest.raises(ParameterError, match=r"^result(\[0\])?[: ]"):
        sb.plot(result)


def test_a_page_is_one_file_and_escapes_its_text():
    figure = new_figure(2.0)
    figure.subplots().plot([0, 1])
    html = page(
        "a < b", ["x & y"], [PageSection("s", ["<script>", Picture(figure, "c"), PageTable(["h"], [["1 < 2"]])])]
    )
    assert "a &lt; b" in html
    assert "x &amp; y" in html
    assert "<script>" not in html
    assert "http" not in html
    assert html.count("data:image/png;base64,") == 1


def test_a_folder_that_cannot_be_written_is_told(tmp_path):
    blocked = tmp_path / "file"
    blocked.write_text("")
    with pytest.raises(FileError, match="cannot write into"):
        sb.paper.paper_report(PaperCheck({}), blocked)
