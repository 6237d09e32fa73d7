"""The processor for which code is compiled: chosen by $STYLOBATE_CPU, refused if this machine cannot run its code."""

import os
import re
import subprocess
import sys

import numpy as np
import pytest

from stylobate.compiler import machine
from stylobate.compiler.marks import fast, lanes
from stylobate.errors import ParameterError

from .calling import text_of

X = np.ones((3, 24))
FUSED = re.compile(r"\bvfn?m(?:add|sub)")


def can_run(processor):
    try:
        machine.machine_of(processor)
    except ParameterError:
        return False
    return True


@fast
def fused(x, out):
    for i in lanes(24):
        out[0, i] = x[0, i] * x[1, i] + x[2, i]


def test_an_unknown_processor_is_refused_with_the_list(monkeypatch):
    monkeypatch.setenv(machine.VARIABLE, "pentium")
    expected = f"STYLOBATE_CPU: unknown processor (got 'pentium'). Use one of {', '.join(machine.processors())}."
    with pytest.raises(ParameterError, match=re.escape(expected)):
        machine.native.__wrapped__()


@pytest.mark.skipif(not can_run("x86-64-v3"), reason="not a machine of x86-64 with FMA")
def test_a_processor_beyond_this_machine_is_refused_with_what_it_lacks(monkeypatch):
    from llvmlite import binding

    own = binding.get_host_cpu_features
    monkeypatch.setattr(binding, "get_host_cpu_features", lambda: type(own())({**own(), "fma": False}))
    assert machine.machine_of("x86-64-v2").vector_bits == 128
    for processor in ("x86-64-v3", "x86-64-v4"):
        with pytest.raises(ParameterError, match=rf"cannot run .*got '{processor}'.* lacks .*fma.*\. Use host or"):
            machine.machine_of(processor)


def test_an_empty_variable_is_the_machine_itself(monkeypatch):
    monkeypatch.setenv(machine.VARIABLE, "")
    assert machine.native.__wrapped__() == machine.machine_of(machine.HOST)


@pytest.mark.skipif(not can_run("x86-64-v3"), reason="not a machine of x86-64 with FMA")
def test_level_2_multiplies_and_adds_apart():
    assembly = {}
    for processor in ("x86-64-v2", "x86-64-v3"):
        target = machine.machine_of(processor)
        assembly[processor] = target.assembly(text_of(fused, X, X, lanes=target.lanes))
    assert FUSED.search(assembly["x86-64-v3"])
    assert not FUSED.search(assembly["x86-64-v2"])
    assert re.search(r"\bmulpd\b", assembly["x86-64-v2"])  # registers of 128 bits, in the old encoding


def test_each_processor_has_code_of_its_own_in_the_cache():
    described = [machine.machine_of(one).described() for one in machine.processors() if can_run(one)]
    assert len({*described}) == len(described)


RUNS = """
import json
import numpy as np
import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
runs = sb.simulate_ensemble(
    model,
    sb.Harmonic.circular(acceleration=0.09, angular_frequency=3.0),
    tilt=np.linspace(0.01, 0.05, 26).reshape(13, 2),
    duration=20.0,
)
print(runs["end_tilt"].values.tobytes().hex(), json.loads(runs.attrs["provenance"])["processor"], sep=";")
"""


@pytest.fixture(scope="module")
def results():
    """End tilts and stated arithmetic of an ensemble, by processor, each from a process of its own."""
    chosen = [one for one in (machine.HOST, "x86-64-v2", "x86-64-v3") if can_run(one)]
    started = {
        one: subprocess.Popen(
            [sys.executable, "-c", RUNS], env={**os.environ, machine.VARIABLE: one}, stdout=subprocess.PIPE, text=True
        )
        for one in chosen
    }
    return {one: process.communicate()[0].strip().split(";") for one, process in started.items()}


def test_results_depend_on_the_arithmetic_only(results):
    bits = {}
    for ends, arithmetic in results.values():
        bits.setdefault(arithmetic, set()).add(ends)
    assert [len(ends) for ends in bits.values()] == [1] * len(bits)


@pytest.mark.skipif(not can_run("x86-64-v3"), reason="not a machine of x86-64 with FMA")
def test_results_state_whether_products_are_fused(results):
    (apart, without), (fused_ends, with_fma) = results["x86-64-v2"], results["x86-64-v3"]
    assert (without, with_fma) == ("x86_64 without FMA", "x86_64 with FMA")
    assert apart != fused_ends
    ends = [np.frombuffer(bytes.fromhex(one)) for one in (apart, fused_ends)]
    np.testing.assert_allclose(*ends, rtol=0.0, atol=1e-9)  # the tolerance of the runs, grown tenfold at most
