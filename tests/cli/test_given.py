"""What a command line gives is read as the command gets it, in every version of the library that reads it."""

from pathlib import Path

import typer

from stylobate.cli.given import Given, with_values


def test_values_are_those_that_the_command_gets_whatever_the_context_holds():
    read = {}

    def command(context: typer.Context, output: Path | None = None, number: int = 3) -> None:
        context.params = {name: str(value) for name, value in context.params.items()}  # as typer before 0.29
        read.update(Given.of(context))
        assert read == {"output": output, "number": number}

    app = typer.Typer()
    app.command()(with_values(command))
    typer.main.get_command(app).main(["--output", "a.nc"], standalone_mode=False)
    assert read == {"output": Path("a.nc"), "number": 3}
