"""Newmark's sliding block: closed forms, laws of scaling, and the model `Sliding`, which shares no code with it."""

import math

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine import block_slip as module
from stylobate.engine.block_slip import TOLERANCE, block_slip
from stylobate.theory import horizontal_sliding

G = 9.81
COLUMN = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)


def noise(seed, components=3, length=8.0, step=0.02):
    """Return a record of filtered noise that begins and ends at rest."""
    count = round(length / step) + 1
    values = np.random.default_rng(seed).normal(size=(count, components))
    smooth = np.apply_along_axis(lambda one: np.convolve(one, np.hanning(15) / 4.0, mode="same"), 0, values)
    envelope = np.sin(np.linspace(0.0, math.pi, count))[:, np.newaxis] ** 2
    return sb.Record(samples=3.0 * smooth * envelope * ([1.0, 0.7, 0.4][:components]), step=step)


@pytest.mark.parametrize("friction", [0.02, 0.1, 0.29])
def test_a_rectangular_pulse_moves_the_block_by_newmark_s_closed_form(friction):
    acceleration, duration = 3.0, 0.5
    pulse = sb.Record(samples=[acceleration, acceleration], step=duration)
    found = block_slip(pulse, friction_coefficient=friction, gravity=G)
    speed = acceleration * duration
    slip = speed**2 / (2.0 * friction * G) * (1.0 - friction * G / acceleration)
    # on linear accelerations in one direction each step is exact, and so is the stop after the record
    assert found.residual[0] == pytest.approx([-slip, 0.0], rel=1e-12)
    assert found.peak[0] == found.path[0] == pytest.approx(slip, rel=1e-12)
    assert found.duration[0] == pytest.approx(speed / (friction * G), rel=1e-12)


def test_a_pulse_and_its_reverse_leave_the_slip_of_two_parabolas():
    # the base is pushed with a for T and stopped with −a for T; relative to it the block slips back and then forward
    a, length, friction = 3.0, 0.4, 0.2
    forces = sb.Record(samples=np.repeat([a, -a], 20_001), step=length / 20_000)
    found = block_slip(forces, friction_coefficient=friction, gravity=G)
    mu = friction * G
    speed = (a - mu) * length  # at the reversal, backwards relative to the base
    first = 0.5 * speed * length
    stops = speed / (a + mu)  # a and friction stop it
    second = 0.5 * speed * stops
    onward = (a - mu) * (length - stops)  # then it slips forward, until the base is at rest
    back = 0.5 * onward * (length - stops) + 0.5 * onward**2 / mu
    # one sample of the record is the ramp from a to −a
    step = length / 20_000
    assert found.peak[0] == pytest.approx(first + second, abs=5.0 * a * length * step)
    assert found.residual[0, 0] == pytest.approx(-first - second + back, abs=5.0 * a * length * step)


@pytest.mark.parametrize("share", [0.6, 0.75, 0.95])
def test_a_harmonic_base_moves_the_block_by_the_closed_form_of_stick_and_slip(share):
    amplitude, omega = 4.0, 9.0
    friction = share * amplitude / G
    closed = horizontal_sliding(amplitude / G, static_friction=friction)
    samples = 4000
    # a tenth of a period more: the sixth slip ends in it, and the seventh has not begun
    times = np.linspace(0.0, 3.1 * 2.0 * math.pi / omega, round(3.1 * samples) + 1)
    record = sb.Record(samples=amplitude * np.sin(omega * times), step=times[1])
    found = block_slip(record, friction_coefficient=friction, gravity=G)
    stroke = float(closed.stroke) * G / omega**2
    # between samples the sine is (2π/n)²/8 too low.
    tolerance = 6.0 * amplitude / omega**2 * (2.0 * math.pi / samples) ** 2 + 10.0 * TOLERANCE
    assert found.path[0] == pytest.approx(6.0 * stroke, abs=tolerance)
    assert found.peak[0] == pytest.approx(stroke, abs=tolerance)
    assert abs(found.residual[0, 0]) <= tolerance


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("friction", [0.06, 0.2])
def test_it_slips_as_the_model_with_six_degrees_of_freedom_does(seed, friction):
    record = noise(seed)
    found = block_slip(record, friction_coefficient=friction, gravity=COLUMN.gravity)
    run = sb.simulate(sb.Sliding(COLUMN, friction_coefficient=friction), record, duration=record.duration + 3.0)
    places = run.data["footprint"].transpose("axis", "time").to_numpy()
    assert run.measures["peak_tilt"] == 0.0
    assert found.peak[0] > 0.01
    assert found.residual[0] == pytest.approx(places[:, -1], abs=1e-5)
    # the run has its path at samples only
    assert found.peak[0] == pytest.approx(np.hypot(*places).max(), abs=1e-4)
    assert found.path[0] == pytest.approx(run.measures["slip_distance"], abs=1e-4)


