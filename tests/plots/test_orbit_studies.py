"""Figures of responses, boundaries, sweeps, sections and exponents show what their results hold."""

import numpy as np
import pytest
from matplotlib.colors import to_hex

import stylobate as sb
from stylobate.errors import EndedEarlyWarning, Outcome
from stylobate.plots.style import BLUE, STABLE_WIDTH, VERMILION
from stylobate.results.outcomes import NOT_COMPUTED

MODEL = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
MOTION = sb.Harmonic.circular(acceleration=0.065, angular_frequency=2.0)


@pytest.fixture(scope="module")
def swept():
    start = sb.studies.steady_start(MODEL, MOTION)
    values = np.stack([[2.0, 1.9, 1.8, 1.9, 2.0], [2.0, 1.9, 1.0, 0.9, 0.8]], axis=1)
    return sb.studies.slow_sweep(MODEL, MOTION, values=values, periods_each=60, **start)


def texts(legend):
    return [text.get_text() for text in legend.get_texts()]


def test_a_sweep_is_drawn_in_the_directions_in_which_it_went(swept):
    figure = sb.plot(swept)
    tilts, turns = figure.axes
    down, up, other, cross = tilts.lines
    assert [one.get_marker() for one in (down, up, other, cross)] == ["<", ">", "<", "X"]
    assert [to_hex(one.get_color()).upper() for one in (down, up, other)] == [BLUE, BLUE, VERMILION]
    assert down.get_xdata().tolist() == [2.0, 1.9, 1.8]
    assert up.get_xdata().tolist() == [1.8, 1.9, 2.0]
    np.testing.assert_array_equal(down.get_ydata(), swept["mean_tilt"].values[:3, 0])
    assert texts(tilts.get_legend())[:3] == ["sweep 1, downward", "sweep 1, upward", "sweep 2, downward"]
    assert tilts.get_ylabel() == r"tilt $\theta$ [rad]"
    assert turns.get_xlabel() == r"base frequency $\Omega/\omega_0$"
    np.testing.assert_array_equal(turns.lines[1].get_ydata(), swept["turns_per_period"].values[2:, 0])


def test_a_cross_marks_where_a_column_overturned_at_its_last_tilt(swept):
    tilts = sb.plot(swept).axes[0]
    assert swept["outcome"].values[2, 1] == Outcome.OVERTURNED
    np.testing.assert_array_equal(tilts.lines[-1].get_xydata(), [[1.0, swept["mean_tilt"].values[1, 1]]])
    assert texts(tilts.get_legend())[-1] == "overturned here"


def test_a_sweep_of_which_nothing_is_computed_has_an_empty_figure(swept):
    empty = swept.where(False)
    empty["outcome"] = swept["outcome"] * 0 + NOT_COMPUTED
    figure = sb.plot(empty.assign_attrs(swept.attrs))
    assert not figure.axes[0].lines
    figure.canvas.draw()


def test_a_sweep_of_one_value_is_a_point(swept):
    figure = sb.plot(swept.isel(step=[0], sweep=[0]))
    assert figure.axes[0].lines[0].get_xydata().shape == (1, 2)
    figure.canvas.draw()


def test_a_section_shows_the_points_of_each_run_with_units():
    start = sb.studies.steady_start(MODEL, MOTION)
    tilt = np.outer([1.0, 1.05], start["tilt"])
    found = sb.studies.poincare_section(MODEL, MOTION, tilt=tilt, tilt_rate=start["tilt_rate"], periods=50, skip=40)
    figure = sb.plot(found)
    first, second = figure.axes
    assert first.get_xlabel() == r"tilt $\theta_x$ [rad]"
    assert second.get_ylabel() == r"tilt rate $\dot\theta_y$ [$\omega_0$]"
    for run in range(2):
        np.testing.assert_array_equal(first.lines[run].get_xydata(), found["section_tilt"].values[run])
        np.testing.assert_array_equal(second.lines[run].get_xydata(), found["section_tilt_rate"].values[run])
    assert [one.split(":")[0] for one in texts(figure.legends[0])] == ["run 1", "run 2"]
    figure.canvas.draw()


def test_exponents_are_drawn_as_they_settle_with_their_errors_in_the_legend():
    start = sb.studies.steady_start(MODEL, MOTION)
    found = sb.studies.lyapunov_exponents(MODEL, MOTION, **start, periods=50, skip=0)
    figure = sb.plot(found)
    (axes,) = figure.axes
    np.testing.assert_array_equal(axes.lines[1].get_ydata(), found["running"].values[:, 0])
    assert axes.get_title(loc="left") == r"sum −0.2 $\omega_0$"
    assert axes.get_ylabel() == r"Lyapunov exponent so far [$\omega_0$]"
    names = texts(figure.legends[0])
    assert len(names) == 4
    # As many places as the error has, and that with two digits.
    shown = names[0].replace("−", "-").split("= ")[1].removesuffix(r" $\omega_0$")
    value, error = (float(part) for part in shown.split(" ± "))
    assert value == pytest.approx(float(found["lyapunov_exponent"][0]), abs=0.1 * float(found["error"][0]))
    assert error == pytest.approx(float(found["error"][0]), rel=0.06)


