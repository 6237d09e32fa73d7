"""Dissipation levels of an assessment, for all columns or for each of them, and checks of their numbers."""

from collections.abc import Collection, Iterable, Mapping
from typing import Any, TypeAlias

from stylobate.column import Column
from stylobate.config.description import Config
from stylobate.config.parts import ANY_COLUMN
from stylobate.errors import ParameterError, require_not_negative
from stylobate.models.declared import dissipation_names, model_quantities
from stylobate.text import did_you_mean

LEVELS = ("low", "central", "high")
"""Required levels."""

OF_DISSIPATION = dissipation_names()
"""The numbers of a model that dissipate."""

Numbers: TypeAlias = Mapping[str, float | str]
"""Dissipation parameters of a level: numbers, or words such as "housner"."""

Dissipation: TypeAlias = Mapping[str, Numbers | Mapping[str, Numbers]]
"""Numbers by level; or, for a column with its own levels, numbers by level under its name."""


def levels_by_column(dissipation: Dissipation, columns: Collection[str]) -> dict[str, Mapping[str, Numbers]]:
    """Return the levels of each column: its own, or those stated for all columns.

    Raises
    ------
    ParameterError
        If levels belong to no column, a column has none, or columns have levels of different names.
    """
    own: dict[str, Any] = {name: one for name, one in dissipation.items() if is_by_level(one)}
    shared: dict[str, Any] = {name: one for name, one in dissipation.items() if name not in own}
    for name in own:
        if name not in columns:
            remedy = did_you_mean(name, columns) or f"Use {', '.join(columns)}."
            raise ParameterError(f"dissipation: {name!r} is no column; {remedy}")
    found = {name: own.get(name, shared) for name in columns}
    first = next(iter(found))
    for name, levels in found.items():
        missing = [level for level in dict.fromkeys((*LEVELS, *found[first])) if level not in levels]
        if missing:
            raise ParameterError(
                f"dissipation: {' and '.join(missing)} must be stated too{f' for {name!r}' if own else ''}. "
                "State it for low, central and high, such as low = {damping = 0.04}"
            )
    return {name: {level: levels[level] for level in found[first]} for name, levels in found.items()}


def is_by_level(numbers: Any) -> bool:
    """Return whether an entry holds the levels of a column, and not the numbers of a level."""
    return isinstance(numbers, Mapping) and bool(numbers) and all(isinstance(one, Mapping) for one in numbers.values())


def at_levels(levels: Mapping[str, Numbers], column: Column) -> dict[str, dict[str, Any]]:
    """Return the numbers of each level for a column: words become numbers."""
    known = model_quantities()
    return {
        level: {name: known[name].for_column(one, column) if name in known else one for name, one in numbers.items()}
        for level, numbers in levels.items()
    }


def problems_of_the_levels(
    dissipation: Dissipation, model: type[Config], columns: Mapping[str, Column | None]
) -> list[str]:
    """Return a line for each mistake in the numbers of the levels.

    Parameters
    ----------
    dissipation
        Low, central and high, and optionally others, for all columns or by column.
    model
        Description of the model to which the numbers belong.
    columns
        The columns by name; None for one that cannot be built.
    """
    try:
        by_column = levels_by_column(dissipation, columns) if columns else {}
    except ParameterError as error:
        return [str(error)]
    problems: dict[str, None] = {}  # levels of all columns have each mistake once
    for name, levels in by_column.items():
        place = f"dissipation.{name}" if is_by_level(dissipation.get(name)) else "dissipation"
        given = at_levels(levels, columns[name] or ANY_COLUMN)
        problems |= dict.fromkeys(_unusable(place, given, model) or [*_differing(place, given), *_falling(name, given)])
    return list(problems)


def _unusable(place: str, levels: Mapping[str, Mapping[str, Any]], model: type[Config]) -> list[str]:
    """Return a line for each number that is out of range, is unknown, or does not belong to the model."""
    problems = []
    for level, numbers in levels.items():
        for name, value in numbers.items():
            try:
                require_not_negative(f"{place}.{level}.{name}", value)
            except ParameterError as error:
                problems.append(str(error))
            if name not in OF_DISSIPATION:
                remedy = did_you_mean(name, OF_DISSIPATION) or f"use {', '.join(OF_DISSIPATION)}"
                problems.append(f"{place}.{level}.{name} is not known here; {remedy}")
    kind = model.model_fields["kind"].default
    return problems + [
        f"{place}: the model {kind} has no {name}; leave it out or choose another model"
        for name in OF_DISSIPATION
        if name not in model.model_fields and any(name in numbers for numbers in levels.values())
    ]


def _differing(place: str, levels: Mapping[str, Mapping[str, float]]) -> Iterable[str]:
    """Return a line if the levels do not name the same numbers, or name none."""
    names = set(levels["central"])
    if names and all(set(level) == names for level in levels.values()):
        return []
    given = ", ".join(f"{level} {' and '.join(sorted(numbers)) or 'nothing'}" for level, numbers in levels.items())
    return [f"{place} must state the same parameters at each level, one or more, got {given}"]


def _falling(column: str, levels: Mapping[str, Mapping[str, float]]) -> Iterable[str]:
    """Return a line if the damping of a level is below that of a lower level."""
    dampings = [levels[name]["damping"] for name in LEVELS if "damping" in levels[name]]
    if len(dampings) < len(LEVELS) or dampings == sorted(dampings):
        return []
    given = ", ".join(f"{name} {value:.3g}" for name, value in zip(LEVELS, dampings, strict=True))
    return [f"dissipation: damping of {column!r} must not fall from low to central to high, got {given}"]
