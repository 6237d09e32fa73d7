"""Compilation of statements: the body of one function."""

import ast
from collections.abc import Callable, Iterable, Mapping
from typing import Any, Protocol

from stylobate.compiler import arrays, marks, slots
from stylobate.compiler.arithmetic import Arithmetic
from stylobate.compiler.names import Names, assigned_in
from stylobate.compiler.reads import Reads
from stylobate.compiler.refusal import LanesRefusal, Refusal, at_its_place
from stylobate.compiler.slots import Need, has_array
from stylobate.compiler.sources import Source
from stylobate.compiler.text import Block
from stylobate.compiler.values import Bounds, Kind, LaneIndex, Number, Value, constant
from stylobate.compiler.whole_numbers import bounds_of

RESULT = "return"
"""Name of the slot of the result of a function."""


class Callees(Protocol):
    """Functions that are compiled together."""

    lanes: int
    reads: Reads

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
        self._loops: list[tuple[Block, Block]] = []
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
            raise slots.WiderSlotError(self._wider)
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
                self.value(node.value)
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
            case ast.While() | ast.For():
                message = (
                    "else after a loop is not compiled; set a truth value before break and test it behind the loop"
                )
                raise Refusal(message)
            case ast.Break() | ast.Continue():
                self._outside_lanes("break and continue within lanes; write a if condition else b")
                self.text.jump(self._loops[-1][isinstance(node, ast.Break)])
            case _:
                message = f"{type(node).__name__} is not compiled; write it with loops, conditions and calls"
                raise Refusal(message)

    def _change(self, node: ast.AugAssign) -> None:
        if not isinstance(node.target, ast.Subscript):
            old = self.value(ast.parse(ast.unparse(node.target), mode="eval").body)
            self.assign_to(node.target, self.arithmetic.binary(node.op, old, self.value(node.value)))
            return
        element, lanes = self.place(node.target)
        old = arrays.load(self.arithmetic, element, lanes)
        new = self.arithmetic.binary(node.op, old, self.value(node.value))
        arrays.store(self.arithmetic, element, lanes, new)

    def _return(self, value: Value) -> None:
        if self._over:
            message = "return within lanes"
            raise Refusal(message)
        if self.arithmetic.lanes:
            self.result, self._returned = value, True
            return
        self._results.add(value is None)
        if len(self._results) > 1:
            message = "some paths return a value, others do not"
            raise Refusal(message)
        if has_array(value):
            message = "arrays are not returned; pass one in which the results are put"
            raise Refusal(message)
        if value is not None:
            self.put(RESULT, value)
        self.text.jump(self.exit)

    def finished(self) -> Value:
        """Return the result after the last instruction of the function."""
        return self.result if self.arithmetic.lanes else slots.load(self.arithmetic, self._slots.get(RESULT))

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

    def _pass(self, statements: Iterable[ast.stmt], onward: Block, done: Block) -> None:
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
            message = f"{ast.unparse(node.iter)} is neither a range nor a tuple"
            raise Refusal(message)
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
            message = "a range whose step is not 1; write a while loop"
            raise Refusal(message)
        counter = self.text.allocated("i64")
        end = self.arithmetic.number(stop, Kind.INTEGER)
        self.text.line(f"store {self.arithmetic.number(start, Kind.INTEGER).operand}, ptr {counter}")
        head, body, onward, done = (self.text.new_block() for _ in range(4))
        self.text.jump(head)
        self.text.begin(head)
        index = Number(Kind.INTEGER, self.text.value(f"load i64, ptr {counter}"), bounds=self._passes(start, stop))
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
        if slots.can_be_stored(item):
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
            message = f"a loop over lanes cannot be inside another one and must have a multiple of {width} passes"
            raise Refusal(message)
        end = self.arithmetic.number(count, Kind.INTEGER)
        head, done = self.text.new_block(), self.text.new_block()
        self.text.jump(head)
        begun = self.text.block
        self.text.begin(head)
        first, onward = self.text.name(), self.text.name()
        position = len(head.lines)
        self.arithmetic.lanes, self._over = width, True
        self.forget(node)
        self._bound[node.target.id] = LaneIndex(Number(Kind.INTEGER, first, bounds=self._passes(0, count)))
        self._block(node.body)
        self.forget(node)
        self.arithmetic.lanes, self._over = 0, False
        self.text.line(f"{onward} = add nuw nsw i64 {first}, {constant(width, Kind.INTEGER).text}")
        more = self.text.value(f"icmp ult i64 {onward}, {end.text}")
        last = self.text.block
        head.lines.insert(position, f"{first} = phi i64 [ 0, %{begun.label} ], [ {onward}, %{last.label} ]")
        self.text.branch(more, head, done)
        self.text.begin(done)
