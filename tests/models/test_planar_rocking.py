"""Rocking in a vertical plane: Housner's block and the column that rocks like it, by their closed forms."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

import stylobate as sb
from stylobate.errors import ParameterError

SOLID = sb.Column.solid(radius=0.2, height=2.0, density=2500.0)
BLOCK = sb.PlanarRocking.block(width=0.3, height=1.5, density=2000.0)
LINE = sb.Harmonic.straight(acceleration=1.0, angular_frequency=4.0, direction=0.3)
ALONG = np.array([math.cos(0.3), math.sin(0.3)])


@given(tilt=st.floats(1e-4, 1.4), rate=st.floats(-1.0, 1.0), a=st.floats(-0.5, 0.5), side=st.sampled_from([1.0, -1.0]))
def test_rates_are_housners_equation(tilt, rate, a, side):
    # I θ̈ = −m g R sin(α − θ) − m R a cos(α − θ) on the positive side; p² = m g R/K.
    column = BLOCK.column
    alpha, share = column.tipping_angle, (column.frequency_parameter / column.frequency_scale) ** 2
    left = alpha - tilt
    expected = -side * share * (math.sin(left) + side * a * math.cos(left))
    found = BLOCK.planar_rates(side * tilt, rate, side, a, 0.0, *BLOCK.parameters)
    assert found == pytest.approx((rate, expected), rel=1e-12, abs=1e-13)


def test_the_frequency_parameter_of_a_block_is_housners():
    # p² = 3g/(4R)
    column = BLOCK.column
    expected = math.sqrt(0.75 * column.gravity / column.rim_distance)
    assert column.frequency_parameter == pytest.approx(expected, rel=1e-14)
    assert column.mass == pytest.approx(900.0, rel=1e-14)


@given(
    tilt=st.floats(1e-3, 1.4), rate=st.floats(-0.5, 0.5), a=st.floats(-0.5, 0.5), az=st.floats(-0.5, 0.5),
    side=st.sampled_from([1.0, -1.0]),
)  # fmt: skip
def test_planar_rates_are_those_along_any_line(tilt, rate, a, az, side):
    model = sb.PlanarRocking(SOLID, damping=0.1, rolling_resistance=0.05)
    found = model.rates(*(side * tilt * ALONG), *(rate * ALONG), *(a * ALONG), az, *model.parameters)
    planar = model.planar_rates(side * tilt, rate, side, a, az, *model.parameters)
    assert np.array(found[2:]) == pytest.approx(planar[1] * ALONG, rel=1e-13, abs=1e-14)


def test_the_restitution_is_housners_unless_another_is_given():
    solid = sb.PlanarRocking(SOLID)
    c, kappa = SOLID.slenderness, SOLID.inertia_ratio
    assert solid.impact_restitution == pytest.approx(float(sb.theory.housner_restitution(c, inertia_ratio=kappa)))
    # (16h² − 9r²)/(16h² + 15r²), h half the height of a solid cylinder: known to twelve digits for c = 0.2.
    assert solid.impact_restitution == pytest.approx((16.0 - 9.0 * c**2) / (16.0 + 15.0 * c**2), rel=1e-14)
    assert solid.impact_restitution == pytest.approx(0.942168674699, abs=1e-12)
    assert BLOCK.impact_restitution == pytest.approx(float(sb.theory.block_restitution(0.2)), rel=1e-14)
    assert sb.PlanarRocking(SOLID, restitution=0.8).impact_restitution == 0.8
    assert sb.PlanarRocking.block(width=0.3, height=1.5, density=1000.0, restitution=0.7).impact_restitution == 0.7


def test_a_body_too_flat_to_rock_back_stays_down():
    flat = sb.PlanarRocking.block(width=3.0, height=1.0, density=1000.0)
    assert flat.impact_restitution == 0.0
    run = sb.simulate(flat, tilt=(0.2, 0.0), duration=5.0)
    assert run.outcome is sb.Outcome.AT_REST
    assert np.all(run.data["tilt"][:, 0] >= 0.0)


def test_slender_free_rocking_is_that_in_closed_form():
    # Corrections are of the order c².
    c = 1e-4
    model = sb.PlanarRocking(sb.Column.dimensionless(c), restitution=1.0)
    run = sb.simulate(model, tilt=(0.6 * c, 0.0), duration=12.0, rtol=1e-11)
    tilt, rate = sb.theory.planar_free_motion(run.data["time"].to_numpy(), 0.6 * c, c)
    np.testing.assert_allclose(run.data["tilt"][:, 0], tilt, rtol=0.0, atol=1e-6 * c)
    np.testing.assert_allclose(run.data["tilt_rate"][:, 0], rate, rtol=0.0, atol=1e-6 * c)


def test_the_period_at_finite_angles_is_the_integral_of_the_energy():
    model = sb.PlanarRocking(SOLID, restitution=1.0)
    c, kappa, most = SOLID.slenderness, SOLID.inertia_ratio, 0.15
    alpha = SOLID.tipping_angle

    def slowness(s):
        # θ = θ0 − s²: the root at the peak tilt goes away; cos(α − θ) rises with the height of the centre of mass.
        left = alpha - (most - s * s)
        drop = math.hypot(1.0, c) * (math.cos(alpha - most) - math.cos(left))
        return 2.0 * s / math.sqrt(2.0 * drop / (1.0 + kappa * c**2)) if s > 0.0 else 0.0

    quarter = quad(slowness, 1e-9, math.sqrt(most), epsabs=1e-13, epsrel=1e-12)[0]
    period = 4.0 * quarter / SOLID.frequency_scale
    run = sb.simulate(model, tilt=(most, 0.0), duration=period, rtol=1e-12)
    assert float(run.data["tilt"][-1, 0]) == pytest.approx(most, rel=1e-9)
    assert float(run.sample(period / 4.0)["tilt"][0, 0]) == pytest.approx(0.0, abs=2e-8)
    assert float(run.sample(period / 2.0)["tilt"][0, 0]) == pytest.approx(-most, rel=1e-9)


@pytest.mark.parametrize("restitution", [None, 0.9, 0.5])
def test_energy_after_n_impacts_is_that_before_times_the_square_of_the_restitution_to_the_n(restitution):
    model = sb.PlanarRocking(SOLID, restitution=restitution)
    run = sb.simulate(model, tilt=(0.15, 0.0), duration=6.0, rtol=1e-11, samples=4001)
    energy = run.data["energy"].to_numpy()
    impacts = np.flatnonzero(np.diff(np.sign(run.data["tilt"][:, 0].to_numpy())))
    levels = energy[np.append(0, impacts + 1)][:6]
    e = model.impact_restitution
    assert levels.size >= 4
    np.testing.assert_allclose(levels, levels[0] * e ** (2.0 * np.arange(levels.size)), rtol=1e-8)


def test_slender_amplitudes_after_impacts_are_housners():
    # Housner (1963), small angles: 1 − φ_n = √(1 − e^{2n}(1 − (1 − φ_0)²)).
    c, e = 1e-4, 0.9
    model = sb.PlanarRocking(sb.Column.dimensionless(c), restitution=e)
    run = sb.simulate(model, tilt=(0.7 * c, 0.0), duration=16.0, rtol=1e-11, samples=20001)
    tilt = run.data["tilt"][:, 0].to_numpy() / c
    impacts = np.flatnonzero(np.diff(np.sign(tilt)))
    swings = [np.abs(part).max() for part in np.split(tilt, impacts + 1)[1:-1]]
    n = np.arange(1, len(swings) + 1)
    assert len(swings) >= 4
    expected = 1.0 - np.sqrt(1.0 - e ** (2 * n) * (1.0 - 0.3**2))
    np.testing.assert_allclose(swings, expected, atol=1e-6)


def test_impacts_bring_it_to_rest_and_without_loss_nothing_does():
    assert sb.simulate(sb.PlanarRocking(SOLID), tilt=(0.05, 0.0), duration=60.0).outcome is sb.Outcome.AT_REST
    lossless = sb.simulate(sb.PlanarRocking(SOLID, restitution=1.0), tilt=(0.05, 0.0), duration=20.0, rtol=1e-11)
    assert lossless.outcome is sb.Outcome.STILL_MOVING
    np.testing.assert_allclose(lossless.data["energy"], lossless.data["energy"][0], rtol=1e-9)


def test_it_leaves_its_base_at_the_acceleration_that_tips_it():
    limit = SOLID.slenderness * SOLID.gravity
    below, above = (LINE.scaled(factor * limit) for factor in (0.999, 1.02))
    assert sb.simulate(sb.PlanarRocking(SOLID), below, duration=5.0).outcome is sb.Outcome.AT_REST
    run = sb.simulate(sb.PlanarRocking(SOLID), above, duration=5.0)
    assert run.events[0].kind == "uplift"
    assert run.measures["peak_tilt"] > 0.0


def test_a_slow_push_beyond_its_strength_overturns_it_for_good():
    run = sb.simulate(sb.PlanarRocking(SOLID), LINE.scaled(4.0), duration=10.0)
    assert run.outcome is sb.Outcome.OVERTURNED
    assert run.planar


@pytest.mark.parametrize(
    "start",
    [
        {"tilt": (0.05, 0.0), "tilt_rate": (0.0, 0.1)},
        {"tilt": (0.05, 0.0), "motion": LINE},
        {"motion": sb.Harmonic.circular(acceleration=1.0, angular_frequency=3.0)},
    ],
)
def test_what_leaves_the_plane_is_refused_in_one_line(start):
    with pytest.raises(ParameterError, match="must lie in one vertical plane for model planar rocking") as refusal:
        sb.simulate(BLOCK, start.pop("motion", None), **start, duration=1.0)
    assert "\n" not in str(refusal.value)


@pytest.mark.slow
def test_a_plane_may_have_any_direction_and_shake_upwards():
    motion = LINE.scaled(2.2) + sb.Harmonic.vertical(acceleration=2.0, angular_frequency=9.0)
    turned = sb.simulate(BLOCK, motion, tilt=0.03 * ALONG, duration=3.0, rtol=1e-10)
    straight = sb.simulate(BLOCK, motion.rotated(-0.3), tilt=(0.03, 0.0), duration=3.0, rtol=1e-10)
    assert turned.planar
    np.testing.assert_allclose(turned.data["tilt"].to_numpy() @ ALONG, straight.data["tilt"][:, 0], atol=1e-9)


def test_it_can_be_described_and_saved(tmp_path):
    model = sb.PlanarRocking(SOLID, damping=0.01, rolling_resistance=0.02)
    run = sb.simulate(model, LINE.scaled(2.2), duration=3.0)
    loaded = sb.load(run.save(tmp_path / "run.nc"))
    setup = sb.config.config_of(loaded.provenance).build()
    assert setup.model == model
    again = sb.simulate(setup.model, setup.motion, **setup.options)
    np.testing.assert_array_equal(again.data["tilt"], run.data["tilt"])


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: sb.PlanarRocking(None), "column must be a Column"),
        (lambda: sb.PlanarRocking(SOLID, damping=-1.0), "damping must be zero or positive, got -1.0"),
        (lambda: sb.PlanarRocking(SOLID, restitution=1.5), "restitution must lie between 0 and 1, 1 for no loss, got"),
        (lambda: sb.PlanarRocking.block(width=0.0, height=1.0, density=1000.0), "width must be positive, got 0.0 m"),
        (lambda: sb.PlanarRocking.block(width=1.0, height=1.0, density=-1.0), "density must be positive, got -1.0 kg"),
    ],
)
def test_bad_numbers_are_refused_in_one_line(make, told):
    with pytest.raises(ParameterError) as refusal:
        make()
    assert str(refusal.value).startswith(told)
    assert "\n" not in str(refusal.value)


def test_every_impact_is_an_event_at_a_change_of_side_and_is_counted():
    block = sb.PlanarRocking.block(width=0.6, height=3.0, density=2400.0)
    run = sb.simulate(block, tilt=(0.1, 0.0), duration=10.0)
    impacts = [event.time for event in run.events if event.kind == "impact"]
    fine = run.sample(np.linspace(0.0, 10.0, 20_001))
    side = np.sign(fine["tilt"][:, 0].to_numpy())
    changes = fine["time"].to_numpy()[:-1][side[1:] * side[:-1] < 0.0]
    assert len(changes) == 17
    assert run.measures["impacts"] == len(impacts) == len(changes)
    np.testing.assert_allclose(impacts, changes, rtol=0.0, atol=1e-3)
    # Each leaves the part e of the speed with which it was reached.
    before, after = (run.sample(np.array(impacts) + t)["tilt_rate"][:, 0].to_numpy() for t in (-1e-7, 1e-7))
    np.testing.assert_allclose(after / before, block.impact_restitution, rtol=1e-5)


def test_a_passage_in_a_plane_that_costs_no_energy_is_an_event_too():
    free = sb.simulate(sb.Slender(sb.Column.dimensionless(0.1)), tilt=(0.05, 0.0), duration=10.0)
    kinds = {event.kind for event in free.events}
    assert kinds == {"passage"}
    assert free.measures["impacts"] == 0.0
    tilt = free.sample([event.time for event in free.events])["tilt"][:, 0]
    assert np.abs(tilt).max() < 1e-9
