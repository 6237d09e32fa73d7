"""Ctrl-C before there is any result: one line, status 130, and no file."""

import os
import signal
import subprocess
import sys

import pytest

from stylobate.cli.main import run
from stylobate.cli.terminal import INTERRUPTED, interrupted_by_signals

SLOW_MODULE = """
import os, signal
try:
    os.kill(os.getpid(), signal.SIGINT)
    for _ in range(1000): pass
except BaseException:
    pass
"""


def test_ctrl_c_during_an_import_that_would_swallow_it_ends_the_program(tmp_path):
    (tmp_path / "swallowing.py").write_text(SLOW_MODULE, encoding="utf-8")
    program = "from stylobate.cli.terminal import interrupted_by_signals as ends\nwith ends(): import swallowing\n"
    paths = os.pathsep.join([str(tmp_path), *sys.path])
    ended = subprocess.run(
        [sys.executable, "-c", program + "print('went on')"],
        env={**os.environ, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (INTERRUPTED, "", "stylobate: interrupted\n")


def test_ctrl_c_at_other_times_is_an_exception_and_the_handler_is_put_back():
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(KeyboardInterrupt), interrupted_by_signals():
        signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is before


def test_before_any_run_is_done_no_file_is_written(tmp_path, capsys, monkeypatch):
    def stop(*arguments, **options):
        del arguments, options
        raise KeyboardInterrupt

    monkeypatch.setattr("stylobate.studies.sweeps.chunks.simulate_ensemble", stop)
    path = tmp_path / "map.nc"
    options = "--slenderness 0.1 --motion circular --x angular-frequency 1 2 3 --y acceleration 0.1 0.2 3 --periods 5"
    assert run(["map", *options.split(), "--output", str(path)]) == INTERRUPTED
    assert capsys.readouterr().err == "stylobate: no run is complete, and nothing is written\nstylobate: interrupted\n"
    assert not list(tmp_path.iterdir())
