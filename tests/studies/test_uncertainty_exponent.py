"""The uncertainty exponent: known boundaries, honest errors."""

import numpy as np
import pytest
import xarray as xr

import stylobate as sb
from stylobate.errors import Outcome, ParameterError
from stylobate.studies.maps.attractor_search import UNSETTLED
from stylobate.studies.maps.uncertainty_exponent import exponent_of, fit_power_law, overturned_or_not, shifted_starts

SMOOTH = np.geomspace(1e-4, 1e-2, 6)


def measured(label, dimension, epsilon, count=20_000, seed=5):
    rng = np.random.default_rng(seed)
    base = {f"x{i}": rng.random(epsilon.size * count) for i in range(dimension)}
    points = shifted_starts(base, "x0", epsilon)
    return exponent_of(label(*points.values()), epsilon, dimension=dimension)


def in_a_circle(x, y):
    return (np.hypot(x - 0.5, y - 0.5) < 0.3).astype(int)


def removed_level(x):
    """At which step the middle-thirds construction removes x, odd or even: the Cantor set is the boundary."""
    x, level, found = x.copy(), 0, np.full(x.shape, -1)
    while (found < 0).any() and level < 30:
        level += 1
        middle = (x > 1.0 / 3.0) & (x < 2.0 / 3.0)
        found[(found < 0) & middle] = level % 2
        x = np.where(x <= 1.0 / 3.0, 3.0 * x, 3.0 * x - 2.0)
    # Outside 0…1, and what is left after the last step.
    return np.abs(found)


def test_a_smooth_boundary_has_exponent_1():
    found = measured(in_a_circle, 2, SMOOTH)
    assert abs(float(found["uncertainty_exponent"]) - 1.0) < 3.0 * float(found["standard_error"])
    assert float(found["standard_error"]) < 0.05
    assert float(found["boundary_dimension"]) == 2.0 - float(found["uncertainty_exponent"])
    # An ε-shift to either side meets the circle from a strip of 2ε along x, on its two sides, over its height 0.6.
    np.testing.assert_allclose(found["fraction"], 4.0 * SMOOTH * 0.6, rtol=0.25)


def test_a_cantor_set_has_its_dimension():
    # Shifts by powers of 3 meet every level of the set alike: no oscillation about the power law.
    epsilon = 3.0 ** np.arange(-10.0, -3.0)
    found = measured(removed_level, 1, epsilon)
    error = float(found["standard_error"])
    assert abs(float(found["boundary_dimension"]) - np.log(2.0) / np.log(3.0)) < 3.0 * error
    assert error < 0.02
    assert float(found["misfit"]) < 3.0


def test_starts_are_shifted_to_both_sides_in_one_component_only():
    base = {"x": np.arange(4.0), "y": np.arange(4.0)}
    points = shifted_starts(base, "x", np.array([0.1, 0.2]))
    np.testing.assert_allclose(points["x"].reshape(3, 4) - base["x"], [[0.0] * 4, [-0.1, -0.1, -0.2, -0.2],
                               [0.1, 0.1, 0.2, 0.2]], atol=1e-15)  # fmt: skip
    np.testing.assert_array_equal(points["y"].reshape(3, 4), np.tile(base["y"], (3, 1)))


def test_starts_that_are_not_told_are_left_out():
    # One ε, three starts: one uncertain, one certain, one with an unknown neighbour.
    states = np.array([0, 1, 0, 1, 1, -2, 0, 1, 0])
    found = exponent_of(states, np.array([0.1]), dimension=1)
    assert (int(found["uncertain"][0]), int(found["pairs"][0])) == (1, 2)


def test_a_start_that_overturned_beside_one_that_did_not_is_uncertain_though_that_is_unsettled():
    # Six starts at one ε: unsettled beside overturned, twice; all unsettled; settled beside unsettled; told in full;
    # not computed.
    states = np.array([2, -2, -2, 0, 0, 2, -2, 2, -2, -2, 0, -1, 2, 2, -2, 0, 0, -1])
    overturned = np.array([1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, -1, 1, 1, 0, 0, 0, -1])
    found = exponent_of(states, np.array([0.1]), overturned=overturned, dimension=1)
    assert [int(found[name][0]) for name in ("uncertain", "pairs", "dropped")] == [2, 3, 2]


