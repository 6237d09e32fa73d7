"""Schemas of requests: the descriptions of the command line, without files of this machine, within the limits."""

from collections.abc import Collection, Mapping
from dataclasses import fields
from typing import Any

from stylobate import config, studies
from stylobate.base_motions.declared import MOTIONS, composite_kinds, kinds_with_response, motion_quantities
from stylobate.config.description import Config
from stylobate.config.motions import is_to_end
from stylobate.lab.limits import Limits
from stylobate.lab.parameter_info import NUMBERS
from stylobate.lab.schema.notation import Schema, listed, or_none, ref, table, text
from stylobate.lab.size_limits import HIGHEST_DEGREE, LEAST, MOST
from stylobate.lab.starts import StartConfig
from stylobate.models.declared import column_quantities, model_quantities
from stylobate.quantities import Quantity
from stylobate.results import OutcomeRules
from stylobate.run_arguments import run_numbers

_DESCRIPTIONS: dict[str, type[Config]] = {
    "Simulation": config.SimulationConfig,
    "Response": config.ResponseConfig,
    "SteadyRollingStart": StartConfig,
    "Map": config.study_config(studies.overturning_map),
    "Basin": config.study_config(studies.basins),
}

_OF_JOBS = {"exact": "Response", "map": "Map", "basin": "Basin", "animation": "Simulation"}


def _in_words(about: str, unit: str) -> str:
    return f"{about} [{unit}]" if unit else about


_TEXTS = {
    **{name: _in_words(one.quantity.text, one.quantity.unit) for name, one in run_numbers().items()},
    "duration": "duration of a run [s]; optional under a record, a pulse or a sine sweep",
    "rules": "numbers of the rules that decide outcomes",
    "demands": "whether to compute contact demands",
    "angular_frequency_range": "lowest and highest angular frequency [rad/s]",
    "points": "number of frequencies of the curves",
    "branch": "branch of steady rolling: upper (the larger tilt) or lower",
}


_TAGS = ("shape", "kind", "method")
"""Keys that distinguish columns, models, motions and steps of processing."""

_ENDING = (*(kind for kind in MOTIONS if is_to_end({"kind": kind})), *composite_kinds())


def _bounds_of(quantity: Quantity) -> Schema:
    if quantity.choices:
        return {"enum": list(quantity.choices)}
    above = LEAST if quantity.gt == 0.0 and quantity.components == 1 else None
    bounds = {"minimum": above if quantity.ge is None else quantity.ge, "maximum": quantity.le}
    return {name: bound for name, bound in bounds.items() if bound is not None}


_RULE: Schema = {"type": "number", "minimum": LEAST}

_BOUNDS: dict[str, Schema] = {
    **{
        name: _bounds_of(quantity)
        for name, quantity in {
            **{name: one.quantity for name, one in run_numbers().items()},
            **column_quantities(),
            **model_quantities(),
            **motion_quantities(),
        }.items()
    },
    "points": {"minimum": 2},
    "tail": {"minimum": 0},
    **{name: {"minimum": 1, "maximum": HIGHEST_DEGREE} for name in ("order", "degree")},
}
"""Bounds of numbers; some numbers have further conditions, which the refusal states."""


def components(limits: Limits) -> dict[str, Schema]:
    """Return the components of all requests."""
    found: dict[str, Schema] = {}
    for name, description in _DESCRIPTIONS.items():
        body = description.model_json_schema(ref_template="#/components/schemas/{model}")
        found |= {part: _part(schema) for part, schema in body.pop("$defs", {}).items()}
        found[name] = _within(body, limits)
    found["RecordMotion"] = _uploaded(found["RecordMotion"])
    return {**{name: _finite(schema) for name, schema in found.items()}, "Record": _RECORD, "JobConfig": _job()}


