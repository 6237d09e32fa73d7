"""Functions of numbers that also take arrays, with the same bits for each number.

Properties of a column and of a model compute with them: the models of an ensemble whose numbers differ are then
evaluated at once, on arrays.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np


def _elementwise(function: Callable[..., float], count: int) -> Callable[..., float]:
    over = np.frompyfunc(function, count, 1)

    def of(*numbers: Any) -> float:
        if any(isinstance(number, np.ndarray) for number in numbers):
            array: Any = over(*numbers).astype(float)
            return array  # type: ignore[no-any-return]  # the type of a property of one object
        return function(*numbers)

    vars(of)["compiled"] = function  # for one number, in compiled code
    return of


sqrt = _elementwise(math.sqrt, 1)
sin = _elementwise(math.sin, 1)
cos = _elementwise(math.cos, 1)
atan2 = _elementwise(math.atan2, 2)
hypot = _elementwise(math.hypot, 2)
smaller = _elementwise(min, 2)
larger = _elementwise(max, 2)
