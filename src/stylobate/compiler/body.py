"""Compilation of statements: names and assignments to them, and the body of one function."""

import ast
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from typing import Any, Protocol

import numpy as np

from stylobate.compiler import marks, memory
from stylobate.compiler.arithmetic import Arithmetic
from stylobate.compiler.expressions import Expressions
from stylobate.compiler.memory import Need, has_array
from stylobate.compiler.reads import Reads
from stylobate.compiler.sources import LanesRefusal, Refusal, Source, at_its_place
from stylobate.compiler.text import BasicBlock
from stylobate.compiler.values import Array, Bounds, LaneIndex, Number, NumberKind, Value, bounds_of, constant

_NOTHING = object()
"""Marks a name that no longer has a value."""


class Names(Expressions):
    """Names that a function assigns to, and names of its module.

    A name that a run-time condition or loop assigns to has a slot in memory, from the start of the condition or loop
    until its next assignment outside. All other names directly have their value.

    Parameters
    ----------
    source
        The function.
    arithmetic
        Writer of its instructions.
    reads
        Log of the values that it reads.
    needs
        What the slot of each name needs to hold, besides the first value.
    """

    def __init__(self, source: Source, arithmetic: Arithmetic, reads: Reads, needs: Mapping[str, Need]) -> None:
        super().__init__(arithmetic, reads, followed=reads.logs(source.function))
        self.source, self._needs = source, needs
        self._bound: dict[str, Value] = {}
        self._slots: dict[str, Value] = {}
        self._wider: dict[str, Need] = {}
        """Bounds that the slots of names turned out to need."""
        self._chosen = _assigned_by_control_flow(source.body)
        self._own = assigned_in(source.body) | set(source.signature.parameters)
        self._depth = 0
        """Depth of run-time conditions and loops."""

    def read(self, name: str) -> Value:
        """Return the value of a name."""
        value = self._bound.get(name, _NOTHING)
        if value is not _NOTHING:
            return value
        if name in self._slots and name not in self._bound:
            if name not in self.text.block.assigned:
                raise Refusal(
                    f"{name} is not assigned on every path to its use; assign it before the condition or loop"
                )
            return memory.load_slot(self.arithmetic, self._slots[name])
        if name in self._own:
            raise Refusal(f"{name} has no value here; a loop over a tuple or over lanes does not keep its names")
        try:
            found = self.source.find(name)
        except (LookupError, ValueError):
            raise Refusal(f"{name} is not defined") from None
        self.reads.log(self.source.function, "name", name, found)
        return found

    def assign(self, name: str, value: Value) -> None:
        """Assign a value to a name."""
        if self.arithmetic.lanes or name not in self._chosen or not self._depth:
            self._bound[name] = value
            return
        self._bound.pop(name, None)
        self.put(name, value)

    def settle(self, node: ast.AST) -> None:
        """Store known values in slots if a condition or loop can assign to their names.

        Raises
        ------
        Refusal
            If a value cannot be stored, so that it cannot be chosen at run time.
        """
        for name in assigned_in([node]) & self._bound.keys():
            if self._bound[name] is _NOTHING:
                continue
            value = self._bound.pop(name)
            if not memory.can_be_stored(value):
                raise Refusal(f"{name} means {value!r}, and control flow assigns to it; begin with a number")
            self.put(name, value)

    def forget(self, node: ast.AST) -> None:
        """Remove the values of the names that `node` assigns to: vectorised passes do not share values."""
        for name in assigned_in([node]):
            self._bound[name] = _NOTHING

    def put(self, name: str, value: Value) -> None:
        """Store a value in the slot of a name."""
        if name not in self._slots:
            self._slots[name] = memory.slot_for(self.arithmetic, value, self._needs.get(name, Need()))
        try:
            memory.store_slot(self.arithmetic, self._slots[name], value)
            self.text.block.assigned.add(name)
        except memory.WiderKindError as error:
            raise memory.WiderSlotError({name: Need(error.kind)}) from error
        bounds = memory.bounds_beyond(self._slots[name], value) if self.arithmetic.checked else None
        if bounds is not None:
            self._wider[name] = Need(bounds=bounds).together(self._wider.get(name, Need()))

    def generated(self, node: ast.GeneratorExp) -> tuple[Value, ...]:
        """Return the values of a generator as a tuple; its names do not exist outside."""
        if len(node.generators) > 1:
            raise Refusal("a generator with two loops; write one in the other")
        one = node.generators[0]
        outside, out = dict(self._bound), []
        for item in self.items(self.value(one.iter)):
            self._bind(one.target, item)
            conditions = [self.condition(test) for test in one.ifs]
            if any(isinstance(condition, Number) for condition in conditions):
                raise Refusal("the conditions of a generator must be known at compile time")
            if all(conditions):
                out.append(self.value(node.elt))
        self._bound = outside
        return tuple(out)

    def _bind(self, target: ast.expr, item: Value) -> None:
        """Assign the parts of an item to the names of a generator."""
        if isinstance(target, ast.Name):
            self._bound[target.id] = item
            return
        assert isinstance(target, ast.Tuple)
        for part, value in zip(target.elts, self.items(item), strict=True):
            self._bind(part, value)

    def assign_to(self, target: ast.expr, value: Value) -> None:
        """Assign a value to the target of an assignment."""
        match target:
            case ast.Name():
                self.assign(target.id, value)
            case ast.Starred():
                self.assign_to(target.value, value)
            case ast.Tuple() | ast.List():
                items = _gathered(self.items(value), target.elts)
                if len(items) != len(target.elts):
                    raise Refusal(f"{ast.unparse(target)} needs {len(target.elts)} values, not {len(items)}")
                for part, item in zip(target.elts, items, strict=True):
                    self.assign_to(part, item)
            case ast.Subscript():
                self._put_into_array(target, value)
            case _:
                raise Refusal(f"{ast.unparse(target)} cannot be assigned to")

    def _put_into_array(self, target: ast.Subscript, value: Value) -> None:
        if isinstance(value, Array):
            memory.copy(self.arithmetic, memory.view(self.arithmetic, self._array(target), self.indices(target)), value)
        else:
            memory.store_element(self.arithmetic, *self.place(target), value)

    def _array(self, target: ast.Subscript) -> Array:
        owner = self.value(target.value)
        if not isinstance(owner, Array):
            raise Refusal(f"{ast.unparse(target.value)} is not an array")
        return owner

    def place(self, target: ast.Subscript) -> tuple[Array, int]:
        """Return the element of an assignment, see `arrays.place`."""
        owner, indices = self._array(target), self.indices(target)
        if len(indices) != len(owner.shape) or any(map(_is_slice, indices)):
            raise Refusal(f"{ast.unparse(target)} is not a single element of an array; write a loop")
        return memory.place(self.arithmetic, owner, indices)


