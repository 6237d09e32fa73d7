"""Number of records that a fragility needs, and the remark on fewer records."""

from stylobate.text import plural

FEW_RECORDS = 20
"""Minimum number of records: with fewer, the measured coverage of dispersion intervals is well below nominal."""


def few_records(count: int) -> str:
    """Return the remark on a fragility from `count` records; empty for enough records.

    >>> few_records(12)
    '12 records: with fewer than 20 the interval of the dispersion is too narrow'
    >>> few_records(20)
    ''
    """
    if count >= FEW_RECORDS:
        return ""
    return f"{plural(count, 'record')}: with fewer than {FEW_RECORDS} the interval of the dispersion is too narrow"
