"""The program `stylobate`: its commands, and how mistakes are told."""

import sys
from collections.abc import Sequence
from typing import Annotated

import typer

from stylobate.cli.assess import assess
from stylobate.cli.basin import basin
from stylobate.cli.boundary import boundary
from stylobate.cli.drift import drift
from stylobate.cli.fragility import fragility
from stylobate.cli.ladder import ladder
from stylobate.cli.many_runs import INTERRUPTED
from stylobate.cli.map import overturning_map
from stylobate.cli.options import joined_ranges
from stylobate.cli.paper import paper
from stylobate.cli.response import response
from stylobate.cli.simulate import simulate
from stylobate.cli.spectrum import spectrum
from stylobate.errors import DescriptionError, StylobateError

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


for command in (paper, simulate, ladder, response, boundary):
    app.command()(command)
app.command("map")(overturning_map)
app.command()(basin)
app.command()(drift)
app.command()(assess)
app.command()(spectrum)
app.command()(fragility)


def main() -> None:
    """Run the command line and end the process; bad input ends with status 2 and one line for each mistake."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: Sequence[str]) -> int:
    """Run one command and return its exit status."""
    arguments = joined_ranges(arguments) or ["--help"]
    try:
        status = typer.main.get_command(app).main(arguments, prog_name="stylobate", standalone_mode=False)
    except _UsageError as error:
        return _tell([getattr(error, "format_message", error.__str__)()])
    except DescriptionError as error:
        return _tell(error.problems)
    except StylobateError as error:
        return _tell([str(error)])
    except (KeyboardInterrupt, typer.Abort):
        status = INTERRUPTED
    if status == INTERRUPTED:
        print("stylobate: interrupted", file=sys.stderr)
    return int(status or 0)


def _tell(problems: Sequence[str]) -> int:
    for problem in problems:
        print(f"stylobate: {problem}", file=sys.stderr)
    return _BAD_INPUT
