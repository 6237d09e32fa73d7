"""A command reads the values that the parser hands over, in every version of the library that parses."""

from pathlib import Path

from stylobate.cli.command import command
from stylobate.cli.options import Options
from stylobate.config.options import Option


def test_values_are_those_that_the_command_gets_whatever_the_context_holds():
    read = {}

    @command(Option("output", type=Path), Option("number", type=int, default=3))
    def write(options: Options) -> None:
        read.update(options)

    write.program("write").main(["--output", "a.nc"], standalone_mode=False)
    assert read == {"output": Path("a.nc"), "number": 3}
