"""Machine code for the processor of this machine, by LLVM."""

import threading
from functools import cache

from llvmlite import binding as llvm

# Level 2 of the passes takes a third longer, and does not speed up code that is already vectorised.
_PASSES, _CODE = 1, 2
# Maximum size of functions that are inlined. The default of LLVM, 225, takes a tenth longer, and its code is as fast.
_INLINED = 60
_BITS = 64

_compiling = threading.Lock()


@cache
def _target() -> llvm.TargetMachine:
    return _new_target()


def _new_target() -> llvm.TargetMachine:
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    features = llvm.get_host_cpu_features()
    # LLVM prefers half registers on processors whose earlier models slowed down with full ones.
    features["prefer-256-bit"] = False
    target = llvm.Target.from_default_triple()
    return target.create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=features.flatten(), opt=_CODE, reloc="pic", codemodel="default"
    )


@cache
def vector_bits() -> int:
    """Return the length of the vector registers of the processor [bits]."""
    features = llvm.get_host_cpu_features()
    return 512 if features.get("avx512f") else 256 if features.get("avx") else 128


def lanes() -> int:
    """Return the number of floats in a vector register."""
    return vector_bits() // _BITS


def attributes() -> str:
    """Return the LLVM attributes of functions for this processor."""
    width = vector_bits()
    return f'nounwind "prefer-vector-width"="{width}" "min-legal-vector-width"="{width}"'


def described() -> str:
    """Return all properties of the machine and of LLVM on which machine code depends."""
    machine = _target()
    features = llvm.get_host_cpu_features().flatten()
    return repr((machine.triple, llvm.get_host_cpu_name(), features, str(machine.target_data), llvm.llvm_version_info))


def optimised(text: str) -> llvm.ModuleRef:
    """Return the optimised LLVM module of a text."""
    machine = _target()
    module = llvm.parse_assembly(text)
    module.triple, module.data_layout = machine.triple, str(machine.target_data)
    module.verify()
    options = llvm.create_pipeline_tuning_options(speed_level=_PASSES)
    # The code is already vectorised; these passes would only cost time.
    options.loop_vectorization = options.slp_vectorization = options.loop_unrolling = False
    options.inlining_threshold = _INLINED
    builder = llvm.create_pass_builder(machine, options)
    builder.getModulePassManager().run(module, builder)
    return module


def object_code(text: str) -> bytes:
    """Return the machine code of the module of a text."""
    with _compiling:
        return bytes(_target().emit_object(optimised(text)))


def assembly(text: str) -> str:
    """Return the assembly of the module of a text."""
    with _compiling:
        return str(_target().emit_assembly(optimised(text)))


def linked(code: bytes) -> llvm.ExecutionEngine:
    """Return an engine whose machine code can be called as long as the engine exists."""
    with _compiling:
        engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _new_target())  # the engine owns its target
        engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        engine.finalize_object()
        return engine
