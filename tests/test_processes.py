"""Worker processes answer, end with the process that started them, and are ended by it."""

import functools
import math
import operator
import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import closing
from pathlib import Path

import pytest

from stylobate.engine.ensemble import run_parts
from stylobate.errors import WorkerLostError
from stylobate.processes import Worker, computed, ending_with_parent

# Longer than any test is left to run.
FOREVER = 600.0


@pytest.fixture
def started(monkeypatch):
    """The workers that are started."""
    workers, start = [], Worker.started

    def note(**options):
        workers.append(start(**options))
        return workers[-1]

    monkeypatch.setattr(Worker, "started", note)
    return workers


def test_more_tasks_than_workers_are_computed_each_with_its_key(started):
    tasks = {n: functools.partial(math.factorial, n) for n in range(7)}
    assert dict(computed(tasks, workers=2)) == {n: math.factorial(n) for n in range(7)}
    assert len(started) == 2
    assert all(worker.process.poll() is not None for worker in started)


def test_no_tasks_need_no_process(started):
    assert list(computed({}, workers=2)) == []
    assert started == []


def test_what_a_task_raises_is_raised_with_its_traceback():
    with pytest.raises(ZeroDivisionError) as caught:
        dict(computed({"a": functools.partial(operator.truediv, 1, 0)}, workers=1))
    assert any("Traceback" in note for note in caught.value.__notes__)


def test_what_a_task_prints_is_no_answer():
    assert dict(computed({"a": functools.partial(print, "spoken")}, workers=1)) == {"a": None}


def test_a_worker_that_dies_is_named_with_its_status(started):
    with pytest.raises(WorkerLostError, match=r"got exit status 7\)\. .* fewer workers"):
        dict(computed({"a": functools.partial(os._exit, 7), "b": functools.partial(time.sleep, FOREVER)}, workers=2))
    assert all(worker.process.poll() is not None for worker in started)


@pytest.mark.posix
def test_closing_ends_workers_in_the_middle_of_their_tasks(started):
    tasks = {"short": functools.partial(abs, -1), "long": functools.partial(time.sleep, FOREVER)}
    with closing(computed(tasks, workers=2)) as results:
        assert next(results) == ("short", 1)
    assert [worker.process.poll() for worker in started] == [-signal.SIGKILL] * 2


@pytest.mark.posix
def test_an_interrupted_ensemble_waits_for_no_worker(started):
    ends = []

    def compute(part, _):
        if part.start == 0:
            return
        try:
            Worker.started().call(time.sleep, 30.0)
        except KeyboardInterrupt:
            ends.append("interrupted")

    def done(_):
        until(lambda: started)
        raise KeyboardInterrupt

    assert not run_parts([slice(0, 1), slice(1, 2)], compute, 2, done)
    assert ends == ["interrupted"]
    assert started[0].process.wait() == -signal.SIGKILL
    started[0].end()


PARENT = """
import functools, sys
from stylobate.processes import computed
hold = "import ctypes, pathlib, os; pathlib.Path({place!r}).write_text(str(os.getpid())); ctypes.PyDLL(None).sleep(600)"
dict(computed({{"a": functools.partial(exec, hold)}}, workers=1))
"""


def until(condition):
    """Wait for a condition; the limit is that of a test that hangs."""
    end = time.monotonic() + 120.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.01)


def runs(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the states of processes from /proc")
@pytest.mark.parametrize("end", ["SIGKILL", "SIGTERM", "SIGINT"])
def test_a_worker_that_holds_pythons_lock_ends_with_its_parent(tmp_path, end):
    place = tmp_path / "pid"
    parent = subprocess.Popen([sys.executable, "-c", PARENT.format(place=str(place))], stderr=subprocess.DEVNULL)
    until(lambda: place.exists() and place.read_text())
    worker = int(place.read_text())
    assert runs(worker)
    parent.send_signal(signal.Signals[end])
    parent.wait(60.0)
    until(lambda: not runs(worker))


IMPORTED = """
import os, pathlib, time
pathlib.Path({place!r}).write_text(str(os.getpid()))
time.sleep(600)
"""
IMPORTING = """
import sys
from stylobate.processes import Worker
class Task:
    def __reduce__(self):
        return __import__, ("imported",)
sys.path.insert(0, {folder!r})
Worker.started().call(Task())
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the states of processes from /proc")
def test_a_worker_that_imports_its_task_ends_with_its_parent(tmp_path):
    place = tmp_path / "pid"
    (tmp_path / "imported.py").write_text(IMPORTED.format(place=str(place)), encoding="utf-8")
    program = IMPORTING.format(folder=str(tmp_path))
    parent = subprocess.Popen([sys.executable, "-c", program], stderr=subprocess.DEVNULL)
    until(lambda: place.exists() and place.read_text())
    worker = int(place.read_text())
    assert runs(worker)
    parent.kill()
    parent.wait(60.0)
    until(lambda: not runs(worker))


CHILD = """
import os, pathlib, time
from stylobate.processes import ending_with_parent
with ending_with_parent():
    pathlib.Path({place!r}).write_text(str(os.getpid()))
    time.sleep(600)
"""


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the states of processes from /proc")
def test_a_process_that_watches_its_parent_ends_with_it(tmp_path):
    place = tmp_path / "pid"
    program = f"import subprocess, sys; subprocess.run([sys.executable, '-c', {CHILD.format(place=str(place))!r}])"
    parent = subprocess.Popen([sys.executable, "-c", program])
    until(lambda: place.exists() and place.read_text())
    child = int(place.read_text())
    assert runs(child)
    parent.kill()
    parent.wait(60.0)
    until(lambda: not runs(child))


def test_no_thread_outlives_the_watch_over_the_parent():
    before = threading.active_count()
    with ending_with_parent():
        assert threading.active_count() == before + 1
    assert threading.active_count() == before
