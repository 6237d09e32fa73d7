"""Columns of an assessment from a table of objects: their shapes, frictions, and levels of damping around theirs."""

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

from pydantic import Field

from stylobate.config.description import Config
from stylobate.config.levels import LEVELS
from stylobate.earthquakes.inventories.objects import InventoryObject, PreparedObject
from stylobate.earthquakes.inventories.table import read_inventory
from stylobate.errors import ConfigError, UnlikelyInputWarning

_HOUSNER = "housner"
_FACTORS = dict(zip(LEVELS, (0.5, 1.0, 2.0), strict=True))


def described_by_table(values: Mapping[str, Any]) -> dict[str, Any]:
    """Replace a path in `columns` by the columns of this table, with their frictions and levels of damping.

    Friction and dissipation of the study, if it states them, are kept. Otherwise the damping of the table is the
    central level, half and twice of it are the low and the high one. What the table holds beside the objects, such as
    other sheets, is a note of the study.

    Raises
    ------
    ConfigError
        With one line for each mistake of the table, or if its objects stand at several sites.
    FileError
        If the file cannot be read.
    """
    model = values.get("model", {})
    kind = model if isinstance(model, str) else model.get("kind", "wobbling")
    stated: dict[str, Any] = {"damping": _HOUSNER} if "dissipation" in values else {}
    friction = values.get("friction_coefficient")
    stated |= {} if friction is None else {"friction_coefficient": 1.0 if isinstance(friction, Mapping) else friction}
    choice = TableChoice.parse({name: values[name] for name in TableChoice.model_fields if name in values})
    with warnings.catch_warnings(record=True) as remarks:
        warnings.simplefilter("always", UnlikelyInputWarning)
        objects = read_inventory(
            values["columns"], model=kind, defaults={**stated, **choice.defaults}, carry=choice.carry
        )
    for remark in remarks:
        warnings.warn(remark.message, remark.category, stacklevel=2)
    _require_one_site(objects)
    problems: list[str] = []
    prepared = [one for one in (_prepared(each, kind, problems) for each in objects) if one is not None]
    if problems:
        raise ConfigError(problems)
    own = {
        "sliding": True,
        "columns": {one.given.name: dict(one.given.column) for one in prepared},
        "friction_coefficient": {one.given.name: one.friction for one in prepared},
        "dissipation": {one.given.name: _levels(one) for one in prepared},
        "about_columns": {one.given.name: about for one in prepared if (about := _about(one.given))},
        "table": str(values["columns"]),
        "read_as": dict(objects[0].read_as),
    }
    kept = {name: value for name, value in values.items() if name != "columns"}
    if remarks and isinstance(stated_notes := values.get("notes", ()), (list, tuple)):
        kept["notes"] = (*stated_notes, *(f"Warning: {one.message}" for one in remarks))
    return {**own, **kept}


class TableChoice(Config):
    """What a description states beside a table of objects.

    Parameters
    ----------
    carry
        Headings of columns of the table to carry through although they are or resemble a known name.
    defaults
        Values for empty cells and missing columns of the table, by name.
    """

    carry: tuple[str, ...] = ()
    defaults: dict[str, float | str] = Field(default_factory=dict)


def _prepared(given: InventoryObject, kind: str, problems: list[str]) -> PreparedObject | None:
    """Build an object; None, with its lines in `problems`, if a number is invalid."""
    try:
        return given.prepared(kind)
    except ConfigError as error:
        problems += error.problems
        return None


def _about(one: InventoryObject) -> str:
    """Return the cells that the table carries, such as the room, in words."""
    return ", ".join(f"{heading} {cell}" for heading, cell in one.carried.items() if cell)


def _require_one_site(objects: Sequence[InventoryObject]) -> None:
    sites = dict.fromkeys(one.site for one in objects)
    if len(sites) > 1:
        raise ConfigError(
            [f"columns: the objects stand at several sites (got {', '.join(sites)}). Assess each site by a table."]
        )


def _levels(one: PreparedObject) -> dict[str, dict[str, Any]]:
    """Return the levels around the dissipation of an object: its damping times a half, one and two."""
    numbers = {name: getattr(one.model, name) for name in one.given.model}
    return {
        level: {name: factor * value if name == "damping" else value for name, value in numbers.items()}
        for level, factor in _FACTORS.items()
    }
