"""Random programs of the accepted language, drawn by hypothesis, with arrays of plain Python for their twins."""

import math
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np
from hypothesis import strategies as st

from stylobate.compiler import marks

LENGTH = 8
"""Length of the arrays `x` and `out` of a program."""

_TABLES = {"TABLE": (1.0, -2.5, 4.0), "SQUARE": ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0), (7.0, 8.0, -0.0))}
_TUPLES = {"T3": (10.0, -0.5, 40.0), "T4": (0.25, 3.0, 1e-300, -1e10)}
_CONSTANTS = ("0.0", "-0.0", "1.0", "-2.0", "0.3", "1e-300", "7.25", "K", "2", "-3")

# Each name in braces stands for another expression of its kind. Whole powers of floats are products when compiled;
# only squares equal those of Python.
_GRAMMAR = {
    "number": """
        {leaf}; {leaf}; {leaf}; -{leaf}; {whole}; float({number}); abs({number}); math.fabs({number})
        ({number} + {number}); ({number} - {number}); ({number} * {number}); ({number} / (1.5 + abs({number})))
        -({number}) ** 2; +({number}) ** 2.0; ({number}) ** 1; ({number} if {condition} else {number})
        min({number}, {number}); max({number}, {number}, 0.5); min(({number}, {number})); sum(({number}, {number}))
        math.copysign({number}, {number}); math.atan2({number}, {number}); math.sin({number}); math.cos({number})
        math.tanh({number}); math.atan({number}); math.sqrt(abs({number})); math.log(abs({number}) + 0.5)
        math.exp(-abs({number})); np.square({number})
    """,
    "call": """
        helper({number}, {whole}); helper({leaf}, {whole}, {leaf}); helper({leaf}, n, b={leaf})
        scaled({number}); pair({number}, K)[1]; pair(*pair({leaf}, {leaf}))[0]
    """,
    "rare number": """
        math.sqrt({number}); math.log({number}); ({number}) ** 2.5; 1.0 / {leaf}; b; c; ({leaf} and {leaf})
        T3[{whole}]; x[{whole}]; T3[{leaf}]; TABLE[{leaf}]; TABLE[3]; ({leaf} % 2)
    """,
    "whole": """
        ({whole} + {whole}); ({whole} - {whole}); ({whole} * {whole}); ({whole} // 3); ({whole} // -2)
        ({whole} % 5); ({whole} % -3); min({whole}, {whole}); max({whole}, {whole}); abs({whole}); -{whole}; +{whole}
        ({whole} if {condition} else {whole}); int({condition}); int({whole}); min(max(int({number}), -9), 9)
        max(min(math.floor({number}), 9), -9); (math.ceil({number}) % 7); min(max(math.trunc({number}), -9), 9)
    """,
    "rare whole": "int({number}); ({whole} // {whole}); ({whole} % {whole}); ({whole}) ** 3",
    "condition": """
        {number} < {leaf}; {number} >= {leaf}; {number} == {leaf}; {whole} != {whole}; {whole} <= 1; bool({number})
        {leaf} < {number} <= {leaf}; {leaf} > {whole} != {leaf}
        ({condition} and {condition}); ({condition} or {condition}); not {condition}
    """,
    "index": "{name} % {length}; min(max({name}, 0), {last}); abs({name}) % {length}; max(min({name}, -1), -{length})",
    "loop": """
        for b in T3; for m, b in enumerate(T4); for b, c in zip(T3, reversed(T3)); for b, c in ((1.0, 2.0), (3.0, K))
    """,
}
_FORMS = {kind: [form for form in re.split(r"; |\n *", forms) if form] for kind, forms in _GRAMMAR.items()}
_NAME = re.compile(r"{(\w+)}")


class Floats:
    """Array of floats, or a view into one, whose elements are floats of Python: NumPy's follow rules of their own."""

    def __init__(self, content: list[Any], places: range | None = None) -> None:
        self._content, self._places = content, range(len(content)) if places is None else places

    def __len__(self) -> int:
        return len(self._places)

    def __getitem__(self, index: Any) -> Any:
        if isinstance(index, tuple):
            first, *others = index
            return self[first][others[0] if len(others) == 1 else tuple(others)]
        found = self._places[index]
        return Floats(self._content, found) if isinstance(found, range) else self._content[found]

    def __setitem__(self, index: int, value: float) -> None:
        self._content[self._places[index]] = float(value)

    def tolist(self) -> list[float]:
        """Return the elements."""
        return [self._content[place] for place in self._places]


def names_of(*, plain: bool) -> dict[str, Any]:
    """Return the values of the names of a program, with arrays of plain Python or with those of NumPy."""
    arrays: dict[str, Any] = {name: np.array(rows) for name, rows in _TABLES.items()}
    numpy: Any = np
    if plain:
        arrays = {
            "TABLE": Floats(list(_TABLES["TABLE"])),
            "SQUARE": Floats([Floats(list(row)) for row in _TABLES["SQUARE"]]),
        }
        numpy = SimpleNamespace(zeros=lambda length: Floats([0.0] * length), square=lambda number: number * number)
    return {**arrays, **_TUPLES, "K": 1.75, "np": numpy, "math": math, "lanes": marks.lanes}


