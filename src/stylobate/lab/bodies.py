"""Bodies of requests: JSON objects of limited size."""

import json
from typing import Any, NoReturn

from starlette.requests import ClientDisconnect, Request

from stylobate.lab.refusals import RefusedError


async def json_body(request: Request, limit: int) -> dict[str, Any]:
    """Return the JSON object in the body of `request`, at most `limit` bytes long.

    Raises
    ------
    RefusedError
        If the body has another type, is too large, is not JSON, or is not an object.
    """
    kind = request.headers.get("content-type", "").partition(";")[0].strip().lower()
    if kind != "application/json":
        raise RefusedError(415, [f"content-type must be application/json, got {kind or 'none'}"])
    try:
        found = json.loads(await _bytes(request, limit), parse_constant=_refuse_constant)
    except (ValueError, RecursionError) as error:
        raise RefusedError(400, [f"the body is not JSON: {error}"]) from None
    if not isinstance(found, dict):
        raise RefusedError(422, [f"the body must be a JSON object, got {type(found).__name__}"])
    return found


async def _bytes(request: Request, limit: int) -> bytes:
    length = request.headers.get("content-length", "")
    if length.isdigit() and int(length) > limit:
        _too_large(limit)
    body = bytearray()
    try:
        async for part in request.stream():
            body += part
            if len(body) > limit:
                _too_large(limit)
    except ClientDisconnect:
        raise RefusedError(400, ["the body ended early"]) from None
    return bytes(body)


def _too_large(limit: int) -> NoReturn:
    raise RefusedError(413, [f"a request may have at most {limit} bytes"])


def _refuse_constant(name: str) -> NoReturn:
    message = f"{name} is not a JSON number"
    raise ValueError(message)
