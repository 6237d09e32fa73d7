"""Values that are read while functions of a model are compiled, and fingerprints of functions.

Machine code holds the values of globals, closures, default values and attributes as numbers. It is valid as long as all
of them are what they were. The values are found again, in another process too, by following the same names.
"""

import dis
import hashlib
import types
from collections.abc import Callable, Iterator, Mapping, Sequence
from enum import Enum, EnumType
from typing import Any, NamedTuple

import numpy as np

from stylobate.compiler.marks import is_fast
from stylobate.compiler.sources import CompileError, Refusal, plain_function, value_of_name

Function = Callable[..., Any]

_VERSIONED = ("stylobate", "builtins", "abc", "typing", "enum", "numpy")
"""Packages whose classes a user does not change."""


def fingerprint(function: Function) -> str:
    """Return a digest of `function`: its code, and the constants and functions that it uses."""
    digest = hashlib.sha256()
    for part in _parts(plain_function(function), set()):
        digest.update(part.encode())
        digest.update(b"\0")
    return digest.hexdigest()


def _parts(function: types.FunctionType, seen: set[int]) -> Iterator[str]:
    if id(function) in seen:
        return
    seen.add(id(function))
    code = function.__code__
    yield from code_parts(code)
    yield f"fast {is_fast(function)}"
    yield from _value_parts(function.__defaults__ or (), seen)
    yield from _value_parts(tuple(sorted((function.__kwdefaults__ or {}).items())), seen)
    for cell in function.__closure__ or ():
        yield from _value_parts(cell.cell_contents, seen)
    for dotted in global_names(code):
        yield dotted
        for value in _along(function.__globals__, dotted):
            yield from _value_parts(value, seen)


def _along(names: Mapping[str, Any], dotted: str) -> Iterator[object]:
    """Yield the objects along a name such as f, module.f or Class.constant."""
    root, *path = dotted.split(".")
    value = names.get(root)
    yield value
    for attribute in path:
        value = getattr(value, attribute, None)
        yield value


def _value_parts(value: object, seen: set[int]) -> Iterator[str]:
    plain = getattr(value, "py_func", value)
    if isinstance(plain, types.FunctionType):
        yield from _parts(plain, seen)
    elif isinstance(plain, tuple | list):
        yield f"{type(plain).__name__} of {len(plain)}"
        for part in plain:
            yield from _value_parts(part, seen)
    elif isinstance(plain, type) and hasattr(plain, "_fields"):
        yield f"{plain.__name__} {plain._fields}"
        yield from _value_parts(tuple(plain._field_defaults.items()), seen)  # type: ignore[attr-defined]
    else:
        yield _class_described(plain)
        yield from _attribute_parts(plain, seen)


def _attribute_parts(thing: object, seen: set[int]) -> Iterator[str]:
    """Yield the values that belong to an object or class of the user; functions count where they are called."""
    kind = thing if isinstance(thing, type) else type(thing)
    if id(thing) in seen or isinstance(thing, types.ModuleType) or kind.__module__.split(".")[0] in _VERSIONED:
        return
    seen.add(id(thing))
    for name, value in sorted(getattr(thing, "__dict__", {}).items()):
        if not (name.startswith("__") or callable(value) or isinstance(value, staticmethod | classmethod | property)):
            yield name
            yield from _value_parts(value, seen)


def _class_described(value: object) -> str:
    """Return a text that differs between different constants."""
    if isinstance(value, np.ndarray):
        return f"{value.dtype} {value.shape} {value.tobytes().hex()}"
    if isinstance(value, Enum):
        return f"{value!r} {value.value!r}"
    if isinstance(value, bool | int | float | complex | str | np.generic | range | None):
        return repr(value)
    return str(getattr(value, "__qualname__", type(value).__qualname__))


def code_parts(code: types.CodeType) -> Iterator[str]:
    """Yield texts that differ between different codes, without the names of file and function."""
    yield code.co_code.hex()
    yield repr((code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars))
    yield repr((code.co_argcount, code.co_posonlyargcount, code.co_kwonlyargcount, code.co_flags))
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from code_parts(constant)
        else:
            yield repr(constant)


def global_names(code: types.CodeType) -> Iterator[str]:
    """Yield the names that `code`, generators included, looks up in its module, with attributes, such as `math.pi`."""
    name = ""
    for instruction in dis.get_instructions(code):
        if instruction.opname == "LOAD_GLOBAL":
            if name:
                yield name
            name = instruction.argval
        elif name and instruction.opname in ("LOAD_ATTR", "LOAD_METHOD"):
            name += f".{instruction.argval}"
        elif name:
            yield name
            name = ""
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            yield from global_names(constant)


