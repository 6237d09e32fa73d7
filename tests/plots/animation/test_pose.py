"""The pose of a leaning column, which all pictures share."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from stylobate.plots.geometry import base_centres, frames, quaternions

RNG = np.random.default_rng(7)
ANGLE, AZIMUTH, TWIST = RNG.uniform(1e-3, 1.4, 40), RNG.uniform(-math.pi, math.pi, 40), RNG.uniform(-9.0, 9.0, 40)
TILT = ANGLE[:, None] * np.stack([np.cos(AZIMUTH), np.sin(AZIMUTH)], axis=-1)


def test_the_axis_leans_by_the_tilt_towards_its_azimuth():
    axis = frames(quaternions(TILT, TWIST))[..., 2]
    leaning = [np.sin(ANGLE) * np.cos(AZIMUTH), np.sin(ANGLE) * np.sin(AZIMUTH), np.cos(ANGLE)]
    np.testing.assert_allclose(axis, np.stack(leaning, axis=-1), atol=1e-14)


def test_rotations_are_those_of_the_three_angles():
    # Up to 2π of twist both signs of a quaternion are the same rotation: compare matrices with SciPy's.
    expected = Rotation.from_euler("ZYZ", np.stack([AZIMUTH, ANGLE, TWIST - AZIMUTH], axis=-1)).as_matrix()
    np.testing.assert_allclose(frames(quaternions(TILT, TWIST)), expected, atol=1e-14)


def test_a_turn_without_a_lean_is_a_turn_about_the_vertical():
    np.testing.assert_allclose(quaternions([0.0, 0.0], 0.7), [math.cos(0.35), 0.0, 0.0, math.sin(0.35)], atol=1e-16)


def test_quaternions_are_unit_and_no_sign_leaps_through_the_upright_or_a_turn():
    time = np.linspace(0.0, 1.0, 2001)
    # Straight through the upright, while it turns three times.
    path = quaternions(np.stack([0.8 * (time - 0.5), 0.0 * time], axis=-1), 6.0 * math.pi * time)
    np.testing.assert_allclose(np.linalg.norm(path, axis=-1), 1.0, atol=1e-14)
    assert np.abs(np.diff(path, axis=0)).max() < 0.5 * math.hypot(6.0 * math.pi, 0.8) / 2000 * 1.01


@pytest.mark.parametrize("clearance", [0.0, 0.3])
def test_the_lowest_point_of_the_rim_is_the_contact_point_at_its_height(clearance):
    radius, footprint = 0.4, RNG.normal(size=(40, 2))
    frame, centre = frames(quaternions(TILT, TWIST)), base_centres(TILT, footprint, radius, clearance)
    # The material point at body angle β − χ is the lowest, and no other is lower.
    around = (AZIMUTH - TWIST)[:, None] + np.linspace(0.0, 2.0 * math.pi, 49)
    body = radius * np.stack([np.cos(around), np.sin(around), 0.0 * around], axis=-1)
    rim = np.einsum("nij,nkj->nki", frame, body) + centre[:, None]
    contact = footprint + radius * TILT / ANGLE[:, None]
    np.testing.assert_allclose(rim[:, 0, :2], contact, atol=1e-14)
    np.testing.assert_allclose(rim[:, 0, 2], clearance, atol=1e-14)
    assert rim[..., 2].min() > clearance - 1e-14


def test_an_upright_column_stands_on_its_footprint():
    np.testing.assert_array_equal(base_centres([0.0, 0.0], [1.0, 2.0], 0.5, 0.1), [1.0, 2.0, 0.1])
