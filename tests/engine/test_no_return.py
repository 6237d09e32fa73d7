"""What is called overturned never comes back."""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import stylobate as sb

C = 0.1


def numbers(low, high):
    # In steps of a thousandth: nothing is learnt from amplitudes of 1e-200.
    return st.integers(round(1000 * low), round(1000 * high)).map(lambda n: n / 1000.0)


phases = numbers(0.0, 6.0)
frequencies = numbers(0.2, 8.0)


def model(damping=0.0):
    return sb.Slender(sb.Column.dimensionless(C), damping=damping)


@st.composite
def elliptic(draw):
    return sb.Harmonic.elliptic(
        amplitude=(draw(numbers(0.0, 3.0 * C)), draw(numbers(0.0, 3.0 * C))),
        phase=draw(phases),
        angular_frequency=draw(frequencies),
        start_phase=draw(phases),
        ramp=draw(st.sampled_from([0.0, 0.0, 2.0, 8.0])),
    )


@st.composite
def motions(draw):
    # One of the parts may be nothing: all of these need the same kernel.
    motion = draw(elliptic()) + draw(elliptic()).delayed(draw(numbers(-3.0, 6.0))).scaled(
        draw(st.sampled_from([0.0, 1.0]))
    )
    motion = motion + sb.Harmonic.vertical(
        acceleration=draw(st.sampled_from([1e-9, 1.0])) * draw(numbers(0.001, 0.8)),
        angular_frequency=draw(frequencies),
        start_phase=draw(phases),
    )
    if draw(st.booleans()):
        motion = motion.delayed(draw(numbers(-3.0, 5.0))).scaled(draw(numbers(-1.5, 1.5)), vertical=1.0)
    return motion


def no_return_tilt(motion, since):
    """Return c + sup|a_h|/(1 + inf a_z) with bounds from samples of the motion: never above the true one."""
    late = motion.acceleration(since + np.linspace(0.0, 200.0, 20_001))
    return C + np.hypot(late[:, 0], late[:, 1]).max() / (1.0 + late[:, 2].min())


@pytest.mark.slow
@settings(max_examples=30)
@given(
    motion=motions(),
    tilt=numbers(0.1, 2.0),
    rate=st.tuples(numbers(-1.5, 1.5), numbers(-1.5, 1.5)),
    damping=st.sampled_from([0.0, 0.1, 0.5, 2.0]),
)
def test_what_is_overturned_goes_on_growing(motion, tilt, rate, damping, integrate_equations_1):
    run = sb.simulate(
        model(damping), motion, tilt=(tilt * C, 0.0), tilt_rate=np.array(rate) * C, duration=15.0, max_steps=2000
    )
    assume(run.outcome is sb.Outcome.OVERTURNED)
    end = run.data.isel(time=-1)
    when = float(end.time)
    assert when == pytest.approx(run.decided_at)
    # The criterion holds, to the tolerance of the bounds and of the root.
    assert float(end.amplitude) >= no_return_tilt(motion, when) * (1.0 - 1e-9) - 1e-12
    assert float(end.amplitude_rate) >= -1e-12
    state = np.concatenate([end.tilt.to_numpy(), end.tilt_rate.to_numpy()])
    later = integrate_equations_1(
        state,
        (when, when + 15.0),
        c=C,
        eta=damping,
        acceleration=motion.acceleration,
        rtol=1e-9,
        atol=1e-12,
        max_step=0.3,
    )
    amplitude = np.hypot(*later.sol(np.linspace(when, when + 15.0, 3001))[:2])
    # The state at the event is known to some 1e-8: at the very edge the tilt may stand still that long.
    assert np.diff(amplitude).min() > -1e-8 * amplitude[0]
    assert amplitude[-1] > amplitude[0]


@pytest.mark.parametrize("above", [1e-6, -1e-6])
def test_the_criterion_is_sharp_for_a_steady_push(above):
    # Held by a push of a0 towards the upright (so slow a motion that it is constant here), a column leaning c + a0
    # is in balance: just above it goes over, just below it comes back.
    a0 = 0.03
    motion = sb.Harmonic.straight(acceleration=a0, angular_frequency=1e-6)
    run = sb.simulate(model(), motion, tilt=(C + a0 + above * C, 0.0), duration=14.0)
    assert (run.outcome is sb.Outcome.OVERTURNED) == (above > 0.0)
    if above < 0.0:
        assert float(run.data.amplitude[-1]) < C


@pytest.mark.parametrize("heading", [0.5, 2.0, 3.1])
def test_a_column_thrown_inward_from_beyond_the_limit_is_not_overturned_at_once(heading):
    rate = 0.3 * np.array([math.cos(heading), math.sin(heading)])
    run = sb.simulate(model(), tilt=(1.2 * C, 0.0), tilt_rate=rate, duration=10.0)
    first_growth = run.data.amplitude_rate[0] >= 0.0
    assert (run.decided_at < 1e-9) == bool(first_growth)


def test_a_start_beyond_return_is_overturned_from_the_start():
    run = sb.simulate(model(), tilt=(0.12, 0.0), tilt_rate=(0.01, 0.0), duration=10.0)
    assert run.outcome is sb.Outcome.OVERTURNED
    assert run.decided_at == pytest.approx(0.0, abs=1e-12)
    assert run.events == (sb.Event("overturned", pytest.approx(0.0, abs=1e-12)),)


def test_a_motion_that_is_over_no_longer_counts():
    # A base motion to come keeps the question open; with its onset skipped by a negative delay it is the same motion.
    motion = sb.Harmonic.straight(acceleration=0.5, angular_frequency=2.0)
    assert sb.simulate(model(), motion.delayed(50.0), tilt=(0.11, 0.0), duration=1.0).outcome is sb.Outcome.STILL_MOVING
    assert sb.simulate(model(), None, tilt=(0.11, 0.0), duration=1.0).outcome is sb.Outcome.OVERTURNED


def test_with_a_weightless_base_nothing_is_proved_and_the_stated_limit_decides():
    motion = sb.Harmonic.vertical(acceleration=1.0, angular_frequency=2.0, start_phase=1.0)
    assert model().least_safe_tilt(0.0, -1.0) == math.inf
    run = sb.simulate(model(), motion.scaled(1.0, vertical=1.0), tilt=(0.12, 0.0), tilt_rate=(0.0, 0.1), duration=1.0)
    assert run.outcome is sb.Outcome.STILL_MOVING
