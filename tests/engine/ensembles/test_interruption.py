"""Ctrl-C in the middle of many runs: what had been computed is kept, and it ends at once."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import stylobate as sb
from stylobate.engine import ensemble
from stylobate.errors import Interrupted

CIRCLE = sb.Harmonic.circular(acceleration=0.1, angular_frequency=2.0)


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize("after", [1, 4])
def test_what_had_been_computed_is_kept_and_nothing_else_told(mixed_runs, monkeypatch, threads, after):
    monkeypatch.setattr(ensemble, "_FEWEST", 50)
    monkeypatch.setattr(ensemble, "_MOST", 50)
    runs = mixed_runs(CIRCLE, 400, seed=8)
    whole = runs.together()
    seen = []

    def progress(done, total):
        seen.append((done, total))
        if len(seen) == after:
            raise KeyboardInterrupt

    with pytest.raises(Interrupted) as caught:
        runs.together(progress=progress, threads=threads)
    partial = caught.value.partial
    computed = partial["outcome"].to_numpy() != -1
    assert seen == [(50 * (k + 1), 400) for k in range(after)]
    assert 50 * after <= computed.sum() < 400
    for name, variable in partial.data_vars.items():
        np.testing.assert_array_equal(variable[computed], whole[name][computed])
        if variable.dtype.kind == "f":
            assert np.isnan(variable[~computed]).all()
    np.testing.assert_array_equal(partial["damping"], whole["damping"])
    assert isinstance(caught.value, KeyboardInterrupt)


def test_progress_counts_all_runs_to_the_end(mixed_runs, monkeypatch):
    monkeypatch.setattr(ensemble, "_FEWEST", 7)
    monkeypatch.setattr(ensemble, "_MOST", 7)
    seen = []
    mixed_runs(CIRCLE, 40, seed=8).together(progress=lambda done, total: seen.append((done, total)), threads=2)
    assert [done for done, _ in seen] == sorted({done for done, _ in seen})
    assert seen[-1] == (40, 40)
    assert len(seen) == 6


def test_what_progress_raises_comes_out(mixed_runs):
    def progress(done, total):
        raise RuntimeError(total)

    with pytest.raises(RuntimeError, match="40"):
        mixed_runs(CIRCLE, 40, seed=8).together(progress=progress)


SCRIPT = """
import sys, time
import numpy as np
import stylobate as sb
from stylobate.errors import Interrupted

model = sb.Slender(sb.Column.dimensionless(0.1), damping=0.1)
circle = sb.Harmonic.circular(acceleration=0.065, angular_frequency=3.0)
start = sb.studies.steady_start(model, circle)
sb.simulate_ensemble(model, circle, **start, duration=1.0)
duration = np.full(6000, 1e9)
duration[:300] = 1.0
try:
    print("begun", flush=True)
    sb.simulate_ensemble(model, circle, **start, duration=duration, max_steps=2_000_000_000, threads=2)
except Interrupted as interrupted:
    print(int((interrupted.partial["outcome"] != -1).sum()), flush=True)
    print(time.process_time(), flush=True)
"""


def processor_time(process):
    """Return the processor time of a process [s], from Linux."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads /proc")
def test_a_real_interrupt_ends_within_two_seconds():
    with subprocess.Popen([sys.executable, "-c", SCRIPT], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline().strip() == "begun"
        begun = before = processor_time(process.pid)
        while before < begun + 0.5:  # the short runs take a few milliseconds
            time.sleep(0.02)
            before = processor_time(process.pid)
        os.kill(process.pid, signal.SIGINT)
        kept, after = (float(process.stdout.readline()) for _ in range(2))
        process.wait(timeout=60.0)
    # Two threads for two seconds.
    assert after - before < 4.0
    # The short runs were done, those of a thousand million periods were not.
    assert kept == 300
    assert process.returncode == 0
