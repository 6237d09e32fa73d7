"""HTTP API of the laboratory, for the page and for any program on this machine. See docs/reference/http-api.md."""

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import anyio
from anyio import to_thread
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from stylobate import config, studies
from stylobate.lab.bodies import json_body
from stylobate.lab.curves import response
from stylobate.lab.jobs import Jobs, broken
from stylobate.lab.limits import Limits
from stylobate.lab.messages import Broken, Finished, Lost, Refused
from stylobate.lab.options import about
from stylobate.lab.refusals import RefusedError
from stylobate.lab.request_parsing import Described, described
from stylobate.lab.responses import plain_column, snippets
from stylobate.lab.schema import schema
from stylobate.lab.size_limits import beyond_size
from stylobate.lab.uploads import Uploads
from stylobate.lab.worker_pool import Answer, BusyError, WorkerPool

_log = logging.getLogger("stylobate.lab")

_JOBS: dict[str, type[Any]] = {
    "exact": config.ResponseConfig,
    "map": config.study_config(studies.overturning_map),
    "basin": config.study_config(studies.basins),
    "animation": config.SimulationConfig,
}


@dataclass(frozen=True, slots=True)
class Api:
    """The endpoints and the state that they share."""

    limits: Limits
    runs: WorkerPool
    jobs: Jobs
    uploads: Uploads

    def routes(self) -> list[Route]:
        """Return the endpoints by path."""
        return [
            Route("/api/about", self.about, methods=["GET"]),
            Route("/api/schema", self.schema, methods=["GET"]),
            Route("/api/describe", self.describe, methods=["POST"]),
            Route("/api/simulate", self.simulate, methods=["POST"]),
            Route("/api/response", self.response, methods=["POST"]),
            Route("/api/start", self.start, methods=["POST"]),
            Route("/api/records", self.upload, methods=["POST"]),
            Route("/api/jobs", self.begin, methods=["POST"]),
            Route("/api/jobs/{identity:str}", self.follow, methods=["GET"]),
            Route("/api/jobs/{identity:str}", self.cancel, methods=["DELETE"]),
            Route("/api/jobs/{identity:str}/file", self.file, methods=["GET"]),
        ]

    async def about(self, request: Request) -> Response:
        """Return the options: models, motions and columns with their parameters; presets; limits."""
        del request
        return JSONResponse(about(self.limits))

    async def schema(self, request: Request) -> Response:
        """Return the description of the endpoints (OpenAPI)."""
        del request
        return JSONResponse(schema(self.limits))

    async def describe(self, request: Request) -> Response:
        """Return the description as TOML and as Python, and the derived numbers of the column, without a run."""
        given = await self._described(request)

        def about() -> dict[str, Any]:
            model = config.SimulationConfig.parse(given.values).build().model
            return {**snippets(given), "column": plain_column(model)}

        return JSONResponse(await to_thread.run_sync(about))

    async def simulate(self, request: Request) -> Response:
        """Compute one run."""
        given = await self._described(request)
        limited = replace(given, values={"max_steps": min(self.limits.usual_steps, self.limits.steps), **given.values})
        return Response(await self._run("run", limited, request), media_type="application/json")

    async def response(self, request: Request) -> Response:
        """Compute amplitude and phase of steady rolling over frequency, from theory."""
        given = await self._described(request)
        return JSONResponse(await to_thread.run_sync(lambda: response(given.values)))

    async def start(self, request: Request) -> Response:
        """Compute initial conditions on steady rolling: from theory, or on the exact orbit if theory is approximate."""
        given = await self._described(request)
        return JSONResponse(await self._run("start", given.values, request))

    async def upload(self, request: Request) -> Response:
        """Store the files of a record and report their contents."""
        body = await json_body(request, self.limits.records)
        problems = beyond_size({name: value for name, value in body.items() if name != "files"})
        if problems:
            raise RefusedError(422, problems)
        upload = await to_thread.run_sync(self.uploads.add, body)
        try:
            answer = await self._run("record", upload.as_read(), request)
        except RefusedError as error:
            self.uploads.drop(upload)
            folder = f"{upload.paths[0].parent}/"
            raise RefusedError(error.status, [line.replace(folder, "") for line in error.problems]) from None
        self.uploads.measured(upload, answer["samples"], answer["step"])
        return JSONResponse({"upload": upload.digest, **answer})

    async def begin(self, request: Request) -> Response:
        """Begin a job."""
        body = await json_body(request, self.limits.body)
        kind, values = body.get("kind"), body.get("description")
        if not isinstance(kind, str) or kind not in _JOBS:
            raise RefusedError(422, [f"kind must be one of {', '.join(_JOBS)}, got {kind!r}"])
        if not isinstance(values, dict):
            raise RefusedError(422, ["description is missing: the plain values of a description"])
        given = described(values, self.uploads, self.limits)
        await to_thread.run_sync(lambda: _JOBS[kind].parse(given.values))
        return JSONResponse({"id": self.jobs.begin(kind, given.values).identity}, status_code=202)

    async def follow(self, request: Request) -> Response:
        """Return the state of a job, with the events from the number `after` on."""
        after = request.query_params.get("after", "0")
        if not (after.isascii() and after.isdigit() and len(after) < 10):  # noqa: PLR2004  digits of a count
            raise RefusedError(422, [f"after must be a number of events, got {after!r}"])
        return JSONResponse(self.jobs.report(request.path_params["identity"], int(after)))

    async def cancel(self, request: Request) -> Response:
        """Cancel a job."""
        job = self.jobs.cancel(request.path_params["identity"])
        return JSONResponse(self.jobs.report(job.identity, 0) | {"events": []})

    async def file(self, request: Request) -> Response:
        """Return the GIF of a job."""
        result = self.jobs[request.path_params["identity"]].result
        if not isinstance(result, bytes):
            raise RefusedError(404, ["this job has no file (yet)"])
        return Response(result, media_type="image/gif")

    async def _described(self, request: Request) -> Described:
        return described(await json_body(request, self.limits.body), self.uploads, self.limits)

    async def _run(self, kind: str, values: Any, request: Request) -> Any:
        """Return the result of a task; end the task when the caller disconnects or its time limit passes."""
        answer: Answer | None = None
        limits = self.limits
        try:
            async with anyio.create_task_group() as group:
                group.start_soon(_when_gone, request, group.cancel_scope.cancel)
                answer = await self.runs.perform(kind, values, lambda _: None, wait=limits.wait, limit=limits.run_time)
                group.cancel_scope.cancel()
        except* BusyError:
            problem = f"all {limits.runs} worker processes were busy for {limits.wait:g} s. Try again."
            raise RefusedError(503, [problem]) from None
        except* TimeoutError:
            problem = f"the run was stopped after {limits.run_time:g} s. Shorten its duration or run it in Python."
            raise RefusedError(504, [problem]) from None
        match answer:
            case Finished(result):
                return result
            case Refused(problems):
                raise RefusedError(422, problems)
            case Lost() if self.runs.ended:
                raise RefusedError(503, ["the laboratory is ending. Start it again."])
            case Lost():
                raise RefusedError(502, [answer.problem])
            case Broken(trace):
                _log.error(trace)
                raise RefusedError(500, [broken(trace)])
        raise RefusedError(400, ["the caller cancelled the request"])


async def _when_gone(request: Request, act: Callable[[], None]) -> None:
    """Call `act` when the sender of `request` disconnects."""
    while (await request.receive())["type"] != "http.disconnect":
        pass
    act()
