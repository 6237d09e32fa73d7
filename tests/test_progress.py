"""A bar appears by default where a computation takes long and somebody looks, and nowhere else."""

import inspect
import os
import subprocess
import sys
import threading
import time
from importlib import import_module
from types import ModuleType, SimpleNamespace

import numpy as np
import pytest

import stylobate as sb
from stylobate import progress
from stylobate.errors import ParameterError
from stylobate.progress import News, counted, shows_progress, silent

MODEL = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
LINE = sb.Harmonic.straight(acceleration=0.15, angular_frequency=2.0)
RUNS = {"duration": 5.0, "parameters": {"acceleration": np.linspace(0.1, 0.2, 40)}, "threads": 1}
OVER = {"acceleration": np.linspace(0.1, 0.2, 5), "angular_frequency": [1.0, 2.0]}
ROOMS = ("", ".studies", ".orbits", ".earthquakes", ".conveying", ".paper", ".engine")


class Look:
    """A bar that keeps what it is told."""

    seen: list[News]
    opened = closed = 0

    def __init__(self, news):
        type(self).opened += 1
        type(self).seen = [news]

    def update(self, news):
        self.seen.append(news)

    def close(self):
        type(self).closed += 1


@pytest.fixture
def look(monkeypatch):
    """A terminal on which each bar is due at once."""

    class Here(Look):
        pass

    monkeypatch.setattr(progress, "DUE", 0.0)
    monkeypatch.setattr(progress, "_place", lambda: "terminal")
    monkeypatch.setattr(progress, "_OnTerminal", Here)
    return Here


def functions_with_progress():
    for room in ROOMS:
        module = import_module(f"stylobate{room}")
        for name in module.__all__:
            one = getattr(module, name)
            owners = [one, *vars(one).values()] if inspect.isclass(one) else [one]
            for function in owners:
                if name in ("Dask", "Threads"):  # executors report to the study
                    continue
                if inspect.isfunction(function) and "progress" in inspect.signature(function).parameters:
                    yield f"{room}.{name}.{function.__name__}", function


def test_every_public_function_with_progress_shows_it_by_default():
    found = dict(functions_with_progress())
    assert len(found) > 25
    assert not [name for name, function in found.items() if not hasattr(function, "__wrapped__")]
    defaults = {inspect.signature(function).parameters["progress"].default for function in found.values()}
    assert defaults == {None}


def test_a_bar_counts_all_runs_and_is_removed(look):
    sb.simulate_ensemble(MODEL, LINE, **RUNS)
    assert look.seen[-1] == News("runs", "40/40", 40, 40)
    assert [news.done for news in look.seen] == sorted(news.done for news in look.seen)
    assert look.opened == look.closed == 1


@pytest.mark.parametrize("given", [False, silent])
def test_false_or_a_function_shows_no_bar_also_not_of_what_is_called(look, given):
    sb.studies.overturning_map(MODEL, LINE, over=OVER, periods=2.0, progress=given)
    assert not look.opened


def test_only_the_outermost_function_shows_a_bar(look):
    sb.studies.overturning_map(MODEL, LINE, over=OVER, periods=2.0)
    assert look.opened == look.closed == 1
    assert {news.what for news in look.seen} == {"map"}


def test_a_bar_is_removed_after_an_error_and_the_next_one_shows(look):
    @shows_progress("work")
    def work(*, fail, progress=None):
        progress(1, 2)
        if fail:
            raise RuntimeError

    with pytest.raises(RuntimeError):
        work(fail=True)
    work(fail=False)
    assert look.opened == look.closed == 2


def test_no_bar_before_it_is_due(look, monkeypatch):
    monkeypatch.setattr(progress, "DUE", 60.0)
    sb.simulate_ensemble(MODEL, LINE, **RUNS)
    assert not look.opened


def test_a_bar_is_due_also_before_the_first_report(look):
    @shows_progress("work")
    def work(*, progress=None):
        del progress
        beat()

    beat = progress.beat
    work()
    assert look.seen[-1] == News("work", "", 0, None)


def test_a_bar_appears_on_a_terminal_while_nothing_is_reported(look):
    @shows_progress("work")
    def work(*, progress=None):
        del progress
        end = time.monotonic() + 10.0
        while not look.opened and time.monotonic() < end:
            time.sleep(0.01)
        assert look.opened

    work()
    assert look.closed == 1


