"""Base of all descriptions: strict keys, one line for each mistake, with a suggestion for an unknown name."""

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any, ClassVar, Self, TypeVar, get_args, get_origin

from pydantic import BaseModel, ConfigDict, ValidationError

from stylobate.column.profiles import PROFILES
from stylobate.errors import ConfigError, ParameterError
from stylobate.quantities import Quantity
from stylobate.text import did_you_mean
from stylobate.units import UnitError

_NOT_KNOWN = re.compile(r"(?P<problem>(?P<path>\S+) (is not known here|does not belong to \w+ '\w+')); .*")


def with_suggestions(description: type[BaseModel], problems: Sequence[str]) -> list[str]:
    """Return the lines on mistakes, with a suggestion in each line on an unknown name.

    Parameters
    ----------
    description
        Class of the description.
    problems
        One line for each mistake.
    """
    return [_suggesting(description, line) for line in problems]


def _suggesting(description: type[BaseModel], line: str) -> str:
    found = _NOT_KNOWN.fullmatch(line)
    if found is None:
        return line
    *path, name = found["path"].split(".")
    question = did_you_mean(name, _names(description, path))
    return f"{found['problem']}; {question}" if question and f" {name}?" not in question else line


def _names(annotation: Any, path: Sequence[str]) -> set[str]:
    """Return the allowed names at a path below a field with this annotation; empty for an unknown path."""
    found: set[str] = set()
    for one in _alternatives(annotation):
        if get_origin(one) is dict and path:
            found |= _names(get_args(one)[1], path[1:])
        if not (isinstance(one, type) and issubclass(one, BaseModel)):
            continue
        fields = {field.alias or name: field.annotation for name, field in one.model_fields.items()}
        if not path:
            found |= set(fields)
        elif path[0] in fields:
            found |= _names(fields[path[0]], path[1:])
    return found


def _alternatives(annotation: Any) -> list[Any]:
    """Return the alternative types of an annotation."""
    origin = get_origin(annotation)
    if origin is dict or not get_args(annotation):
        return [annotation]
    inner = get_args(annotation)[:1] if origin is Annotated else get_args(annotation)
    return [one for part in inner for one in _alternatives(part)]


_T = TypeVar("_T")

Number = Annotated[float, Quantity()]
Seconds = Annotated[float, Quantity(unit="s")]
Radians = Annotated[float, Quantity(unit="rad")]
Metres = Annotated[float, Quantity(unit="m")]
Hertz = Annotated[float, Quantity(unit="Hz")]
MetresPerSquareSecond = Annotated[float, Quantity(unit="m/s²")]
"""Numbers that a description states in SI units, or as text with a unit, such as "5 ms"."""

# Fields whose value, or each element of whose list, is one of several descriptions, told apart by a tag.
_UNION_FIELDS = ("column", "model", "motion")
# Fields that are tables of such descriptions, by names that the user chooses.
_UNION_TABLES = ("columns",)
_MOMENTS = ("transverse_inertia", "axial_inertia")
_PROFILES = ", ".join(PROFILES)
WANTED = {
    "duration": ": length of a run [s], such as 60; optional only under a base motion that ends or has a period",
    "motion.kind": ': the kind of base motion, such as "stroke" or "circular"; on the command line --motion stroke',
    "motion.velocity": ": velocity of the pulse [m/s]; on the command line --pulse-velocity",
    "profile": f": the kind of profile, {_PROFILES}",
    **dict.fromkeys(_MOMENTS, f". State it, or in place of both moments a profile ({_PROFILES})"),
}
"""Explanation of a missing part, added to its message."""
WANTED_TOGETHER = {_MOMENTS: f"State profile ({_PROFILES}) to estimate them, or state both."}
"""Remedy for two numbers that are missing together."""


