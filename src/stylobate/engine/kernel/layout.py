"""The buffer of a kernel: one contiguous array, row r of lane i at buf[r * WIDTH + i].

`columns` defines the meaning of the rows (`Setup`, `Log`, `Lane`); the `Shape` of a kernel determines which it has.
"""

from collections.abc import Iterator
from enum import IntEnum

import numpy as np
import numpy.typing as npt

Table = npt.NDArray[np.float64]
Row = npt.NDArray[np.float64]


class FromZero(IntEnum):
    """Columns or rows, numbered from zero in the order of their definition."""

    @staticmethod
    def _generate_next_value_(name: str, start: int, count: int, last_values: list[int]) -> int:
        del name, start, last_values
        return count


class Rows:
    """Named rows, numbered in the order of addition."""

    def __init__(self) -> None:
        self._numbers: dict[str, int] = {}

    def add(self, *names: str) -> None:
        """Add rows."""
        for name in names:
            assert name not in self._numbers, name
            self._numbers[name] = len(self._numbers)

    def add_many(self, name: str, count: int) -> None:
        """Add the rows name0, name1 and so on."""
        self.add(*(f"{name}{index}" for index in range(count)))

    def __getitem__(self, name: str) -> int:
        return self._numbers[name]

    def get(self, name: str) -> int:
        """Return the index of a row, or 0 if there is no row of this name."""
        return self._numbers.get(name, 0)

    def __iter__(self) -> Iterator[str]:
        return iter(self._numbers)

    def __len__(self) -> int:
        return len(self._numbers)
