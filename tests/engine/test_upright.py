"""Passages near the upright, where the direction of the lean turns by π in no time."""

import math

import numpy as np
import pytest

import stylobate as sb

C = 0.1


def model(damping=0.0):
    return sb.Slender(sb.Column.dimensionless(C), damping=damping)


def half_swing(tilt, momentum):
    """Return time and angle of the free motion (11), Ä = ℓ²/A³ + A − c and β̇ = ℓ/A², by quadrature.

    With u = Ȧ² = 2(E − cA + A²/2) − ℓ²/A² the time and angle to the inner turning point are integrals of 1/√u and
    ℓ/(A²√u); tanh-sinh nodes take their endpoints, where u vanishes.
    """
    energy = momentum**2 / (2.0 * tilt**2) + C * tilt - 0.5 * tilt**2
    # A²u = A⁴ − 2cA³ + 2E A² − ℓ²: the outer turning point is `tilt`; divide it out and find the inner one.
    roots = np.roots([1.0, -2.0 * C, 2.0 * energy, 0.0, -(momentum**2)])
    inner = min(r.real for r in roots if abs(r.imag) < 1e-9 * abs(r) + 1e-18 and r.real > 0.0)
    others = [r for r in roots if r.real < 0.0 or r.real > tilt * (1.0 + 1e-9)]
    s = np.linspace(-3.6, 3.6, 4001)
    near = 1.0 / (1.0 + np.exp(-math.pi * np.sinh(s)))  # from 0 at the inner point to 1 at the outer one
    far = 1.0 / (1.0 + np.exp(math.pi * np.sinh(s)))
    weight = math.pi * np.cosh(s) * near * far * (s[1] - s[0])
    reach = tilt - inner
    a = inner + reach * near
    rest = np.ones_like(a)
    for root in others:
        rest = rest * np.abs(a - root)
    speed = reach * np.sqrt(near * far * rest) / a
    return float(np.sum(weight * reach / speed)), float(np.sum(weight * reach * momentum / a**2 / speed))


@pytest.mark.parametrize("momentum", [0.1, 1e-2, 1e-4, -1e-4])
def test_free_motion_takes_the_time_and_angle_of_its_quadratures(momentum):
    # Angular momentum in units of c²; from one outer turning point to the next.
    tilt, ell = 0.5 * C, momentum * C**2
    half, angle = half_swing(tilt, ell)
    run = sb.simulate(model(), tilt=(tilt, 0.0), tilt_rate=(0.0, ell / tilt), duration=2.0 * half, rtol=1e-12)
    assert float(run.data.amplitude[-1]) == pytest.approx(tilt, rel=1e-8)
    assert float(run.data.amplitude_rate[-1]) == pytest.approx(0.0, abs=1e-8 * C)
    assert float(run.data.azimuth[-1] - run.data.azimuth[0]) == pytest.approx(2.0 * angle, abs=1e-6)


@pytest.mark.parametrize("exponent", [-3, -6, -7, -9, -10, -12, -14])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_the_azimuth_turns_by_half_a_turn_at_each_passage_in_the_sense_of_the_momentum(exponent, sense):
    # In the limit ℓ → 0; the offset b differs from it by terms b ln b.
    offset = 10.0**exponent
    tilt = 0.5 * C
    speed = math.sqrt(2.0 * (C * tilt - 0.5 * tilt**2))
    swing = 2.0 * math.acosh(2.0)
    run = sb.simulate(
        model(), tilt=(tilt, 0.0), tilt_rate=(0.0, sense * offset * C * speed / tilt), duration=3.0 * swing, rtol=1e-12
    )
    turned = float(run.data.azimuth[-1] - run.data.azimuth[0])
    assert turned == pytest.approx(sense * 3.0 * math.pi, abs=100.0 * offset * abs(math.log(offset)) + 1e-4)
    assert run.measures["turns"] == pytest.approx(turned / (2.0 * math.pi), rel=1e-9)
    momentum = run.data.angular_momentum.to_numpy()
    # A difference of two products of tilt and speed, each rounded.
    np.testing.assert_allclose(momentum, momentum[0], rtol=5e-3, atol=8.0 * np.finfo(float).eps * tilt * speed)
    assert run.measures["least_passage"] == pytest.approx(offset * C, rel=1e-2)
    assert run.uncertain == (offset < 1e-8)


