"""Steps of compiled kernels have the bits of their plain-Python twins, where no arithmetic is fast."""

import ctypes

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine.compiler import machine
from stylobate.engine.compiler.unit import ArrayArgument
from stylobate.engine.lanes.kernels import kernel_of

COLUMN = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
CIRCLE = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.2)
VERTICAL = sb.Harmonic(amplitude=(0.6, 0.6, 0.2), phase=(0.0, 1.0, 2.0), angular_frequency=3.0)

CASES = {
    "slender": (sb.Slender(COLUMN, damping=0.1), CIRCLE, {}),
    "slender in a plane": (sb.Slender(COLUMN, damping=0.1), CIRCLE, {}),
    "slender, sum of waves": (sb.Slender(COLUMN), CIRCLE + VERTICAL.rotated(0.4), {}),
    "slender, record": (sb.Slender(COLUMN), sb.sample_record(), {}),
    "slender, by series": (sb.Slender(COLUMN, damping=0.1), CIRCLE, {"method": "taylor"}),
    "slender rolling": (sb.SlenderRolling(COLUMN, damping=0.1), VERTICAL, {}),
    "wobbling": (sb.Wobbling(COLUMN, damping=0.1), CIRCLE, {"demands": True}),
    "rolling": (sb.Rolling(COLUMN, damping=0.1), VERTICAL, {"demands": True}),
    "sliding": (sb.Sliding(COLUMN, 0.4), VERTICAL, {}),
}


@pytest.mark.parametrize("case", CASES)
def test_steps_have_the_bits_of_plain_python(case, plan_of):
    model, motion, options = CASES[case]
    plan = plan_of(model, motion, **options)
    kernel = kernel_of(type(model), plan.shape(planar=case.endswith("plane")))
    rows, width = kernel.shape.rows(), kernel.shape.width
    unit = kernel.compiled.unit(exact=True)
    unit.export(kernel.compiled.module.step, "step", [ArrayArgument((len(rows) * width,))])
    engine = machine.linked(machine.object_code(unit.module.text(machine.attributes())))
    compiled = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_void_p)(engine.get_function_address("step"))

    buf = np.random.default_rng(8).normal(scale=0.05, size=(len(rows), width))
    for name in ("h", "rtol", "atol", "atol_now", "longest_step", "stop"):
        buf[rows[name]] = np.abs(buf[rows[name]])
    for j, number in enumerate(model.parameters):
        buf[rows[f"p{j}"]] = number
    one, other = buf.ravel().copy(), buf.ravel().copy()
    compiled(one.ctypes.data)
    with np.errstate(all="ignore"):
        kernel.compiled.module.step(other)
    assert np.isfinite(other).mean() > 0.9
    changed = (other != buf.ravel()).reshape(len(rows), width).any(axis=1)
    assert changed.sum() > 40
    np.testing.assert_array_equal(one.reshape(len(rows), width), other.reshape(len(rows), width))
