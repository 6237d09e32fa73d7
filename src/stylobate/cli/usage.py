"""Messages about mistakes in the options of a command line, with the values that an option needs."""

from collections.abc import Sequence
from typing import Any

from stylobate.errors import ParameterError

_RANGE = 3


def usage_error(error: Exception, program: Any) -> str:
    """Write one line for a mistake in the options.

    For an option with several values, the line states these values.

    Parameters
    ----------
    error
        The exception of the parser.
    program
        The parser of the command.
    """
    message: str = getattr(error, "format_message", error.__str__)()
    option = getattr(error, "param", None) or _named(error, program)
    count = getattr(option, "nargs", 1)
    if option is None or count == 1:
        return message
    names = getattr(option, "metavar", None) or ""
    wanted = f"{count} numbers" if set(names.split()) <= {"NUMBER"} else names
    if "requires" in message:
        return f"{option.opts[0]} must be followed by {wanted}; got fewer"
    return f"{option.opts[0]} must be followed by {wanted}; {wanted.split()[-1]} must be a whole number"


def _named(error: Exception, program: Any) -> Any:
    """Find the option in an error about too few values, or None; the error does not name the command."""
    name = getattr(error, "option_name", None)
    return next((option for option in getattr(program, "params", ()) if name in option.opts), None)


def joined_ranges(arguments: Sequence[str]) -> list[str]:
    """Join the three values of each option --over in `arguments`: typer has no lists of tuples."""
    joined: list[str] = []
    rest = list(arguments)
    while rest:
        joined.append(rest.pop(0))
        if joined[-1] == "--over":
            joined.append(" ".join(rest[:_RANGE]))
            del rest[:_RANGE]
    return joined


def named_range(text: str) -> tuple[str, list[str]]:
    """Split the joined values of an option --over into the name and the two bounds.

    Raises
    ------
    ParameterError
        If there are not three values.
    """
    name, *bounds = text.split()
    if len(bounds) != _RANGE - 1:
        message = f"--over must be followed by a name, its lowest and its highest value; got {text!r}"
        raise ParameterError(message)
    return name, bounds