@pytest.mark.parametrize("offset", [1e-10, 1e-11, 1e-12, 1e-13])
@pytest.mark.parametrize("friction", [0.0, 0.1])
def test_the_hop_over_the_upright_agrees_with_resolved_integration(offset, friction, integrate_equations_1):
    speed, ahead = 0.8 * C, 0.5e-6 * C
    state = (-ahead, offset * C, speed, 0.0)
    acceleration = (0.02, -0.03, 0.1)
    chosen = model(friction)
    elapsed, end = chosen.passage(*state, *acceleration, *chosen.parameters)
    # The turn takes b/v: steps of the reference fall to a thousandth of that by its own error control.
    reference = integrate_equations_1(
        state, (0.0, elapsed), c=C, eta=friction, acceleration=lambda _: acceleration, rtol=1e-13, atol=1e-25
    ).y[:, -1]
    change = reference[2:] - state[2:]
    assert elapsed == pytest.approx(2.0 * ahead / speed, rel=1e-12)
    # The path is straight to (c b/v²) ln(l/b), some 1e-9 of the offset's own kick; forces are constant to 1e-6.
    np.testing.assert_allclose(np.array(end[2:]) - state[2:], change, rtol=2e-4, atol=1e-5 * abs(change).max())
    np.testing.assert_allclose(end[0], reference[0], rtol=1e-5)
    moved = abs(reference[1] - state[1])
    assert end[1] - state[1] == pytest.approx(reference[1] - state[1], abs=0.5 * moved)
    np.testing.assert_allclose(end[1], reference[1], rtol=0.0, atol=1e-3 * ahead)


@pytest.mark.parametrize("offset", [1e-6, 1e-8, 3e-10, 1e-11, 1e-13])
def test_a_forced_passage_agrees_with_resolved_integration(offset, integrate_equations_1):
    motion = sb.Harmonic.straight(acceleration=0.06, angular_frequency=2.0, start_phase=0.4)
    start = (0.02, offset * C, -0.03, 0.0)
    run = sb.simulate(model(0.1), motion, tilt=start[:2], tilt_rate=start[2:], duration=0.9, rtol=1e-12)
    reference = integrate_equations_1(
        start, (0.0, 0.9), c=C, eta=0.1, acceleration=motion.acceleration, rtol=1e-13, atol=1e-22
    ).y[:, -1]
    assert not run.planar
    assert reference[0] < 0.0
    found = np.concatenate([run.data.tilt.to_numpy()[-1], run.data.tilt_rate.to_numpy()[-1]])
    np.testing.assert_allclose(found, reference, rtol=0.0, atol=1e-9 * C)
    # Across the plane to a thousandth of its own size: the kick is linear in the offset, apart from ln(offset).
    across = np.abs(reference[[1, 3]]).max()
    np.testing.assert_allclose(found[[1, 3]], reference[[1, 3]], rtol=0.0, atol=1e-3 * across + 1e-11 * C)


@pytest.mark.parametrize("rtol", [1e-2, 1e-4, 1e-8])
@pytest.mark.parametrize("rate", [1.0, 5.0, -5.0])
def test_free_rolling_turns_at_its_own_rate(rate, rtol):
    amplitude = C / (1.0 + rate**2)  # (5)
    duration = 40.0 / abs(rate)
    run = sb.simulate(model(), tilt=(0.0, amplitude), tilt_rate=(-amplitude * rate, 0.0), duration=duration, rtol=rtol)
    # With coarse tolerance the rate is off a little; a turn gained or lost would be at least 1.
    assert run.measures["turns"] == pytest.approx(rate * duration / (2.0 * math.pi), abs=min(0.3, 1e3 * rtol))


def test_a_motion_from_the_upright_begins_along_its_speed(integrate_equations_1):
    motion = sb.Harmonic.circular(acceleration=0.05, angular_frequency=2.0)
    run = sb.simulate(model(), motion, tilt_rate=(0.03, 0.04), duration=1.0, rtol=1e-11)
    early = run.sample(1e-4)
    np.testing.assert_allclose(early.tilt[0], [3e-6, 4e-6], rtol=2e-3)
    start = (3e-9 * 1e-3, 4e-9 * 1e-3, 0.03, 0.04)
    reference = integrate_equations_1(start, (0.0, 1.0), c=C, acceleration=motion.acceleration).y[:, -1]
    np.testing.assert_allclose(run.data.tilt[-1], reference[:2], rtol=0.0, atol=1e-8 * C)


def test_a_close_passage_is_uncertain_out_of_a_plane_and_certain_within_one():
    across = sb.simulate(model(), tilt=(0.05, 0.0), tilt_rate=(0.0, 1e-14), duration=5.0)
    within = sb.simulate(model(), tilt=(0.05, 0.0), tilt_rate=(-1e-14, 0.0), duration=5.0)
    assert across.uncertain
    assert not across.planar
    assert within.planar
    assert not within.uncertain


def test_a_passage_at_the_very_end_of_a_run_ends_it():
    model = sb.SlenderRolling(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
    start = {"tilt": (0.03, 0.0), "tilt_rate": (-0.001, 0.0)}
    passage = next(event for event in sb.simulate(model, duration=30.0, **start).events if event.kind == "passage")
    run = sb.simulate(model, duration=passage.time, **start)
    assert run.outcome is sb.Outcome.STILL_MOVING
    assert float(run.data["time"][-1]) == passage.time
    assert float(run.data["amplitude"][-1]) == pytest.approx(0.0, abs=1e-10)