def test_the_error_falls_with_the_tolerance():
    record, friction = noise(5), np.linspace(0.03, 0.25, 12)
    exact = block_slip(record, friction_coefficient=friction, gravity=G, tolerance=1e-11)
    errors = []
    for tolerance in (1e-5, 1e-7):
        found = block_slip(record, friction_coefficient=friction, gravity=G, tolerance=tolerance)
        errors.append(np.abs(found.residual - exact.residual).max())
    # per step the error of a velocity is below the tolerance; per time it falls as its power 2/3
    assert errors[1] < errors[0] / 10.0
    assert errors[1] < 1e-5


def test_horizontal_accelerations_and_friction_scale_the_slip():
    record, friction = noise(1), 0.08
    plain = block_slip(record, friction_coefficient=friction, gravity=G, tolerance=1e-9)
    larger = block_slip(record, friction_coefficient=2.5 * friction, horizontal=2.5, gravity=G, tolerance=1e-9)
    assert larger.residual == pytest.approx(2.5 * plain.residual, abs=1e-6)
    assert larger.peak == pytest.approx(2.5 * plain.peak, abs=1e-6)
    assert larger.duration == pytest.approx(plain.duration, abs=1e-3)


def test_time_scales_the_slip_with_its_square():
    record = noise(2)
    slower = sb.Record(samples=record.samples, step=1.5 * record.step)
    fast, slow = (block_slip(one, friction_coefficient=0.1, gravity=G, tolerance=1e-9) for one in (record, slower))
    assert slow.residual == pytest.approx(1.5**2 * fast.residual, abs=1e-6)


def test_rotating_the_record_rotates_the_slip():
    record, angle = noise(3), 0.7
    turned = record.rotated(angle)
    one, other = (
        block_slip(motion, friction_coefficient=0.1, gravity=G, tolerance=1e-9) for motion in (record, turned)
    )
    matrix = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    assert other.residual[0] == pytest.approx(matrix @ one.residual[0], abs=1e-6)
    assert other.peak == pytest.approx(one.peak, abs=1e-6)


def test_it_begins_to_slip_where_the_load_exceeds_the_friction():
    record = noise(4)
    x, y, z = record.samples.T
    friction = 0.15
    scale = friction * G / (np.hypot(x, y) - friction * z).max()
    below, above = (
        block_slip(record, friction_coefficient=friction, horizontal=s, vertical=s, gravity=G)
        for s in (scale * (1.0 - 1e-9), scale * (1.0 + 1e-3))
    )
    assert below.path[0] == below.duration[0] == 0.0
    assert above.path[0] > 0.0


def test_a_base_that_falls_faster_than_g_is_marked():
    record = noise(6)
    scale = -G / record.samples[:, 2].min()
    factors = scale * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    found = block_slip(record, friction_coefficient=0.1, vertical=factors, gravity=G)
    assert found.flies.tolist() == [False, True]


def test_samples_before_the_run_have_no_effect():
    record = noise(7)
    early = sb.Record(samples=record.samples, step=record.step, start=-3.01)
    values = early.acceleration(np.append(0.0, early.times[early.times > 0.0]))
    found = block_slip(early, friction_coefficient=0.1, gravity=G)
    # the same motion, sampled from t = 0 on so finely that the samples of the record are among the times
    fine = sb.Record(samples=early.acceleration(np.arange(0.0, early.end + 1e-9, 0.01)), step=0.01)
    assert len(values) < len(record.samples)
    assert found.residual == pytest.approx(block_slip(fine, friction_coefficient=0.1, gravity=G).residual, abs=1e-5)
    gone = sb.Record(samples=record.samples, step=record.step, start=-100.0)
    assert block_slip(gone, friction_coefficient=0.1, gravity=G).path.tolist() == [0.0]


def test_the_trace_leads_to_the_end_and_knows_the_peak():
    record = noise(1)
    found = block_slip(record, friction_coefficient=[0.05, 0.1], gravity=G, traced=True)
    assert found.trace.shape == (2, len(record.samples), 2)
    assert (found.trace[:, 0] == 0.0).all()
    distance = np.hypot(found.trace[..., 0], found.trace[..., 1]).max(axis=1)
    # between samples it moves by half an acceleration times the square of half a step beyond
    assert distance == pytest.approx(found.peak, abs=10.0 * record.step**2 / 8.0)
    assert found.trace[:, -1] == pytest.approx(found.residual, abs=1e-3)


def test_compiled_code_and_python_agree():
    record = noise(0, length=2.0)
    knots = module._knots(record)
    lanes = np.array([[0.05, 1.0, 1.0], [0.2, 2.0, -1.0]])
    results = []
    for call in (module._compiled(), module._compiled().plain):
        out = np.zeros((2, 6))
        call(knots, lanes, out, np.zeros((0, 2)), G, 1e-6)
        results.append(out)
    assert results[0] == pytest.approx(results[1], rel=1e-12)
