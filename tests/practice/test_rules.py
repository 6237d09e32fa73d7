"""Rules of practice: mechanics behind each number, by a second route or by runs, and how the numbers scale."""

import math
from dataclasses import replace

import numpy as np
import pytest

import stylobate as sb
from stylobate.errors import ParameterError
from stylobate.practice import (
    KinematicLimit,
    Shaking,
    asce_rocking,
    asce_sliding,
    fema_contents,
    housner_half_sine,
    housner_velocity,
    ishiyama_velocity,
    italian_mechanism,
    overturning_velocity,
    rules_of_practice,
    west,
)
from stylobate.practice.shaking import PERIODS

G = 9.80665
COLUMN = sb.Column.solid(radius=0.2, height=2.0, density=2700.0)
REST = Shaking(peak_acceleration=0.0, peak_velocity=0.0, spectrum=lambda _: np.zeros_like(PERIODS))


def slender(c, height=10.0):
    return sb.Column.solid(radius=0.5 * c * height, height=height, density=2700.0)


def constant_displacement(displacement):
    """Shaking whose spectral displacement is the same at all periods."""
    return replace(REST, spectrum=lambda _: displacement * (2.0 * math.pi / PERIODS) ** 2, peak_acceleration=1e9)


@pytest.mark.parametrize("model", [sb.PlanarRocking, sb.Wobbling])
@pytest.mark.parametrize("c", [0.05, 0.3])
def test_a_sudden_base_velocity_overturns_above_the_overturning_velocity_only(model, c):
    column = slender(c)
    rate = overturning_velocity(column) * column.mass * column.mass_height / column.rim_inertia
    length = 40.0 / column.frequency_parameter
    outcomes = [
        sb.simulate(model(column), tilt=(1e-12, 0.0), tilt_rate=(share * rate, 0.0), duration=length).outcome
        for share in (1.0 - 1e-4, 1.0 + 1e-4)
    ]
    assert outcomes[0] is not sb.Outcome.OVERTURNED
    assert outcomes[1] is sb.Outcome.OVERTURNED


@pytest.mark.parametrize("share", [0.999, 1.001])
def test_a_column_rocks_above_the_acceleration_of_west_only(share):
    limit = west(COLUMN, REST).capacity
    pulse = sb.Pulse.half_sine(acceleration=share * limit, angular_frequency=3.0)
    run = sb.simulate(sb.Wobbling(COLUMN, damping=0.05), pulse, rtol=1e-10)
    assert (float(run.data["amplitude"].max()) > 0.0) == (share > 1.0)
    assert west(COLUMN, Shaking.of(pulse)).safe == (share < 1.0)


def test_ishiyama_is_the_formula_of_the_literature_for_a_block():
    block = sb.PlanarRocking.block(width=0.3, height=2.0, density=2000.0).column
    alpha, size = block.tipping_angle, block.rim_distance
    literature = 0.4 * math.sqrt(8.0 / 3.0 * G * size * (1.0 - math.cos(alpha)) / math.cos(alpha) ** 2)
    assert ishiyama_velocity(block, REST).capacity == pytest.approx(literature, rel=1e-12)
    assert ishiyama_velocity(block, REST).capacity == pytest.approx(0.1 * 30.0 / math.sqrt(200.0), rel=0.05)


@pytest.mark.parametrize("size", [0.1, 3.0])
def test_capacities_scale_with_the_size(size):
    larger = COLUMN.resized(size)
    for rule, power in (
        (west, 0.0),
        (ishiyama_velocity, 0.5),
        (housner_velocity, 0.5),
        (fema_contents, 0.5),
        (asce_rocking, 0.0),
        (italian_mechanism, 1.0),
    ):
        assert rule(larger, REST).capacity == pytest.approx(size**power * rule(COLUMN, REST).capacity, rel=1e-12)


