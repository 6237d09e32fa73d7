"""Run of a vibratory machine: derivatives, ends, bounds, and the machine on its springs integrated by itself."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import stylobate as sb
from stylobate.errors import ParameterError

SLOW = sb.MachineRun(
    stroke=0.002, frequency=20.0, angle=0.4, direction=0.3, run_up=6.0, steady=1.0, run_down=9.0,
    resonance=5.0, resonance_damping=0.1, start_phase=0.5,
)  # fmt: skip

runs = st.builds(
    sb.MachineRun,
    stroke=st.floats(1e-4, 1e-2),
    frequency=st.floats(5.0, 60.0),
    angle=st.floats(-1.5, 1.5),
    run_up=st.floats(0.2, 3.0),
    steady=st.floats(0.0, 1.0),
    run_down=st.floats(0.2, 3.0),
    resonance=st.sampled_from([0.0, 3.0, 30.0]),
    resonance_damping=st.floats(0.02, 0.9),
    start_phase=st.floats(-3.0, 3.0),
)


@given(motion=runs, share=st.floats(0.0, 1.0))
@settings(max_examples=60)
def test_velocity_and_acceleration_are_derivatives(motion, share):
    step = 2e-3 / max(motion.frequency, motion.resonance)
    time = motion.duration * share
    if any(abs(time - edge) < 4.0 * step for edge in (0.0, *motion.breaks)):
        return
    fastest = motion.highest_frequency
    speed = math.hypot(motion.peak_horizontal(), motion.vertical_range()[1]) / fastest
    for order, function, derivative in (
        (1, motion.displacement, motion.velocity),
        (2, motion.velocity, motion.acceleration),
    ):
        weights = {1: 45.0 / 60.0, 2: -9.0 / 60.0, 3: 1.0 / 60.0}
        found = sum(w * (function(time + k * step) - function(time - k * step)) for k, w in weights.items()) / step
        size = speed * (fastest if order == 2 else 1.0)
        np.testing.assert_allclose(found, derivative(time), rtol=0.0, atol=1e-7 * size)


def test_displacement_and_velocity_are_continuous_and_the_machine_stands_before_and_after():
    for edge in (0.0, *SLOW.breaks[:-1]):
        for function, size in ((SLOW.displacement, 0.002), (SLOW.velocity, 0.25)):
            before, after = function(edge - 1e-9), function(edge + 1e-9)
            np.testing.assert_allclose(before, after, rtol=0.0, atol=1e-5 * size)
    # What is left of the free oscillation at the end.
    left = np.linalg.norm(SLOW.displacement(SLOW.duration - 1e-9 - np.linspace(0.0, 0.2, 101)), axis=1).max()
    assert left < 1.2e-4 * 0.001 * math.exp(0.2 * 0.1 * 2.0 * math.pi * 5.0)
    for time in (-1.0, SLOW.duration, SLOW.duration + 5.0):
        np.testing.assert_array_equal(SLOW.velocity(time), 0.0)
        np.testing.assert_array_equal(SLOW.acceleration(time), 0.0)
        np.testing.assert_allclose(SLOW.displacement(time), 0.0, atol=1e-18)


def test_it_works_as_a_stroke_at_its_frequency_when_the_free_oscillation_has_decayed():
    machine = replace(SLOW, steady=8.0)
    times = np.linspace(13.0, 14.0, 4001)  # 7 s after the run-up: e^{-22} of the free oscillation is left
    along = np.linalg.norm(machine.displacement(times), axis=1)
    assert along.max() == pytest.approx(0.001, rel=1e-4)
    stroke = sb.Harmonic.stroke(stroke=0.002, frequency=20.0, angle=0.4, direction=0.3)
    np.testing.assert_allclose(
        np.abs(machine.acceleration(times)).max(axis=0), np.abs(stroke.acceleration(times)).max(axis=0), rtol=1e-4
    )
    np.testing.assert_allclose(
        machine.acceleration(times[:-201] + 0.05), machine.acceleration(times[:-201]), rtol=0.0, atol=1e-7
    )


@given(motion=runs)
@settings(max_examples=30)
def test_the_bounds_are_not_exceeded_and_hardly_above_the_peak(motion):
    times = np.linspace(0.0, motion.duration, 40_001)
    x, y, z = motion.acceleration(times).T
    largest, (low, high) = np.hypot(x, y).max(), motion.vertical_range()
    assert largest <= motion.peak_horizontal()
    assert low <= z.min()
    assert z.max() <= high
    assert motion.peak_horizontal(motion.duration) == 0.0


@pytest.mark.parametrize(
    "machine",
    [
        SLOW,
        replace(SLOW, run_up=0.5, run_down=0.6, resonance=10.0, resonance_damping=0.05),
        replace(SLOW, resonance=30.0),
    ],
)
def test_it_is_the_machine_on_its_springs_driven_by_its_unbalance(machine):
    """Newton's law of machine and unbalance by time steps, for an eccentricity of 1 m."""
    natural, full = 2.0 * math.pi * machine.resonance, 2.0 * math.pi * machine.frequency
    zeta, (up, works, stops) = machine.resonance_damping, machine.breaks[:3]

    def rate_and_change(t):
        if t < up:
            a = math.pi * t / up
            return 0.5 * full * (1.0 - math.cos(a)), 0.5 * full * math.pi / up * math.sin(a)
        if t < works or t >= stops:
            return full * (t < works), 0.0
        b = math.pi * (t - works) / (stops - works)
        return 0.5 * full * (1.0 + math.cos(b)), -0.5 * full * math.pi / (stops - works) * math.sin(b)

    def push(t, state):
        x, speed, phase = state
        rate, change = rate_and_change(t)
        force = rate**2 * math.cos(phase) + change * math.sin(phase)
        return speed, force - 2.0 * zeta * natural * speed - natural**2 * x, rate

    end = stops + 0.9 * (machine.duration - stops)
    states, times, start = [], [], (0.0, 0.0, machine.start_phase)
    for first, last in ((0.0, up), (up, works), (works, stops), (stops, end))[: 4 if end > stops else 3]:
        span = np.linspace(first, last, 500)
        tight = {"method": "DOP853", "rtol": 1e-9, "atol": 1e-11, "max_step": 0.5 / max(machine.frequency, 1.0)}
        part = solve_ivp(push, (first, last), start, t_eval=span, **tight)
        start = part.y[:, -1]
        states.append(part.y[0])
        times.append(span)
    line = np.array([math.cos(0.4) * math.cos(0.3), math.cos(0.4) * math.sin(0.3), math.sin(0.4)])
    working = abs(full**2 / complex(natural**2 - full**2, 2.0 * zeta * natural * full))
    found = machine.displacement(np.concatenate(times)) @ line
    expected = np.concatenate(states) * 0.001 / working
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-6 * np.abs(expected).max())


