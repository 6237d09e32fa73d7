"""Unit of compiled code: functions, each compiled once for each structure of its arguments."""

import ast
import inspect
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from types import FunctionType
from typing import Any

from stylobate.compiler.arithmetic import Arithmetic
from stylobate.compiler.body import Body
from stylobate.compiler.memory import Need, WiderSlotError
from stylobate.compiler.reads import Reads
from stylobate.compiler.sources import CompileError, LanesRefusal, Refusal, Source, plain_function, source_of
from stylobate.compiler.text import FunctionText, ModuleText
from stylobate.compiler.values import Array, Element, Number, NumberKind, Value, parts, rebuilt


@dataclass(frozen=True, slots=True)
class ArrayArgument:
    """Contiguous array argument of compiled code.

    Parameters
    ----------
    shape
        Lengths; None for lengths that each call passes.
    element
        Type of the elements.
    """

    shape: tuple[int | None, ...]
    element: Element = Element.FLOAT


@dataclass(frozen=True, slots=True)
class _Made:
    name: str
    result: Value


class Unit:
    """Functions that are compiled together.

    Parameters
    ----------
    lanes
        Numbers in a vector; 0 disables vectorisation.
    fast
        Functions that are compiled as if they were marked `fast`.
    exact
        Whether no arithmetic is fast, so that results equal those of plain Python.
    reads
        Log of the values that are read.
    trusted
        Whether whole numbers need no bounds in functions that do not belong to a model: those of the package take care
        of their indices themselves.
    traps
        Whether code may raise errors, which end the program: a page catches that, the process of Python would not.
    """

    def __init__(
        self,
        *,
        lanes: int,
        fast: Collection[Callable[..., Any]] = (),
        exact: bool = False,
        reads: Reads | None = None,
        trusted: bool = False,
        traps: bool = False,
    ) -> None:
        self.module, self.reads = ModuleText(), Reads({}) if reads is None else reads
        self.lanes, self.exact, self._trusted, self.traps = lanes, exact, trusted, traps
        self._fast = {plain_function(function) for function in fast}
        self._sources: dict[FunctionType, Source] = {}
        self._made: dict[tuple[Any, ...], _Made] = {}
        self._known: list[Sequence[Value]] = []
        self._within: list[FunctionType] = []

    def export(
        self,
        function: Callable[..., Any],
        name: str,
        arguments: Sequence[ArrayArgument | NumberKind | int],
        *,
        returns: NumberKind = NumberKind.INTEGER,
    ) -> None:
        """Add an exported function, whose arguments are numbers and pointers, each followed by its unknown lengths.

        A whole number among the arguments is known when the function is compiled, and is not passed.
        The function returns a whole number of 64 bits or a condition, or a float if it `returns` one.
        """
        text = FunctionText()
        head: list[str] = []
        arithmetic = Arithmetic(self.module, text, fast=False)
        values = [_argument(arithmetic, argument, head) for argument in arguments]
        result = _called(arithmetic, self._specialised(plain_function(function), values, fast=False), values)
        whole = result is None or (isinstance(result, Number) and result.kind < NumberKind.FLOAT)
        if returns is NumberKind.INTEGER and not whole:
            raise CompileError(f"{name} returns a whole number, a condition or nothing when it is called from outside")
        text.end("ret i64 0" if result is None else f"ret {arithmetic.number(result, returns).operand}")
        kind = "double" if returns is NumberKind.FLOAT else "i64"
        self.module.define(f"{kind} @{name}({', '.join(head)})", text.body())

    def call(
        self, caller: Body, function: Callable[..., Any], values: list[Value], keywords: Mapping[str, Value]
    ) -> Value:
        """Return the result of a function that `caller` calls; in lanes the function is inlined."""
        try:
            plain = self.reads.plain(function)
        except CompileError as error:
            raise Refusal(error) from error
        source, arithmetic = self._source(plain), caller.arithmetic
        fast = bool(arithmetic.flags)
        bound = _bound(self.reads, source, values, keywords)
        if not arithmetic.lanes:
            ordered = list(bound.values())
            return _called(arithmetic, self._specialised(plain, ordered, fast=fast), ordered)
        begun = len(arithmetic.text.block.lines)
        try:
            with self._entered(plain), arithmetic.checking(self._is_checked(plain)):
                body = Body(self, source, arithmetic, {})
                body.run(bound)
            return body.finished()
        except LanesRefusal:
            del arithmetic.text.block.lines[begun:]
            return self._lane_by_lane(arithmetic, plain, list(bound.values()), fast=fast)

    def _lane_by_lane(
        self, arithmetic: Arithmetic, function: FunctionType, values: Sequence[Value], *, fast: bool
    ) -> Value:
        """Return the results of separate calls for each lane, slowly, for a function with branches or loops."""
        results = []
        for lane in range(arithmetic.lanes):
            single = [arithmetic.of_lane(value, lane) for value in values]
            results.append(_called(arithmetic, self._specialised(function, single, fast=fast), single))
        return arithmetic.in_lanes(results)

    def _source(self, function: FunctionType) -> Source:
        if function not in self._sources:
            self._sources[function] = source_of(function)
        return self._sources[function]

    def _specialised(self, function: FunctionType, values: Sequence[Value], *, fast: bool) -> _Made:
        key = (function, fast, *map(_structure, values))
        self._known.append(values)  # keeps the objects alive whose identities are in keys
        if key not in self._made:
            source = self._source(function)
            with self._entered(function):
                self._made[key] = self._compiled(source, values, fast=fast or source.fast or function in self._fast)
        return self._made[key]

    def _compiled(self, source: Source, values: Sequence[Value], *, fast: bool) -> _Made:
        needs: dict[str, Need] = {}
        while True:
            text, head = FunctionText(), list[str]()
            arguments = [_parameter(value, head) for value in values]
            arithmetic = Arithmetic(self.module, text, fast=fast and not self.exact)
            arithmetic.checked = self._is_checked(source.function)
            body = Body(self, source, arithmetic, needs)
            try:
                body.run(dict(zip(source.signature.parameters, arguments, strict=True)))
            except WiderSlotError as error:
                needs |= {name: needs.get(name, Need()).together(need) for name, need in error.needs.items()}
                continue
            result = body.finished()
            name = f"{source.name}.{len(self._made)}"
            if _is_stored(result):
                head.insert(0, f"ptr noalias {_RESULT}")
            self.module.define(f'internal {_returned(result)} @"{name}"({", ".join(head)})', _with_return(text, result))
            return _Made(name, result)

    def _is_checked(self, function: FunctionType) -> bool:
        return not self._trusted or self.reads.logs(function)

    @contextmanager
    def _entered(self, function: FunctionType) -> Iterator[None]:
        if function in self._within:
            raise Refusal(f"{function.__name__} calls itself; write it as a loop")
        self._within.append(function)
        try:
            yield
        finally:
            self._within.pop()