def test_other_threads_show_no_bar_and_call_a_function(look):
    told = []
    one = threading.Thread(target=sb.simulate_ensemble, args=(MODEL, LINE), kwargs=RUNS)
    other = threading.Thread(
        target=sb.simulate_ensemble,
        args=(MODEL, LINE),
        kwargs={**RUNS, "progress": lambda *news: told.append(counted(*news))},
    )
    for thread in (one, other):
        thread.start()
        thread.join()
    assert not look.opened
    assert told[-1].done == 40


@pytest.mark.parametrize("bad", ["yes", 1, 0.5])
def test_what_is_no_function_is_refused(bad):
    with pytest.raises(ParameterError, match=r"^progress: no function"):
        sb.simulate_ensemble(MODEL, LINE, duration=1.0, progress=bad)


def test_in_a_notebook_a_bar_is_text_that_is_replaced_and_removed(monkeypatch):
    shown = []
    kernel = SimpleNamespace(kernel=object())
    handle = SimpleNamespace(update=lambda data, raw: shown.append(data["text/plain"]))
    python, display = ModuleType("IPython"), ModuleType("IPython.display")
    python.get_ipython, python.display = lambda: kernel, display
    display.display = lambda data, raw, display_id: handle
    monkeypatch.setitem(sys.modules, "IPython", python)
    monkeypatch.setitem(sys.modules, "IPython.display", display)
    monkeypatch.setattr(progress, "DUE", 0.0)
    monkeypatch.setattr(progress, "_PAUSE", 0.0)
    sb.simulate_ensemble(MODEL, LINE, **RUNS)
    assert shown[-2].startswith("runs ━━━━")
    assert "40/40" in shown[-2]
    assert not any("\x1b" in text or "\n" in text for text in shown)
    assert shown[-1] == ""


SCRIPT = """
import sys, time
import numpy as np
from stylobate import progress
import stylobate as sb
progress.DUE = {due}
model = sb.Slender(sb.Column.dimensionless(slenderness=0.1), damping=0.1)
line = sb.Harmonic.straight(acceleration=0.15, angular_frequency=2.0)
sb.simulate_ensemble(model, line, duration=5.0, parameters={{"acceleration": np.linspace(0.1, 0.2, 40)}}{more})
print("rich" in sys.modules)
"""


def on_terminal(due, more=""):
    """Run the script with stderr on a terminal; return its output, and what the terminal received."""
    import pty

    ours, theirs = pty.openpty()
    code = SCRIPT.format(due=due, more=more)
    environment = {**os.environ, "TERM": "xterm", "COLUMNS": "80"}
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=theirs, text=True, env=environment
    ) as process:
        os.close(theirs)
        received = b""
        while True:
            try:
                part = os.read(ours, 4096)
            except OSError:  # the other end is closed
                break
            if not part:
                break
            received += part
        printed = process.stdout.read()
    os.close(ours)
    assert process.returncode == 0
    return printed, received.decode()


@pytest.mark.slow
@pytest.mark.posix
def test_on_a_terminal_a_bar_is_drawn_and_erased_and_stdout_stays_free():
    printed, received = on_terminal(due=0.0)
    assert printed == "True\n"
    assert "runs" in received
    assert received.rstrip().endswith("\x1b[2K")  # the line is erased


@pytest.mark.slow
@pytest.mark.posix
@pytest.mark.parametrize(("due", "more"), [(60.0, ""), (0.0, ", progress=False")])
def test_a_short_or_silent_computation_imports_no_rich_and_draws_nothing(due, more):
    printed, received = on_terminal(due, more)
    assert printed == "False\n"
    assert "━" not in received


@pytest.mark.slow
def test_without_a_terminal_nothing_is_drawn():
    code = SCRIPT.format(due=0.0, more="")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"
    assert "━" not in done.stderr


def test_the_default_takes_no_time_that_counts(slowness):
    @shows_progress("nothing")
    def nothing(*, progress=None):
        del progress

    since = time.perf_counter()
    for _ in range(1000):
        nothing()
    # A few microseconds beside the milliseconds of the shortest ensemble.
    assert (time.perf_counter() - since) / 1000 < 100e-6 * slowness()
