"""Machines for which LLVM makes code: this one or an older one of its kind, and the virtual machine of web browsers.

llvmlite is imported when something is compiled or linked.
"""

import os
import threading
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from stylobate.errors import ParameterError

if TYPE_CHECKING:
    from llvmlite import binding as llvm

# Level 2 of the passes takes a third longer, and does not speed up code that is already vectorised.
_PASSES, _CODE = 1, 2
# Maximum size of functions that are inlined. The default of LLVM, 225, takes a tenth longer, and its code is as fast.
_INLINED = 60
_BITS = 64

VARIABLE = "STYLOBATE_CPU"
"""Environment variable with the processor for which code is compiled; a process reads it once."""

HOST = "host"
"""The processor of this machine, with all that it can do; the default."""

_compiling = threading.Lock()


@dataclass(frozen=True, slots=True)
class Machine:
    """A target of LLVM.

    Parameters
    ----------
    triple
        Architecture, vendor and system, as LLVM names them.
    processor
        Name of the processor.
    features
        Its features, with commas between them.
    vector_bits
        Length of the vector registers [bits].
    relocation
        Relocation model of LLVM: "pic" for code that is loaded anywhere, or "static".
    """

    triple: str
    processor: str
    features: str
    vector_bits: int
    relocation: str = "pic"

    @property
    def lanes(self) -> int:
        """Number of floats in a vector register."""
        return self.vector_bits // _BITS

    @property
    def attributes(self) -> str:
        """LLVM attributes of functions."""
        width = self.vector_bits
        return f'nounwind "prefer-vector-width"="{width}" "min-legal-vector-width"="{width}"'

    def described(self) -> str:
        """Return all properties of the machine and of LLVM on which machine code depends."""
        from llvmlite import binding as llvm

        layout = str(_target(self).target_data)
        return repr((self.triple, self.processor, self.features, layout, llvm.llvm_version_info))

    def optimised(self, text: str) -> "llvm.ModuleRef":
        """Return the optimised LLVM module of a text."""
        from llvmlite import binding as llvm

        target = _target(self)
        module = llvm.parse_assembly(text)
        module.triple, module.data_layout = target.triple, str(target.target_data)
        module.verify()
        options = llvm.create_pipeline_tuning_options(speed_level=_PASSES)
        # The code is already vectorised; these passes would only cost time.
        options.loop_vectorization = options.slp_vectorization = options.loop_unrolling = False
        options.inlining_threshold = _INLINED
        builder = llvm.create_pass_builder(target, options)
        builder.getModulePassManager().run(module, builder)
        return module

    def object_code(self, text: str) -> bytes:
        """Return the machine code of the module of a text."""
        with _compiling:
            return bytes(_target(self).emit_object(self.optimised(text)))

    def assembly(self, text: str) -> str:
        """Return the assembly of the module of a text."""
        with _compiling:
            return str(_target(self).emit_assembly(self.optimised(text)))


WEB = Machine(
    triple="wasm32-unknown-unknown",
    processor="generic",
    features="+simd128,+bulk-memory,+mutable-globals,+sign-ext,+nontrapping-fptoint",
    vector_bits=128,
    relocation="static",
)
"""WebAssembly with vectors of 128 bits."""


@dataclass(frozen=True, slots=True)
class _Level:
    """Level of x86-64: the features that it adds to the level below, and the length of its vector registers [bits]."""

    features: str
    vector_bits: int


# The levels of the System V ABI of x86-64, with LLVM's names of features. Level 3 is the first one that fuses products
# with sums.
_LEVELS = {
    "x86-64-v2": _Level("cx16 sahf popcnt sse3 sse4.1 sse4.2 ssse3", 128),
    "x86-64-v3": _Level("avx avx2 bmi bmi2 f16c fma lzcnt movbe", 256),
    "x86-64-v4": _Level("avx512f avx512bw avx512cd avx512dq avx512vl", 512),
}
_X86 = "x86_64"


def processors() -> list[str]:
    """Return the names that $STYLOBATE_CPU may have on machines of this architecture."""
    return [HOST, *_LEVELS] if _architecture() == _X86 else [HOST, "generic"]


@cache
def native() -> Machine:
    """Return the machine for which code is compiled that runs here: this one, or the one that $STYLOBATE_CPU names.

    Raises
    ------
    ParameterError
        If this machine has no processor of that name, or cannot run its code.
    """
    return machine_of(os.environ.get(VARIABLE) or HOST)


def machine_of(processor: str) -> Machine:
    """Return the machine of a processor, one of `processors`.

    Raises
    ------
    ParameterError
        If the name is unknown, or this machine cannot run code for that processor.
    """
    from llvmlite import binding as llvm

    triple, features = llvm.get_default_triple(), llvm.get_host_cpu_features()
    if processor not in processors():
        names = ", ".join(processors())
        raise ParameterError(f"{VARIABLE}: unknown processor (got {processor!r}). Use one of {names}.")
    if processor == HOST:
        bits = 512 if features.get("avx512f") else 256 if features.get("avx") else 128
        # LLVM prefers half registers on processors whose earlier models slowed down with full ones.
        features["prefer-256-bit"] = False
        return Machine(triple, llvm.get_host_cpu_name(), features.flatten(), bits)
    if processor not in _LEVELS:
        return Machine(triple, processor, "", 128)
    below = list(_LEVELS)[: list(_LEVELS).index(processor) + 1]
    missing = [one for level in below for one in _LEVELS[level].features.split() if not features.get(one)]
    if missing:
        raise ParameterError(
            f"{VARIABLE}: this machine cannot run code for that processor (got {processor!r}), because it lacks "
            f"{', '.join(missing)}. Use {HOST} or a lower level."
        )
    return Machine(triple, processor, "-prefer-256-bit", _LEVELS[processor].vector_bits)


def arithmetic() -> str:
    """Return the arithmetic on which bits of results depend: the architecture, and whether it fuses products with sums.

    Vector registers of another length change no bit.
    """
    machine = native()
    features = machine.features.split(",")
    fused = _architecture() != _X86 or machine.processor in ("x86-64-v3", "x86-64-v4") or "+fma" in features
    return f"{_architecture()} {'with' if fused else 'without'} FMA"


def _architecture() -> str:
    from llvmlite import binding as llvm

    return str(llvm.get_default_triple()).partition("-")[0]


def linked(*codes: bytes) -> "llvm.ExecutionEngine":
    """Return an engine whose machine code for this machine can be called as long as the engine exists.

    A function that one code lacks is that of another, or else of the library of C.
    """
    from llvmlite import binding as llvm

    with _compiling:
        engine = llvm.create_mcjit_compiler(
            llvm.parse_assembly(""), _new_target(native())
        )  # the engine owns its target
        for code in codes:
            engine.add_object_file(llvm.ObjectFileRef.from_data(code))
        engine.finalize_object()
        return engine


@cache
def _target(machine: Machine) -> "llvm.TargetMachine":
    return _new_target(machine)


def _new_target(machine: Machine) -> "llvm.TargetMachine":
    from llvmlite import binding as llvm

    if machine == native():
        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
    else:
        llvm.initialize_all_targets()
        llvm.initialize_all_asmprinters()
    return llvm.Target.from_triple(machine.triple).create_target_machine(
        cpu=machine.processor, features=machine.features, opt=_CODE, reloc=machine.relocation, codemodel="default"
    )