Functions = Mapping[str, Callable[..., Any]]

_NUMBERS_AND_TEXTS = (bool, int, float, complex, str, bytes, range, type(None), type(Ellipsis), np.generic)
_BY_CONTENT = (*_NUMBERS_AND_TEXTS, tuple, list, np.ndarray)
"""Types that are described by their content; all others are objects whose attributes are read one by one."""

NO_VALUE = (ArithmeticError, AttributeError, LookupError, TypeError, ValueError, CompileError)
"""Errors if there is no value at a place."""


class Place(NamedTuple):
    """Where a value was found: its owner, by the index of its place, and the way from there.

    The owner −1 is the mapping of the functions of the model.
    """

    owner: int
    way: str
    name: str


def _default(function: types.FunctionType, name: str) -> object:
    if name in (function.__kwdefaults__ or {}):
        return (function.__kwdefaults__ or {})[name]
    code, defaults = function.__code__, function.__defaults__ or ()
    return defaults[code.co_varnames.index(name) - code.co_argcount + len(defaults)]


_WAYS: dict[str, Callable[[Any, str], object]] = {
    "function": lambda functions, name: functions[name],
    "plain": lambda function, _: plain_function(function),
    "name": value_of_name,
    "attribute": getattr,
    "default": _default,
    "item": lambda items, position: items[int(position)],
}


class Reads:
    """Log of the values that are read while the functions of a model are compiled.

    Functions that are not reached from those of the model are part of the program; their values are not logged.

    Parameters
    ----------
    functions
        Functions of the model, by their names.
    """

    def __init__(self, functions: Functions) -> None:
        self._functions = functions
        self.places: list[Place] = []
        self._values: list[object] = []
        self._index: dict[Place, int] = {}
        self._owners: dict[int, int] = {}
        self._alive: list[object] = []
        for name in sorted(functions):
            self._log(Place(-1, "function", name), functions[name])

    def logs(self, owner: object) -> bool:
        """Return whether the values that belong to this function or object are logged."""
        return id(owner) in self._owners

    def log(self, owner: object, way: str, name: str, value: object) -> None:
        """Log a value, if it belongs to a function or object that a function of the model reached."""
        index = self._owners.get(id(owner))
        if index is not None:
            self._log(Place(index, way, name), value)

    def plain(self, function: Callable[..., Any]) -> types.FunctionType:
        """Return the Python function of a callable, and log it."""
        plain = plain_function(function)
        if plain is not function:
            self.log(function, "plain", "", plain)
        return plain

    def _log(self, place: Place, value: object) -> None:
        index = self._index.get(place)
        if index is None:
            index = self._index[place] = len(self.places)
            self.places.append(place)
            self._values.append(value)
        elif value is not self._values[index] and description(value) != description(self._values[index]):
            raise Refusal(f"{_in_words(self.places, index)} has another value at each reading; keep it in a variable")
        self._own(value, index)

    def _own(self, value: object, index: int) -> None:
        if isinstance(value, tuple | list):
            for position, part in enumerate(value):
                if not is_plain(part):
                    self._log(Place(index, "item", str(position)), part)
        elif not isinstance(value, _BY_CONTENT) and id(value) not in self._owners:
            self._owners[id(value)] = index
            self._alive.append(value)

    def watch(self) -> "Watch":
        """Return the watch over the logged values.

        Raises
        ------
        Refusal
            If a value has changed since it was logged.
        """
        watch = Watch(self._functions, self.places)
        for index, (then, now) in enumerate(zip(descriptions(self._values), watch.descriptions, strict=True)):
            if then != now:
                raise Refusal(f"{_in_words(self.places, index)} changed during the compilation; start again")
        return watch


