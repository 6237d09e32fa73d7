"""The program `stylobate`: find the command, run it, and report mistakes one per line."""

import difflib
import gc
import os
import shutil
import sys
import textwrap
import warnings
from collections.abc import Sequence
from functools import partial
from typing import Any

from stylobate.cli.commands import COMMANDS
from stylobate.cli.terminal import INTERRUPTED, NOT_READ, interrupted_by_signals, log_lines, remark
from stylobate.errors import ConfigError, EndedEarlyWarning, ModelError, StylobateError, UnlikelyInputWarning
from stylobate.text import printable

_BAD_INPUT = 2
_WIDEST = 80
_ABOUT = "Free-standing round columns on shaking bases: they stay, rock, roll round their rim, or overturn."
_EXAMPLES = (
    "Examples: stylobate paper; stylobate simulate --slenderness 0.1 --damping 0.1 --motion circular "
    "--acceleration 0.065 --angular-frequency 1.8 --tilt 0.04 0 --tilt-rate 0 0.07 --duration 200 --figure run.png"
)


def main() -> None:
    """Run the command line and end the process; bad input ends with status 2 and one line for each mistake."""
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "true")  # or pydantic searches all installed packages for them
    with interrupted_by_signals():
        try:
            status = run(sys.argv[1:])
            sys.stdout.flush()
        except KeyboardInterrupt:  # before or after the command itself
            status = INTERRUPTED
        except BrokenPipeError:  # the output is no longer read, as behind `| head`
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # for what Python writes at its end
            status = NOT_READ
    gc.freeze()  # or Python searches all objects once more before it ends, for several tenths of a second
    sys.exit(status)


def run(arguments: Sequence[str]) -> int:
    """Run one command and return its exit status."""
    with warnings.catch_warnings():
        for kind in (UnlikelyInputWarning, EndedEarlyWarning):
            warnings.simplefilter("always", kind)
        warnings.showwarning = partial(_show_warning, set())
        with log_lines():
            return _run(arguments)


def _show_warning(shown: set[str], message: Warning | str, *rest: Any, **more: Any) -> None:
    del rest, more
    # A number is checked in each constructor that it passes, and one that varies in each run.
    about, unlikely, _ = str(message).partition(" is unlikely")
    key = about.partition(":")[0] if unlikely else about
    if key not in shown:
        shown.add(key)
        remark(f"warning: {message}")


def _run(arguments: Sequence[str]) -> int:
    if any("\0" in argument for argument in arguments):
        return _report(["the command line: an argument holds a NUL character. Remove it."])
    name, *rest = arguments or ("--help",)
    if name == "--help":
        print(_help())
        return 0
    if name == "--version":
        from stylobate import __version__

        print(f"stylobate {__version__}")
        return 0
    if name not in COMMANDS:
        return _report([_unknown(name)])
    return _run_command(name, rest)


def _run_command(name: str, arguments: Sequence[str]) -> int:
    import click

    from stylobate.cli.command import usage_error

    program = None
    try:
        program = COMMANDS[name].load().program(name, arguments)
        with program.make_context(f"stylobate {name}", list(arguments)) as context:
            program.invoke(context)
        status = 0
    except click.exceptions.Exit as ended:
        status = ended.exit_code
    except click.ClickException as error:
        return _report([usage_error(error, program)])
    except (ConfigError, ModelError) as error:
        return _report(error.problems)
    except StylobateError as error:
        return _report([str(error)])
    except BrokenPipeError:
        raise
    except OSError as error:  # a file name that the system rejects, or a disk failure
        reason = error.strerror or str(error)
        return _report(
            [f"{error.filename}: cannot be used ({reason}). Name another one." if error.filename else reason]
        )
    except (KeyboardInterrupt, click.Abort):
        status = INTERRUPTED
    if status == INTERRUPTED:
        remark("interrupted")
    return int(status or 0)


def _report(problems: Sequence[str]) -> int:
    for problem in problems:
        remark(printable(problem).replace("\n", "\\n"))  # names may contain line ends
    return _BAD_INPUT


def _unknown(name: str) -> str:
    if name.startswith("-"):
        return f"No such option: {name}. Write the command before its options: stylobate COMMAND {name} …"
    similar = difflib.get_close_matches(name, COMMANDS, n=1)
    return f"No such command {name!r}. {f'Did you mean {similar[0]}?' if similar else 'See stylobate --help.'}"


def _help() -> str:
    width = min(_WIDEST, shutil.get_terminal_size().columns) - 2
    first = max(map(len, COMMANDS)) + 4

    def wrapped(text: str) -> str:
        return textwrap.fill(text, width, initial_indent="  ", subsequent_indent="  ")

    rows = [
        textwrap.fill(entry.summary, width, initial_indent=f"  {name}".ljust(first), subsequent_indent=" " * first)
        for name, entry in COMMANDS.items()
    ]
    options = ["  --version  Print the version.", "  --help     Show this message and exit."]
    return "\n".join(
        [
            *("Usage: stylobate [OPTIONS] COMMAND [ARGS]...", "", wrapped(_ABOUT), ""),
            *("Options:", *options, "", "Commands:", *rows, "", wrapped(_EXAMPLES)),
        ]
    )
