"""What a run begins with besides its tilt: spin, twist and position, of models that know them."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError

COLUMN = sb.Column.solid(radius=0.2, height=2.0, density=2500.0)
LEAN = {"tilt": (0.05, 0.0), "tilt_rate": (0.0, 0.1), "duration": 1.0}
WITH_SPIN = [sb.Rolling(COLUMN), sb.SlenderRolling(COLUMN)]
WITH_PLACE = [*WITH_SPIN, sb.Wobbling(COLUMN), sb.Wobbling(COLUMN, constraint="rubber")]


def named(model):
    return model.name


@pytest.mark.parametrize("model", WITH_SPIN, ids=named)
def test_a_run_begins_with_the_spin_told(model):
    run = sb.simulate(model, **LEAN, spin=0.7)
    assert float(run.data["spin"][0]) == pytest.approx(0.7, rel=1e-14)
    assert run.provenance["spin"] == 0.7


@pytest.mark.parametrize("model", WITH_PLACE, ids=named)
def test_twist_and_place_at_the_start_are_added_to_all_that_follows(model):
    # They act on the length of steps only.
    there = sb.simulate(model, **LEAN, twist=0.4, position=(0.3, -0.2), rtol=1e-12)
    here = sb.simulate(model, **LEAN, rtol=1e-12)
    np.testing.assert_allclose(there.data["tilt"], here.data["tilt"], atol=1e-11)
    np.testing.assert_allclose(there.data["twist"], here.data["twist"] + 0.4, atol=1e-11)
    for name in ("footprint", "contact_point"):
        np.testing.assert_allclose(there.data[name], here.data[name] + np.array([0.3, -0.2]), atol=1e-11)
    np.testing.assert_allclose(
        np.hypot(*(there.data["contact_point"] - there.data["footprint"]).to_numpy().T), COLUMN.radius, rtol=1e-12
    )


@pytest.mark.parametrize("model", [sb.Rolling(COLUMN), sb.SlenderRolling(COLUMN)], ids=named)
def test_the_footprint_moves_as_the_column_twists(model):
    # Ḃ0 = −r χ̇ n, by differences of a fine sampling.
    run = sb.simulate(model, **LEAN, spin=0.7, samples=4001, rtol=1e-11)
    beta, twist, place = (run.data[name].to_numpy() for name in ("azimuth", "twist", "footprint"))
    across = np.array([-np.sin(beta), np.cos(beta)]).T
    moved = np.diff(place, axis=0)
    expected = -COLUMN.radius * np.diff(twist)[:, np.newaxis] * (across[1:] + across[:-1]) / 2.0
    step = np.abs(np.diff(beta)).max()
    np.testing.assert_allclose(moved, expected, rtol=0.0, atol=step**2 * np.abs(moved).max())


def test_a_spin_moves_a_leaning_column_out_of_its_plane():
    still, spinning, other = (
        sb.simulate(sb.Rolling(COLUMN), tilt=(0.05, 0.0), spin=spin, duration=0.5) for spin in (0.0, 1.0, -1.0)
    )
    assert still.planar
    assert not spinning.planar
    assert np.abs(spinning.data["tilt"][:, 1]).max() > 1e-4
    # Mirrored for the other spin.
    np.testing.assert_allclose(other.data["tilt"][:, 0], spinning.data["tilt"][:, 0], atol=1e-9)
    np.testing.assert_allclose(other.data["tilt"][:, 1], -spinning.data["tilt"][:, 1], atol=1e-9)


def test_what_is_carried_along_stays_while_the_column_stands():
    run = sb.simulate(sb.Wobbling(COLUMN, damping=0.5), tilt=(0.01, 0.0), twist=0.4, position=(0.1, 0.2), duration=30.0)
    assert run.outcome is sb.Outcome.AT_REST
    np.testing.assert_allclose(run.data["twist"], 0.4, rtol=1e-15)
    np.testing.assert_allclose(run.data["footprint"], [[0.1, 0.2]] * run.data.sizes["time"], rtol=1e-15)
    assert np.isnan(run.data["contact_point"][-1]).all()


@pytest.mark.parametrize("model", [sb.Slender(COLUMN), sb.Wobbling(COLUMN), sb.PlanarRocking(COLUMN)], ids=named)
def test_a_model_that_cannot_turn_refuses_a_spin(model):
    with pytest.raises(ParameterError, match=r"^spin must be left out: .* got 0.5 rad/s$") as refusal:
        sb.simulate(model, tilt=(0.05, 0.0), spin=0.5, duration=1.0)
    assert f"model {model.name}" in str(refusal.value)


@pytest.mark.parametrize("tilt", [0.0, 1e-18, -1e-17])
def test_a_column_that_stands_flat_refuses_a_spin(tilt):
    # Tilts that are the rounding of none count as none.
    with pytest.raises(ParameterError, match=r"^spin must be 0 for a column that stands flat .*; give it a tilt$"):
        sb.simulate(sb.Rolling(COLUMN), tilt=(tilt, 0.0), spin=0.5, duration=1.0)


@pytest.mark.parametrize("model", [sb.Slender(COLUMN), sb.PlanarRocking(COLUMN)], ids=named)
@pytest.mark.parametrize(("name", "value"), [("twist", 0.3), ("position", (0.0, 0.1))])
def test_a_model_that_does_not_follow_them_refuses_twist_and_position(model, name, value):
    with pytest.raises(ParameterError, match=rf"^{name} must be left out: model {model.name}") as refusal:
        sb.simulate(model, tilt=(0.05, 0.0), **{name: value}, duration=1.0)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"spin": math.nan}, "spin must be finite, got nan rad/s"),
        ({"spin": "fast"}, "spin must be a real number, got 'fast'"),
        ({"twist": math.inf}, "twist must be finite, got inf rad"),
        ({"position": 0.3}, "position must have 2 numbers, got 0.3"),
        ({"position": (0.3, math.nan)}, "position[1] must be finite, got nan m"),
        ({"friction_coefficient": 0.0}, "friction_coefficient must be positive, got 0.0"),
        ({"friction_coefficient": -0.5}, "friction_coefficient must be positive, got -0.5"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(change, told):
    with pytest.raises(ParameterError) as refusal:
        sb.simulate(sb.Rolling(COLUMN), **LEAN, **change)
    assert str(refusal.value) == told
