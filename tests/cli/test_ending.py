"""A request to end reaches a command as Ctrl-C does, so that what is done is kept."""

import gc
import importlib
import os
import signal
import subprocess
import sys

import pytest

cli = importlib.import_module("stylobate.cli.main")  # the package has a function of this name


def test_a_request_to_end_interrupts_the_command(monkeypatch):
    before = signal.getsignal(signal.SIGTERM)
    monkeypatch.setattr(cli, "run", lambda _: signal.raise_signal(signal.SIGTERM))
    try:
        with pytest.raises(SystemExit) as ended:
            cli.main()
        assert ended.value.code == cli.INTERRUPTED
        # Python searches no objects again, which takes several tenths of a second.
        assert gc.get_freeze_count() > 0
    finally:
        gc.unfreeze()
        signal.signal(signal.SIGTERM, before)


@pytest.mark.posix
@pytest.mark.parametrize("arguments", [["--version"], ["simulate", "--help"]])
def test_a_command_ends_silently_when_nobody_reads_its_output(arguments):
    read, write = os.pipe()
    os.close(read)
    ended = subprocess.run(
        [sys.executable, "-m", "stylobate", *arguments], stdout=write, stderr=subprocess.PIPE, check=False
    )
    os.close(write)
    assert (ended.returncode, ended.stderr) == (128 + signal.SIGPIPE, b"")
