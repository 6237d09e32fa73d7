"""Kernels on disk: compiled once with a word about it, read by every later process, kept apart by what they say."""

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import stylobate as sb
from stylobate.base_motions import BaseMotion
from stylobate.compiler.kept import PLAIN_VARIABLE, cache_folder
from stylobate.compiler.machine import Machine, arithmetic
from stylobate.engine.kernel import bound, kernels

CIRCLE = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
START = {"tilt": (0.04, 0.0), "tilt_rate": (0.0, 0.07), "duration": 20.0}

SCRIPT = """
import json, time
import stylobate as sb

model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=1.8)
begun = time.perf_counter()
data = sb.simulate_ensemble(model, circle, tilt=(0.04, 0.0), tilt_rate=(0.0, 0.07), duration=20.0)
took = time.perf_counter() - begun
print(json.dumps({
    "took": took,
    "end": data["end_tilt"].values.tobytes().hex(),
}))
"""


def run(script, folder):
    return subprocess.run(
        [sys.executable, "-c", script],
        env={**os.environ, "STYLOBATE_CACHE": str(folder)},
        capture_output=True,
        text=True,
        check=True,
    )


@pytest.fixture
def nothing_loaded():
    """No kernel is in memory, as in a new process."""
    kernels._kernel.cache_clear()
    yield
    kernels._kernel.cache_clear()


@pytest.mark.usefixtures("nothing_loaded")
def test_a_second_process_compiles_nothing_and_computes_the_same_bits(tmp_path, monkeypatch, capsys):
    first = run(SCRIPT, tmp_path)
    assert "compiling slender, space motion" in first.stderr
    assert str(tmp_path) in first.stderr
    assert len(first.stderr.splitlines()) == 1
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path))
    monkeypatch.delattr(Machine, "object_code")
    exec(SCRIPT, {})  # noqa: S102
    one, two = json.loads(first.stdout), json.loads(capsys.readouterr().out)
    assert two["took"] < one["took"]
    assert one["end"] == two["end"]
    assert sorted(path.name.partition("__")[0].partition("_")[0] for path in tmp_path.glob("*.code")) == [
        "last",
        "slender",
    ]


@pytest.mark.slow
def test_of_two_processes_that_need_a_kernel_one_compiles_it(tmp_path):
    with ThreadPoolExecutor() as pool:
        both = list(pool.map(lambda _: run(SCRIPT, tmp_path), range(2)))
    assert sum("compiling" in one.stderr for one in both) == 1
    assert json.loads(both[0].stdout)["end"] == json.loads(both[1].stdout)["end"]


def test_the_folder_is_that_of_the_variable_or_of_the_users_caches(tmp_path, monkeypatch):
    monkeypatch.setenv("STYLOBATE_CACHE", str(tmp_path))
    assert cache_folder() == tmp_path
    monkeypatch.delenv("STYLOBATE_CACHE")
    assert cache_folder().name == "stylobate"
    assert cache_folder().is_absolute()


def of_all_kinds():
    """Return results of runs that release, rock in a plane, rest and overturn, an array each."""
    model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.3)
    line = sb.Harmonic.straight(acceleration=0.13, angular_frequency=3.0)
    circle = sb.Harmonic.circular(acceleration=0.13, angular_frequency=2.0)
    found = []
    for motion, energy, tilt, rate in (
        (circle, None, [(0.04, 0.0), (0.0, 0.0), (0.09, 0.0)], [(0.0, 0.07), (0.0, 0.0), (0.04, 0.0)]),
        (line, None, [(0.02, 0.0), (0.0, 0.0), (0.02, 0.01)], (0.0, 0.0)),
        (circle.scaled(0.1), 0.09, [(0.01, 0.0), (0.01, 0.003)], (0.0, 0.0)),
    ):
        options = {"duration": 6.0, "rtol": 1e-9, "samples": 3, "rest_energy": energy}
        data = sb.simulate_ensemble(model, motion, tilt=tilt, tilt_rate=rate, **options)
        names = ("outcome", "decided_at", "uplifts", "end_tilt", "peak_tilt", "turns", "sampled_tilt")
        found += [np.nan_to_num(data[name].values, nan=-1.0).ravel() for name in names]
    return found


