"""Answers as JSON that compresses well: long lists of numbers as differences of whole numbers.

A smooth history has small differences: a packed run takes two thirds of its size after gzip. A column of numbers is
`[decimals, order, whole]`: sum `whole` `order` times, then divide by ten to the power `decimals`. The sums are exact,
and the quotient is the double next to the decimal number: `web/src/page/server/packed.ts` reads the same numbers.
"""

import json
import zlib
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

_SHORTEST = 32
"""Length from which a list is packed."""
_HIGHEST_ORDER, _MOST_DECIMALS = 3, 20
_LARGEST = 2.0**53
"""Whole numbers below it are exact as doubles."""


def packed(answer: bytes) -> bytes:
    """Return an answer as JSON in which each long list of finite numbers, or of rows of numbers, is packed."""
    return _written(_packed(json.loads(answer))).encode()


def _written(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False, separators=(",", ":"))


def _packed(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _packed(one) for name, one in value.items()}
    if not isinstance(value, list):
        return value
    columns = _columns(value) if len(value) >= _SHORTEST else None
    return [_packed(one) for one in value] if columns is None else columns


def _columns(rows: list[Any]) -> dict[str, Any] | None:
    """Return the columns of a list of numbers, or of rows of equal length; None for other lists."""
    try:
        values = np.array(rows)
    except ValueError:  # rows of different lengths
        return None
    if values.dtype.kind not in "if" or values.ndim > 2:  # noqa: PLR2004  rows and columns
        return None
    columns = [_column(one) for one in np.atleast_2d(values.T).astype(float)]
    return {"packed": columns, "rows": values.ndim == 2}  # noqa: PLR2004


def _column(values: npt.NDArray[np.float64]) -> list[Any]:
    """Return the form of a column that compresses best."""
    return min(_forms(values), key=lambda form: len(zlib.compress(_written(form).encode(), 1)))


def _forms(values: npt.NDArray[np.float64]) -> Iterator[list[Any]]:
    """Yield the numbers themselves, and the differences of whole numbers if the numbers have few decimals."""
    yield [0, 0, values.tolist()]
    for decimals in range(_MOST_DECIMALS + 1):
        scale = 10.0**decimals
        whole = np.rint(values * scale)
        if np.array_equal(whole / scale, values):
            break
    else:
        return
    for order in range(_HIGHEST_ORDER + 1):
        if np.abs(whole).max() * 2.0**order < _LARGEST:
            yield [decimals, order, np.diff(whole.astype(np.int64), order, prepend=[0] * order).tolist()]
