"""The endpoints: what each takes, what it answers, and what it may refuse."""

from typing import Any

from stylobate.lab.schema import examples
from stylobate.lab.schema.notation import Schema, ref, table

_REFUSALS = {
    400: "The body is no JSON, or ended early.",
    403: "A foreign Host or Origin.",
    404: "There is no such job (any more), or it has no file.",
    413: "The body is too large.",
    415: "The body is of another type than application/json.",
    422: "The values cannot be: one line for each mistake.",
    429: "Too many jobs wait.",
    500: "The process that computed ended of its own, perhaps for want of memory.",
    503: "Too busy, or the run took too long.",
}

_OF_ALL = (403,)
_OF_BODIES = (*_OF_ALL, 400, 413, 415, 422)
_OF_RUNS = (*_OF_BODIES, 500, 503)

_JOB = {"name": "identity", "in": "path", "required": True, "schema": {"type": "string"}, "description": "of the job"}
_AFTER = {
    "name": "after",
    "in": "query",
    "description": "the number of events that are known already",
    "schema": {"type": "integer", "minimum": 0, "maximum": 999_999_999, "default": 0},
}


def paths() -> dict[str, Any]:
    """Return the endpoints by path and method."""
    return {
        "/api/about": {"get": _endpoint("about", "What there is to choose from", ref("About"))},
        "/api/schema": {"get": _endpoint("schema", "This description", table("OpenAPI 3.1.", {}, others={}))},
        "/api/describe": {
            "post": _endpoint(
                "describe",
                "TOML and Python of a run, and the numbers of its column",
                ref("Described"),
                _OF_BODIES,
                body=("Simulation", examples.RUNS),
            )
        },
        "/api/simulate": {
            "post": _endpoint("simulate", "One run", ref("Run"), _OF_RUNS, body=("Simulation", examples.RUNS))
        },
        "/api/response": {
            "post": _endpoint(
                "response",
                "Response curves of theory",
                ref("ResponseCurves"),
                _OF_BODIES,
                body=("Response", examples.RESPONSES),
            )
        },
        "/api/records": {
            "post": _endpoint(
                "upload", "Keep a record", ref("UploadedRecord"), _OF_RUNS, body=("Record", examples.RECORDS)
            )
        },
        "/api/jobs": {
            "post": _endpoint(
                "begin",
                "Begin a job",
                ref("Begun"),
                (*_OF_BODIES, 429),
                status=202,
                body=("JobDescription", examples.JOBS),
            )
        },
        "/api/jobs/{identity}": {
            "parameters": [_JOB],
            "get": {
                **_endpoint("follow", "How a job stands", ref("Job"), (*_OF_ALL, 404, 422)),
                "parameters": [_AFTER],
            },
            "delete": _endpoint("cancel", "Cancel a job", ref("Job"), (*_OF_ALL, 404)),
        },
        "/api/jobs/{identity}/file": {
            "parameters": [_JOB],
            "get": _endpoint("file", "The GIF of an animation", None, (*_OF_ALL, 404)),
        },
    }


def _endpoint(
    name: str,
    told: str,
    answer: Schema | None,
    refusals: tuple[int, ...] = _OF_ALL,
    *,
    status: int = 200,
    body: tuple[str, dict[str, Any]] | None = None,
) -> dict[str, Any]:
    """Return one endpoint; without an `answer` it is a picture; a `body` is the name of its component, and examples."""
    content: dict[str, Any] = {"image/gif": {}} if answer is None else {"application/json": {"schema": answer}}
    problems = {"application/json": {"schema": ref("Problems")}}
    found: dict[str, Any] = {
        "operationId": name,
        "summary": told,
        "responses": {
            str(status): {"description": told, "content": content},
            **{str(code): {"description": _REFUSALS[code], "content": problems} for code in sorted(refusals)},
        },
    }
    if body is not None:
        component, shown = body
        sent = {"schema": ref(component), "examples": {key: {"value": value} for key, value in shown.items()}}
        found["requestBody"] = {"required": True, "content": {"application/json": sent}}
    return found