def test_the_same_code_runs_as_plain_python(monkeypatch):
    compiled = of_all_kinds()
    monkeypatch.setenv(PLAIN_VARIABLE, "1")
    plain = of_all_kinds()
    assert len(plain) == len(compiled) == 21
    for index, (one, other) in enumerate(zip(plain, compiled, strict=True)):
        # Products and sums of plain Python are rounded apart: to a few tolerances. When a column came to rest, and how
        # far round it had got, is read off cubics within a step, to their error.
        np.testing.assert_allclose(one, other, rtol=0.0, atol=1e-5 if index in {15, 19} else 2e-7)
    differ = any(np.any(one != other) for one, other in zip(plain, compiled, strict=True))
    assert differ is arithmetic().endswith("with FMA")
    outcomes = {int(code) for values in plain[::7] for code in values}
    assert len(outcomes) >= 3


class Burst(BaseMotion):
    """A motion of one's own."""

    breaks, highest_frequency = (0.7,), 4.0

    def derivative(self, time, order):
        t = np.asarray(time, dtype=float)
        envelope = np.where(t < 0.7, 0.0, np.exp(-(((t - 3.0) / 4.0) ** 2)))
        wave = 0.08 * np.cos(2.0 * t), 0.04 * np.sin(3.3 * t), 0.03 * np.cos(4.0 * t)
        return tuple((order == 2) * envelope * part for part in wave)

    def peak_horizontal(self, since=0.0):
        return 0.09

    def vertical_range(self, since=0.0):
        return -0.03, 0.03

    def directions(self):
        return (0.08, 0.0), (0.0, 0.04)


def test_sums_of_waves_and_motions_of_ones_own_move_lanes_of_plain_python_as_single_runs(monkeypatch):
    model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
    one = sb.Harmonic.elliptic(amplitude=(0.06, 0.03), phase=1.0, angular_frequency=2.0, start_phase=0.4)
    two = one + sb.Harmonic.straight(acceleration=0.03, angular_frequency=3.1, direction=1.0)
    start = {"tilt": (0.04, 0.01), "tilt_rate": (-0.01, 0.03), "duration": 4.0, "rtol": 1e-9}
    changes = {"rotation": [0.0, 0.9, -2.0], "scale": [1.0, 1.4, -0.8], "delay": [0.0, 0.63, -0.4]}
    off = []
    for motion, values in ((two, {}), (two.rotated(-0.4).scaled(0.7), {}), (Burst(), changes)):
        with monkeypatch.context() as patch:
            patch.setenv(PLAIN_VARIABLE, "1")
            data = sb.simulate_ensemble(model, motion, **start, parameters=values)
        for index in range(data.sizes["run"]):
            _, moved = sb.with_parameters(model, motion, **{name: many[index] for name, many in values.items()})
            single = sb.simulate(model, moved, **start)
            off.append(float(np.abs(data["end_tilt"].values[index] - single.data["tilt"].values[-1]).max()))
    assert len(off) == 5
    assert max(off) < 1e-7


def test_the_kernels_that_one_model_needs_are_described_in_different_words(monkeypatch):
    words = []

    class Unseen(sb.Slender):
        """In memory there is no kernel of it."""

    class FoundError(Exception):
        pass

    def found(*, description, **__):
        words.append(description)
        raise FoundError

    monkeypatch.setattr(kernels, "Compiled", found)
    model = Unseen(sb.Column.dimensionless(0.1), damping=0.1)
    for options in ({}, {"demands": True}, {"method": "taylor"}):
        with pytest.raises(FoundError):
            sb.simulate_ensemble(model, CIRCLE, **START, **options)
    assert len(set(words)) == len(words) == 3


def test_every_name_that_the_driver_leaves_open_is_bound_by_some_kernel(plan_of):
    column = sb.Column.dimensionless(0.1)
    # Of the driver itself, of the written part, and of models of a user's own.
    given = {"begin", "handle", "expand", "at_rest"}
    for model, options, planar in (
        (sb.Slender(column), {"method": "taylor"}, False),
        (sb.Wobbling(column), {"demands": True}, True),
        (sb.Sliding(column), {}, False),
    ):
        compiled = kernels.kernel_of(type(model), plan_of(model, CIRCLE, **options).shape(planar=planar)).compiled
        given |= {*compiled.program().names, *compiled.functions}
    assert set(bound.__annotations__) == given
