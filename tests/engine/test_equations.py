"""The engine against published numbers and against equations (1) integrated on their own."""

import math

import numpy as np
import pytest

import stylobate as sb

C = 0.1


def model(damping=0.0, c=C):
    return sb.Slender(sb.Column.dimensionless(c), damping=damping)


def final_state(run):
    return np.concatenate([run.data.tilt.to_numpy()[-1], run.data.tilt_rate.to_numpy()[-1]])


@pytest.mark.parametrize("c", [1e-3, 0.1])
def test_forced_motion_reaches_the_published_state(c):
    # Physics page, "Numbers to test against", in units of c: the equations without friction scale with c.
    straight = sb.Harmonic(amplitude=(0.9 * c, 0.7 * c, 0.0), phase=(0.0, 0.9, 0.0), angular_frequency=1.7)
    run = sb.simulate(
        model(c=c), straight, tilt=(0.5 * c, 0.2 * c), tilt_rate=(0.1 * c, 0.35 * c), duration=3.0, rtol=1e-12
    )
    published = [0.033153473664, 0.6700240983541, 0.507152125059, -0.2563540126826]
    np.testing.assert_allclose(final_state(run) / c, published, rtol=0.0, atol=1e-9)


MOTIONS = {
    "circular": sb.Harmonic.circular(acceleration=0.08, angular_frequency=2.3, start_phase=0.7),
    "clockwise": sb.Harmonic.circular(acceleration=0.05, angular_frequency=2.3, sense=-1),
    "elliptic": sb.Harmonic.elliptic(amplitude=(0.09, 0.03), phase=0.4, angular_frequency=3.1),
    "ramped": sb.Harmonic.circular(acceleration=0.08, angular_frequency=2.3, ramp=4.0),
    "with vertical": sb.Harmonic.circular(acceleration=0.05, angular_frequency=2.0)
    + sb.Harmonic.vertical(acceleration=0.4, angular_frequency=3.0, start_phase=0.3),
    "delayed": sb.Harmonic.circular(acceleration=0.05, angular_frequency=2.0).delayed(2.5).rotated(0.4),
    "mixed": sb.Harmonic.straight(acceleration=0.05, angular_frequency=2.0)
    + sb.Harmonic.straight(acceleration=0.03, angular_frequency=math.sqrt(3.0), direction=1.0),
}


@pytest.mark.parametrize("damping", [0.0, 0.1, 1.0])
@pytest.mark.parametrize("name", MOTIONS)
def test_engine_solves_equations_1(name, damping, integrate_equations_1):
    motion = MOTIONS[name]
    tilt, rate, duration = (0.04, 0.01), (-0.005, 0.05), 8.0
    run = sb.simulate(model(damping), motion, tilt=tilt, tilt_rate=rate, duration=duration, rtol=1e-11)

    def acceleration(tau):
        return motion.acceleration(tau)

    end = float(run.data.time[-1])
    reference = integrate_equations_1(
        (*tilt, *rate), (0.0, end), c=C, eta=damping, acceleration=acceleration, max_step=0.05
    )
    assert end > 3.0
    assert not run.planar
    # Global error: about the local tolerance times the number of steps (some 100) and a growth of e² between.
    np.testing.assert_allclose(run.data.tilt.to_numpy(), reference.sol(run.data.time).T[:, :2], rtol=0.0, atol=1e-8 * C)
    np.testing.assert_allclose(
        run.data.tilt_rate.to_numpy(), reference.sol(run.data.time).T[:, 2:], rtol=0.0, atol=1e-8 * C
    )


def test_global_error_falls_with_the_tolerance(integrate_equations_1):
    motion = MOTIONS["circular"]
    start = (0.04, 0.01, -0.005, 0.05)
    reference = integrate_equations_1(start, (0.0, 8.0), c=C, eta=0.1, acceleration=motion.acceleration)
    errors = []
    for rtol in (1e-4, 1e-6, 1e-8, 1e-10):
        run = sb.simulate(model(0.1), motion, tilt=start[:2], tilt_rate=start[2:], duration=8.0, rtol=rtol)
        errors.append(np.abs(final_state(run) - reference.y[:, -1]).max() / C)
    ratios = np.array(errors[:-1]) / errors[1:]
    assert np.all(ratios > 10.0)  # a hundredth of the tolerance, at least a tenth of the error
    assert errors[-1] < 1e-8


def test_long_run_does_not_depend_on_the_number_of_samples():
    few, many = (
        sb.simulate(model(0.1), MOTIONS["circular"], tilt=(0.04, 0.01), duration=30.0, samples=n) for n in (2, 2001)
    )
    np.testing.assert_array_equal(final_state(few), final_state(many))
    assert few.data.sizes["time"] == 2
    assert many.data.sizes["time"] == 2001
