"""The laboratory as an ASGI application."""

import tempfile
from collections.abc import AsyncIterator, Callable, Collection
from contextlib import AsyncExitStack, asynccontextmanager
from pathlib import Path

import anyio
from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Mount, Router

from stylobate.errors import ConfigError, StylobateError
from stylobate.lab.api import Api
from stylobate.lab.guards import Guard
from stylobate.lab.jobs import Jobs, broken
from stylobate.lab.limits import Limits, RefusedError
from stylobate.lab.pages import page_routes
from stylobate.lab.pool import OUT_OF_MEMORY, Pool
from stylobate.lab.uploads import Uploads


def end_processes(app: Starlette) -> None:
    """End the worker processes of a running application; open requests are then answered with an error."""
    for pool in getattr(app.state, "pools", ()):
        pool.end()


def create_app(
    *,
    hosts: Collection[str],
    token: str | None = None,
    limits: Limits | None = None,
    ready: Callable[[], object] | None = None,
) -> Starlette:
    """Return the application, for an ASGI server.

    Parameters
    ----------
    hosts
        Accepted values of the header Host, such as "127.0.0.1:8642"; requests with others are refused.
    token
        Token that requests must contain if other machines can reach the application.
    limits
        Limits on requests.
    ready
        Called when the application can answer requests.
    """
    bounds = limits or Limits()
    inner = Router()

    @asynccontextmanager
    async def lifespan(app: Starlette) -> AsyncIterator[None]:
        async with AsyncExitStack() as stack:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="stylobate-lab-")))
            group = await stack.enter_async_context(anyio.create_task_group())
            stack.callback(group.cancel_scope.cancel)
            runs, work = Pool(bounds.runs, group), Pool(bounds.jobs, group, background=True)
            for pool in (runs, work):
                stack.callback(pool.end)
            app.state.pools = (runs, work)
            jobs = Jobs(work, bounds, group)
            group.start_soon(jobs.watch)
            runs.warm_up()
            inner.routes[:] = Api(bounds, runs, jobs, Uploads(folder, bounds.uploads, bounds.unpacked)).routes()
            if ready is not None:
                ready()
            yield

    return Starlette(
        routes=[*page_routes(), Mount("/", app=inner)],
        middleware=[Middleware(Guard, hosts=hosts, token=token)],
        exception_handlers={
            RefusedError: _refusal,
            StylobateError: _mistake,
            MemoryError: _out_of_memory,
            HTTPException: _problem,
            Exception: _failure,
        },
        lifespan=lifespan,
    )


async def _refusal(request: Request, error: Exception) -> Response:
    del request
    assert isinstance(error, RefusedError)
    return JSONResponse({"problems": list(error.problems)}, status_code=error.status)


async def _mistake(request: Request, error: Exception) -> Response:
    """Answer with the library's messages about the values."""
    del request
    problems = error.problems if isinstance(error, ConfigError) else str(error).splitlines()
    return JSONResponse({"problems": list(problems)}, status_code=422)


async def _out_of_memory(request: Request, error: Exception) -> Response:
    del request, error
    return JSONResponse({"problems": [OUT_OF_MEMORY]}, status_code=422)


async def _failure(request: Request, error: Exception) -> Response:
    del request
    return JSONResponse({"problems": [broken(repr(error))]}, status_code=500)


async def _problem(request: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    problem = f"{request.method} {request.url.path}: {error.detail.lower()}"
    return JSONResponse({"problems": [problem]}, status_code=error.status_code, headers=error.headers)
