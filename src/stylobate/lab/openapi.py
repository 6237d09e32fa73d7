"""Description of endpoints in OpenAPI 3.1: requests, answers and errors.

Requests are the descriptions of the command line, without files of this machine, within the limits.
"""

import base64
from collections.abc import Callable, Collection, Iterable, Mapping
from dataclasses import dataclass, fields
from importlib.metadata import version
from typing import Any, TypeVar

from pydantic import BaseModel

from stylobate import config
from stylobate.base_motions.declared import MOTIONS, kinds_with_response, motion_quantities
from stylobate.config.parts import moves
from stylobate.config.study import study_of
from stylobate.errors import LARGEST, SMALLEST
from stylobate.lab import answers
from stylobate.lab.answers import Schema, in_words
from stylobate.lab.curves import StartConfig
from stylobate.lab.limits import Limits
from stylobate.lab.options import NUMBERS, presets
from stylobate.lab.requests import BRANCHES, GRIDS, JOBS, RecordRequest, may_start_on_branch
from stylobate.models.declared import column_quantities, model_quantities
from stylobate.quantities import Quantity
from stylobate.results import OutcomeRules
from stylobate.run_arguments import run_numbers

_F = TypeVar("_F", bound=Callable[..., Any])

_REQUESTS: Mapping[str, type[BaseModel]] = {
    "Simulation": config.SimulationConfig,
    "Response": JOBS["exact"],
    "SteadyRollingStart": StartConfig,
    **{JOBS[name].__name__.removesuffix("Config"): JOBS[name] for name in GRIDS},
    "Record": RecordRequest,
}
"""The components of requests."""


# Examples of requests, ready to send

_PRESETS = {preset.identity: preset.description for preset in presets()}
_CIRCLE = {
    "column": {"shape": "dimensionless", "slenderness": 0.1},
    "model": {"kind": "slender", "damping": 0.1},
    "motion": {"kind": "circular", "acceleration": 0.065, "angular_frequency": 1.8},
}
_START = {"tilt": [0.03, 0.0], "tilt_rate": [0.0, 0.07]}
_PLANE = {
    "x": {"name": "angular_frequency", "from": 0.8, "to": 4.0, "number": 12},
    "y": {"name": "acceleration", "from": 0.02, "to": 0.4, "number": 10},
}
_TILTS = {place: {"name": f"tilt_{place}", "from": -0.12, "to": 0.12, "number": 7} for place in "xy"}
_RECORD = base64.b64encode(b"0.00 0.000\n0.01 0.120\n0.02 0.310\n0.03 0.080\n0.04 -0.210\n0.05 0.000\n").decode()
_OF_JOBS = {
    **{
        name: {**_CIRCLE, "duration": 200.0, name: _TILTS}
        if study_of(one).starts
        else {**_CIRCLE, **_START, "duration": 60.0, name: _PLANE}
        for name, one in GRIDS.items()
    },
    "exact": {**_CIRCLE, "angular_frequency_range": [1.2, 2.0]},
    "animation": {**_CIRCLE, **_START, "duration": 2.0},
}

EXAMPLES: Mapping[str, Mapping[str, Any]] = {
    "Simulation": {name: _PRESETS[name] for name in (next(iter(_PRESETS)), "temple")},
    "Response": {"circle": {**_CIRCLE, "angular_frequency_range": [0.5, 4.0], "points": 100}},
    "SteadyRollingStart": {"circle": {**_CIRCLE, "branch": "upper"}},
    "Record": {"text": {"files": [{"name": "shock.txt", "content": _RECORD}], "units": "g"}},
    "JobConfig": {kind: {"kind": kind, "description": description} for kind, description in _OF_JOBS.items()},
}
"""Examples by the component of which they are."""

# Endpoints

_REFUSALS = {
    400: "The body is not JSON, or ended early.",
    403: "A foreign Host or Origin.",
    401: "The token is missing or wrong.",
    404: "The job does not exist (any more), or has no file.",
    413: "The body is too large.",
    415: "The content type of the body is not application/json.",
    422: "The values are invalid: one line for each mistake.",
    429: "Too many jobs are waiting.",
    500: "Internal error.",
    502: "The worker process was ended from outside, possibly because memory ran out.",
    503: "No worker process became free in time; try again.",
    504: "The run exceeded the time limit; the same request would exceed it again.",
}

OF_ALL = (401, 403)
OF_BODIES = (*OF_ALL, 400, 413, 415, 422)
OF_RUNS = (*OF_BODIES, 500, 502, 503, 504)

_IDENTITY = {"name": "identity", "in": "path", "required": True, "schema": {"type": "string"}, "description": "the job"}
AFTER = {
    "name": "after",
    "in": "query",
    "description": "number of events that the caller has already received",
    "schema": {"type": "integer", "minimum": 0, "maximum": 999_999_999, "default": 0},
}


