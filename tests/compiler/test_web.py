"""Kernels as modules of WebAssembly: Node computes the bits that this machine computes with the same arithmetic."""

import ctypes
import json
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import stylobate as sb
from stylobate.compiler import mathematics
from stylobate.compiler.machine import WEB, linked, native
from stylobate.compiler.unit import ArrayArgument, Unit
from stylobate.compiler.web import imports_of, module_of
from stylobate.engine.kernel.kernels import Kernel
from stylobate.errors import UnsupportedError

RUNNER = Path(__file__).with_name("run_module.mjs")
COLUMN = sb.Column.dimensionless(slenderness=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)


def twice(x):
    x[0] = 2.0 * x[0]


def code_of(function, *arguments):
    """Return the object code of a function for WebAssembly."""
    unit = Unit(lanes=WEB.lanes, trusted=True)
    unit.export(function, function.__name__, list(arguments))
    return WEB.object_code(unit.module.text("nounwind"))


def test_a_module_exports_the_named_functions_only():
    module = module_of(code_of(twice, ArrayArgument((1,))), ["twice"])
    assert module.startswith(b"\0asm\x01\0\0\0")
    assert imports_of(module) == []
    assert b"reloc" not in module
    with pytest.raises(UnsupportedError, match=r"exports: must be functions of the code \(got 'thrice'\)"):
        module_of(code_of(twice, ArrayArgument((1,))), ["thrice"])


@pytest.fixture
def batches(monkeypatch):
    """Kernels that were called, with their arrays before, and their table after."""
    called, own = [], Kernel.advance

    def advance(kernel, table, pieces, halt, buffer, **options):
        before = [table.copy(), pieces.copy(), np.zeros_like(halt), buffer.copy()]
        ended = own(kernel, table, pieces, halt, buffer, **options)
        called.append((kernel, before, table.copy()))
        return ended

    monkeypatch.setattr(Kernel, "advance", advance)
    return called


def code_of_kernel(kernel, machine):
    """Return the object code of a kernel without fast arithmetic, in two lanes."""
    compiled = kernel.compiled
    unit = compiled.unit(machine=machine, exact=True)
    unit.export(getattr(compiled.module, compiled.name), compiled.name, compiled.arguments)
    return machine.object_code(unit.module.text("nounwind"))


def in_node(kernel, arrays, folder):
    """Return the table of a kernel that Node ran on these arrays."""
    compiled = kernel.compiled
    module = module_of(code_of_kernel(kernel, WEB), [compiled.name])
    assert set(imports_of(module)) <= set(mathematics.FUNCTIONS)
    (folder / "kernel.wasm").write_bytes(module)
    functions = module_of(mathematics.object_code(WEB), list(mathematics.FUNCTIONS))
    (folder / "mathematics.wasm").write_bytes(functions)
    shapes = [
        {"sizes": list(array.shape), "width": array.itemsize, "lengths": None in argument.shape}
        for array, argument in zip(arrays, compiled.arguments, strict=True)
    ]
    header = json.dumps({"shapes": shapes}).encode()
    content = len(header).to_bytes(4, "little") + header
    for array in arrays:
        content += array.tobytes() + bytes(-array.nbytes % 64)
    (folder / "input").write_bytes(content)
    paths = [str(folder / name) for name in ("kernel.wasm", "mathematics.wasm", "input", "output")]
    subprocess.run(["node", str(RUNNER), *paths], check=True, timeout=120)
    return np.frombuffer((folder / "output").read_bytes()).reshape(arrays[0].shape)


def here(kernel, arrays):
    """Return the table of a kernel that this machine ran on these arrays, with the arithmetic of WebAssembly."""
    two_lanes = replace(native(), vector_bits=128)
    compiled, copies = kernel.compiled, [array.copy() for array in arrays]
    engine = linked(mathematics.object_code(two_lanes), code_of_kernel(kernel, two_lanes))
    values = []
    for array, argument in zip(copies, compiled.arguments, strict=True):
        values += [ctypes.c_void_p(array.ctypes.data)]
        values += [ctypes.c_int64(size) for size in array.shape] if None in argument.shape else []
    function = ctypes.CFUNCTYPE(ctypes.c_int64, *map(type, values))(engine.get_function_address(compiled.name))
    function(*values)
    return copies[0]


@pytest.mark.system
@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node")
@pytest.mark.parametrize(
    ("model", "duration"),
    [
        (sb.Slender(COLUMN, damping=0.1), 30.0),
        pytest.param(sb.Rolling(COLUMN, damping=0.1), 30.0, marks=pytest.mark.slow),
        pytest.param(sb.Sliding(COLUMN, damping=0.1, friction_coefficient=0.3), 30.0, marks=pytest.mark.slow),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_node_computes_the_bits_of_this_machine(model, duration, batches, tmp_path):
    over = {"acceleration": np.linspace(0.05, 0.3, 12), "angular_frequency": np.linspace(1.0, 4.0, 12)}
    start = {"tilt": (0.0386, 0.0042), "tilt_rate": (-0.0075, 0.0695)}
    sb.simulate_ensemble(model, CIRCLE, parameters=over, duration=duration, **start)
    assert batches
    for kernel, before, after in batches:
        found = in_node(kernel, before, tmp_path)
        known = here(kernel, before)
        assert found.tobytes() == known.tobytes()
        # fast arithmetic and the library of C differ by rounding alone, which slip amplifies
        assert np.mean(np.isclose(known, after, rtol=1e-6, atol=1e-6, equal_nan=True)) > 0.98
