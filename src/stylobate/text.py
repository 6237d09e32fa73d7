"""Counts, numbers, units and misspelt names in text, and characters that cannot be printed."""

import re
from collections.abc import Iterable
from difflib import get_close_matches

_LIKENESS = 0.7
_EXPONENTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")
# Controls, marks that reorder the text around them, halves of surrogate pairs, and characters that XML 1.0 excludes.
UNPRINTABLE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069\ud800-\udfff\ufffe\uffff]")
_LINE_ENDS = re.compile("\r\n?|[\x0b\x0c\x85]")  # a form feed or a vertical tab ends a line within a cell


def printable(text: str) -> str:
    r"""Return `text` as it is written into tables, pages, figures and terminals.

    Each kind of line end becomes a newline; a character that cannot be printed becomes U+FFFD.

    >>> printable("amphora\x07 of\x0bAthens")
    'amphora� of\nAthens'
    """
    return UNPRINTABLE.sub("\N{REPLACEMENT CHARACTER}", _LINE_ENDS.sub("\n", text))


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


def unit_in_text(units: str) -> str:
    """Write the units of a variable in netCDF files as in text; empty for a number without unit.

    >>> unit_in_text("m s-2"), unit_in_text("s-1"), unit_in_text("kg m2"), unit_in_text("1")
    ('m/s²', '1/s', 'kg m²', '')
    """
    above, below = list[str](), list[str]()
    for symbol, power in re.findall(r"([^\s\d-]+)(-?\d*)", units):
        raised = power.lstrip("-").translate(_EXPONENTS) if power not in ("", "-1") else ""
        (below if power.startswith("-") else above).append(symbol + raised)
    return "/".join([" ".join(above) or "1", *below]) if above or below else ""


def did_you_mean(name: str, known: Iterable[str]) -> str:
    """Return a question that suggests the most similar of the `known` names; empty without a similar name.

    >>> did_you_mean("dampign", ["damping", "restitution"])
    'did you mean damping?'
    """
    found = get_close_matches(name, sorted(known), n=1, cutoff=_LIKENESS)
    return f"did you mean {found[0]}?" if found else ""
