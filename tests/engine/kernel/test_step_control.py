"""The next step towards the vertical: it is shortened before it would fail."""

import pytest

import stylobate as sb
from stylobate.engine.kernel.kernels import kernel_of

CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)


@pytest.mark.parametrize(
    ("tilts", "speeds", "radial", "accepted", "factor"),
    [
        ((0.04, 0.02), (0.1, 0.1), -1.0, 1.0, 0.5),  # halfway to the vertical
        ((0.04, 0.04), (0.1, 0.2), -1.0, 1.0, 0.5),  # twice as fast
        ((0.04, 0.0), (0.1, 0.1), -1.0, 1.0, 0.2),  # not below the bound of the step ratio
        ((0.02, 0.04), (0.1, 0.1), -1.0, 1.0, 1.0),  # never longer
        ((0.04, 0.02), (0.1, 0.1), 1.0, 1.0, 1.0),  # outwards
        ((0.04, 0.02), (0.1, 0.1), -1.0, 0.0, 1.0),  # a rejected step has not come nearer
    ],
)
def test_a_step_towards_the_vertical_keeps_its_part_of_tilt_over_speed(
    tilts, speeds, radial, accepted, factor, plan_of
):
    shape = plan_of(sb.Slender(sb.Column.dimensionless(0.1)), CIRCLE).shape(planar=False)
    kernel, rows = kernel_of(sb.Slender, shape), shape.rows()
    buffer = kernel.buffer()
    given = {"tilt": tilts[0], "new_tilt": tilts[1], "vx": speeds[0], "vy": 0.0, "new_vx": 0.0, "new_vy": speeds[1]}
    for name, value in (given | {"new_radial": radial, "go": accepted}).items():
        buffer[rows[name], 0] = value
    assert kernel.compiled.module.approach(buffer, 0) == pytest.approx(factor, rel=1e-14)


def test_the_next_step_is_that_which_the_error_allows_times_this_factor(plan_of):
    shape = plan_of(sb.Slender(sb.Column.dimensionless(0.1)), CIRCLE).shape(planar=False)
    kernel, rows = kernel_of(sb.Slender, shape), shape.rows()

    def wanted(nearer):
        buffer = kernel.buffer()
        given = {"h": 0.1, "time": 2.0, "go": 1.0, "ok": 1.0, "stop": 9.0, "error": 0.5, "rejected": 0.0, "aimed": 0.0}
        for name, value in (given | {"longest_step": 1.0, "steps": 3.0}).items():
            buffer[rows[name], 0] = value
        kernel.compiled.module.choose_next_step(buffer, 0, nearer)
        assert buffer[rows["h"], 0] == buffer[rows["wanted"], 0]
        return buffer[rows["wanted"], 0]

    assert wanted(1.0) == pytest.approx(0.1 * 0.9 * 0.5**-0.125, rel=1e-14)
    assert wanted(0.4) == pytest.approx(0.4 * wanted(1.0), rel=1e-14)