def test_unsettled_runs_do_not_hide_the_boundary_of_the_safe_starts(caplog):
    model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
    motion = sb.Harmonic.circular(acceleration=0.02, angular_frequency=1.2)
    arguments = {
        "over": {"tilt_x": (-0.1, 0.1), "tilt_rate_y": (-0.1, 0.1)},
        "shifted": "tilt_x",
        "shifts": [1e-3, 6e-3],
        "count": 60,
        "periods": 50,
    }
    found = sb.studies.uncertainty_exponent(model, motion, **arguments)
    dropped, told = int(found["dropped"].sum()), int(found["pairs"].sum())
    assert dropped > 12  # the runs are too short for many
    assert f"dropped {dropped} of 120 initial conditions" in caplog.text
    assert told == 120 - dropped
    safe = sb.studies.uncertainty_exponent(model, motion, **arguments, overturning_only=True)
    assert (found["uncertain"] >= safe["uncertain"]).all()
    assert int(safe["uncertain"].sum()) > 10
    assert int(safe["dropped"].sum()) == 0
    assert caplog.text.count("dropped") == 1


def test_only_a_run_that_overturned_or_not_is_told():
    outcomes = [Outcome.OVERTURNED, Outcome.AT_REST, Outcome.LIFTED_OFF, Outcome.LIMIT_REACHED, Outcome.FAILED]
    codes = np.array([*outcomes, -1])
    told = overturned_or_not(xr.Dataset({"outcome": ("run", codes)}))
    assert told.tolist() == [1, 0, UNSETTLED, UNSETTLED, UNSETTLED, -1]


def test_counts_of_nothing_pull_the_fit_as_much_as_they_tell():
    x, total = np.geomspace(1e-4, 1e-1, 7), np.full(7, 2000)
    rng = np.random.default_rng(11)
    laws = [fit_power_law(x, rng.binomial(total, 2.0 * x), total) for _ in range(60)]
    exponents = np.array([law.exponent for law in laws])
    errors = np.array([law.standard_error for law in laws])
    assert (2000 * 2.0 * x[0]) < 0.5  # where most counts are nothing
    # Unbiased, and the spread is what the standard error says: mean of 60 within 3 of its errors, ratio within 30 %.
    assert abs(exponents.mean() - 1.0) < 3.0 * errors.mean() / np.sqrt(60)
    assert exponents.std() / np.sqrt(np.mean(errors**2)) == pytest.approx(1.0, abs=0.3)


def test_saturated_shares_are_not_fitted_and_too_few_give_no_exponent():
    law = fit_power_law(np.array([0.01, 0.02, 0.5]), [10, 20, 90], [100, 100, 100])
    assert law.used.tolist() == [True, True, False]
    assert law.exponent == pytest.approx(1.0, abs=1e-6)
    np.testing.assert_allclose(law.at(np.array([0.01, 0.02])), [0.1, 0.2], rtol=1e-6)
    assert np.isnan(fit_power_law(np.array([0.1, 0.2]), [0, 3], [100, 100]).exponent)


def test_a_law_that_does_not_hold_says_so():
    law = fit_power_law(np.array([1.0, 2.0, 4.0, 8.0]), [100, 10, 300, 20], [1000] * 4)
    assert law.misfit > 10.0


def test_the_boundary_of_a_free_column_is_smooth():
    # Without friction a column in a plane falls if |x|/c + |v|/(cω0) > 1.
    model = sb.Slender(sb.Column.dimensionless(0.1))
    over = {"tilt_x": (0.0, 0.09), "tilt_rate_x": (0.0, 0.09)}
    shifts = np.geomspace(1e-4, 4e-3, 5)
    found = sb.studies.uncertainty_exponent(
        model, over=over, shifted="tilt_x", shifts=shifts, count=3000, overturning_only=True, duration=20.0
    )
    # A strip of 2ε along x about the line from (0.01, 0.09) to (0.09, 0.01); five standard errors of a share.
    share = 2.0 * shifts * 0.08 / 0.09**2
    np.testing.assert_array_less(np.abs(found["fraction"] - share), 5.0 * np.sqrt(share / 3000))
    assert abs(float(found["uncertainty_exponent"]) - 1.0) < 3.0 * float(found["standard_error"])
    assert float(found["standard_error"]) < 0.1
    assert found.attrs["kind"] == "uncertainty exponent"
    assert found["epsilon"].attrs["units"] == "rad"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"shifted": "tilt_y"}, "shifted"),
        ({"shifts": [0.1]}, "shifts"),
        ({"shifts": [0.2, 0.1]}, "shifts"),
        ({"count": 0}, "count"),
        ({"overturning_only": True, "tilt_limit": 0.3}, "tilt_limit"),
        ({"over": {"damping": (0.0, 1.0)}}, "damping"),
    ],
)
def test_bad_input_is_named(change, message):
    arguments = {"over": {"tilt_x": (0.0, 0.1)}, "shifted": "tilt_x", "count": 2, "duration": 1.0} | change
    with pytest.raises(ParameterError, match=message):
        sb.studies.uncertainty_exponent(sb.Slender(sb.Column.dimensionless(0.1)), **arguments)
