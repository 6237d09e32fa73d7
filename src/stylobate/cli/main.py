"""The program `stylobate`: its commands, and how mistakes are told."""

import sys
import warnings
from collections.abc import Sequence
from typing import Annotated, Any

import typer

from stylobate.cli.assess import assess
from stylobate.cli.basin import basin
from stylobate.cli.boundary import boundary
from stylobate.cli.drift import drift
from stylobate.cli.fragility import fragility
from stylobate.cli.given import with_values
from stylobate.cli.hierarchy import model_hierarchy
from stylobate.cli.interrupts import INTERRUPTED, interrupted_by_signals
from stylobate.cli.lab import lab
from stylobate.cli.map import overturning_map
from stylobate.cli.options import joined_ranges
from stylobate.cli.paper import paper
from stylobate.cli.progress import log_lines
from stylobate.cli.records import records
from stylobate.cli.response import response
from stylobate.cli.simulate import simulate
from stylobate.cli.spectrum import spectrum
from stylobate.cli.usage import told
from stylobate.errors import ConfigError, ModelError, StylobateError, UnlikelyInputWarning

_BAD_INPUT = 2

# The class of all mistakes on a command line; typer gives it no public name of its own.
_UsageError: type[Exception] = typer.BadParameter.__mro__[1]

app = typer.Typer(
    name="stylobate",
    help="Free-standing round columns on shaking bases: they stay, rock, roll round their rim, or overturn.",
    epilog="Examples: stylobate paper; stylobate simulate --slenderness 0.1 --damping 0.1 --motion circular "
    "--acceleration 0.065 --angular-frequency 1.8 --tilt 0.04 0 --tilt-rate 0 0.07 --duration 200 --figure run.png",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
)


def _show_version(wanted: bool) -> None:
    if wanted:
        from stylobate import __version__  # noqa: PLC0415  read from the installed package only when asked for

        print(f"stylobate {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool, typer.Option("--version", help="Print the version.", callback=_show_version, is_eager=True)
    ] = False,
) -> None:
    del version


for command in (paper, simulate, model_hierarchy, response, boundary):
    app.command()(with_values(command))
app.command("map")(with_values(overturning_map))
for command in (basin, drift, records, assess, spectrum, fragility, lab):
    app.command()(with_values(command))


def main() -> None:
    """Run the command line and end the process; bad input ends with status 2 and one line for each mistake."""
    with interrupted_by_signals():
        try:
            status = run(sys.argv[1:])
        except KeyboardInterrupt:  # before or after the command itself
            status = INTERRUPTED
    sys.exit(status)


def run(arguments: Sequence[str]) -> int:
    """Run one command and return its exit status."""
    with warnings.catch_warnings():
        warnings.simplefilter("always", UnlikelyInputWarning)
        warnings.showwarning = _show_warning
        with log_lines():
            return _run(joined_ranges(arguments) or ["--help"])


def _show_warning(message: Warning | str, *rest: Any, **more: Any) -> None:
    del rest, more
    print(f"stylobate: warning: {message}", file=sys.stderr)


def _run(arguments: Sequence[str]) -> int:
    if any("\0" in argument for argument in arguments):
        return _tell(["the command line: an argument holds a NUL character. Remove it."])
    program = typer.main.get_command(app)
    try:
        status = program.main(arguments, prog_name="stylobate", standalone_mode=False)
    except _UsageError as error:
        return _tell([told(error, program)])
    except (ConfigError, ModelError) as error:
        return _tell(error.problems)
    except StylobateError as error:
        return _tell([str(error)])
    except OSError as error:  # a name that no system accepts, or a disk that fails
        reason = error.strerror or str(error)
        return _tell([f"{error.filename}: cannot be used ({reason}). Name another one." if error.filename else reason])
    except (KeyboardInterrupt, typer.Abort):
        status = INTERRUPTED
    if status == INTERRUPTED:
        print("stylobate: interrupted", file=sys.stderr)
    return int(status or 0)


def _tell(problems: Sequence[str]) -> int:
    for problem in problems:
        line = problem.replace("\n", "\\n")  # of a name that holds one
        print(f"stylobate: {line}", file=sys.stderr)
    return _BAD_INPUT
