"""Tables of base motions in the language of the compiler: those of NumPy, and the integrals of the motions."""

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions import Harmonic, Pulse, SineSweep
from stylobate.engine.ensembles.polynomials import tabulated
from stylobate.engine.kernel.columns import Piece
from stylobate.engine.standalone import tables
from stylobate.engine.standalone.bases import AXES, COURSE, Polynomials, Table
from stylobate.engine.standalone.programs import Shaking

BOUNDS = slice(Piece.LARGEST_HORIZONTAL, Piece.MAXIMUM_VERTICAL + 1)


def pulse(motion):
    return motion, (motion.start, motion.duration), tables.steady_of_pulse(motion)


def sweep(motion):
    return motion, (motion.start, motion.duration), tables.steady_of_sweep(motion)


def wave(motion):
    return motion, (motion.ramp,), tables.steady_of_wave(motion)


SMOOTH = {
    "one_sine": pulse(Pulse.one_sine(acceleration=2.0, angular_frequency=5.0, direction=0.3, start=0.2, vertical=0.4)),
    "ricker": pulse(Pulse.ricker(acceleration=2.0, angular_frequency=5.0, direction=1.0)),
    "antisymmetric_ricker": pulse(Pulse.antisymmetric_ricker(acceleration=2.0, angular_frequency=9.0)),
    "gabor": pulse(Pulse.gabor(velocity=0.4, frequency=2.0, oscillations=3.0, phase=0.3)),
    "near-fault": pulse(Pulse.mavroeidis_papageorgiou(velocity=0.4, frequency=2.0, oscillations=3.0)),
    "type_c": pulse(Pulse.type_c(velocity=0.4, angular_frequency=7.0, cycles=2)),
    "linear sweep": sweep(SineSweep.linear(acceleration=1.0, frequencies=(1.0, 5.0), length=3.0, start_phase=0.4)),
    "logarithmic sweep": sweep(SineSweep.logarithmic(displacement=0.02, frequencies=(4.0, 1.0), length=3.0, start=0.3)),
    "ramp": wave(Harmonic.circular(acceleration=0.8, angular_frequency=6.0, start_phase=0.5, ramp=1.5)),
}


def smooth(motion, breaks, steady, end):
    rows, out = np.zeros((200, Shaking.SMOOTH.piece)), np.zeros(len(Table._fields))
    count = tables.smooth_table(motion, breaks, steady, end, rows, out)
    return rows[:count], Table(*out)


def worst_of_course(motion, base, times):
    """Return the largest errors of displacement and acceleration."""
    course, place, acceleration = np.zeros(COURSE), np.zeros(AXES), np.zeros(AXES)
    base.begin(course)
    worst = np.zeros(2)
    for time in times:
        base.set_sample(time, course, place, acceleration)
        apart = np.abs(place - motion.displacement(time)).max(), np.abs(acceleration - motion.acceleration(time)).max()
        worst = np.maximum(worst, apart)
    return worst


def values(rows):
    """Return the accelerations of polynomials at some points of each."""
    coefficients = rows[:, len(Piece) :].reshape(len(rows), AXES, -1)
    return coefficients @ np.linspace(-1.0, 1.0, 9) ** np.arange(coefficients.shape[-1])[:, np.newaxis]


@pytest.mark.parametrize("name", SMOOTH)
def test_polynomials_are_those_of_numpy(name):
    motion, breaks, steady = SMOOTH[name]
    rows, found = smooth(motion, breaks, steady, 6.0)
    known = tabulated(motion, 6.0).rows
    size = motion.peak_horizontal(0.0)
    assert rows.shape == known.shape
    np.testing.assert_allclose(values(rows), values(known), atol=2e-11 * size)
    np.testing.assert_allclose(rows[:, : Piece.LARGEST_HORIZONTAL], known[:, : Piece.LARGEST_HORIZONTAL], rtol=1e-13)
    np.testing.assert_array_equal(rows[:, Piece.CONTINUED], known[:, Piece.CONTINUED])
    own = np.maximum(np.hypot(*motion.directions()[0]), size)  # bounds of motions may lie above their peaks
    assert found.largest <= own * (1.0 + 1e-9)
    assert (found.lasts, found.highest_frequency) == (motion.duration, motion.highest_frequency)


