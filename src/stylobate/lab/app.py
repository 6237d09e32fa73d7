"""The laboratory as an ASGI application: its page, and its HTTP API for the page and for any program on this machine.

See docs/reference/http-api.md.
"""

import tempfile
from collections.abc import AsyncIterator, Callable, Collection, Sequence
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import anyio
from anyio import to_thread
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.middleware.gzip import GZipMiddleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Mount, Route, Router

from stylobate.errors import ConfigError, StylobateError
from stylobate.lab import answers, openapi
from stylobate.lab.curves import response
from stylobate.lab.entrance import Entrance
from stylobate.lab.guards import Guard
from stylobate.lab.jobs import Jobs, broken
from stylobate.lab.limits import Limits, RefusedError
from stylobate.lab.messages import OUT_OF_MEMORY, Broken, Finished, Lost, Refused
from stylobate.lab.options import about
from stylobate.lab.pages import page_routes
from stylobate.lab.pool import BusyError, Pool
from stylobate.lab.requests import (
    BRANCHES,
    JOBS,
    Archive,
    Description,
    Uploads,
    described,
    json_body,
    may_start_on_branch,
    problems_of_numbers,
)
from stylobate.lab.runs import described_case

_SMALL, _QUICKLY = 1024, 3
"""Size from which an answer is compressed [bytes], and the level of the compression."""


def create_app(
    *,
    hosts: Collection[str],
    token: str,
    limits: Limits | None = None,
    ready: Callable[[], object] | None = None,
) -> Starlette:
    """Return the application, for an ASGI server.

    Parameters
    ----------
    hosts
        Accepted values of the header Host, such as "127.0.0.1:8642"; requests with others are refused.
    token
        Token that requests must state: 12 to 128 letters, digits, "-", ".", "_" or "~".
    limits
        Limits on requests.
    ready
        Called when the application can answer requests.

    Raises
    ------
    ParameterError
        If the token is too short, too long, or has other characters.
    """
    bounds = limits or Limits()
    inner, entrance = Router(), Entrance(token)

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        async with AsyncExitStack() as stack:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="stylobate-lab-")))
            group = await stack.enter_async_context(anyio.create_task_group())
            stack.callback(group.cancel_scope.cancel)
            runs, work = Pool(bounds.runs, group), Pool(bounds.jobs, group, background=True)
            app.state.pools = (runs, work)
            stack.callback(end_processes, app)
            jobs = Jobs(work, bounds, group)
            group.start_soon(jobs.watch)
            runs.warm_up()
            inner.routes[:] = Api(bounds, runs, jobs, Uploads(folder, bounds.uploads, bounds.unpacked)).routes()
            if ready is not None:
                ready()
            yield

    app = Starlette(
        routes=[*page_routes(), Mount("/", app=inner)],
        middleware=[
            Middleware(Guard, hosts=hosts, entrance=entrance),
            Middleware(GZipMiddleware, minimum_size=_SMALL, compresslevel=_QUICKLY),
        ],
        exception_handlers=dict.fromkeys(
            (RefusedError, StylobateError, MemoryError, HTTPException, Exception), _problems
        ),
        lifespan=lifespan,
    )
    app.state.entrance = entrance
    return app


def end_processes(app: Starlette) -> None:
    """End the worker processes of a running application; open requests are then answered with an error."""
    for pool in getattr(app.state, "pools", ()):
        pool.end()


async def _problems(request: Request, error: Exception) -> Response:
    """Answer with one line for each reason of a refusal or a failure."""
    status, headers = 422, None
    lines: Sequence[str]
    match error:
        case RefusedError(problems=lines):
            status = error.status
        case ConfigError(problems=lines):
            pass
        case StylobateError():
            lines = str(error).splitlines()
        case MemoryError():
            lines = [OUT_OF_MEMORY]
        case HTTPException():
            status, headers = error.status_code, error.headers
            lines = [f"{request.method} {request.url.path}: {error.detail.lower()}"]
        case _:
            status, lines = 500, [broken(repr(error))]
    return _answer(answers.Problems(problems=list(lines)), status, headers)


