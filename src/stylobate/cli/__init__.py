"""Command line: one module per command."""

from stylobate.cli.terminal import interrupted_by_signals

with interrupted_by_signals():
    from stylobate.cli.main import main

__all__ = ["main"]
