"""Steps are rejected if they miss the tolerance; a step towards the vertical is shortened before it would fail."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

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


# One attempt shortens a step to a thousandth at least: the last three are too long.
@pytest.mark.parametrize(("h", "accepted"), [(0.3, 1.0), (0.4, 1.0), (600.0, 0.0), (800.0, 0.0), (1000.0, 0.0)])
def test_a_step_by_series_knows_its_error_and_is_rejected_if_it_misses_the_tolerance(h, accepted, plan_of):
    model, rtol, atol = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1), 1e-8, 1e-12
    shape = plan_of(model, CIRCLE, method="taylor").shape(planar=False)
    kernel, rows = kernel_of(sb.Slender, shape), shape.rows()
    buffer = np.zeros_like(kernel.buffer())  # the base is at rest
    given = {"h": h, "rtol": rtol, "atol_now": atol, "tilt_limit": 9.0, "no_return": 9.0}
    for name, value in (given | {f"p{j}": number for j, number in enumerate(model.parameters)}).items():
        buffer[rows[name], 0] = value
    start = np.array([0.03, 0.01, -0.02, 0.04])
    buffer[rows["y0"] : rows["y0"] + 4, 0] = start
    kernel.compiled.module.make_series_step(buffer, 1)
    kernel.compiled.module.accept(buffer, 0)
    found, made = buffer[rows["new0"] : rows["new0"] + 4, 0], buffer[rows["h"], 0]
    exact = solve_ivp(
        lambda _, y: model.rates(*y, 0.0, 0.0, 0.0, *model.parameters), (0.0, made), start, "DOP853",
        rtol=1e-13, atol=1e-16,
    ).y[:, -1]  # fmt: skip
    error = np.sum(np.abs(found - exact) / (atol + rtol * np.maximum(np.abs(start), np.abs(found))))
    # The estimate takes the defect as a power of the time, and leaves out the positions, whose error is h/18 of it.
    assert buffer[rows["error"], 0] == pytest.approx(error, rel=0.2)
    assert (buffer[rows["ok"], 0], buffer[rows["go"], 0]) == (accepted, accepted)
