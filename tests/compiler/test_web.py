"""Kernels as modules of WebAssembly: they pass Node's validation and compute what this machine computes."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import stylobate as sb
from stylobate.compiler.machine import WEB
from stylobate.compiler.unit import ArrayArgument, Unit
from stylobate.compiler.web import imports_of, module_of
from stylobate.engine.kernel.kernels import Kernel
from stylobate.errors import UnsupportedError

RUNNER = Path(__file__).with_name("run_module.mjs")
COLUMN = sb.Column.dimensionless(slenderness=0.1)
CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
MATHEMATICS = {"sin", "cos", "atan", "atan2", "hypot", "asinh", "exp", "pow"}
# Columns of the results are compared to this tolerance: sums and mathematical functions round differently.
SAME = 1e-7


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
    """Kernels that were called, with their arrays before and after."""
    called, own = [], Kernel.advance

    def advance(kernel, table, pieces, halt, buffer, **options):
        before = [table.copy(), pieces.copy(), np.zeros_like(halt), buffer.copy()]
        ended = own(kernel, table, pieces, halt, buffer, **options)
        called.append((kernel, before, table.copy()))
        return ended

    monkeypatch.setattr(Kernel, "advance", advance)
    return called


def in_node(kernel, arrays, folder):
    """Return the table of a kernel that Node ran on these arrays."""
    compiled = kernel.compiled
    unit = compiled.unit(machine=WEB)
    unit.export(getattr(compiled.module, compiled.name), compiled.name, compiled.arguments)
    module = module_of(WEB.object_code(unit.module.text("nounwind")), [compiled.name])
    assert set(imports_of(module)) <= MATHEMATICS
    (folder / "kernel.wasm").write_bytes(module)
    shapes = [
        {"sizes": list(array.shape), "width": array.itemsize, "lengths": None in argument.shape}
        for array, argument in zip(arrays, compiled.arguments, strict=True)
    ]
    header = json.dumps({"shapes": shapes}).encode()
    content = len(header).to_bytes(4, "little") + header
    for array in arrays:
        content += array.tobytes() + bytes(-array.nbytes % 64)
    (folder / "input").write_bytes(content)
    paths = [str(folder / name) for name in ("kernel.wasm", "input", "output")]
    subprocess.run(["node", str(RUNNER), *paths], check=True, timeout=120)
    return np.frombuffer((folder / "output").read_bytes()).reshape(arrays[0].shape)


@pytest.mark.skipif(shutil.which("node") is None, reason="needs Node")
@pytest.mark.parametrize(
    ("model", "duration"),
    [
        (sb.Slender(COLUMN, damping=0.1), 30.0),
        pytest.param(sb.Rolling(COLUMN, damping=0.1), 30.0, marks=pytest.mark.slow),
        # slip that changes its direction amplifies rounding
        pytest.param(sb.Sliding(COLUMN, damping=0.1, friction_coefficient=0.3), 3.0, marks=pytest.mark.slow),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_a_kernel_in_node_computes_what_this_machine_computes(model, duration, batches, tmp_path):
    over = {"acceleration": np.linspace(0.05, 0.3, 12), "angular_frequency": np.linspace(1.0, 4.0, 12)}
    start = {"tilt": (0.0386, 0.0042), "tilt_rate": (-0.0075, 0.0695)}
    sb.simulate_ensemble(model, CIRCLE, parameters=over, duration=duration, **start)
    assert batches
    for kernel, before, after in batches:
        found = in_node(kernel, before, tmp_path)
        changed = ~((before[0] == after) | (np.isnan(before[0]) & np.isnan(after)))
        assert changed.any()
        np.testing.assert_allclose(found, after, rtol=SAME, atol=SAME)