def test_slender_columns_scale_as_radius_over_root_of_height():
    errors = []
    for c in (0.1, 0.05):
        column = slender(c, height=6.0)
        limit = column.radius / math.sqrt(column.mass_height) * math.sqrt(4.0 / 3.0 * G)
        errors.append(overturning_velocity(column) / limit - 1.0)
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_contents_of_fema_scale_otherwise_than_slender_columns():
    low, tall = (fema_contents(slender(0.4 / height, height=height), REST).capacity for height in (1.0, 2.0))
    assert low / tall == pytest.approx(2.0, rel=1e-12)  # mechanics: √2


def test_housner_is_his_slender_formula():
    column = slender(1e-3)
    limit = G * column.tipping_angle / column.frequency_parameter
    assert housner_velocity(column, REST).capacity == pytest.approx(limit, rel=1e-5)


def test_the_mean_pseudo_velocity_of_a_constant_velocity_spectrum_is_that_velocity():
    shaking = replace(REST, spectrum=lambda _: 0.7 * 2.0 * math.pi / PERIODS, peak_acceleration=1e3)
    assert housner_velocity(COLUMN, shaking).demand == pytest.approx(0.7, rel=1e-9)


def test_the_half_sine_formula_of_housner_calls_a_pulse_safe_that_overturns():
    column = slender(1e-3)
    unit, p = column.slenderness * G, column.frequency_parameter
    rule = housner_half_sine(column, acceleration=2.0 * unit, angular_frequency=2.0 * p)
    assert rule.capacity / unit == pytest.approx(math.sqrt(5.0), rel=1e-12)
    assert rule.safe
    pulse = sb.Pulse.half_sine(acceleration=2.0 * unit, angular_frequency=2.0 * p)
    assert sb.simulate(sb.PlanarRocking(column), pulse).outcome is sb.Outcome.OVERTURNED
    assert float(sb.theory.half_sine_overturning(2.0, 1.0)) == pytest.approx(1.80072, abs=5e-6)


def test_under_a_constant_displacement_the_rocking_angle_is_displacement_over_height_and_inertia():
    inertia = COLUMN.rim_inertia / (COLUMN.mass * COLUMN.mass_height**2)
    for angle in (0.05, 0.15):
        shaking = constant_displacement(angle * inertia * COLUMN.mass_height)
        answer = asce_rocking(COLUMN, shaking)
        assert answer.demand == pytest.approx(angle, abs=COLUMN.tipping_angle / 150)
        assert answer.safe
    assert not asce_rocking(COLUMN, constant_displacement(0.21 * inertia * COLUMN.mass_height)).safe


@pytest.mark.parametrize("factor", [1.0, 1.3])
def test_a_constant_spectrum_overturns_above_the_capacity_at_the_tipping_angle(factor):
    alpha = COLUMN.tipping_angle
    limit = 2.0 * G * (1.0 / math.cos(alpha) - 1.0) / (alpha * factor)
    for share in (0.99, 1.01):
        level = share * limit
        shaking = replace(REST, spectrum=lambda _, level=level: np.full_like(PERIODS, level), peak_acceleration=level)
        assert asce_rocking(COLUMN, shaking, vertical_factor=factor).safe == (share < 1.0)


def test_the_damping_of_the_rocking_rule_is_that_of_housner_s_impacts():
    asked = []

    def spectrum(damping):
        asked.append(damping)
        return np.zeros_like(PERIODS)

    asce_rocking(COLUMN, replace(REST, spectrum=spectrum))
    decrement = 2.0 * math.pi * asked[0] / math.sqrt(1.0 - asked[0] ** 2)
    assert math.exp(-0.5 * decrement) == pytest.approx(COLUMN.housner_restitution, rel=1e-12)


def test_the_sliding_distance_is_the_displacement_of_the_spectrum():
    shaking = constant_displacement(0.12)
    near = asce_sliding(COLUMN, shaking, friction=0.4, clearance=0.1)
    assert near.demand == pytest.approx(0.12, rel=3e-3)
    assert not near.safe
    assert asce_sliding(COLUMN, shaking, friction=0.4).safe
    weaker = replace(REST, spectrum=lambda _: np.full_like(PERIODS, 0.79 * G), peak_acceleration=0.79 * G)
    assert asce_sliding(COLUMN, weaker, friction=0.4).demand == 0.0
    assert asce_sliding(COLUMN, replace(weaker, peak_vertical=0.5 * G), friction=0.4).demand > 0.0


