"""Linear equations: Gaussian elimination with partial pivoting, in the arrays of the caller."""

import math
from typing import NamedTuple

from stylobate.engine.kernel.layout import Row, Table


class NewtonRoom(NamedTuple):
    """Work arrays of an implicit step: the Jacobian, the matrix of all stages, and vectors of the same length."""

    jacobian: Table
    matrix: Table
    pivots: Row
    change: Row
    correction: Row


def factor(matrix: Table, pivots: Row) -> bool:
    """Replace a square matrix by its factors L and U, and record the row exchanges; return False if it is singular.

    A matrix with numbers that are not finite counts as singular. Zeros below the diagonal cost no operations.
    """
    n = len(matrix)
    for k in range(n):
        largest = k
        for row in range(k + 1, n):
            if abs(matrix[row, k]) > abs(matrix[largest, k]):
                largest = row
        pivots[k] = largest
        if not 0.0 < abs(matrix[largest, k]) < math.inf:
            return False
        if largest != k:
            for column in range(n):
                matrix[k, column], matrix[largest, column] = matrix[largest, column], matrix[k, column]
        per = 1.0 / matrix[k, k]
        for row in range(k + 1, n):
            if matrix[row, k] != 0.0:
                share = matrix[row, k] * per
                matrix[row, k] = share
                for column in range(k + 1, n):
                    matrix[row, column] -= share * matrix[k, column]
    return True


def solve(factors: Table, pivots: Row, x: Row) -> None:
    """Replace the right-hand side `x` by the solution of the equations with the `factors` from `factor`."""
    n = len(x)
    for k in range(n):
        largest = int(pivots[k])
        x[k], x[largest] = x[largest], x[k]
    for k in range(n):
        if x[k] != 0.0:
            for row in range(k + 1, n):
                x[row] -= factors[row, k] * x[k]
    for done in range(n):
        k = n - 1 - done
        if x[k] != 0.0:
            x[k] /= factors[k, k]
            for row in range(k):
                x[row] -= factors[row, k] * x[k]
