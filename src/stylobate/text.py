"""Counts, numbers and misspelt names in text."""

from collections.abc import Iterable
from difflib import get_close_matches

_LIKENESS = 0.7


def plural(number: int, noun: str) -> str:
    """Format a count, such as "1 run" or "3 runs".

    Parameters
    ----------
    number
        Count.
    noun
        Noun in the singular; its plural ends with s.
    """
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def four_digits(number: float) -> str:
    """Format a number with four significant digits, up to a million without exponent.

    >>> four_digits(21205.75), four_digits(0.1), four_digits(1.23456e-7), four_digits(-0.0)
    ('21210', '0.1', '1.235e-07', '0')
    """
    return f"{float(f'{number:.4g}') + 0.0:.6g}"


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return a question that suggests the most similar of the `known` names; empty without a similar name.

    >>> did_you_mean("dampign", ["damping", "restitution"])
    'did you mean damping?'
    """
    found = get_close_matches(name, sorted(known), n=1, cutoff=_LIKENESS)
    return f"did you mean {found[0]}?" if found else ""