def _argument(arithmetic: Arithmetic, argument: ArrayArgument | NumberKind | int, head: list[str]) -> Value:
    """Return an argument of an exported function; its number, or pointer and lengths, are added to the head."""
    if isinstance(argument, NumberKind):
        return _parameter(Number(argument, ""), head)
    if isinstance(argument, int):
        return argument
    pointer = f"%x{len(head)}"
    head.append(f"ptr {pointer}")
    shape: list[Value] = []
    for length in argument.shape:
        if length is None:
            shape.append(Number(NumberKind.INTEGER, f"%x{len(head)}"))
            head.append(shape[-1].operand)
        else:
            shape.append(length)
    strides: list[Value] = [1]
    for length in reversed(shape[1:]):
        strides.insert(0, arithmetic.binary(ast.Mult(), strides[0], length))
    return Array(pointer, tuple(shape), tuple(strides), argument.element)


def _parameter(value: Value, head: list[str]) -> Value:
    """Return a parameter of an internal function; its numbers and pointers are added to the head."""

    def passed(part: Value) -> Value:
        if isinstance(part, Number):
            number = replace(part, text=f"%x{len(head)}")
            head.append(number.operand)
            return number
        if isinstance(part, Array):
            pointer = f"%x{len(head)}"
            head.append(f"ptr {pointer}")
            return replace(
                part, pointer=pointer, shape=tuple(map(passed, part.shape)), strides=tuple(map(passed, part.strides))
            )
        return part

    return rebuilt(value, passed)


