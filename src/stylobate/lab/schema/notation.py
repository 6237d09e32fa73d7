"""What JSON may be, in few words: JSON Schema 2020-12, as OpenAPI 3.1 has it."""

from collections.abc import Mapping, Sequence
from typing import Any

Schema = dict[str, Any]


def text(told: str = "", **more: Any) -> Schema:
    """Return a text."""
    return {"type": "string", **_described(told), **more}


def word(told: str, words: Sequence[str]) -> Schema:
    """Return one of some `words`."""
    return text(told, enum=list(words))


def number(told: str = "", **more: Any) -> Schema:
    """Return a number."""
    return {"type": "number", **_described(told), **more}


def whole(told: str = "", **more: Any) -> Schema:
    """Return a whole number, zero or above."""
    return {"type": "integer", "minimum": 0, **_described(told), **more}


def flag(told: str) -> Schema:
    """Return true or false."""
    return {"type": "boolean", **_described(told)}


def or_none(schema: Schema) -> Schema:
    """Return what may be null besides: a number that is not finite, or what is not known."""
    return {**schema, "type": [schema["type"], "null"]}


def listed(told: str, item: Schema, *, most: int | None = None, **more: Any) -> Schema:
    """Return a list of any length, or of `most` at most."""
    bound = {} if most is None else {"maxItems": most}
    return {"type": "array", "items": item, **_described(told), **bound, **more}


def exactly(told: str, *items: Schema) -> Schema:
    """Return a list of just these `items`."""
    return {"type": "array", "prefixItems": list(items), "items": False, "minItems": len(items), **_described(told)}


def row(told: str, length: int) -> Schema:
    """Return a list of so many numbers."""
    return listed(told, {"type": "number"}, minItems=length, most=length)


def table(
    told: str, needed: Mapping[str, Schema], optional: Mapping[str, Schema] | None = None, others: Schema | None = None
) -> Schema:
    """Return an object that has the names `needed`, may have those that are `optional`, and `others` of one kind."""
    return {
        "type": "object",
        **_described(told),
        "properties": {**needed, **(optional or {})},
        "required": list(needed),
        "additionalProperties": False if others is None else others,
    }


def ref(name: str) -> Schema:
    """Return a component by its name."""
    return {"$ref": f"#/components/schemas/{name}"}


def unless_none(schema: Schema) -> Schema:
    """Return what may be null besides, for a component or a list."""
    return {"anyOf": [schema, {"type": "null"}]}


def _described(told: str) -> dict[str, str]:
    return {"description": told} if told else {}
