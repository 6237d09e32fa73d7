"""Maps and basins whose runs end early once they have converged have the outcomes of those at full duration."""

import json

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import Outcome, ParameterError, UnsupportedError
from stylobate.studies.known_rolling import known_rolling

COLUMN = sb.Column.dimensionless(0.1)
MODELS = {
    "slender": sb.Slender(COLUMN, damping=0.1),
    "slender rolling": sb.SlenderRolling(COLUMN, damping=0.1, spin_damping=0.3),
    "wobbling": sb.Wobbling(COLUMN, damping=0.1),
    "rolling": sb.Rolling(COLUMN, damping=0.1, spin_damping=0.3),
}
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
LINE = sb.Harmonic.straight(acceleration=0.13, angular_frequency=4.0)
SLENDER = MODELS["slender"]


def ended_early(early, full):
    """Return which runs ended early, once the others are seen to be the same to the last bit."""
    ended = early["end_time"].values < full["end_time"].values
    for name in ("outcome", "end_time", "peak_tilt", "mean_tilt"):
        np.testing.assert_array_equal(early[name].values[~ended], full[name].values[~ended], err_msg=name)
    return ended


@pytest.mark.parametrize(
    "name",
    ["slender", "rolling", *(pytest.param(one, marks=pytest.mark.slow) for one in ("slender rolling", "wobbling"))],
)
def test_a_map_has_the_outcomes_of_full_durations(name):
    over = {"angular_frequency": np.linspace(1.0, 5.0, 20), "acceleration": np.linspace(0.02, 0.3, 20)}
    options = {"over": over, "periods": 250.0, "tilt": (0.03, 0.0)}
    full, early = (
        sb.studies.overturning_map(MODELS[name], CIRCLE, **options, end_converged=end) for end in (False, True)
    )
    np.testing.assert_array_equal(early["outcome"], full["outcome"])
    ended = ended_early(early, full)
    assert ended.sum() > 50
    assert (full["outcome"].values[ended] == Outcome.ROLLING).all()
    for variable in ("mean_tilt", "mean_rolling_rate"):
        np.testing.assert_allclose(early[variable].values[ended], full[variable].values[ended], rtol=1e-7)


@pytest.mark.parametrize(
    ("name", "turned"),
    [
        *[("slender", True), ("rolling", False)],
        *[pytest.param("wobbling", turned, marks=pytest.mark.slow) for turned in (False, True)],
        *[pytest.param(*case, marks=pytest.mark.slow) for case in (("slender", False), ("rolling", True))],
    ],
)
def test_a_basin_has_the_attractors_of_full_durations(name, turned):
    # Clockwise, with another phase at t = 0.
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8, sense=-1, start_phase=2.0)
    axis = np.linspace(-0.08, 0.08, 16)
    options = {"over": {"tilt_x": axis, "tilt_rate_y": axis}, "periods": 200.0}
    full, early = (
        sb.studies.basins(MODELS[name], motion if turned else CIRCLE, **options, end_converged=end)
        for end in (False, True)
    )
    assert early["attractor_name"].values.tolist() == full["attractor_name"].values.tolist()
    np.testing.assert_array_equal(early["attractor"], full["attractor"])
    np.testing.assert_array_equal(early["outcome"], full["outcome"])
    np.testing.assert_allclose(early["attractor_mean_tilt"], full["attractor_mean_tilt"], rtol=1e-6)
    assert ended_early(early, full).any()


@pytest.mark.slow
def test_orbits_that_are_passed_end_runs_of_a_basin():
    orbits = [sb.orbits.periodic_orbit(SLENDER, LINE, sense=sense) for sense in (1, -1)]
    axis = np.linspace(-0.08, 0.08, 16)
    options = {
        "over": {
            "tilt_x": axis,
            "tilt_y": axis,
        },
        "periods": 260.0,
    }
    full, early = (sb.studies.basins(SLENDER, LINE, **options, orbits=known) for known in ((), orbits))
    assert early["attractor_name"].values.tolist() == full["attractor_name"].values.tolist()
    np.testing.assert_array_equal(early["attractor"], full["attractor"])
    np.testing.assert_array_equal(early["outcome"], full["outcome"])
    assert ended_early(early, full).sum() > 100
    assert "known_orbits" not in json.loads(full.attrs["provenance"])
    assert len(json.loads(early.attrs["provenance"])["known_orbits"]) == 2