def _operands(value: Value) -> Iterator[str]:
    """Yield the operands of an argument, in the order of `_parameter`."""
    if isinstance(value, Number):
        yield value.operand
    elif isinstance(value, Array):
        yield f"ptr {value.pointer}"
        for size in (*value.shape, *value.strides):
            yield from _operands(size)
    elif isinstance(value, tuple):
        for part in value:
            yield from _operands(part)


def _structure(value: Value) -> Any:
    """Return the structure of an argument; a function is compiled once for each structure."""
    match value:
        case Number():
            return value.kind, value.bounds
        case Array():
            return (*map(_structure, (*value.shape, *value.strides)), value.element, value.writable)
        case tuple():
            return (type(value), *map(_structure, value))
        case bool() | int() | float() | str():
            return (type(value), repr(value))
        case _:
            return (type(value), id(value))


def _bound(reads: Reads, source: Source, values: list[Value], keywords: Mapping[str, Value]) -> dict[str, Value]:
    """Return the arguments of a call by name, including defaults."""
    try:
        bound = source.signature.bind(*values, **keywords)
    except TypeError as error:
        raise Refusal(f"{source.name}: {error}") from error
    given = set(bound.arguments)
    bound.apply_defaults()
    for name, value in bound.arguments.items():
        if name not in given and source.signature.parameters[name].default is not inspect.Parameter.empty:
            reads.log(source.function, "default", name, value)
    return dict(bound.arguments)


def _called(arithmetic: Arithmetic, made: _Made, values: Sequence[Value]) -> Value:
    text, kind = arithmetic.text, _type_of(made.result)
    operands = [operand for value in values for operand in _operands(value)]
    room = text.allocated(kind) if _is_stored(made.result) else ""
    if room:
        operands.insert(0, f"ptr {room}")
    call = f'call {_returned(made.result)} @"{made.name}"({", ".join(operands)})'
    result = ""
    if room or kind == "void":
        text.line(call)
    else:
        result = text.value(call)
    if kind == "void":
        return None
    places = iter(range(len(list(parts(made.result)))))

    def taken(part: Value) -> Value:
        if not isinstance(part, Number):
            return part
        place = next(places)
        if not room:
            return replace(part, text=text.value(f"extractvalue {kind} {result}, {place}"))
        return replace(part, text=text.value(f"load {part.type}, ptr {_place(text, kind, room, place)}"))

    return rebuilt(made.result, taken)


# Registers for results are few: for more floats than two, LLVM uses those of the x87 unit, which are slow and whose
# stack it does not keep balanced. More results are stored in memory of the caller; inlining removes the detour.
_MOST_RETURNED, _RESULT = 2, "%result"


def _is_stored(result: Value) -> bool:
    """Return whether a result is stored where the first argument points."""
    return len(list(parts(result))) > _MOST_RETURNED


def _returned(result: Value) -> str:
    return "void" if _is_stored(result) else _type_of(result)


def _type_of(result: Value) -> str:
    types = [number.type for number in parts(result)]
    return f"{{ {', '.join(types)} }}" if types else "void"


def _place(text: FunctionText, kind: str, pointer: str, place: int) -> str:
    return text.value(f"getelementptr inbounds {kind}, ptr {pointer}, i32 0, i32 {place}")


def _with_return(text: FunctionText, result: Value) -> str:
    kind, whole = _type_of(result), "poison"
    for place, number in enumerate(parts(result)):
        if _is_stored(result):
            text.line(f"store {number.operand}, ptr {_place(text, kind, _RESULT, place)}")
        else:
            whole = text.value(f"insertvalue {kind} {whole}, {number.operand}, {place}")
    text.end("ret void" if _returned(result) == "void" else f"ret {kind} {whole}")
    return text.body()
