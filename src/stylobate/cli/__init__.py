"""The command line: one file a command."""

from stylobate.cli.main import main

__all__ = ["main"]