def _gathered(items: tuple[Value, ...], targets: Sequence[ast.expr]) -> tuple[Value, ...]:
    """Return items with those of a starred target as one tuple."""
    starred = [place for place, target in enumerate(targets) if isinstance(target, ast.Starred)]
    if not starred or len(items) < len(targets) - 1:
        return items
    (first,), more = starred, len(items) - len(targets) + 1
    return (*items[:first], tuple(items[first : first + more]), *items[first + more :])


def _is_slice(index: Value) -> bool:
    return isinstance(index, slice)


def assigned_in(statements: Iterable[ast.AST]) -> set[str]:
    """Return the names that statements assign to, without the names inside generators."""
    return set().union(*map(_assigned_by, statements))


@cache
def _assigned_by(statement: ast.AST) -> frozenset[str]:
    parts = list(ast.walk(statement))
    inner = {id(name) for part in parts if isinstance(part, ast.comprehension) for name in ast.walk(part.target)}
    return frozenset(
        part.id
        for part in parts
        if isinstance(part, ast.Name) and isinstance(part.ctx, ast.Store) and id(part) not in inner
    )


def _assigned_by_control_flow(statements: Iterable[ast.stmt]) -> set[str]:
    return assigned_in(statement for statement in statements if isinstance(statement, ast.If | ast.While | ast.For))


RESULT = "return"
"""Name of the slot of the result of a function."""


class Callees(Protocol):
    """Functions that are compiled together."""

    lanes: int
    reads: Reads
    traps: bool

    def call(
        self, caller: "Body", function: Callable[..., Any], values: list[Value], keywords: Mapping[str, Value]
    ) -> Value:
        """Return the result of a function that `caller` calls."""


