"""A request to end reaches a command as Ctrl-C does, so that what is done is kept."""

import importlib
import signal

import pytest

cli = importlib.import_module("stylobate.cli.main")  # the package has a function of this name


def test_a_request_to_end_interrupts_the_command(monkeypatch):
    before = signal.getsignal(signal.SIGTERM)
    monkeypatch.setattr(cli, "run", lambda _: signal.raise_signal(signal.SIGTERM))
    try:
        with pytest.raises(SystemExit) as ended:
            cli.main()
        assert ended.value.code == cli.INTERRUPTED
    finally:
        signal.signal(signal.SIGTERM, before)