def _finite(schema: Any) -> Any:
    """Return a schema with bounds on all numbers, at any depth."""
    if isinstance(schema, list):
        return [_finite(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    bounds = {"minimum": -MOST, "maximum": MOST} if schema.get("type") == "number" else {}
    return {**bounds, **{name: _finite(part) for name, part in schema.items()}}


def _within(body: Schema, limits: Limits) -> Schema:
    """Return the schema of a description with texts for its numbers, and the limits."""
    most = {name: bound for name, (bound, _) in limits.of_numbers().items()}
    properties: dict[str, Schema] = body["properties"]
    for name, schema in properties.items():
        if name in _TEXTS:
            schema["description"] = _TEXTS[name]
        _bound(name, schema)
        if name in most:
            _of_numbers(schema)["maximum"] = most[name]
    if "rules" in properties:
        properties["rules"] = table(_TEXTS["rules"], {}, {field.name: _RULE for field in fields(OutcomeRules)})
    if "angular_frequency_range" in properties or "branch" in properties:
        properties["motion"] = _only(properties["motion"], kinds_with_response())
    if "duration" in body["required"]:
        return _until_the_end(body)
    return body


def _until_the_end(body: Schema) -> Schema:
    """Return the schema of a run, which requires a duration unless its motion, or a part of it, ends."""
    ending = {"type": "object", "properties": {"kind": {"enum": list(_ENDING)}}}
    lasting = [
        {"required": ["duration"], "properties": {"duration": {"type": "number"}}},
        {"required": ["motion"], "properties": {"motion": ending}},
    ]
    return {**body, "required": [name for name in body["required"] if name != "duration"], "anyOf": lasting}


def _only(union: Schema, kinds: Collection[str]) -> Schema:
    """Return the union of the motions of these `kinds`."""
    mapping = {kind: place for kind, place in union["discriminator"]["mapping"].items() if kind in kinds}
    places = [{"$ref": place} for place in dict.fromkeys(mapping.values())]
    return {**union, "discriminator": {**union["discriminator"], "mapping": mapping}, "oneOf": places}


def _part(schema: Schema) -> Schema:
    """Return the schema of a column, a model, a motion or a step, with texts and bounds for its numbers."""
    properties = schema.get("properties", {})
    own = not {"motion", "motions", "method"} & set(properties)  # composite motions and steps state their own texts
    for name, body in properties.items():
        if own:
            body |= {**_described(name), **body}
        if own or name in ("order", "degree"):
            _bound(name, body)
    tags = [tag for tag in _TAGS if tag in properties]
    required = [*tags, *(name for name in schema.get("required", []) if name not in tags)]
    return {**schema, **({"required": required} if required else {})}


def _bound(name: str, schema: Schema) -> None:
    if name in _BOUNDS:
        _of_numbers(schema).update(_BOUNDS[name])


def _of_numbers(schema: Schema) -> Schema:
    """Return the part of a schema that describes numbers, if the schema also allows null."""
    parts: list[Schema] = schema.get("anyOf", [schema])
    return next(part for part in parts if part["type"] != "null")


def _described(name: str) -> Schema:
    number = NUMBERS.get(name)
    if number is None or not number.about:
        return {}
    return {"description": _in_words(number.about, number.unit)}


def _uploaded(record: Schema) -> Schema:
    """Return the schema of a record, with an upload in place of a path."""
    digest = or_none(text("digest of an uploaded record"))
    kept: Mapping[str, Any] = {
        name: body for name, body in record["properties"].items() if name not in ("path", "file_sha256")
    }
    about = "A record: either uploaded (`upload`), or a `sample` of the package."
    return {**record, "description": about, "properties": {**kept, "upload": digest}}


def _job() -> Schema:
    """Return the schema of a request for a job, whose description depends on its kind."""
    kinds = [
        table("", {"kind": {"const": kind}, "description": ref(description)}) for kind, description in _OF_JOBS.items()
    ]
    return {"description": "A job: its kind and description.", "oneOf": kinds}


_BASE64 = "^(?:[A-Za-z0-9+/]{4})*(?:[A-Za-z0-9+/]{2}==|[A-Za-z0-9+/]{3}=)?$"

_RECORD = table(
    "The files of a record: its components.",
    {
        "files": listed(
            "files of one event",
            table(
                "",
                {
                    "name": text(
                        "file name without a folder", pattern=r"^[A-Za-z0-9_-][A-Za-z0-9_. -]*$", maxLength=120
                    ),
                    "content": text("content of the file", contentEncoding="base64", pattern=_BASE64),
                },
            ),
            most=3,
            minItems=1,
        )
    },
    {
        "units": or_none(text("unit of the acceleration, such as g or cm/s²; null if the file states the unit")),
        "step": {"type": ["number", "null"], "description": "time step [s]; null if the file states the step"},
    },
)
