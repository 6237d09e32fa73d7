"""Numbers of things in words."""


def plural(number: int, noun: str) -> str:
    """Return a number of things, such as "1 run" or "3 runs".

    Parameters
    ----------
    number
        How many there are.
    noun
        What they are, in the singular; its plural ends with s.
    """
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