@dataclass(frozen=True, slots=True)
class Endpoint:
    """An endpoint, declared on the function that answers it.

    Attributes
    ----------
    method, path, name, about
        HTTP method, path, name of the function and its first line.
    answer
        What is answered; None for a GIF.
    refusals
        HTTP statuses of refusals.
    body
        Name of the component that the request is.
    status
        HTTP status of the answer.
    parameters
        Parameters of the query.
    """

    method: str
    path: str
    name: str
    about: str
    answer: type[BaseModel] | None
    refusals: tuple[int, ...] = OF_ALL
    body: str | None = None
    status: int = 200
    parameters: tuple[Schema, ...] = ()

    def described(self) -> Schema:
        """Return the endpoint in OpenAPI."""
        content = {"image/gif": {}} if self.answer is None else _json(_ref(self.answer.__name__))
        responses = {str(self.status): {"description": self.about, "content": content}}
        for code in sorted(self.refusals):
            responses[str(code)] = {"description": _REFUSALS[code], "content": _json(_ref("Problems"))}
        found: Schema = {"operationId": self.name, "summary": self.about, "responses": responses}
        if self.parameters:
            found["parameters"] = list(self.parameters)
        if self.body is not None:
            examples = {name: {"value": value} for name, value in EXAMPLES[self.body].items()}
            found["requestBody"] = {"required": True, "content": _json(_ref(self.body), examples=examples)}
        return found


def endpoint(place: str, answer: type[BaseModel] | None, **more: Any) -> Callable[[_F], _F]:
    """Declare an endpoint at a `place`, such as "POST /api/simulate"; other arguments are those of `Endpoint`."""
    method, path = place.split()

    def declare(function: _F) -> _F:
        about = (function.__doc__ or "").partition("\n")[0].rstrip(".")
        function.endpoint = Endpoint(method.lower(), path, function.__name__, about, answer, **more)  # type: ignore[attr-defined]
        return function

    return declare


_SECURITY = {
    "token": {
        "type": "http",
        "scheme": "bearer",
        "description": "The token in the address that `stylobate lab` prints, or the one that was chosen at its start. "
        "The page keeps it in a cookie instead.",
    }
}


def document(endpoints: Iterable[Endpoint], limits: Limits) -> Schema:
    """Return the description of `endpoints` in OpenAPI 3.1."""
    paths: dict[str, Schema] = {}
    for one in endpoints:
        place = paths.setdefault(one.path, {"parameters": [_IDENTITY]} if "{identity}" in one.path else {})
        place[one.method] = one.described()
    return {
        "openapi": "3.1.0",
        "info": {
            "title": "stylobate laboratory",
            "version": version("stylobate"),
            "description": f"Requests may have {limits.body} bytes, uploads of records {limits.records}. Numbers "
            f"are in SI units, angles in rad; their size must be zero or between {SMALLEST:g} and {LARGEST:g}.",
        },
        "paths": paths,
        "components": {"schemas": {**_requests(limits), **answers.schemas()}, "securitySchemes": _SECURITY},
        "security": [{name: []} for name in _SECURITY],
    }


def _ref(name: str) -> Schema:
    return {"$ref": answers.REFERENCE.format(model=name)}


def _json(schema: Schema, **more: Schema) -> Schema:
    return {"application/json": {"schema": schema, **more}}


# Requests

_DECLARED: Mapping[str, Quantity] = {
    **{name: one.quantity for name, one in run_numbers().items()},
    **column_quantities(),
    **model_quantities(),
    **motion_quantities(),
}

_TEXTS = {
    **{name: in_words(one.quantity) for name, one in run_numbers().items()},
    "duration": "duration of a run [s]; optional under a base motion that ends or has a period",
    "demands": "whether to compute contact demands",
    "angular_frequency_range": "lowest and highest angular frequency [rad/s]",
    "points": "number of frequencies of the curves",
    "branch": "branch of steady rolling: upper (the larger tilt) or lower",
}

_TAGS = ("shape", "kind", "method")
"""Keys that distinguish columns, models, motions and steps of processing."""

_MOVING = tuple(kind for kind in MOTIONS if moves({"kind": kind}))


