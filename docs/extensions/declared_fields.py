"""Read kinds, numbers and tables of description files from their declarations, for the page on file formats."""

import inspect
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import cache
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic_core import PydanticUndefined

from stylobate.column.shapes import SHAPES_IN_FILES, SHAPES_WITH_OPTIONS
from stylobate.config import study_config
from stylobate.kinds import loaded
from stylobate.models.declared import MODELS
from stylobate.quantities import Parameter, parameters_of
from stylobate.run_arguments import run_numbers

PARTS: Mapping[str, Callable[[], Mapping[str, Callable[..., Any]]]] = {
    "column": lambda: {**SHAPES_WITH_OPTIONS, **SHAPES_IN_FILES},
    "model": lambda: MODELS,
    "motion": lambda: loaded("stylobate.base_motions.declared:MOTIONS"),
}
"""The parts of a description that have kinds, and what makes each kind."""

_READ_FROM_FILES = "record"  # this kind of motion is the table of `RecordMotion`, not of declared numbers


@dataclass(frozen=True, slots=True)
class Kind:
    """A kind of column, model or base motion: its text, the numbers that it needs, and its optional numbers."""

    name: str
    text: str
    needed: tuple[str, ...]
    optional: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Number:
    """A declared number: its names, unit, default and range, and the kinds that have it."""

    name: str
    text: str
    unit: str
    default: str
    range: str
    kinds: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Field:
    """A key of a table in a description file."""

    name: str
    type: str
    default: str
    text: str


def kinds(part: str) -> list[Kind]:
    """List the kinds of a part: "column", "model" or "motion"."""
    return [_kind(name, make) for name, make in PARTS[part]().items()]


def _kind(name: str, make: Callable[..., Any]) -> Kind:
    text = _as_noun((inspect.getdoc(make) or "").partition("\n")[0])
    if name == _READ_FROM_FILES:
        return Kind(name, text, (), ())
    declared, arguments = parameters_of(make), inspect.signature(make).parameters
    others = [one for one in ("motion", "motions", "parts") if one in arguments]
    others += ["motion"] if "self" in arguments else []
    needed = [one for one in declared if declared[one].required]
    return Kind(
        name,
        text,
        (*others, *needed),
        (
            *(one for one in ("elevations",) if one in arguments),
            *(one for one in declared if not declared[one].required),
        ),
    )


def _as_noun(text: str) -> str:
    """Turn the first line of a constructor's docstring into what it makes.

    >>> _as_noun("Make a motion on a circle."), _as_noun("Scale this motion by `factor`.")
    ('A motion on a circle.', 'Scale this motion by `factor`.')
    """
    noun = re.sub(r"^(?:Make|Return|Create|Build|Construct) ", "", text)
    return noun[:1].upper() + noun[1:]


def numbers(part: str) -> list[Number]:
    """List the declared numbers of all kinds of a part; one that differs between kinds has a row for each meaning."""
    found: dict[tuple[str, str, str, str, str], list[str]] = {}
    makers = {
        name: make for name, make in PARTS[part]().items() if name != _READ_FROM_FILES
    }
    for kind, make in makers.items():
        for name, parameter in parameters_of(make).items():
            key = (
                name,
                _text(parameter),
                parameter.quantity.unit,
                _default(parameter),
                range_of(parameter),
            )
            found.setdefault(key, []).append(kind)
    ordered = sorted(found, key=lambda key: [one[0] for one in found].index(key[0]))
    return [
        Number(*key, () if len(found[key]) == len(makers) else tuple(found[key]))
        for key in ordered
    ]


def numbers_of_runs() -> list[Number]:
    """List the numbers of runs, such as the initial state and the tolerances."""
    return [
        Number(name, _text(one), one.quantity.unit, _default(one), range_of(one), ())
        for name, one in run_numbers().items()
    ]


def _text(parameter: Parameter) -> str:
    return " ".join(
        one for one in (parameter.quantity.text, parameter.quantity.symbol) if one
    )


def _default(parameter: Parameter) -> str:
    return "" if parameter.required else _shown(parameter.default)


def range_of(parameter: Parameter) -> str:
    """Write which values a number can have.

    >>> from stylobate.quantities import Quantity
    >>> range_of(Parameter("damping", Quantity(ge=0.0), float))
    'zero or positive'
    """
    if parameter.choices:
        return ", ".join(map(_shown, parameter.choices))
    words = parameter.quantity.demand.removeprefix("be ").removeprefix("lie ")
    words = "any" if words == "finite" else words
    words = f"whole, {words}" if parameter.whole else words
    words = ", or ".join([words, *map(_shown, parameter.quantity.by_word)])
    count = parameter.quantity.components
    return f"{count} numbers, {words}" if count > 1 else words


