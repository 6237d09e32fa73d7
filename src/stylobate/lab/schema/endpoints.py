"""Endpoints in OpenAPI: request, answer and possible errors of each."""

from typing import Any

from stylobate.lab.schema import examples
from stylobate.lab.schema.notation import Schema, ref, table

_REFUSALS = {
    400: "The body is not JSON, or ended early.",
    403: "A foreign Host or Origin.",
    401: "The token is missing or wrong; needed if other machines can reach the laboratory.",
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

_OF_ALL = (401, 403)
_OF_BODIES = (*_OF_ALL, 400, 413, 415, 422)
_OF_RUNS = (*_OF_BODIES, 500, 502, 503, 504)

_JOB = {"name": "identity", "in": "path", "required": True, "schema": {"type": "string"}, "description": "the job"}
_AFTER = {
    "name": "after",
    "in": "query",
    "description": "number of events that the caller has already received",
    "schema": {"type": "integer", "minimum": 0, "maximum": 999_999_999, "default": 0},
}


def paths() -> dict[str, Any]:
    """Return the endpoints by path and method."""
    return {
        "/api/about": {"get": _endpoint("about", "Options", ref("About"))},
        "/api/schema": {"get": _endpoint("schema", "This description", table("OpenAPI 3.1.", {}, others={}))},
        "/api/describe": {
            "post": _endpoint(
                "describe",
                "Description of a run as TOML and Python, and the numbers of its column",
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
                "Response curves from theory",
                ref("ResponseCurves"),
                _OF_BODIES,
                body=("Response", examples.RESPONSES),
            )
        },
        "/api/start": {
            "post": _endpoint(
                "start",
                "Initial conditions on steady rolling, from theory or on the exact orbit",
                ref("Start"),
                _OF_RUNS,
                body=("SteadyRollingStart", examples.STARTS),
            )
        },
        "/api/records": {
            "post": _endpoint(
                "upload", "Upload a record", ref("UploadedRecord"), _OF_RUNS, body=("Record", examples.RECORDS)
            )
        },
        "/api/jobs": {
            "post": _endpoint(
                "begin",
                "Begin a job",
                ref("Begun"),
                (*_OF_BODIES, 429),
                status=202,
                body=("JobConfig", examples.JOBS),
            )
        },
        "/api/jobs/{identity}": {
            "parameters": [_JOB],
            "get": {
                **_endpoint("follow", "State of a job", ref("Job"), (*_OF_ALL, 404, 422)),
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
    about: str,
    answer: Schema | None,
    refusals: tuple[int, ...] = _OF_ALL,
    *,
    status: int = 200,
    body: tuple[str, dict[str, Any]] | None = None,
) -> dict[str, Any]:
    """Return one endpoint; without an `answer` it returns a GIF; a `body` is a component's name, and examples."""
    content: dict[str, Any] = {"image/gif": {}} if answer is None else {"application/json": {"schema": answer}}
    problems = {"application/json": {"schema": ref("Problems")}}
    found: dict[str, Any] = {
        "operationId": name,
        "summary": about,
        "responses": {
            str(status): {"description": about, "content": content},
            **{str(code): {"description": _REFUSALS[code], "content": problems} for code in sorted(refusals)},
        },
    }
    if body is not None:
        component, shown = body
        sent = {"schema": ref(component), "examples": {key: {"value": value} for key, value in shown.items()}}
        found["requestBody"] = {"required": True, "content": {"application/json": sent}}
    return found
