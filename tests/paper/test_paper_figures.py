"""Every figure of the report on the source paper shows data inside named axes."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.paper.analyses import circular, free, planar, straight, twist
from stylobate.paper.analyses.setting import paper_model
from stylobate.paper.report import _PICTURES
from stylobate.results.findings import PaperCheck, PaperSection

pytestmark = pytest.mark.long

LINE = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
# It takes seconds to compute; tests of plots draw it from another column.
ELSEWHERE = "stability-boundary"
DRAWN = [(name, draw) for name, _, draw, _ in _PICTURES if name != ELSEWHERE]


def modulated_data():
    """Return circles in the place of the limit cycles, which take seconds to find."""
    turn = np.linspace(0.0, 2.0 * np.pi, 33)
    fields = {
        f"{name}_{k}": (f"point_{k}", values)
        for k in range(2)
        for name, values in (
            ("tau", turn),
            ("amplitude", 1.0 + 0.1 * np.cos(turn)),
            ("phase", 0.5 + 0.1 * np.sin(turn)),
        )
    }
    return xr.Dataset({**fields, "steady_phase_0": 0.5, "steady_phase_1": 0.6}, attrs={"nu": [1.38, 1.36]})


@pytest.fixture(scope="module")
def check():
    data = {
        "response": circular.response_data(),
        "critical": circular.critical_data(),
        "modulated": modulated_data(),
        "twist": twist.twist_data(),
        "twist_boundary": twist.boundary_data(),
        "straight": straight.full_response_data(),
        "averaging": straight.averaging_data(),
        "exact": sb.studies.exact_response(paper_model(), LINE, angular_frequency=(2.9, 3.1), generations=0),
        "backbones": planar.backbone_data(),
        "kicks": planar.kick_data(),
        "runaway": free.runaway_data(),
        "pressure": free.pressure_data(),
    }
    return PaperCheck({"All": PaperSection((), data)})


def shows_data(axes):
    """Return whether some point of a curve lies within the limits of its axes."""
    (left, right), (low, high) = np.sort(axes.get_xlim()), np.sort(axes.get_ylim())
    curves = (np.asarray(line.get_xydata(), dtype=float).T for line in axes.lines)
    return any(np.any((left <= x) & (x <= right) & (low <= y) & (y <= high)) for x, y in curves)


@pytest.mark.parametrize(("name", "draw"), DRAWN, ids=[name for name, _ in DRAWN])
def test_a_figure_shows_its_data_inside_named_axes(name, draw, check):
    figure = draw(check)
    figure.canvas.draw()
    assert figure.axes
    for axes in figure.axes:
        assert shows_data(axes)
        assert axes.get_ylabel() or not axes.axison
    assert any(axes.get_xlabel() for axes in figure.axes) or name == "column"


def test_pictures_have_names_of_their_own():
    names = [name for name, *_ in _PICTURES]
    assert ELSEWHERE in names
    assert len(set(names)) == len(names)