def _answer(answer: answers.Answer, status: int = 200, headers: Any = None) -> Response:
    return Response(answer.as_json(), status, headers, media_type="application/json")


# Endpoints


@dataclass(frozen=True, slots=True)
class Api:
    """The endpoints and the state that they share."""

    limits: Limits
    runs: Pool
    jobs: Jobs
    uploads: Uploads

    def routes(self) -> list[Route]:
        """Return the endpoints by path; each has the name of a method."""
        return [Route(one.path, getattr(self, one.name), methods=[one.method.upper()]) for one in endpoints()]

    @openapi.endpoint("GET /api/about", answers.About)
    async def about(self, request: Request) -> Response:
        """Return the options: models, motions and columns with their parameters; presets; limits."""
        del request
        return _answer(about(self.limits))

    @openapi.endpoint("GET /api/schema", answers.Document)
    async def schema(self, request: Request) -> Response:
        """Return the description of the endpoints (OpenAPI)."""
        del request
        return JSONResponse(schema(self.limits))

    @openapi.endpoint("POST /api/describe", answers.Described, refusals=openapi.OF_BODIES, body="Simulation")
    async def describe(self, request: Request) -> Response:
        """Return the description as TOML and as Python, and the derived numbers of the column, without a run."""
        return _answer(await to_thread.run_sync(described_case, await self._described(request)))

    @openapi.endpoint("POST /api/simulate", answers.Run, refusals=openapi.OF_RUNS, body="Simulation")
    async def simulate(self, request: Request) -> Response:
        """Compute one run."""
        return Response(await self._run("run", await self._described(request), request), media_type="application/json")

    @openapi.endpoint("POST /api/variations", answers.Variations, refusals=openapi.OF_RUNS, body="Simulation")
    async def variations(self, request: Request) -> Response:
        """Compute small variations of one run: how often they end in each way, and their tilts."""
        given = await self._described(request)
        return _answer(await self._run("variations", given.values, request))

    @openapi.endpoint("POST /api/response", answers.ResponseCurves, refusals=openapi.OF_BODIES, body="Response")
    async def response(self, request: Request) -> Response:
        """Compute amplitude and phase of steady rolling over frequency, from theory."""
        given = await self._described(request)
        return _answer(await to_thread.run_sync(response, given.values))

    @openapi.endpoint("POST /api/start", answers.Start, refusals=openapi.OF_RUNS, body="SteadyRollingStart")
    async def start(self, request: Request) -> Response:
        """Compute initial conditions on steady rolling: from theory, or on the exact orbit if theory is approximate."""
        given = await self._described(request)
        return _answer(await self._run("start", given.values, request))

    @openapi.endpoint("POST /api/records", answers.UploadedRecord, refusals=openapi.OF_RUNS, body="Record")
    async def upload(self, request: Request) -> Response:
        """Store the files of a record, or an archive of records, and report the contents of one."""
        body = await json_body(request, self.limits.records)
        numbers = {name: value for name, value in body.items() if name not in ("files", "record")}
        problems = problems_of_numbers(numbers, self.limits)
        if problems:
            raise RefusedError(422, problems)
        upload = await to_thread.run_sync(self.uploads.add, body)
        archive = Archive({}, ())
        try:
            if upload.is_archive:
                archive = await self._run("archive", replace(upload, parts=()).first_read(), request)
                upload = self.uploads.choose(upload, archive, body.get("record"))
            contents = await self._run("record", upload.first_read(), request)
        except RefusedError as error:
            self.uploads.drop(upload)
            problems = [line.replace(f"{upload.folder}/", "") for line in error.problems]
            raise RefusedError(error.status, problems) from None
        warnings = [*archive.warnings, *contents.pop("warnings")]
        records = list(archive.records)
        return _answer(answers.UploadedRecord(upload=upload.digest, **contents, warnings=warnings, records=records))

    @openapi.endpoint("POST /api/jobs", answers.Begun, refusals=(*openapi.OF_BODIES, 429), body="JobConfig", status=202)
    async def begin(self, request: Request) -> Response:
        """Begin a job."""
        body = await json_body(request, self.limits.body)
        kind, values = body.get("kind"), body.get("description")
        if not isinstance(kind, str) or kind not in JOBS:
            raise RefusedError(422, [f"kind must be one of {', '.join(JOBS)}, got {kind!r}"])
        if not isinstance(values, dict):
            raise RefusedError(422, ["description is missing: the plain values of a description"])
        start = body.get("start")
        if start is not None and not (start in BRANCHES and may_start_on_branch(kind)):
            raise RefusedError(422, [f"start must be one of {', '.join(BRANCHES)}, for a map (got {start!r})"])
        given = described(values, self.uploads, self.limits)
        await to_thread.run_sync(JOBS[kind].parse, given.values)
        asked = given.values if start is None else {**given.values, "start": start}
        return _answer(answers.Begun(id=self.jobs.begin(kind, asked)), 202)

    @openapi.endpoint(
        "GET /api/jobs/{identity}", answers.Job, refusals=(*openapi.OF_ALL, 404, 422), parameters=(openapi.AFTER,)
    )
    async def follow(self, request: Request) -> Response:
        """Return the state of a job, with the events from the number `after` on."""
        after = request.query_params.get("after", "0")
        if not (after.isascii() and after.isdigit() and len(after) < 10):  # noqa: PLR2004  digits of a count
            raise RefusedError(422, [f"after must be a number of events, got {after!r}"])
        return _answer(self.jobs.report(request.path_params["identity"], int(after)))

    @openapi.endpoint("DELETE /api/jobs/{identity}", answers.Job, refusals=(*openapi.OF_ALL, 404))
    async def cancel(self, request: Request) -> Response:
        """Cancel a job."""
        identity = request.path_params["identity"]
        self.jobs.cancel(identity)
        return _answer(self.jobs.report(identity))

    @openapi.endpoint("GET /api/jobs/{identity}/file", None, refusals=(*openapi.OF_ALL, 404))
    async def file(self, request: Request) -> Response:
        """Return the GIF of a job."""
        result = self.jobs[request.path_params["identity"]].result
        if not isinstance(result, bytes):
            raise RefusedError(404, ["this job has no file (yet)"])
        return Response(result, media_type="image/gif")

    async def _described(self, request: Request) -> Description:
        return described(await json_body(request, self.limits.body), self.uploads, self.limits)

    async def _run(self, kind: str, values: Any, request: Request) -> Any:
        """Return the result of a task; end the task when the caller disconnects or its time limit passes."""
        limits = self.limits
        perform = partial(self.runs.perform, kind, values, wait=limits.wait, limit=limits.run_time)
        answer = None
        try:
            async with anyio.create_task_group() as group:
                group.start_soon(_when_gone, request, group.cancel_scope.cancel)
                answer = await perform(lambda _: None)
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
                raise RefusedError(500, [broken(trace)])
        raise RefusedError(400, ["the caller cancelled the request"])


def endpoints() -> list[openapi.Endpoint]:
    """Return the endpoints as they are declared."""
    return [one.endpoint for one in vars(Api).values() if hasattr(one, "endpoint")]


def schema(limits: Limits) -> answers.Schema:
    """Return the description of the API, OpenAPI 3.1."""
    return openapi.document(endpoints(), limits)


async def _when_gone(request: Request, act: Callable[[], None]) -> None:
    """Call `act` when the sender of `request` disconnects."""
    while (await request.receive())["type"] != "http.disconnect":
        pass
    act()
