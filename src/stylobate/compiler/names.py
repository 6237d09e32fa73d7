"""Names of a function under construction, and assignments to them."""

import ast
from collections.abc import Iterable, Mapping
from functools import cache

from stylobate.compiler import arrays, slots
from stylobate.compiler.arithmetic import Arithmetic
from stylobate.compiler.expressions import Expressions
from stylobate.compiler.reads import Reads
from stylobate.compiler.refusal import Refusal
from stylobate.compiler.slots import Need
from stylobate.compiler.sources import Source
from stylobate.compiler.values import Array, Number, Value

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
                message = f"{name} is not assigned on every path to its use; assign it before the condition or loop"
                raise Refusal(message)
            return slots.load(self.arithmetic, self._slots[name])
        if name in self._own:
            message = f"{name} has no value here; a loop over a tuple or over lanes does not keep its names"
            raise Refusal(message)
        try:
            found = self.source.find(name)
        except (LookupError, ValueError):
            message = f"{name} is not defined"
            raise Refusal(message) from None
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
            if not slots.can_be_stored(value):
                message = f"{name} means {value!r}, and control flow assigns to it; begin with a number"
                raise Refusal(message)
            self.put(name, value)

    def forget(self, node: ast.AST) -> None:
        """Remove the values of the names that `node` assigns to: vectorised passes do not share values."""
        for name in assigned_in([node]):
            self._bound[name] = _NOTHING

    def put(self, name: str, value: Value) -> None:
        """Store a value in the slot of a name."""
        if name not in self._slots:
            self._slots[name] = slots.slot_for(self.arithmetic, value, self._needs.get(name, Need()))
        try:
            slots.store(self.arithmetic, self._slots[name], value)
            self.text.block.assigned.add(name)
        except slots.WiderKindError as error:
            raise slots.WiderSlotError({name: Need(error.kind)}) from error
        bounds = slots.bounds_beyond(self._slots[name], value) if self.arithmetic.checked else None
        if bounds is not None:
            self._wider[name] = Need(bounds=bounds).together(self._wider.get(name, Need()))

    def generated(self, node: ast.GeneratorExp) -> tuple[Value, ...]:
        """Return the values of a generator as a tuple; its names do not exist outside."""
        if len(node.generators) > 1:
            message = "a generator with two loops; write one in the other"
            raise Refusal(message)
        one = node.generators[0]
        outside, out = dict(self._bound), []
        for item in self.items(self.value(one.iter)):
            self._bind(one.target, item)
            conditions = [self.condition(test) for test in one.ifs]
            if any(isinstance(condition, Number) for condition in conditions):
                message = "the conditions of a generator must be known at compile time"
                raise Refusal(message)
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
            case ast.Tuple() | ast.List():
                items = self.items(value)
                if len(items) != len(target.elts):
                    message = f"{ast.unparse(target)} needs {len(target.elts)} values, not {len(items)}"
                    raise Refusal(message)
                for part, item in zip(target.elts, items, strict=True):
                    self.assign_to(part, item)
            case ast.Subscript():
                self._put_into_array(target, value)
            case _:
                message = f"{ast.unparse(target)} cannot be assigned to"
                raise Refusal(message)

    def _put_into_array(self, target: ast.Subscript, value: Value) -> None:
        if isinstance(value, Array):
            arrays.copy(self.arithmetic, arrays.view(self.arithmetic, self._array(target), self.indices(target)), value)
        else:
            arrays.store(self.arithmetic, *self.place(target), value)

    def _array(self, target: ast.Subscript) -> Array:
        owner = self.value(target.value)
        if not isinstance(owner, Array):
            message = f"{ast.unparse(target.value)} is not an array"
            raise Refusal(message)
        return owner

    def place(self, target: ast.Subscript) -> tuple[Array, int]:
        """Return the element of an assignment, see `arrays.place`."""
        owner, indices = self._array(target), self.indices(target)
        if len(indices) != len(owner.shape) or any(map(_is_slice, indices)):
            message = f"{ast.unparse(target)} is not a single element of an array; write a loop"
            raise Refusal(message)
        return arrays.place(self.arithmetic, owner, indices)


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