def test_an_orbit_counts_at_phase_zero_whatever_the_phase_at_the_start():
    moved = sb.Harmonic.straight(acceleration=0.13, angular_frequency=4.0, start_phase=1.0)
    orbit = sb.orbits.periodic_orbit(SLENDER, moved)
    options = {"over": {"start_phase": [0.0, 2.5], "tilt_x": np.linspace(0.003, 0.02, 20)}, "periods": 260.0}
    options["tilt_rate"] = (0.0, 0.02)  # not in the plane of the base motion
    full, early = (sb.studies.basins(SLENDER, LINE, **options, orbits=known) for known in ((), [orbit]))
    np.testing.assert_array_equal(early["attractor"], full["attractor"])
    assert ended_early(early, full).any(axis=1).all()


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("sense", [1, -1])
def test_closed_forms_of_runs_are_those_of_single_runs(name, sense):
    motion = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8, sense=sense, start_phase=0.4)
    values = {
        "angular_frequency": np.array([1.6, 2.0, 2.5]),
        "acceleration": np.array([0.05, 0.06, 0.07]),
        "scale": np.array([1.0, -0.9, 1.1]),
        "rotation": np.array([0.0, 1.0, 2.0]),
        "damping": np.array([0.1, 0.2, 0.3]),
        "size": np.array([1.0, 2.0, 2.0]),
    }
    known = known_rolling(MODELS[name], motion, values, 3)
    for k in range(3):
        changed = sb.with_parameters(MODELS[name], motion, **{one: float(array[k]) for one, array in values.items()})
        orbit = sb.orbits.periodic_orbit(*changed)
        # From t = 0 the state is carried to phase zero.
        until = -0.4 / (2.0 * np.pi) % 1.0
        state = orbit.system.carry(orbit.state, 0.0, until).end
        x, y, vx, vy = changed[0].tilt_of(*state, *changed[0].parameters)
        np.testing.assert_allclose(known.tilt[k], (x, y), atol=1e-9)
        np.testing.assert_allclose(known.tilt_rate[k], np.array([vx, vy]) / changed[0].time_scale, atol=1e-9)
        if changed[0].spin_state is not None:
            np.testing.assert_allclose(known.spin[k], orbit.spin, atol=1e-9)
        np.testing.assert_allclose(known.multiplier[k], abs(orbit.multipliers[0]), rtol=1e-6)
        np.testing.assert_allclose(known.mean_tilt[k], orbit.mean_tilt, rtol=1e-8)
        assert known.turns == orbit.turns


def test_what_has_no_closed_form_is_refused():
    over = {"angular_frequency": [1.0, 2.0], "damping": [0.1, 0.2]}
    with pytest.raises(UnsupportedError, match="the base motion must be circular"):
        sb.studies.overturning_map(SLENDER, LINE, over=over, periods=100.0, end_converged=True)
    resisted = sb.Wobbling(COLUMN, damping=0.1, rolling_resistance=0.01)
    with pytest.raises(UnsupportedError, match="must state a closed form"):
        sb.studies.overturning_map(resisted, CIRCLE, over=over, periods=100.0, end_converged=True)
    ramped = {"ramp": [1.0, 2.0], "damping": [0.1, 0.2]}
    with pytest.raises(UnsupportedError, match="ramp must not vary"):
        sb.studies.overturning_map(SLENDER, CIRCLE, over=ramped, periods=100.0, end_converged=True)
    saddle = sb.studies.steady_start(SLENDER, CIRCLE, branch="lower")
    unstable = sb.orbits.periodic_orbit(SLENDER, CIRCLE, guess=(*saddle["tilt"], *saddle["tilt_rate"]))
    basin = {"over": {"tilt_x": [0.0, 0.1], "tilt_y": [0.0, 0.1]}, "periods": 100.0}
    for orbit, motion, text in (
        (unstable, CIRCLE, "must be stable"),
        (unstable, LINE, "must be one of the model and base motion"),
        ("rolling", CIRCLE, "orbits must be periodic orbits"),
    ):
        with pytest.raises(ParameterError, match=text):
            sb.studies.basins(SLENDER, motion, **basin, orbits=[orbit])
