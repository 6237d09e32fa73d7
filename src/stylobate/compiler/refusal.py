"""Errors of the compiler: unsupported code, with its location and a remedy."""

import ast


class CompileError(Exception):
    """A function cannot be compiled; the message has location, reason and remedy."""


class Refusal(Exception):  # noqa: N818  becomes a CompileError where the place is known
    """A function contains unsupported code.

    Parameters
    ----------
    reason
        Reason and remedy.
    """


class LanesRefusal(Refusal):
    """A function contains code that is unsupported only in loops over lanes."""


def at_its_place(reason: object, node: ast.AST, file: str, function: str) -> CompileError:
    """Return the error for a refusal, with file and line."""
    return CompileError(f"{file}:{getattr(node, 'lineno', '?')}: in {function}: {reason}")
