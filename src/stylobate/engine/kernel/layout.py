"""The buffer of a kernel: one contiguous array, row r of lane i at buf[r * WIDTH + i]."""

from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

Table = npt.NDArray[np.float64]
Row = npt.NDArray[np.float64]


class Rows:
    """Named rows, numbered in the order in which they are added."""

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
        """Return the number of a row, or 0 where there is none of this name."""
        return self._numbers.get(name, 0)

    def __iter__(self) -> Iterator[str]:
        return iter(self._numbers)

    def __len__(self) -> int:
        return len(self._numbers)

    def at(self, name: str) -> str:
        """Return the source of the entry of lane `i` in the flat buffer, as the innermost loops address it."""
        return f"buf[{self._numbers[name]} * WIDTH + i]"

    def of_lane(self, name: str) -> str:
        """Return the source of the entry of lane `i` in the buffer as a table, as the driver addresses it."""
        return f"buf[{self._numbers[name]}, i]"