class Watch:
    """Values at the places of a log, which show whether machine code is still valid.

    Raises
    ------
    NO_VALUE
        If there is no value at one of the places.
    """

    def __init__(self, functions: Functions, places: Sequence[Place]) -> None:
        self._functions, self.places = functions, [Place(*place) for place in places]
        values = self._found()
        self.descriptions = descriptions(values)
        self._keep(values)

    def unchanged(self) -> bool:
        """Return whether all values are what they were; takes some 10 µs."""
        try:
            return self._is_same() or self._same_descriptions()
        except NO_VALUE:
            return False

    def _is_same(self) -> bool:
        """Return whether the same objects stand at all places: then each owner is the one at which its values were."""
        for names, name, value in self._names:
            if names.get(name, names) is not value:
                return False
        for find, owner, name, value in self._others:
            if find(owner, name) is not value:
                return False
        for function, code in self._codes:
            if function.__code__ is not code:
                return False
        return all(description(value) == before for value, before in self._contents)

    def _same_descriptions(self) -> bool:
        values = self._found()
        if descriptions(values) != self.descriptions:
            return False
        self._keep(values)
        return True

    def _found(self) -> list[object]:
        values: list[object] = []
        for place in self.places:
            values.append(_WAYS[place.way](self._owner(place, values), place.name))
        return values

    def _owner(self, place: Place, values: Sequence[object]) -> Any:
        return self._functions if place.owner < 0 else values[place.owner]

    def _keep(self, values: list[object]) -> None:
        self._names: list[tuple[dict[str, Any], str, object]] = []
        self._others: list[tuple[Callable[[Any, str], object], Any, str, object]] = []
        for place, value in zip(self.places, values, strict=True):
            owner = self._owner(place, values)
            if place.way == "name" and place.name in _global_names(owner):
                self._names.append((owner.__globals__, place.name, value))
            else:
                self._others.append((_WAYS[place.way], owner, place.name, value))
        once = {id(value): value for value in values}.values()
        self._codes = [(value, value.__code__) for value in once if isinstance(value, types.FunctionType)]
        self._contents = [(value, description(value)) for value in once if _can_change(value)]


def _global_names(function: types.FunctionType) -> set[str]:
    return set(function.__globals__) - set(function.__code__.co_freevars)


def _can_change(value: object) -> bool:
    """Return whether the content of a value can change without another object in its place."""
    return isinstance(value, np.ndarray | list) or (isinstance(value, tuple) and not _is_fixed(value))


def _is_fixed(items: tuple[object, ...]) -> bool:
    return all(
        _is_fixed(part) if isinstance(part, tuple) else not isinstance(part, np.ndarray | list | types.FunctionType)
        for part in items
    )


def is_plain(value: object) -> bool:
    """Return whether a value consists of numbers and texts."""
    if isinstance(value, tuple | list):
        return all(map(is_plain, value))
    return isinstance(value, (*_NUMBERS_AND_TEXTS, np.ndarray)) and not isinstance(value, Enum)


def descriptions(values: Sequence[object]) -> list[str]:
    """Return the descriptions of values; an object that stands at several places is described at the first one."""
    first: dict[int, int] = {}
    out = []
    for index, value in enumerate(values):
        place = index if is_plain(value) else first.setdefault(id(value), index)
        out.append(description(value) if place == index else f"the same as {place}")
    return out


def description(value: object) -> str:
    """Return a text that differs between different values, and is the same in each process."""
    return f"{_name_of(type(value))} {_content(value)}"


def _content(value: object) -> str:
    match value:
        case Enum():
            return f"{value.name} {description(value.value)}"
        case float():
            return float.__repr__(value)
        case int():
            return int.__repr__(value)
        case np.ndarray():
            return f"{value.dtype} {value.shape} {_digest([value.tobytes()])}"
        case tuple() | list():
            return f"{getattr(value, '_fields', '')} [{', '.join(map(description, value))}]"
        case _:
            return repr(value) if isinstance(value, _NUMBERS_AND_TEXTS) else _described(value)


def _described(value: object) -> str:
    if isinstance(value, types.FunctionType):
        return _digest([f"fast {is_fast(value)}", *code_parts(value.__code__)])
    if isinstance(value, type) and issubclass(value, tuple) and hasattr(value, "_fields"):
        return f"{_name_of(value)} {value._fields} {description(tuple(value._field_defaults.items()))}"  # type: ignore[attr-defined]
    if isinstance(value, EnumType):
        return f"{_name_of(value)} {description(list(value))}"
    return _name_of(value) if callable(value) or isinstance(value, types.ModuleType) else ""


def _digest(parts: Sequence[str | bytes] | Iterator[str]) -> str:
    total = hashlib.sha256()
    for part in parts:
        total.update(part.encode() if isinstance(part, str) else part)
        total.update(b"\0")
    return total.hexdigest()


def _name_of(thing: Any) -> str:
    name = getattr(thing, "__qualname__", None) or getattr(thing, "__name__", "")
    return f"{getattr(thing, '__module__', '')}.{name}"


def _in_words(places: Sequence[Place], index: int) -> str:
    """Return a name such as CONST.k."""
    owner, way, name = places[index]
    if way == "attribute":
        return f"{_in_words(places, owner)}.{name}"
    if way == "item":
        return f"{_in_words(places, owner)}[{name}]"
    return _in_words(places, owner) if way == "plain" else name