def test_exponents_of_a_motion_that_ended_are_not_told():
    slow = sb.Harmonic.circular(acceleration=0.065, angular_frequency=0.9)
    with pytest.warns(EndedEarlyWarning, match="overturned"):
        found = sb.studies.lyapunov_exponents(MODEL, slow, tilt=(0.08, 0.0), periods=50, skip=0)
    figure = sb.plot(found)
    assert figure.axes[0].get_title(loc="left").startswith("overturned after")
    assert all(name.endswith("undecided") for name in texts(figure.legends[0]))
    figure.canvas.draw()


def test_a_section_without_points_says_so():
    slow = sb.Harmonic.circular(acceleration=0.065, angular_frequency=0.9)
    with pytest.warns(EndedEarlyWarning, match="1 overturned"):
        found = sb.studies.poincare_section(MODEL, slow, tilt=(0.08, 0.0), periods=60, skip=40)
    figure = sb.plot(found)
    assert [[text.get_text() for text in axes.texts] for axes in figure.axes] == [
        ["no points: the motion ended before"],
        ["no points: the motion ended before"],
    ]


@pytest.mark.parametrize("skip", [0, 3])
def test_the_periods_that_were_skipped_count_until_a_motion_ends(skip):
    # It rolls for a few periods before it leaves.
    slow = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.3)
    start = sb.studies.steady_start(MODEL, slow)
    tilt = np.multiply(1.001, start["tilt"])
    with pytest.warns(EndedEarlyWarning, match="overturned"):
        found = sb.studies.lyapunov_exponents(
            MODEL, slow, tilt=tilt, tilt_rate=start["tilt_rate"], periods=80, skip=skip
        )
    lasted = int(found["periods_counted"]) + found.attrs["periods_skipped"]
    assert lasted > 3
    assert found.attrs["periods_skipped"] == skip
    title = sb.plot(found).axes[0].get_title(loc="left")
    assert title == f"overturned after {lasted} whole periods"


LINE = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)


def bold(axes):
    return [line for line in axes.lines if line.get_linewidth() == STABLE_WIDTH and line.get_xdata().size]


def test_bold_lines_and_bands_end_at_the_bifurcations():
    curves = sb.studies.exact_response(MODEL, LINE, angular_frequency=(1.2, 3.0))
    pitchfork, doubling, other, torus = curves["bifurcation_angular_frequency"].values
    tilt = sb.plot(curves).axes[0]
    rolling, asymmetric = (line for line in bold(tilt) if line.get_linestyle() == "-")
    drawn = rolling.get_xdata()[np.isfinite(rolling.get_ydata())]
    assert (drawn.min(), drawn.max()) == (pitchfork, 3.0)
    drawn = asymmetric.get_xdata()[np.isfinite(asymmetric.get_ydata())]
    assert {pitchfork, doubling, other, torus} <= set(drawn)
    assert not np.any((drawn > other) & (drawn < doubling))
    ends = np.sort([edge for band in tilt.collections for path in band.get_paths() for edge in ends_of(path)])
    np.testing.assert_allclose(ends, np.sort([pitchfork, 3.0, pitchfork, doubling, other, torus]))
    assert texts(tilt.get_legend()).count("range of the tilt over a period") == 1


def ends_of(path):
    return path.vertices[:, 0].min(), path.vertices[:, 0].max()


def test_rocking_is_called_stable_in_its_plane():
    orbit = sb.orbits.periodic_orbit(MODEL, LINE, guess=[0.02523651, 0.0, -0.00401839, 0.0])
    curves = sb.studies.exact_response(MODEL, LINE, angular_frequency=(2.9, 3.1), orbit=orbit, generations=0)
    figure = sb.plot(curves)
    (axes,) = figure.axes  # rocking has no phase
    assert "bold: stable in the plane" in texts(axes.get_legend())
    figure.canvas.draw()


@pytest.mark.slow
def test_without_damping_stable_is_called_neutrally_stable():
    model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.0)
    line = sb.Harmonic.straight(acceleration=0.04, angular_frequency=3.0)
    curves = sb.studies.exact_response(model, line, angular_frequency=(2.9, 3.1), generations=0)
    assert "bold: neutrally stable" in texts(sb.plot(curves).axes[0].get_legend())
    compared = sb.studies.averaging_map(model, line, values=[0.04, 0.05], angular_frequency=[2.9, 3.1])
    assert texts(sb.plot(compared).legends[0]) == ["neutrally stable, as averaging predicts"]


def test_a_boundary_shows_nothing_outside_the_range_and_says_where_there_is_none():
    found = sb.studies.stability_boundary(MODEL, LINE, bounds=(0.1, 0.12), angular_frequency=(2.0, 2.5), values=[0.11])
    figure = sb.plot(found)
    (axes,) = figure.axes
    assert (axes.get_xlim(), axes.get_ylim()) == ((2.0, 2.5), (0.1, 0.12))
    # The averaged critical frequency lies far below.
    assert not axes.lines
    assert axes.get_title(loc="left") == "no loss of stability: exact rolling is stable here"
    figure.canvas.draw()