def _requests(limits: Limits) -> dict[str, Schema]:
    """Return the components of all requests."""
    found: dict[str, Schema] = {}
    bounds = _bounds(limits)
    for name, description in _REQUESTS.items():
        body = description.model_json_schema(ref_template=answers.REFERENCE)
        found |= {part: _part(schema, bounds) for part, schema in body.pop("$defs", {}).items()}
        found[name] = _whole(body, bounds)
    record, digest = found["RecordMotion"], {"type": ["string", "null"], "description": "digest of an uploaded record"}
    kept = {name: one for name, one in record["properties"].items() if name not in ("path", "file_sha256")}
    found["RecordMotion"] = record | {
        "description": "A record: either uploaded (`upload`), or a `sample` of the package.",
        "properties": {**kept, "upload": digest},
    }
    names = {description: name for name, description in _REQUESTS.items()}
    start = {"enum": [*BRANCHES, None], "description": "branch of steady rolling on which each run starts"}
    kinds = [
        _object(
            {"kind": {"const": kind}, "description": _ref(names[one])}
            | ({"start": start} if may_start_on_branch(kind) else {}),
            needed=("kind", "description"),
        )
        for kind, one in JOBS.items()
    ]
    job = {"description": "A job: its kind and description.", "oneOf": kinds}
    return {**{name: _finite(one) for name, one in found.items()}, "JobConfig": job}


def _bounds(limits: Limits) -> dict[str, Schema]:
    """Return the bounds of numbers by name; some numbers have further conditions, which the refusal states."""
    found: dict[str, Schema] = {"points": {"minimum": 2}, "tail": {"minimum": 0}}
    for name, one in _DECLARED.items():
        above = SMALLEST if one.gt == 0.0 and one.components == 1 else None
        bounds = {"minimum": above if one.ge is None else one.ge, "maximum": one.le}
        found[name] = {"enum": list(one.choices)} if one.choices else {k: v for k, v in bounds.items() if v is not None}
    for name, (most, _) in limits.of_numbers().items():
        found[name] = {**found.get(name, {}), "maximum": most}
    return found


def _whole(body: Schema, bounds: Mapping[str, Schema]) -> Schema:
    """Return the schema of a description with texts and bounds for its numbers."""
    properties: dict[str, Schema] = body["properties"]
    for name, schema in properties.items():
        if name in _TEXTS:
            schema["description"] = _TEXTS[name]
        _of_numbers(schema).update(bounds.get(name, {}))
    if "rules" in properties:
        rules = {field.name: {"type": "number", "minimum": SMALLEST} for field in fields(OutcomeRules)}
        properties["rules"] = _object(rules, needed=()) | {"description": "numbers of the rules that decide outcomes"}
    if "angular_frequency_range" in properties or "branch" in properties:
        properties["motion"] = _only(properties["motion"], kinds_with_response())
    if "duration" not in body["required"]:
        return body
    # A run requires a duration if the base does not move.
    moving = {"type": "object", "properties": {"kind": {"enum": list(_MOVING)}}}
    lasting = [
        {"required": ["duration"], "properties": {"duration": {"type": "number"}}},
        {"required": ["motion"], "properties": {"motion": moving}},
    ]
    return {**body, "required": [name for name in body["required"] if name != "duration"], "anyOf": lasting}


def _part(schema: Schema, bounds: Mapping[str, Schema]) -> Schema:
    """Return the schema of a column, a model, a motion or a step, with texts and bounds for its numbers."""
    properties = schema.get("properties", {})
    if "method" in properties:  # a step of processing
        for name in {"before", "after", "length", "order", "degree"} & set(properties):
            least = {"minimum": 1} if name in ("order", "degree") else {}
            _of_numbers(properties[name]).update({"maximum": bounds[name]["maximum"], **least})
    elif not {"motion", "motions"} & set(properties):  # composite motions state their own texts
        for name, body in properties.items():
            if name in NUMBERS and NUMBERS[name].text:
                body.setdefault("description", in_words(NUMBERS[name]))
            _of_numbers(body).update(bounds.get(name, {}))
    tags = [tag for tag in _TAGS if tag in properties]
    required = [*tags, *(name for name in schema.get("required", []) if name not in tags)]
    return {**schema, **({"required": required} if required else {})}


def _only(union: Schema, kinds: Collection[str]) -> Schema:
    """Return the union of the motions of these `kinds`."""
    mapping = {kind: place for kind, place in union["discriminator"]["mapping"].items() if kind in kinds}
    places = [{"$ref": place} for place in dict.fromkeys(mapping.values())]
    return {**union, "discriminator": {**union["discriminator"], "mapping": mapping}, "oneOf": places}


def _of_numbers(schema: Schema) -> Schema:
    """Return the part of a schema that describes numbers, if the schema also allows null."""
    return next(part for part in schema.get("anyOf", [schema]) if part.get("type") != "null")


def _object(properties: Schema, needed: Collection[str] | None = None) -> Schema:
    required = list(properties if needed is None else needed)
    return {"type": "object", "properties": properties, "required": required, "additionalProperties": False}


def _finite(schema: Any) -> Any:
    """Return a schema with bounds on all numbers, at any depth."""
    if isinstance(schema, list):
        return [_finite(part) for part in schema]
    if not isinstance(schema, dict):
        return schema
    bounds = {"minimum": -LARGEST, "maximum": LARGEST} if schema.get("type") == "number" else {}
    return {**bounds, **{name: _finite(part) for name, part in schema.items()}}