def test_the_mechanism_is_the_static_balance_of_a_slender_column():
    errors = []
    for c in (0.1, 0.05):
        column = slender(c)
        left = 0.6 * column.tipping_angle  # α − θ
        displacement = column.radius - column.rim_distance * math.sin(left)
        linear = c * G * (1.0 - displacement / column.radius)
        errors.append(abs(linear / (G * math.tan(left)) - 1.0))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)


def test_demand_and_capacity_of_the_mechanism_by_hand():
    answer = italian_mechanism(COLUMN, constant_displacement(0.07), limit=KinematicLimit.LIFE_SAFETY)
    assert answer.capacity == pytest.approx(0.4 * 0.2)
    assert answer.demand == pytest.approx(0.07, rel=5e-3)
    asked = constant_displacement(0.07)
    level = replace(asked, spectrum=lambda _: np.full_like(PERIODS, 1.0), peak_acceleration=1.0)
    secant = 2.0 / 3.0 * 1.0 / G  # d/a at 0.4 d0: (0.4/0.6) h/g
    assert italian_mechanism(COLUMN, level, limit=KinematicLimit.LIFE_SAFETY).demand == pytest.approx(secant, rel=3e-3)
    assert italian_mechanism(COLUMN, level, limit=KinematicLimit.COLLAPSE).demand == pytest.approx(1.5 / G, rel=3e-3)


def test_shaking_of_a_pulse_has_its_peaks_and_of_a_record_its_spectrum():
    pulse = sb.Pulse.one_sine(acceleration=3.0, angular_frequency=6.0)
    shaking = Shaking.of(pulse)
    assert shaking.peak_acceleration == pytest.approx(3.0, rel=1e-3)
    assert shaking.peak_velocity == pytest.approx(1.0, rel=1e-3)
    record = sb.sample_record().trimmed(end=12.0)
    spectrum = Shaking.of(record).spectrum(0.05)
    exact = sb.records.response_spectra(record, PERIODS, damping=0.05)["rotd100"].to_numpy()
    np.testing.assert_allclose(spectrum, exact, rtol=2e-3)


def test_shaking_grows_with_the_record():
    record = sb.sample_record().trimmed(end=8.0)
    by_hand, scaled = Shaking.of(record.scaled(1.7)), Shaking.of(record).scaled(1.7)
    for name in ("peak_acceleration", "peak_velocity", "peak_vertical"):
        assert getattr(by_hand, name) == pytest.approx(getattr(scaled, name), rel=1e-12)
    periods = np.array([0.01, 0.05, 0.3, 2.0, 10.0, 20.0])
    np.testing.assert_allclose(by_hand.at(periods, 0.05), scaled.at(periods, 0.05), rtol=1e-9)
    assert float(scaled.at(0.0, 0.05)) == pytest.approx(scaled.peak_acceleration)
    assert float(REST.at(0.0, 0.05)) == 0.0


def test_every_rule_has_clause_and_source_and_only_the_medians_are_checked():
    answers = rules_of_practice(COLUMN, sb.Pulse.one_sine(acceleration=3.0, angular_frequency=6.0), friction=0.5)
    assert all(answer.clause and answer.source for answer in answers)
    assert [answer.rule for answer in answers if answer.checked] == ["FEMA P-58, contents"]
    assert len({answer.rule for answer in answers}) == len(answers) == 8


def test_invalid_arguments_are_refused():
    with pytest.raises(ParameterError, match="motion: must be a base motion"):
        rules_of_practice(COLUMN, "el centro")
    with pytest.raises(ParameterError, match="motion: must end"):
        Shaking.of(sb.Harmonic.circular(acceleration=1.0, angular_frequency=3.0))
    with pytest.raises(ParameterError, match="peak_velocity"):
        replace(REST, peak_velocity=-1.0)
    with pytest.raises(ParameterError, match="vertical_factor: must be at least 1"):
        asce_rocking(COLUMN, REST, vertical_factor=0.5)
