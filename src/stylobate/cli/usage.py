"""Mistakes in the options of a command line, told by what the option wants."""

from typing import Any


def told(error: Exception, program: Any) -> str:
    """Return one line for a mistake that the parser of options found.

    Of an option that is followed by several values it says which these are.

    Parameters
    ----------
    error
        What the parser raised.
    program
        The command line with its commands, whose options have one meaning in all of them.
    """
    message: str = getattr(error, "format_message", error.__str__)()
    option = getattr(error, "param", None) or _named(error, program)
    count = getattr(option, "nargs", 1)
    if option is None or count == 1:
        return message
    wanted = getattr(option, "metavar", None) or f"{count} numbers"
    if "requires" in message:
        return f"{option.opts[0]} must be followed by {wanted}; got fewer"
    wrong = f"{wanted.split()[-1]} must be a whole number" if "integer" in message else "one of them is no number"
    return f"{option.opts[0]} must be followed by {wanted}; {wrong}"


def _named(error: Exception, program: Any) -> Any:
    """Return the option that an error of too few values names, or None; the error knows no command."""
    name = getattr(error, "option_name", None)
    options = (option for command in getattr(program, "commands", {}).values() for option in command.params)
    return next((option for option in options if name in option.opts), None)
