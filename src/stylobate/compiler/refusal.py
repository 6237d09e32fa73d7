"""What is not of the accepted language is refused, with its place and a remedy."""

import ast


class CompileError(Exception):
    """A function cannot be compiled; one line says where, why and what to write instead."""


class Refusal(Exception):  # noqa: N818  becomes a CompileError where the place is known
    """Something in a function is refused.

    Parameters
    ----------
    reason
        What it is, and the remedy.
    """


class LanesRefusal(Refusal):
    """Something is refused in lanes only."""


def at_its_place(reason: object, node: ast.AST, file: str, function: str) -> CompileError:
    """Return the error of a refusal, with file and line."""
    return CompileError(f"{file}:{getattr(node, 'lineno', '?')}: in {function}: {reason}")
