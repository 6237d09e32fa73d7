"""Counts in words."""


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