@pytest.mark.parametrize("name", ["one_sine", "ricker", "antisymmetric_ricker", "gabor", "near-fault", "type_c"])
def test_bounds_of_pulses_are_their_peaks_from_each_piece_on(name):
    motion, breaks, steady = SMOOTH[name]
    rows, found = smooth(motion, breaks, steady, 6.0)
    known = tabulated(motion, 6.0).rows
    np.testing.assert_allclose(rows[:, BOUNDS], known[:, BOUNDS], atol=3e-8 * motion.peak_horizontal(0.0))
    line = np.array([found.first_x, found.first_y])
    assert np.hypot(*line) == pytest.approx(found.largest, rel=1e-2)
    assert (found.other_x, found.other_y) == (0.0, 0.0)


@pytest.mark.parametrize("name", SMOOTH)
def test_the_base_moves_as_the_motion_does(name):
    motion, breaks, steady = SMOOTH[name]
    rows, found = smooth(motion, breaks, steady, 5.0)
    size = motion.peak_horizontal(0.0)
    place, acceleration = worst_of_course(motion, Polynomials(found, rows), np.linspace(0.0, 5.0, 61)[:-1])
    assert place < 1e-12 * size
    assert acceleration < 2e-11 * size


def test_a_motion_with_a_hidden_jump_is_not_tabulated():
    class Jumping:
        duration, period, highest_frequency, mean_frequency, degree = 3.0, None, 2.0, 2.0, None

        def derivative(self, time, _order):
            return (1.0 if time > 1.234 else 0.0), 0.0, 0.0

    rows, out = np.zeros((200, Shaking.SMOOTH.piece)), np.zeros(len(Table._fields))
    assert tables.smooth_table(Jumping(), (3.0,), (0.0,) * 7, 3.0, rows, out) == -1


@pytest.mark.parametrize(("scale", "rotation"), [(1.0, 0.0), (-0.7, 0.4)])
def test_the_table_of_a_record_is_that_of_numpy(scale, rotation):
    record = sb.sample_record().trimmed(end=9.0)
    rows, out = np.zeros((len(record.samples) + 1, Shaking.LINEAR.piece)), np.zeros(len(Table._fields))
    count = tables.record_table(record.samples.copy(), record.step, scale, rotation, rows, out)
    changed = record.scaled(scale).rotated(rotation)
    known = tabulated(changed, 9.0).rows
    size = changed.peak_horizontal(0.0)
    assert count == len(known)
    np.testing.assert_allclose(rows[:count], known, rtol=1e-12, atol=1e-12 * size)
    found = Table(*out)
    assert found.mean_frequency == pytest.approx(changed.mean_frequency, rel=1e-12)
    assert (found.lasts, found.highest_frequency) == (changed.duration, changed.highest_frequency)
    vectors = (found.first_x, found.first_y), (found.other_x, found.other_y)
    np.testing.assert_allclose(vectors, changed.directions(), rtol=1e-12)
    place, acceleration = worst_of_course(changed, Polynomials(found, rows[:count]), np.linspace(0.0, 9.5, 71))
    assert place < 1e-12 * size
    assert acceleration < 1e-11 * size


def test_a_record_along_a_line_has_one_direction_and_pieces_between_bends():
    samples = np.zeros((7, 3))
    samples[1:6, 0] = (1.0, 2.0, 3.0, 1.0, 1.0)
    rows, out = np.zeros((8, Shaking.LINEAR.piece)), np.zeros(len(Table._fields))
    count = tables.record_table(samples, 0.5, 1.0, 0.0, rows, out)
    found = Table(*out)
    assert rows[:count, Piece.START].tolist() == [0.0, 1.5, 2.0, 2.5, 3.0]
    assert (found.first_x, found.first_y, found.other_x, found.other_y) == (3.0, 0.0, 0.0, 0.0)