@st.composite
def programs(draw: Callable[..., Any]) -> str:
    """Return the text of a function `program` of the arrays `x` and `out`, with the functions that it calls."""
    writer = _Writer(draw)
    writer.helpers()
    writer.program()
    return "\n".join(writer.lines) + "\n"


@cache
def _integers(count: int) -> st.SearchStrategy[int]:
    return st.integers(0, count - 1)


class _Writer:
    """Writes a program: numbers `a`, `b`, `c`, whole numbers `n`, `m`, a tuple `t`, a view `row`, an array `room`."""

    def __init__(self, draw: Callable[..., Any]) -> None:
        self.lines: list[str] = []
        self._draw, self._indent = draw, 0
        self._numbers, self._wholes, self._others = ["a"], ["n"], set[str]()
        self._passes: list[tuple[str, int]] = []
        """Names of loops with the number of their passes."""
        self._in_lanes = self._in_helper = False

    # Choices

    def _below(self, count: int) -> int:
        return int(self._draw(_integers(count)))

    def _one(self, *choices: Any) -> Any:
        return choices[self._below(len(choices))]

    def _rarely(self) -> bool:
        return self._below(1000) == 337  # the ends of a range are drawn more often

    def _write(self, line: str) -> None:
        self.lines.append("    " * self._indent + line)

    @contextmanager
    def _block(self, head: str) -> Iterator[None]:
        """Write an indented block; names assigned in it are not known afterwards."""
        self._write(head)
        known = [*self._numbers], [*self._wholes], {*self._others}
        self._indent += 1
        yield
        self._indent -= 1
        self._numbers, self._wholes, self._others = known

    # Functions

    def helpers(self) -> None:
        """Write the functions that a program calls."""
        self._in_helper = True
        with self._block("def helper(a, n, b=0.5):"):
            self._numbers, self._wholes = ["a", "b"], ["n"]
            self._statements(1)
            self._write(f"return {self._number(2)}")
        with self._block("def pair(a, b):"):
            self._numbers, self._wholes = ["a", "b"], []
            if self._one(True, False):
                with self._block(f"if {self._condition(1)}:"):
                    self._write(f"return {self._number(1)}, {self._number(1)}")
            self._write(f"return {self._number(1)}, {self._number(1)}")
        with self._block("def made(k):"):
            self._write(f"return lambda u: u * k + {self._one('K', '1.0', 'T3[1]')}")
        self._write(f"scaled = made({self._one('1.5', '-2.0', 'K')})")
        self._in_helper = False

    def program(self) -> None:
        """Write the function `program`."""
        with self._block("def program(x, out):"):
            self._write(f"a = x[{self._below(LENGTH)}]")
            self._write(f"n = {self._below(4)}")
            if self._one(True, False):
                self._write(f"row = {self._one('x[2:5]', 'x[:3]', 'x[5:]', 'SQUARE[1]', 'SQUARE[-1]', 'TABLE')}")
                self._others.add("row")
            if self._one(True, False):
                self._write("room = np.zeros(3)")
                self._others.add("room")
            self._statements(2)
            if self._one(True, False, False):
                self._loop_over_lanes()
            for name in self._numbers:
                self._write(f"out[{self._below(LENGTH)}] = {name}")
            self._write(f"return {self._whole(1)}")

    # Statements

    def _statements(self, depth: int) -> None:
        for _ in range(1 + self._below(3)):
            self._statement(depth)

    def _statement(self, depth: int) -> None:
        simple = [self._assign, self._assign, self._assign_whole, self._change, self._assign_two, self._assign_tuple]
        if not self._in_helper:
            simple += [self._put, self._put]
        nested = [self._if, self._if, self._for_range, self._for_tuple, self._while] if depth else []
        chosen = self._one(*simple, *nested)
        chosen(depth) if chosen in nested else chosen()

    def _assign(self) -> None:
        name = self._one("a", "b", "c")
        self._write(f"{name} = {self._number(3)}")
        self._numbers = sorted({*self._numbers, name})

    def _assign_whole(self) -> None:
        name = self._one("n", "m")
        value = self._whole(2)
        self._write(f"{name} = {value if self._rarely() or not self._passes else f'min(max({value}, -20), 20)'}")
        self._wholes = sorted({*self._wholes, name})

    def _change(self) -> None:
        if self._one(True, True, False) or not self._wholes:
            self._write(f"{self._one(*self._numbers)} {self._one('+', '-', '*')}= {self._number(2)}")
        else:
            self._write(f"{self._one(*self._wholes)} {self._one('+', '-')}= {self._whole(1)}")

    def _assign_two(self) -> None:
        names = self._one(("a", "b"), ("b", "c"), ("c", "a"))
        values = f"{self._number(2)}, {self._number(1)}"
        self._write(
            f"{', '.join(names)} = {values if self._in_helper or self._one(True, False) else f'pair({values})'}"
        )
        self._numbers = sorted({*self._numbers, *names})

    def _assign_tuple(self) -> None:
        self._write(f"t = {self._number(1)}, {self._number(1)}, {self._number(1)}")
        self._others.add("t")

    def _put(self) -> None:
        choices = [("out", LENGTH), ("out", LENGTH), *([("room", 3)] if "room" in self._others else [])]
        name, length = self._one(*choices)
        self._write(f"{name}[{self._index(length)}] {self._one('', '', '+', '*')}= {self._number(2)}")

    def _if(self, depth: int) -> None:
        with self._block(f"if {self._condition(2)}:"):
            self._statements(depth - 1)
            self._leave()
        if self._one(True, False):
            with self._block(f"elif {self._condition(1)}:"):
                self._statements(depth - 1)
        if self._one(True, False):
            with self._block("else:"):
                self._statements(depth - 1)

    def _leave(self) -> None:
        if self._passes and self._below(4) == 0:
            self._write(self._one("break", "continue"))
        elif self._below(12) == 0:
            self._write(f"return {self._number(1) if self._in_helper else self._whole(1)}")

    def _for_range(self, depth: int) -> None:
        name = "ijk"[len(self._passes)] if len(self._passes) < 3 else "l"
        count = 1 + self._below(5)
        stop = self._one("{0}", "0, {0}", "min({0}, {1})").format(count, self._whole(1))
        with self._block(f"for {name} in range({stop}):"):
            self._passes.append((name, count))
            self._statements(depth - 1)
            self._passes.pop()

    def _for_tuple(self, depth: int) -> None:
        head = str(self._one(*_FORMS["loop"]))
        with self._block(f"{head}:"):
            self._numbers = sorted({*self._numbers, "b", *(["c"] if "c in" in head else [])})
            self._wholes = sorted({*self._wholes, *(["m"] if "m, " in head else [])})
            self._passes.append(("", 0))
            self._statements(depth - 1)
            self._passes.pop()
        self._numbers = [name for name in self._numbers if name == "a"]
        self._wholes = [name for name in self._wholes if name == "n"]

    def _while(self, depth: int) -> None:
        name = f"w{len(self.lines)}"
        self._write(f"{name} = 0")
        condition = f"{name} < {1 + self._below(4)}"
        with self._block(f"while {condition}{f' and {self._condition(1)}' if self._one(True, False) else ''}:"):
            self._write(f"{name} += 1")
            self._passes.append((name, 5))
            self._statements(depth - 1)
            self._passes.pop()

    def _loop_over_lanes(self) -> None:
        with self._block(f"for i in lanes({LENGTH}):"):
            self._in_lanes = True
            self._write(f"b = {self._number(3)}")
            self._numbers = sorted({*self._numbers, "b"})
            self._write(f"out[i] = {self._number(3)}")
            self._in_lanes = False

    # Expressions

    def _number(self, depth: int) -> str:
        return self._expression("number", depth)

    def _whole(self, depth: int) -> str:
        return self._expression("whole", depth)

    def _condition(self, depth: int) -> str:
        return self._expression("condition", depth)

    def _expression(self, kind: str, depth: int) -> str:
        if kind == "leaf" or (kind == "number" and not depth):
            return self._leaf()
        if kind == "whole" and not depth:
            return self._whole_name()
        if kind == "number" and not self._in_helper and self._below(6) == 0:
            kind = "call"
        elif f"rare {kind}" in _FORMS and self._rarely():
            kind = f"rare {kind}"
        template = str(self._one(*_FORMS[kind]))
        return _NAME.sub(lambda found: self._expression(found[1], max(depth - 1, 0)), template)

    def _leaf(self) -> str:
        arrays = [("T3", 3), ("T4", 4), ("TABLE", 3), *((name, 3) for name in sorted(self._others))]
        arrays += [] if self._in_helper else [("x", LENGTH)] * 2
        match self._below(8):
            case 0:
                return str(self._one(*_CONSTANTS))
            case 1:
                return f"SQUARE[{self._index(3)}{self._one(', ', '][')}{self._index(3)}]"
            case 2 | 3 | 4:
                name, length = self._one(*arrays)
                return f"{name}[{self._index(length)}]"
            case 5 if self._in_lanes:
                return "x[i]"
        return str(self._one(*self._numbers))

    def _whole_name(self) -> str:
        passes = [name for name, _ in self._passes if name]
        return str(self._one(str(self._below(9) - 3), *self._wholes, *passes, "len(T4)"))

    def _index(self, length: int) -> str:
        passes = [name for name, count in self._passes if 0 < count <= length]
        choice = self._below(4)
        if choice == 2 and passes:
            return str(self._one(*passes))
        if choice == 3 and self._wholes:
            form, name = self._one(*_FORMS["index"]), self._one(*self._wholes)
            return str(form.format(name=name, length=length, last=length - 1))
        return str(self._below(2 * length) - length)
