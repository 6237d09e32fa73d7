"""The innermost loops of kernels are vector code: lost without a word, the loss is told here."""

import collections
import re

import numpy as np
import pytest
from llvmlite import binding as llvm

import stylobate as sb
from stylobate.engine.ensembles.batch import Plan
from stylobate.engine.ensembles.motion_columns import MotionPlan
from stylobate.engine.ensembles.options import Options
from stylobate.engine.lanes.kernels import kernel_of

CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
OPTIONS = Options.checked(
    rtol=1e-8,
    atol=None,
    tilt_limit=None,
    rest_energy=None,
    max_steps=1000,
    samples=None,
    strobes=0,
    rules=None,
)

# A mnemonic of floating arithmetic with its suffix: pd works on all lanes of a register, sd on one number.
ARITHMETIC = re.compile(r"^\s+v?((?:add|sub|mul|div|sqrt|min|max|fn?m(?:add|sub)\d*)(?:pd|sd))\s(.*)$", re.MULTILINE)


def has_avx():
    return llvm.get_host_cpu_features().get("avx", False)


pytestmark = pytest.mark.skipif(not has_avx(), reason="the machine has no AVX")


def arithmetic_of(function):
    """Count floating instructions of a compiled function by mnemonic, and the registers that they use."""
    (assembly,) = function.inspect_asm().values()
    counts, registers = collections.Counter(), collections.Counter()
    for mnemonic, operands in ARITHMETIC.findall(assembly):
        counts[mnemonic[-2:]] += 1
        registers.update(set(re.findall(r"%([xyz]mm)\d+", operands)))
    return counts, registers


@pytest.fixture(scope="module", params=["step", "observe"])
def loop(request):
    return request.param


@pytest.mark.parametrize("planar", [False, True], ids=["space", "plane"])
@pytest.mark.parametrize(
    "motion",
    [
        pytest.param(CIRCLE, id="harmonic"),
        pytest.param(CIRCLE.delayed(1.0), id="windowed", marks=pytest.mark.slow),
        pytest.param(CIRCLE + CIRCLE.rotated(1.0), id="two terms", marks=pytest.mark.slow),
    ],
)
def test_steps_and_their_observation_work_on_all_lanes_at_once(loop, motion, planar):
    plan = Plan(sb.Slender(sb.Column.dimensionless(0.1)), MotionPlan.of(motion, {}, np.ones(1)), OPTIONS)
    shape = plan.shape(planar=planar)
    kernel = kernel_of(sb.Slender, shape)
    function = getattr(kernel.module, loop)
    function(np.ones(len(shape.rows()) * shape.width))
    counts, registers = arithmetic_of(function)
    assert counts["pd"] > 100
    assert counts["sd"] == 0, counts
    assert registers["ymm"] + registers["zmm"] > registers["xmm"]


def test_a_loop_with_a_branch_would_be_seen():
    # The same count finds scalar instructions where there are some: a call into the C library.
    from numba import njit  # noqa: PLC0415

    @njit
    def slow(values):
        for i in range(len(values)):
            values[i] = np.sin(values[i]) * values[i] + 1.0

    slow(np.ones(8))
    counts, _ = arithmetic_of(slow)
    assert counts["sd"] > 0