class Body(Names):
    """Body of one function under construction.

    Parameters
    ----------
    callees
        Functions that it calls.
    source
        The function.
    arithmetic
        Writer of its instructions.
    needs
        What the slot of each name needs to hold, besides the first value.
    """

    def __init__(self, callees: Callees, source: Source, arithmetic: Arithmetic, needs: Mapping[str, Need]) -> None:
        super().__init__(source, arithmetic, callees.reads, needs)
        self.callees = callees
        self.result: Value = None
        self.exit = self.text.new_block()
        self._loops: list[tuple[BasicBlock, BasicBlock]] = []
        self._returned = False
        self._over = False
        """Whether the current instructions are in a loop over lanes of this function, not of its caller."""
        self._results: set[bool] = set()
        self._at: ast.AST = source.arguments

    # Running

    def run(self, arguments: Mapping[str, Value]) -> None:
        """Write the instructions of the function for these arguments.

        Raises
        ------
        CompileError
            If the function contains unsupported code.
        LanesRefusal
            If the function is called in a loop over lanes and contains code that is unsupported there.
        slots.WiderSlotError
            If slots of names need another kind or bounds.
        """
        try:
            for name, value in arguments.items():
                self.assign(name, value)
            self._block(self.source.body)
        except Refusal as refusal:
            if isinstance(refusal, LanesRefusal) and not self._over:
                raise  # the caller compiles one lane after the other
            raise at_its_place(refusal, self._at, self.source.file, self.source.name) from refusal
        except (ArithmeticError, LookupError, TypeError, ValueError, AttributeError) as error:  # from known values
            reason = f"{type(error).__name__}: {error}"
            raise at_its_place(reason, self._at, self.source.file, self.source.name) from error
        if self.arithmetic.lanes:
            return
        if RESULT in self._slots and not self.text.block.ended:
            message = "some paths return a value, others do not"
            raise at_its_place(message, self._at, self.source.file, self.source.name)
        if self._wider:
            raise memory.WiderSlotError(self._wider)
        self.text.jump(self.exit)
        self.text.begin(self.exit)

    def call(self, function: Callable[..., Any], values: list[Value], keywords: dict[str, Value]) -> Value:
        """Return the result of a function written in Python."""
        return self.callees.call(self, function, values, keywords)

    @property
    def in_loop(self) -> bool:
        """Whether the current instructions are inside a loop."""
        return bool(self._loops)

    # Statements

    def _block(self, statements: Iterable[ast.stmt]) -> None:
        for statement in statements:
            if self.text.block.ended or self._returned:
                return
            self._at = statement
            self._statement(statement)

    def _statement(self, node: ast.stmt) -> None:  # noqa: C901, PLR0912  one case for each form
        match node:
            case ast.Expr(value=ast.Constant()) | ast.Pass():
                pass
            case ast.Expr():
                if not self._is_advice(node.value):
                    self.value(node.value)
            case ast.Delete(targets=targets) if all(isinstance(target, ast.Name) for target in targets):
                pass
            case ast.Raise() if self.callees.traps:
                trap = self.arithmetic.module.declared("llvm.trap", "void", [])
                self.text.line(f"call void {trap}()")
                self.text.end("unreachable")
            case ast.Assert() if self.callees.traps:
                pass
            case ast.Assign():
                value = self.value(node.value)
                for target in node.targets:
                    self.assign_to(target, value)
            case ast.AnnAssign():
                if node.value is not None:
                    self.assign_to(node.target, self.value(node.value))
            case ast.AugAssign():
                self._change(node)
            case ast.Return():
                self._return(None if node.value is None else self.value(node.value))
            case ast.If():
                self._if(node)
            case ast.While(orelse=[]):
                self._while(node)
            case ast.For(orelse=[]):
                self._for(node)
            case ast.With(items=[ast.withitem(ast.Call(func=ast.Attribute() as function), None)]) if (
                self.value(function) is np.errstate
            ):
                self._block(node.body)
            case ast.While() | ast.For():
                raise Refusal(
                    "else after a loop is not compiled; set a truth value before break and test it behind the loop"
                )
            case ast.Break() | ast.Continue():
                self._outside_lanes("break and continue within lanes; write a if condition else b")
                self.text.jump(self._loops[-1][isinstance(node, ast.Break)])
            case _:
                raise Refusal(f"{type(node).__name__} is not compiled; write it with loops, conditions and calls")

    def _is_advice(self, node: ast.expr) -> bool:
        """Return whether an expression calls a function that only speaks to the user."""
        if not isinstance(node, ast.Call) or not isinstance(node.func, ast.Name):
            return False
        return node.func.id not in self._own and marks.is_advice(self.read(node.func.id))

    def _change(self, node: ast.AugAssign) -> None:
        if not isinstance(node.target, ast.Subscript):
            old = self.value(ast.parse(ast.unparse(node.target), mode="eval").body)
            self.assign_to(node.target, self.arithmetic.binary(node.op, old, self.value(node.value)))
            return
        element, lanes = self.place(node.target)
        old = memory.load_element(self.arithmetic, element, lanes)
        new = self.arithmetic.binary(node.op, old, self.value(node.value))
        memory.store_element(self.arithmetic, element, lanes, new)

    def _return(self, value: Value) -> None:
        if self._over:
            raise Refusal("return within lanes")
        if self.arithmetic.lanes:
            self.result, self._returned = value, True
            return
        self._results.add(value is None)
        if len(self._results) > 1:
            raise Refusal("some paths return a value, others do not")
        if has_array(value):
            raise Refusal("arrays are not returned; pass one in which the results are put")
        if value is not None:
            self.put(RESULT, value)
        self.text.jump(self.exit)

    def finished(self) -> Value:
        """Return the result after the last instruction of the function."""
        return self.result if self.arithmetic.lanes else memory.load_slot(self.arithmetic, self._slots.get(RESULT))

    def _if(self, node: ast.If) -> None:
        condition = self.condition(node.test)
        if not isinstance(condition, Number):
            self._block(node.body if condition else node.orelse)
            return
        self._outside_lanes("a condition on lanes; write a if condition else b")
        self.settle(node)
        yes, no, done = (self.text.new_block() for _ in range(3))
        self.text.branch(condition.text, yes, no)
        for block, statements in ((yes, node.body), (no, node.orelse)):
            self.text.begin(block)
            self._while_running(statements)
            self.text.jump(done)
        self.text.begin(done)

    def _while_running(self, statements: Iterable[ast.stmt]) -> None:
        self._depth += 1
        self._block(statements)
        self._depth -= 1

    def _while(self, node: ast.While) -> None:
        self._outside_lanes()
        self.settle(node)
        head, body, done = (self.text.new_block() for _ in range(3))
        self.text.jump(head)
        self.text.begin(head)
        condition = self.condition(node.test)
        if isinstance(condition, Number):
            self.text.branch(condition.text, body, done)
        else:
            self.text.jump(body if condition else done)
        self.text.begin(body)
        self._pass(node.body, head, done)
        self.text.jump(head)
        self.text.begin(done)

    def _pass(self, statements: Iterable[ast.stmt], onward: BasicBlock, done: BasicBlock) -> None:
        self._loops.append((onward, done))
        self._while_running(statements)
        self._loops.pop()

    def _outside_lanes(self, reason: str = "a loop whose length is not known, within lanes") -> None:
        if self.arithmetic.lanes:
            raise LanesRefusal(reason)

    # Loops

    def _for(self, node: ast.For) -> None:
        if isinstance(node.iter, ast.Call) and isinstance(node.iter.func, ast.Name | ast.Attribute):
            function = self.value(node.iter.func)
            if function in (range, marks.lanes):
                ends = [self.value(argument) for argument in node.iter.args]
                if function is marks.lanes and self.callees.lanes:
                    self._over_lanes(node, *ends)
                else:
                    self._over_range(node, ends)
                return
        items = self.value(node.iter)
        if not isinstance(items, tuple):
            raise Refusal(f"{ast.unparse(node.iter)} is neither a range nor a tuple")
        self._unrolled(node, items)

    def _over_range(self, node: ast.For, ends: list[Value]) -> None:
        known = all(isinstance(end, int) for end in ends)
        if known and (self.arithmetic.lanes or self._picks_from_tuples(node)):
            self._unrolled(node, range(*ends))
            return
        self._outside_lanes()
        self.settle(node)
        start, stop, *step = ends if len(ends) > 1 else [0, *ends]
        if step and step != [1]:
            raise Refusal("a range whose step is not 1; write a while loop")
        counter = self.text.allocated("i64")
        end = self.arithmetic.number(stop, NumberKind.INTEGER)
        self.text.line(f"store {self.arithmetic.number(start, NumberKind.INTEGER).operand}, ptr {counter}")
        head, body, onward, done = (self.text.new_block() for _ in range(4))
        self.text.jump(head)
        self.text.begin(head)
        index = Number(
            NumberKind.INTEGER, self.text.value(f"load i64, ptr {counter}"), bounds=self._passes(start, stop)
        )
        self.text.branch(self.arithmetic.compared(ast.Lt(), index, end).text, body, done)
        certain = known and start < stop
        if certain:  # the loop ends after a pass, not before the first one
            done.reached = False
        self.text.begin(body)
        self._depth += 1
        self._take_item(node, index)
        self._depth -= 1
        self._pass(node.body, onward, done)
        if isinstance(node.target, ast.Name):
            self._bound.pop(node.target.id, None)  # its slot holds the value at the end of the loop
        self.text.jump(onward)
        self.text.begin(onward)
        if certain:
            self.text.reach(done)
        next_one = self.arithmetic.binary(ast.Add(), index, 1)
        self.text.line(f"store {next_one.operand}, ptr {counter}")
        self.text.jump(head)
        self.text.begin(done)

    def _passes(self, start: Value, stop: Value) -> Bounds | None:
        """Return the bounds of the index of a loop."""
        if not self.arithmetic.checked:
            return None
        low = bounds_of(start)[0]
        return low, max(low, bounds_of(stop)[1] - 1)

    def _unrolled(self, node: ast.For, items: Iterable[Value]) -> None:
        done = self.text.new_block()
        left_early = any(isinstance(part, ast.Break | ast.Continue) for one in node.body for part in ast.walk(one))
        if left_early and not self.arithmetic.lanes:
            self.settle(node)
        for item in items:
            onward = self.text.new_block()
            self._depth += left_early
            self._take_item(node, item)
            self._loops.append((onward, done))
            self._block(node.body)
            self._depth -= left_early
            self._loops.pop()
            if not self.arithmetic.lanes:
                self.text.jump(onward)
                self.text.begin(onward)
        if isinstance(node.target, ast.Name) and not self.arithmetic.lanes:
            self._bound.pop(node.target.id, None)  # its slot holds the value at the end of the loop
        if not self.arithmetic.lanes:
            self.text.jump(done)
            self.text.begin(done)

    def _take_item(self, node: ast.For, item: Value) -> None:
        """Assign a value to the target of a loop; it is known in the body unless the body assigns to it."""
        name = node.target.id if isinstance(node.target, ast.Name) else ""
        if not name or name in assigned_in(node.body) or self.arithmetic.lanes:
            self.assign_to(node.target, item)
            return
        if memory.can_be_stored(item):
            self.put(name, item)
        self._bound[name] = item

    def _picks_from_tuples(self, node: ast.For) -> bool:
        """Return whether the loop index selects from tuples, so that the loop must be unrolled."""
        if not isinstance(node.target, ast.Name):
            return False
        return any(
            isinstance(part, ast.Subscript)
            and isinstance(part.value, ast.Name)
            and isinstance(part.slice, ast.Name)
            and part.slice.id == node.target.id
            and self._is_tuple(part.value.id)
            for statement in node.body
            for part in ast.walk(statement)
        )

    def _is_tuple(self, name: str) -> bool:
        known = self._bound.get(name, self._slots.get(name))
        if known is None and name not in self._own:
            known = self.read(name)
        return isinstance(known, tuple)

    def _over_lanes(self, node: ast.For, count: Value) -> None:
        """Compile a vectorised loop over lanes, with as many passes at once as a vector holds."""
        width = self.callees.lanes
        whole = count % width == 0 if isinstance(count, int) else isinstance(count, Number)
        if self.arithmetic.lanes or not whole or not isinstance(node.target, ast.Name):
            raise Refusal(f"a loop over lanes cannot be inside another one and must have a multiple of {width} passes")
        end = self.arithmetic.number(count, NumberKind.INTEGER)
        head, done = self.text.new_block(), self.text.new_block()
        self.text.jump(head)
        begun = self.text.block
        self.text.begin(head)
        first, onward = self.text.name(), self.text.name()
        position = len(head.lines)
        self.arithmetic.lanes, self._over = width, True
        self.forget(node)
        self._bound[node.target.id] = LaneIndex(Number(NumberKind.INTEGER, first, bounds=self._passes(0, count)))
        self._block(node.body)
        self.forget(node)
        self.arithmetic.lanes, self._over = 0, False
        self.text.line(f"{onward} = add nuw nsw i64 {first}, {constant(width, NumberKind.INTEGER).text}")
        more = self.text.value(f"icmp ult i64 {onward}, {end.text}")
        last = self.text.block
        head.lines.insert(position, f"{first} = phi i64 [ 0, %{begun.label} ], [ {onward}, %{last.label} ]")
        self.text.branch(more, head, done)
        self.text.begin(done)