def test_the_faster_the_passage_the_smaller_its_peak_and_slowly_it_is_that_of_steady_vibration():
    peaks = []
    for run_up in (1.0, 4.0, 16.0, 64.0, 256.0):
        machine = replace(SLOW, run_up=run_up, steady=0.0, resonance_damping=0.05)
        passage = np.linspace(0.0, run_up, 40_001)
        peaks.append(np.linalg.norm(machine.displacement(passage), axis=1).max())
    assert (np.diff(peaks) > 0.0).all()
    # Steady response at frequency f: the largest over f, relative to that at 20 Hz.
    f = np.linspace(4.0, 6.0, 4001)
    gain = np.abs(f**2 / (25.0 - f**2 + 0.5j * f))
    assert peaks[-1] == pytest.approx(0.001 * gain.max() / abs(400.0 / complex(25.0 - 400.0, 10.0)), rel=0.01)


def test_without_resonance_the_stroke_stays_and_soft_springs_are_its_mirror_image():
    """A free machine moves against its unbalance: its acceleration is that of a crank on the other side."""
    crank, soft = (replace(SLOW, resonance=one) for one in (0.0, 1e-4))
    times = np.linspace(0.5, 15.0, 301)
    size = np.abs(crank.acceleration(times)).max()
    np.testing.assert_allclose(crank.acceleration(times), -soft.acceleration(times), rtol=0.0, atol=1e-4 * size)
    assert np.linalg.norm(crank.displacement(times), axis=1).max() == pytest.approx(0.001, rel=1e-3)


def test_a_part_comes_to_rest_when_the_track_has_stopped():
    pin = sb.Column.solid(radius=0.006, height=0.040, density=7850.0)
    part = sb.Sliding(pin, friction_coefficient=0.2, damping=0.05)
    machine = sb.MachineRun(stroke=0.0006, frequency=50.0, angle=0.436, run_up=0.1, steady=0.2, run_down=0.2)
    run = sb.simulate(part, machine)
    assert run.outcome is sb.Outcome.AT_REST
    assert run.decided_at <= machine.duration + 0.1
    assert run.measures["residual_displacement_x"] > 0.0


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"run_up": 0.0}, "run_up"),
        ({"resonance_damping": 0.0}, "resonance_damping"),
        ({"angle": 25.0}, "angle"),
        ({"steady": 1e6}, "steady"),
    ],
)
def test_impossible_numbers_are_refused_by_name(change, name):
    with pytest.raises(ParameterError, match=name):
        replace(SLOW, **change)
