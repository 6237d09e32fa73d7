"""Short notation for JSON Schema 2020-12, which OpenAPI 3.1 uses."""

from collections.abc import Mapping, Sequence
from typing import Any

from stylobate.quantities import Quantity

Schema = dict[str, Any]


def text(about: str = "", **more: Any) -> Schema:
    """Return the schema of a text."""
    return {"type": "string", **_with_description(about), **more}


def word(about: str, words: Sequence[str]) -> Schema:
    """Return the schema of one of some `words`."""
    return text(about, enum=list(words))


def number(about: str = "", **more: Any) -> Schema:
    """Return the schema of a number."""
    return {"type": "number", **_with_description(about), **more}


def declared(quantity: Quantity, **more: Any) -> Schema:
    """Return the schema of a declared quantity."""
    return number(f"{quantity.text} [{quantity.unit}]" if quantity.unit else quantity.text, **more)


def whole(about: str = "", **more: Any) -> Schema:
    """Return the schema of a whole number, zero or above."""
    return {"type": "integer", "minimum": 0, **_with_description(about), **more}


def flag(about: str) -> Schema:
    """Return the schema of true or false."""
    return {"type": "boolean", **_with_description(about)}


def or_none(schema: Schema) -> Schema:
    """Return a schema that also allows null, for a number that is not finite or not known."""
    return {**schema, "type": [schema["type"], "null"]}


def listed(about: str, item: Schema, *, most: int | None = None, **more: Any) -> Schema:
    """Return the schema of a list of any length, or of `most` at most."""
    bound = {} if most is None else {"maxItems": most}
    return {"type": "array", "items": item, **_with_description(about), **bound, **more}


def exactly(about: str, *items: Schema) -> Schema:
    """Return the schema of a list of exactly these `items`."""
    return {
        "type": "array",
        "prefixItems": list(items),
        "items": False,
        "minItems": len(items),
        **_with_description(about),
    }


def row(about: str, length: int) -> Schema:
    """Return the schema of a list of numbers of this `length`."""
    return listed(about, {"type": "number"}, minItems=length, most=length)


def table(
    about: str, needed: Mapping[str, Schema], optional: Mapping[str, Schema] | None = None, others: Schema | None = None
) -> Schema:
    """Return the schema of an object with names that are `needed` or `optional`, and `others` of one kind."""
    return {
        "type": "object",
        **_with_description(about),
        "properties": {**needed, **(optional or {})},
        "required": list(needed),
        "additionalProperties": False if others is None else others,
    }


def ref(name: str) -> Schema:
    """Return a reference to a component by its name."""
    return {"$ref": f"#/components/schemas/{name}"}


def unless_none(schema: Schema) -> Schema:
    """Return a schema that also allows null, for a component or a list."""
    return {"anyOf": [schema, {"type": "null"}]}


def _with_description(about: str) -> dict[str, str]:
    return {"description": about} if about else {}
