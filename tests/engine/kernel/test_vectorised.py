"""The innermost loops of kernels are vector code: lost without a word, the loss is told here."""

import collections
import re

import pytest
from llvmlite import binding as llvm

import stylobate as sb
from stylobate.compiler import machine
from stylobate.compiler.unit import ArrayArgument
from stylobate.compiler.values import NumberKind
from stylobate.engine.kernel.kernels import kernel_of
from stylobate.models.sliding import Sliding

CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)

# A mnemonic of floating arithmetic with its suffix: pd works on all lanes of a register, sd on one number.
ARITHMETIC = re.compile(r"^\s+v?((?:add|sub|mul|div|sqrt|min|max|fn?m(?:add|sub)\d*)(?:pd|sd))\s(.*)$", re.MULTILINE)


def has_avx():
    return llvm.get_host_cpu_features().get("avx", False)


pytestmark = pytest.mark.skipif(not has_avx(), reason="the machine has no AVX")


def arithmetic_of(assembly):
    """Count floating instructions of a compiled function by mnemonic, and the registers that they use."""
    counts, registers = collections.Counter(), collections.Counter()
    for mnemonic, operands in ARITHMETIC.findall(assembly):
        counts[mnemonic[-2:]] += 1
        registers.update(set(re.findall(r"%([xyz]mm)\d+", operands)))
    return counts, registers


def wide(registers):
    """Count the uses of registers as long as those of the processor allow, or half as long."""
    return registers["ymm"] + registers["zmm"] if machine.native().vector_bits > 128 else registers["xmm"]


def called_by(assembly):
    """Return the names of what lies outside a compiled function and is called by it."""
    return set(re.findall(r"call\w*\s+\*?([A-Za-z_]\w*)", assembly))


MATHEMATICS = {"sin", "cos", "tan", "exp", "log", "pow", "sqrt", "hypot", "atan2", "fmin", "fmax", "floor", "rint"}

MOTIONS = {
    "harmonic": CIRCLE,
    "windowed": CIRCLE.delayed(1.0),
    "two terms": CIRCLE + CIRCLE.rotated(1.0),
    "vertical": sb.Harmonic(amplitude=(0.065, 0.065, 0.2), phase=(0.0, 1.0, 2.0), angular_frequency=3.0),
}
# In a plane both methods make the same steps.
KERNELS = [
    pytest.param(motion, method, planar, marks=[] if motion == "harmonic" else pytest.mark.slow)
    for motion in MOTIONS
    for method, planar in (("dop853", False), ("dop853", True), ("taylor", False))
]


@pytest.fixture(scope="module")
def assembly_of(plan_of):
    """Make a function of a kernel for the processor; behind the buffer it takes whole numbers or these arguments."""

    def made(name, motion, method, planar, model=sb.Slender, *, demands=False, after=()):
        plan = plan_of(model(sb.Column.dimensionless(0.1)), MOTIONS[motion], method=method, demands=demands)
        shape = plan.shape(planar=planar)
        compiled = kernel_of(model, shape).compiled
        unit = compiled.unit()
        unit.export(getattr(compiled.module, name), name, [ArrayArgument((len(shape.rows()), shape.width)), *after])
        return machine.native().assembly(unit.module.text(machine.native().attributes))

    return made


@pytest.mark.parametrize(
    ("motion", "method", "planar", "model"),
    [
        *(pytest.param(*kernel.values, sb.Slender, marks=kernel.marks) for kernel in KERNELS),
        *(
            pytest.param("harmonic", method, False, sb.SlenderRolling, marks=pytest.mark.slow)
            for method in ("dop853", "taylor")
        ),
        pytest.param("harmonic", "dop853", False, sb.Wobbling, marks=pytest.mark.slow),
        pytest.param("harmonic", "dop853", False, sb.Rolling, marks=pytest.mark.slow),
        pytest.param("harmonic", "dop853", True, sb.PlanarRocking, marks=pytest.mark.slow),
        pytest.param("vertical", "dop853", False, sb.Rolling, marks=pytest.mark.slow),
    ],
)
def test_steps_work_on_all_lanes_at_once(motion, method, planar, model, assembly_of):
    counts, registers = arithmetic_of(assembly_of("step", motion, method, planar, model, after=(NumberKind.INTEGER, 0)))
    assert counts["pd"] > 100
    assert counts["sd"] == 0, counts
    assert wide(registers) > registers.total() / 2


@pytest.mark.parametrize(
    ("model", "planar"),
    [
        (sb.Rolling, False),
        pytest.param(sb.Wobbling, False, marks=pytest.mark.slow),
        pytest.param(sb.PlanarRocking, True, marks=pytest.mark.slow),
        pytest.param(sb.Slender, False, marks=pytest.mark.slow),
    ],
)
def test_steps_that_follow_loads_work_on_all_lanes_at_once(model, planar, assembly_of):
    counts, _ = arithmetic_of(
        assembly_of("step", "harmonic", "dop853", planar, model, demands=True, after=(NumberKind.INTEGER, 0))
    )
    assert counts["pd"] > 100
    assert counts["sd"] == 0, counts


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "argument"),
    [("evaluate", NumberKind.FLOAT), ("evaluate_with_guards", NumberKind.FLOAT), ("step", NumberKind.INTEGER)],
)
@pytest.mark.parametrize("group", range(3))
def test_equations_and_margins_of_changing_contact_work_on_all_lanes_at_once(name, argument, group, assembly_of):
    counts, _ = arithmetic_of(assembly_of(name, "harmonic", "dop853", False, Sliding, after=(argument, group)))
    assert counts["pd"] > 100
    assert counts["sd"] == 0, counts


# What tells the polynomials of a step, and the sums, belong to one lane: scalar. Between them stands a loop over the
# nodes; in it two cosines, the root and four integrands take more than this many instructions, whatever the model.
INSTRUCTIONS_AT_NODES = 40


@pytest.mark.parametrize(("motion", "method", "planar"), [kernel for kernel in KERNELS if kernel.values[1] == "taylor"])
def test_observation_works_on_all_nodes_at_once(motion, method, planar, assembly_of):
    assembly = assembly_of("observe", motion, method, planar, after=(NumberKind.INTEGER,))
    counts, registers = arithmetic_of(assembly)
    assert counts["pd"] >= INSTRUCTIONS_AT_NODES, counts
    assert wide(registers) >= INSTRUCTIONS_AT_NODES, registers
    assert not called_by(assembly) & MATHEMATICS
