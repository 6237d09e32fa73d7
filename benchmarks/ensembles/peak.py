"""Measured arithmetic peak of one core, and operation count of a DOP853 step of equations (1)."""

import ctypes
import time

import llvmlite.binding as llvm
from scipy.integrate import DOP853

# Number of independent chains, which hide the latency; chains and both factors must fit the 16 registers without
# AVX-512.
_CHAINS = 12
_ROUNDS = 2_000_000


def packed_doubles() -> int:
    """Return the number of doubles in a vector register of this processor."""
    features = llvm.get_host_cpu_features()
    return 8 if features.get("avx512f") else 4 if features.get("avx2") else 2


def instruction_set() -> str:
    """Return the name of the instructions of the measured peak."""
    return {8: "AVX-512", 4: "AVX2", 2: "128-bit vectors"}[packed_doubles()]


def measured_peak(repetitions: int = 7) -> float:
    """Measure the peak rate of additions and multiplications [1/s] of packed fused multiply-adds in registers."""
    engine, spin = _spin(packed_doubles())
    flops = 2.0 * packed_doubles() * _CHAINS * _ROUNDS
    best = 0.0
    for _ in range(repetitions):
        begun = time.process_time()
        spin(_ROUNDS)
        best = max(best, flops / (time.process_time() - begun))
    del engine  # owns the machine code
    return best


def in_words(measured: float) -> str:
    """Describe the instructions of this processor and the `measured` peak of a core, for notes under tables."""
    return f"{instruction_set()}; arithmetic peak of one core, measured: {measured / 1e9:.0f} GFlop/s"


def flops_of_a_step(equations: int = 4) -> int:
    """Count the operations of an accepted step of DOP853 without events and summaries.

    Additions, subtractions, multiplications, divisions, square roots, absolute values and roundings count one each, a
    fused multiply-add two. The count covers twelve evaluations of the right-hand side, the sums over the non-zero
    entries of the tableau and the error estimates of orders 5 and 3, without step control.
    """
    rows = [DOP853.A[stage, :stage] for stage in range(1, 12)] + [DOP853.B]
    sums = sum(2 * int((row != 0.0).sum()) - 1 + 2 for row in rows)  # of slopes, times step, added to state
    estimate = sum(2 * int((row != 0.0).sum()) - 1 + 3 for row in (DOP853.E5, DOP853.E3))  # scaled, squared, added
    scale = 6  # atol + rtol max(|y|, |y'|), its reciprocal
    return equations * (sums + estimate + scale) + 12 * _RIGHT_HAND_SIDE


# One cosine: reduction 6, square 1, eight terms by Horner's rule 15, product with s and sum 3.
_COSINE = 25
# Phase 3; two cosines with start phase 1 and amplitude 1; lean 3 + 1 + 1 + 1; two equations of 5.
_RIGHT_HAND_SIDE = 3 + 2 * (_COSINE + 2) + 6 + 2 * 5


def _spin(width: int):
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    target = llvm.Target.from_default_triple()
    machine = target.create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=llvm.get_host_cpu_features().flatten(), opt=3
    )
    module = llvm.parse_assembly(_source(width))
    module.verify()
    engine = llvm.create_mcjit_compiler(module, machine)
    engine.finalize_object()
    function = ctypes.CFUNCTYPE(None, ctypes.c_int64)(engine.get_function_address("spin"))
    return engine, function


def _source(width: int) -> str:
    """Return LLVM code of a loop of fused multiply-adds, each into its own register; the results are stored."""
    vector = f"<{width} x double>"
    fma = f"@llvm.fma.v{width}f64"
    begin = f"<{', '.join(['double 0x3FEFFFFFFFFFFFFF'] * width)}>"
    chains = range(_CHAINS)
    heads = "\n".join(f"  %a{k} = phi {vector} [ {begin}, %entry ], [ %b{k}, %loop ]" for k in chains)
    body = "\n".join(f"  %b{k} = call {vector} {fma}({vector} %a{k}, {vector} %x, {vector} %y)" for k in chains)
    keep = "\n".join(f"  store volatile {vector} %b{k}, ptr %place" for k in chains)
    return f"""
declare {vector} {fma}({vector}, {vector}, {vector})
define void @spin(i64 %rounds) {{
entry:
  %place = alloca {vector}, align 64
  store volatile {vector} {begin}, ptr %place
  %x = load volatile {vector}, ptr %place
  %y = load volatile {vector}, ptr %place
  br label %loop
loop:
  %i = phi i64 [ 0, %entry ], [ %j, %loop ]
{heads}
{body}
  %j = add i64 %i, 1
  %more = icmp slt i64 %j, %rounds
  br i1 %more, label %loop, label %done
done:
{keep}
  ret void
}}
"""
