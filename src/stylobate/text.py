"""Counts, numbers, units and misspelt names in text, and characters that cannot be printed."""

import re
from collections.abc import Iterable, Mapping
from difflib import get_close_matches

from stylobate.aliases import may_mean, meant_by, spellings_of

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


def shortened(parts: Iterable[object], most: int = 6) -> str:
    """List parts between commas, at most so many, and the number of the others.

    >>> shortened([1, 2, 3]), shortened(range(2, 220), most=4)
    ('1, 2, 3', '2, 3, 4, 5 and 214 more')
    """
    words = list(map(str, parts))
    more = f" and {len(words) - most} more" if len(words) > most else ""
    return ", ".join(words[:most]) + more


def headings_in_words(read_as: Mapping[str, str]) -> str:
    """State what the headings of a table were taken as; empty without any.

    >>> headings_in_words({"Weight (kg)": "mass", "Ø": "diameter"})
    "read 'Weight (kg)' as mass, 'Ø' as diameter"
    """
    pairs = ", ".join(f"{heading!r} as {name}" for heading, name in read_as.items())
    return f"read {pairs}" if pairs else ""


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
    """Return a question that suggests the most similar of the `known` names, or those that an alias means.

    Empty without a similar name.

    >>> did_you_mean("dampign", ["damping", "restitution"]), did_you_mean("weight", ["height", "mass"])
    ('did you mean damping?', 'did you mean mass?')
    """
    found = similar(name, known)
    return f"did you mean {' or '.join(found)}?" if found else ""


def similar(name: str, known: Iterable[str], likeness: float = _LIKENESS) -> tuple[str, ...]:
    """Return the `known` names that a name means as an alias, or else the most similar one; empty without any.

    >>> similar("wieght", ["height", "mass"]), similar("width", ["radius", "diameter"])
    (('mass',), ('radius', 'diameter'))
    """
    names = sorted(known)
    exact = meant_by(name)
    if exact in names and exact != name:
        return (exact,)
    spellings = {spelling: one for one in names for spelling in reversed(spellings_of(one))}
    close = get_close_matches(name, sorted(spellings), n=1, cutoff=likeness)
    return tuple(spellings[one] for one in close) or tuple(one for one in may_mean(name) if one in names)
