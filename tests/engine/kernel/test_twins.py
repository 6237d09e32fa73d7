"""Steps of compiled kernels have the bits of their plain-Python twins, where no arithmetic is fast."""

import ctypes
import itertools
from dataclasses import replace

import numpy as np
import pytest

import stylobate as sb
from stylobate.compiler import machine
from stylobate.compiler.unit import ArrayArgument
from stylobate.compiler.values import NumberKind
from stylobate.engine.ensembles.batch import Batch
from stylobate.engine.ensembles.runs import broadcast
from stylobate.engine.kernel.columns import TRACE_TERMS, Trace
from stylobate.engine.kernel.kernels import kernel_of

COLUMN = sb.Column.solid(radius=0.5, height=3.0, density=2700.0)
CIRCLE = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.2)
STRAIGHT = sb.Harmonic.straight(acceleration=0.6, angular_frequency=2.2)
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
    "planar rocking, in a plane": (sb.PlanarRocking(COLUMN), STRAIGHT, {}),
}


# What the compiler meets in these it meets in other cases too.
LIKE_OTHERS = {"slender", "slender rolling", "wobbling"}


def without_fast_arithmetic(compiled, name, arguments, kinds):
    """Return a compiled function that takes values of these kinds."""
    unit = compiled.unit(exact=True)
    unit.export(getattr(compiled.module, name), name, arguments)
    engine = machine.linked(machine.native().object_code(unit.module.text(machine.native().attributes)))
    function = ctypes.CFUNCTYPE(ctypes.c_int64, *kinds)(engine.get_function_address(name))
    vars(function)["engine"] = engine  # keeps the code alive
    return function


@pytest.mark.parametrize(
    ("case", "draws"),
    [
        *(pytest.param(case, 5, marks=pytest.mark.slow) if case in LIKE_OTHERS else (case, 5) for case in CASES),
        *(pytest.param(case, 300, marks=pytest.mark.slow) for case in CASES),
    ],
)
def test_steps_have_the_bits_of_plain_python(case, draws, plan_of):
    model, motion, options = CASES[case]
    plan = plan_of(model, motion, **options)
    kernel = kernel_of(type(model), plan.shape(planar=case.endswith("plane")))
    rows, width = kernel.shape.rows(), kernel.shape.width
    kinds = [ctypes.c_void_p, ctypes.c_int64]
    groups = range(len(kernel.shape.groups))
    compiled = [
        without_fast_arithmetic(
            kernel.compiled, "step", [ArrayArgument((len(rows), width)), NumberKind.INTEGER, group], kinds
        )
        for group in groups
    ]
    rng = np.random.default_rng(8)
    for draw, group in itertools.product(range(draws), groups):
        scale = 0.05 if draw == 0 else 10.0 ** rng.uniform(-6.0, 0.0)
        buf = rng.normal(scale=scale, size=(len(rows), width))
        for name in ("h", "rtol", "atol", "atol_now", "longest_step", "stop"):
            buf[rows[name]] = np.abs(buf[rows[name]])
        for j, number in enumerate(model.parameters):
            buf[rows[f"p{j}"]] = number
        one, other = buf.copy(), buf.copy()
        compiled[group](one.ctypes.data, width)
        with np.errstate(all="ignore"):
            kernel.compiled.module.step(other, width, group)
        assert draw or np.isfinite(other).mean() > 0.9
        assert (other != buf).any(axis=1).sum() > 40
        np.testing.assert_array_equal(one, other)


@pytest.mark.slow
def test_a_run_with_implicit_steps_has_the_bits_of_plain_python(plan_of):
    # A base that stands for 0.068 s and then slides, under a load that turns.
    line = sb.Harmonic.elliptic(amplitude=(1.2, 0.6), phase=1.0, angular_frequency=2.0, start_phase=-1.0)
    model = sb.Sliding(sb.Column.solid(radius=1.0, height=2.0, density=2700.0), 0.1)
    plan = replace(plan_of(model, line), traces=3000)
    batch = Batch.of(plan, broadcast((0.0, 0.0), (0.0, 0.0), 0.0, np.array([0.07]), {}))
    kernel = kernel_of(sb.Sliding, plan.shape(planar=False))
    # Looks come early, so that few steps are explicit.
    early = {"LOOK_EVERY": 5.0, "LOOK_AGAIN": 5.0, "LOOK_FIRST": 5.0, "STIFF_STEPS": 2.0}
    program = kernel.compiled.program()
    compiled = replace(kernel.compiled, program=lambda: replace(program, names={**program.names, **early}))
    tables, halt = (batch.table.copy(), batch.table.copy()), np.zeros(1, dtype=np.uint8)
    room, pieces = kernel.buffer(), plan.motion.pieces
    passed = [
        *(tables[0].ctypes.data, *tables[0].shape),
        *(pieces.ctypes.data, *pieces.shape),
        *(array.ctypes.data for array in (halt, room)),
    ]
    without_fast_arithmetic(compiled, "advance", compiled.arguments, [ctypes.c_int64] * len(passed))(*passed)
    room = kernel.buffer()
    with np.errstate(all="ignore"):
        compiled.module.advance(tables[1], pieces, halt, room)
    np.testing.assert_array_equal(*tables)
    # The dense output of an implicit step is a cubic.
    entries = tables[0][0, -plan.traces * plan.layout.trace_width :].reshape(plan.traces, -1)
    terms = entries[entries[:, Trace.LENGTH] > 0.0, len(Trace) :].reshape(-1, TRACE_TERMS, kernel.shape.order)
    cubic = np.any(terms[:, 3], axis=1) & ~np.any(terms[:, 4:], axis=(1, 2))
    assert cubic.sum() > 5
