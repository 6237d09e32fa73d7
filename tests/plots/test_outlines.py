"""Figures draw the outline of a column whose profile is known."""

from dataclasses import asdict

import numpy as np
import pytest

import stylobate as sb
from stylobate.earthquakes.assessment.report.sketch import lying_angle, turned
from stylobate.plots.body import FlutedColumn
from stylobate.plots.geometry import Shape

COLUMNS = {
    "frustum": sb.Column.frustum(radius=0.2, top_radius=0.1, height=1.0, density=2000.0),
    "amphora": sb.Column.estimated(
        radius=0.11, height=0.95, mass_height=0.52, mass=14.0, profile="amphora", max_radius=0.2
    ),
    "bowl": sb.Column.from_profile([0.0, 0.0, 0.1, 0.2], [0.1, 0.15, 0.3, 0.4], wall_thickness=0.01, density=2000.0),
}


@pytest.mark.parametrize("name", COLUMNS)
def test_a_body_that_overturned_lies_on_the_ground(name):
    shape = Shape.of_column(asdict(COLUMNS[name]))
    corners = turned(shape.side, shape.radius, lying_angle(shape))
    assert corners[:, 1].min() >= -1e-12
    assert (np.abs(corners[:, 1]) < 1e-12).sum() == 2  # the rim of the base, and the corner that touched first


def test_the_outline_is_that_of_the_profile():
    shape = Shape.of_column(asdict(COLUMNS["amphora"]))
    assert shape.corners[0] == pytest.approx((0.0, 0.11))
    assert shape.corners[-1][0] == pytest.approx(0.95)
    assert shape.largest_radius == pytest.approx(0.2)
    assert shape.side[:, 0].min() == pytest.approx(-0.2)


def test_the_facets_of_an_outline_lie_on_its_rings_and_face_outwards():
    shape = Shape.of_column(asdict(COLUMNS["amphora"]))
    body = FlutedColumn.of(shape)
    assert np.hypot(*np.moveaxis(body.rings[..., :2], -1, 0)).mean(axis=1) == pytest.approx(
        [radius for _, radius in shape.corners]
    )
    for low, high, normals in zip(body.rings[:-1], body.rings[1:], body.normals, strict=True):
        # The normals are those of a round body, not of its flat facets: 40 of them turn by 9° each.
        across, up = np.roll(low, -1, axis=0) - low, high - low
        outward = np.cross(across, up)
        assert outward / np.linalg.norm(outward, axis=1, keepdims=True) == pytest.approx(normals, abs=2e-3)


def test_an_outline_of_many_corners_keeps_its_ends():
    z = np.linspace(0.0, 1.0, 400)
    column = sb.Column.from_profile(z, 0.2 + 0.1 * np.sin(3.0 * z), mass=300.0)
    body = FlutedColumn.of(Shape.of_column(asdict(column)))
    assert len(body.rings) < 60
    assert body.rings[[0, -1], 0, 2] == pytest.approx([0.0, 1.0])