class Config(BaseModel):
    """A part of a TOML or JSON description; unknown keys are mistakes."""

    # Most descriptions are never used by one process; pydantic builds those that are.
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)

    make: ClassVar[Callable[..., Any]]
    """Described class or named constructor; only for a kind of column, model or motion."""

    @classmethod
    def parse(cls, values: Mapping[str, Any]) -> Self:
        """Validate these `values` and return their description.

        Raises
        ------
        ConfigError
            With one line for each mistake.
        """
        try:
            return cls.model_validate(values)
        except ValidationError as error:
            raise ConfigError(with_suggestions(cls, _lines(error.errors()))) from None

    def values(self) -> dict[str, Any]:
        """Return the description as plain values for JSON and TOML, without keys that are None."""
        return self.model_dump(mode="json", exclude_none=True)


def built(name: str, build: Callable[[], _T], problems: list[str]) -> _T | None:
    """Return the result of `build`; if it fails, return None and add a line to `problems`."""
    try:
        return build()
    except ParameterError as error:
        problems.append(f"{name}: {error}")
    except ArithmeticError:
        # Each number is valid, but a result of them overflows.
        problems.append(f"{name}: its numbers are too large or too small to compute with; check their units")
    return None


def _lines(problems: Sequence[Any]) -> list[str]:
    """Write one line for each mistake; numbers that need each other share one if both are missing."""
    missing = {problem["loc"] for problem in problems if problem["type"] == "missing"}
    lines = []
    for problem in problems:
        *place, name = problem["loc"] or ("",)
        pair = next((one for one in WANTED_TOGETHER if name in one), ())
        if not pair or not all((*place, one) in missing for one in pair):
            lines.append(_line(problem))
        elif name == pair[0]:
            whole = ".".join(_without_tags(problem["loc"]))
            lines.append(f"{whole} and {pair[1]} are missing. {WANTED_TOGETHER[pair]}")
    return lines


def _line(problem: Any) -> str:
    name = ".".join(_without_tags(problem["loc"])) or "the description"
    given = problem.get("input")
    context = problem.get("ctx", {})
    tag = str(context.get("discriminator", "")).strip("'")
    match problem["type"]:
        case "missing":
            return f"{name} is missing{WANTED.get(name) or WANTED.get(problem['loc'][-1], '')}"
        case "extra_forbidden":
            return _unknown(name, problem["loc"])
        case "union_tag_invalid":
            return f"{name}.{tag} must be one of {context['expected_tags']}, got {context['tag']!r}{_meant(context)}"
        case "union_tag_not_found":
            return f"{name}.{tag} is missing{WANTED.get(f'{name}.{tag}', '')}"
        case "value_error":
            return f"{name} {context['error']}" if isinstance(context["error"], UnitError) else str(context["error"])
    return f"{name}: {problem['msg'][0].lower()}{problem['msg'][1:]}, got {given!r}"


def _meant(context: Mapping[str, Any]) -> str:
    """Suggest a known kind for an unknown one."""
    if ":" in context["tag"]:
        return "; a class of your own is read from a TOML file or a saved result only"
    question = did_you_mean(context["tag"], re.findall(r"'(\w+)'", context["expected_tags"]))
    return f"; {question}" if question else ""


def _unknown(name: str, loc: tuple[int | str, ...]) -> str:
    if loc[0] in _UNION_FIELDS and len(loc) > 1:
        return f"{name} does not belong to {loc[0]} {loc[1]!r}; remove it or choose another"
    return f"{name} is not known here; remove it, or see the documentation for the names"


def _without_tags(loc: tuple[int | str, ...]) -> list[str]:
    # pydantic puts the chosen member of a tagged union behind its field, as in ("motion", "circular", "acceleration").
    return [
        str(part)
        for i, part in enumerate(loc)
        if i == 0 or not (loc[i - 1] in _UNION_FIELDS or isinstance(loc[i - 1], int) or _in_table(loc, i))
    ]


def _in_table(loc: tuple[int | str, ...], place: int) -> bool:
    """Return whether the part at this `place` is the tag of a union in a table of named descriptions."""
    return place == 2 and loc[0] in _UNION_TABLES and len(loc) > 3  # noqa: PLR2004  columns, name, shape, number
