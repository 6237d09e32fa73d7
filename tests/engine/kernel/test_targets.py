"""The text of a kernel becomes code for other processors too: nothing in its laws is of one machine only."""

import re

import pytest
from llvmlite import binding as llvm

import stylobate as sb
from stylobate.compiler.unit import ArrayArgument, Unit
from stylobate.compiler.values import Element
from stylobate.engine.kernel.kernels import kernel_of

# Number of lanes and features of each; a thread of a graphics processor makes one run.
TARGETS = {
    "x86_64-unknown-linux-gnu": (4, "+avx2,+fma"),
    "x86_64-pc-windows-msvc": (4, "+avx2,+fma"),
    "aarch64-unknown-linux-gnu": (2, ""),
    "arm64-apple-macosx14": (2, ""),
    "wasm32-unknown-unknown": (2, "+simd128"),
    "nvptx64-nvidia-cuda": (0, "+ptx78"),
}


@pytest.fixture(scope="module")
def texts(plan_of):
    """The text of a kernel for LLVM, driver and events included, by the number of lanes."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    motion = sb.Harmonic.circular(acceleration=0.6, angular_frequency=2.2)
    plan = plan_of(sb.Rolling(sb.Column.dimensionless(0.2)), motion)
    kernel = kernel_of(sb.Rolling, plan.shape(planar=False))
    rows, width, table = len(kernel.shape.rows()), kernel.shape.width, ArrayArgument((None, None))
    signal, buf = ArrayArgument((1,), Element.SIGNAL), ArrayArgument((rows, width))

    def text(lanes):
        unit = Unit(lanes=lanes, trusted=True)
        unit.export(kernel.compiled.module.advance, "advance", [table, table, signal, buf])
        return unit.module.text("nounwind")

    return {lanes: text(lanes) for lanes in {lanes for lanes, _ in TARGETS.values()}}


@pytest.mark.parametrize("target", TARGETS)
def test_a_kernel_becomes_code_for_another_processor(texts, target):
    lanes, features = TARGETS[target]
    text = texts[lanes]
    if target.startswith("nvptx"):  # whose mathematics is a library with names of its own
        text = re.sub(r"@(?:llvm\.)?(sin|cos|exp|log|pow|atan2|hypot|asinh|fmod)(?:\.f64)?\(", r"@__nv_\1(", text)
    machine = llvm.Target.from_triple(target).create_target_machine(
        cpu="sm_80" if target.startswith("nvptx") else "", features=features, opt=1
    )
    module = llvm.parse_assembly(text)
    module.triple, module.data_layout = target, str(machine.target_data)
    module.verify()
    assembly = machine.emit_assembly(module)
    assert len(assembly.splitlines()) > 3000
    assert "advance" in assembly