def _shown(value: Any) -> str:
    """Write a value as in TOML; nothing for None."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value!s}"'
    if isinstance(value, (tuple, list)):
        return f"[{', '.join(map(_shown, value))}]"
    if isinstance(value, dict):
        return "{}" if not value else str(value)
    return f"{value:g}" if isinstance(value, float) else str(value)


def table_of(place: str) -> type:
    """Load the class at "package.module:Name" whose fields are the keys of a table, or that of a declared study.

    A study without a table of its own has its keys at the top of a description.
    """
    found: Any = loaded(f"stylobate.{place}")
    if hasattr(found, "study"):
        top = study_config(found)
        own = top.model_fields.get(found.study.name)
        found = top if own is None else own.annotation
    cls: type = found
    return cls


def fields_of(cls: type, left_out: Iterable[str] = ()) -> list[Field]:
    """List the keys of a table, with the texts of the parameters in the docstring of its class."""
    texts = described(cls)
    found = (
        _fields_of_config(cls)
        if issubclass(cls, BaseModel)
        else _fields_of_dataclass(cls)
    )
    skipped = {*left_out, "kind", "shape", "file_sha256"}
    return [
        Field(name, kind, default, texts.get(name, ""))
        for name, kind, default in found
        if name not in skipped
    ]


def _fields_of_config(cls: type[BaseModel]) -> list[tuple[str, str, str]]:
    rows = []
    for name, one in cls.model_fields.items():
        needed = one.default is PydanticUndefined and one.default_factory is None
        default = (
            "" if needed or one.default is PydanticUndefined else _plain(one.default)
        )
        words = type_in_words(
            Annotated[one.annotation, *one.metadata] if one.metadata else one.annotation
        )
        rows.append(
            (one.alias or name, words + (", needed" if needed else ""), default)
        )
    return rows


def _fields_of_dataclass(cls: type) -> list[tuple[str, str, str]]:
    assert is_dataclass(cls)
    hints = inspect.get_annotations(cls, eval_str=True)
    return [
        (
            one.name,
            type_in_words(hints[one.name]),
            "" if one.default is MISSING else _shown(one.default),
        )
        for one in fields(cls)
    ]


def _plain(default: Any) -> str:
    if isinstance(default, BaseModel):
        kind = getattr(default, "kind", None)
        return f'"{kind}"' if kind else ""
    return "" if default in ((), "") else _shown(default)


_PLAIN_TYPES = {
    float: "number",
    int: "whole number",
    str: "text",
    bool: "true or false",
    NoneType: "",
}
_PLURALS = {
    "number": "numbers",
    "whole number": "whole numbers",
    "text": "texts",
    "table": "tables",
    "2 numbers": "pairs of numbers",
}


def type_in_words(annotation: Any) -> str:
    """Write the type of a value as a reader of TOML sees it.

    >>> type_in_words(tuple[float, ...] | None), type_in_words(Literal["on", "off"])
    ('list of numbers', '"on" or "off"')
    """
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin in _IN_WORDS:
        return _IN_WORDS[origin](arguments)
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return "table"
    return _PLAIN_TYPES.get(
        annotation, getattr(annotation, "__name__", str(annotation))
    )


def _choice_in_words(arguments: tuple[Any, ...]) -> str:
    members = [one for one in arguments if one is not NoneType]
    return " or ".join(dict.fromkeys(type_in_words(one) for one in members))


def _list_in_words(arguments: tuple[Any, ...]) -> str:
    words = " or ".join(
        _PLURALS.get(one, one) for one in type_in_words(arguments[0]).split(" or ")
    )
    return (
        f"list of {words}"
        if arguments[-1] is Ellipsis or len(arguments) == 1
        else f"{len(arguments)} {words}"
    )


_IN_WORDS: Mapping[Any, Callable[[tuple[Any, ...]], str]] = {
    Annotated: lambda arguments: type_in_words(arguments[0]),
    Union: _choice_in_words,
    UnionType: _choice_in_words,
    Literal: lambda arguments: " or ".join(map(_shown, arguments)),
    tuple: _list_in_words,
    list: _list_in_words,
    dict: lambda arguments: f"table: {type_in_words(arguments[1])} by name",
}


@cache
def described(cls: type) -> Mapping[str, str]:
    """Read the texts of the parameters from the docstrings of a class and of its bases."""
    texts: dict[str, str] = {}
    for one in reversed(cls.__mro__):
        texts |= _parameters(inspect.cleandoc(vars(one).get("__doc__") or ""))
    return texts


def _parameters(docstring: str) -> dict[str, str]:
    """Read the section "Parameters" of a docstring in NumPy style."""
    _, _, section = docstring.partition("Parameters\n----------\n")
    texts: dict[str, str] = {}
    names: list[str] = []
    for line in section.splitlines():
        if line and not line.startswith(" "):
            if set(line) == {"-"}:
                break
            names = [one.strip() for one in line.partition(":")[0].split(",")]
        elif line.strip():
            texts |= {
                name: f"{texts.get(name, '')} {line.strip()}".strip() for name in names
            }
    return texts
