"""The description of the laboratory's endpoints for programs: OpenAPI, made from the descriptions themselves."""

from importlib.metadata import version
from typing import Any

from stylobate import spec
from stylobate.lab.limits import Limits
from stylobate.spec.description import Description

_REFUSALS = {
    "400": "The body is no JSON.",
    "403": "A foreign Host or Origin.",
    "404": "There is no such job or path.",
    "413": "The body is too large.",
    "415": "The body is of another type than application/json.",
    "422": "The values cannot be: one line for each mistake.",
    "429": "Too many jobs wait.",
    "503": "Too busy, or a run that took too long.",
}

_DESCRIPTIONS: dict[str, type[Description]] = {
    "Simulation": spec.SimulationDescription,
    "Response": spec.ResponseDescription,
    "Map": spec.MapDescription,
    "Basin": spec.BasinDescription,
}


def schema(limits: Limits) -> dict[str, Any]:
    """Return the endpoints as OpenAPI 3.1."""
    parts: dict[str, Any] = {"Problems": _object({"problems": {"type": "array", "items": {"type": "string"}}})}
    for name, description in _DESCRIPTIONS.items():
        told = description.model_json_schema(ref_template="#/components/schemas/{model}")
        parts |= told.pop("$defs", {})
        parts[name] = told
    return {
        "openapi": "3.1.0",
        "info": {
            "title": "The laboratory of stylobate",
            "version": version("stylobate"),
            "description": f"Requests may have {limits.body} bytes, those with records {limits.records}.",
        },
        "paths": _paths(),
        "components": {"schemas": parts},
    }


def _paths() -> dict[str, Any]:
    identity = {"name": "identity", "in": "path", "required": True, "schema": {"type": "string"}}
    after = {"name": "after", "in": "query", "schema": {"type": "integer", "minimum": 0, "maximum": 999_999_999}}
    job = _object(
        {
            "kind": {"enum": ["exact", "map", "basin", "animation"]},
            "description": {"anyOf": [_ref(name) for name in _DESCRIPTIONS]},
        }
    )
    return {
        "/api/about": {"get": _endpoint("What there is to choose from", ok="200")},
        "/api/schema": {"get": _endpoint("This description", ok="200")},
        "/api/describe": {"post": _endpoint("TOML and Python of a run", ok="200", body=_ref("Simulation"))},
        "/api/simulate": {"post": _endpoint("One run", ok="200", body=_ref("Simulation"))},
        "/api/response": {"post": _endpoint("Response curves of theory", ok="200", body=_ref("Response"))},
        "/api/records": {"post": _endpoint("Upload a record", ok="200", body=_record())},
        "/api/jobs": {"post": _endpoint("Begin a job", ok="202", body=job)},
        "/api/jobs/{identity}": {
            "get": _endpoint("How a job stands", ok="200", parameters=[identity, after]),
            "delete": _endpoint("Cancel a job", ok="200", parameters=[identity]),
        },
        "/api/jobs/{identity}/file": {"get": _endpoint("The GIF of a job", ok="200", parameters=[identity])},
    }


def _endpoint(
    told: str, *, ok: str, body: dict[str, Any] | None = None, parameters: list[Any] | None = None
) -> dict[str, Any]:
    problems = {"content": {"application/json": {"schema": _ref("Problems")}}}
    found: dict[str, Any] = {
        "summary": told,
        "responses": {
            ok: {"description": told},
            **{status: {"description": why, **problems} for status, why in _REFUSALS.items()},
        },
    }
    if body is not None:
        found["requestBody"] = {"required": True, "content": {"application/json": {"schema": body}}}
    if parameters:
        found["parameters"] = parameters
    return found


def _record() -> dict[str, Any]:
    file = _object({"name": {"type": "string"}, "content": {"type": "string", "contentEncoding": "base64"}})
    told = _object({"files": {"type": "array", "items": file, "minItems": 1, "maxItems": 3}})
    told["properties"] |= {"units": {"type": ["string", "null"]}, "step": {"type": ["number", "null"]}}
    return told


def _object(properties: dict[str, Any]) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


def _ref(name: str) -> dict[str, str]:
    return {"$ref": f"#/components/schemas/{name}"}
