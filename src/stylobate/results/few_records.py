"""How many records a fragility needs, and what is said of fewer."""

from stylobate.text import plural

FEW_RECORDS = 20
"""With fewer records the measured coverage of the intervals of a dispersion is well below what they claim."""


def few_records(count: int) -> str:
    """Return what is to be said of a fragility from so many records: nothing where there are enough.

    >>> few_records(12)
    '12 records: with fewer than 20 the interval of the dispersion is too narrow'
    >>> few_records(20)
    ''
    """
    if count >= FEW_RECORDS:
        return ""
    return f"{plural(count, 'record')}: with fewer than {FEW_RECORDS} the interval of the dispersion is too narrow"
