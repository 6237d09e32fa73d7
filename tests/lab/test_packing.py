"""Packed answers: read back, the numbers are the same to the last bit."""

import gzip
import json

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from stylobate.lab.answers import numbers
from stylobate.lab.packing import packed


def unpacked(value):
    """Read a packed answer as the page does."""
    if isinstance(value, list):
        return [unpacked(one) for one in value]
    if not isinstance(value, dict):
        return value
    if "packed" not in value:
        return {name: unpacked(one) for name, one in value.items()}
    columns = []
    for decimals, order, whole in value["packed"]:
        column = np.array(whole, dtype=float)
        for _ in range(order):
            column = np.cumsum(column)
        columns.append((column / float(f"1e{decimals}")).tolist())
    return [list(row) for row in zip(*columns, strict=True)] if value["rows"] else columns[0]


def zipped(value):
    """Return the size of a value as JSON after gzip."""
    return len(gzip.compress(json.dumps(value, separators=(",", ":")).encode()))


FINITE = st.floats(-1e6, 1e6, allow_subnormal=False)


@given(arrays(float, st.tuples(st.integers(0, 60), st.integers(1, 3)), elements=FINITE))
def test_numbers_are_read_back_exactly(values):
    rounded = {"rows": numbers(values), "series": {"time": numbers(values[:, 0])}}
    assert unpacked(json.loads(packed(json.dumps(rounded).encode()))) == rounded


def test_a_smooth_history_is_smaller_and_other_lists_stay():
    time = np.linspace(0.0, 20.0, 2000)
    answer = {"tilt": numbers(np.sin(time)), "unknown": [None, *numbers(time)], "words": ["x"] * 99, "few": [0.5] * 9}
    before = json.dumps(answer, separators=(",", ":")).encode()
    found = json.loads(packed(before))
    assert {name: found[name] for name in ("unknown", "words", "few")} == {
        name: answer[name] for name in ("unknown", "words", "few")
    }
    assert zipped(found["tilt"]) < 0.5 * zipped(answer["tilt"])
    assert unpacked(found) == answer
