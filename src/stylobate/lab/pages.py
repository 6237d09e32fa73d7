"""Files of the page: built at packaging time, and served from one folder only."""

from importlib.resources import files
from pathlib import Path

from starlette.requests import Request
from starlette.responses import FileResponse, PlainTextResponse, Response
from starlette.routing import Route
from starlette.types import Receive, Scope, Send

_TYPES = {
    ".html": "text/html",
    ".js": "text/javascript",
    ".css": "text/css",
    ".svg": "image/svg+xml",
    ".txt": "text/plain",
}

NO_PAGE = """The laboratory's page is not in this installation.

A wheel of stylobate holds it. In a source tree it is built with Node (20 or newer):

    make page        (or: npm ci && npm run build, in src/stylobate/lab/web)

The API under /api works without it; see the documentation.
"""


def page_folder() -> Path:
    """Return the folder of the built page."""
    return Path(str(files("stylobate.lab"))) / "page"


def page_is_built() -> bool:
    """Return whether the page is built."""
    return (page_folder() / "index.html").is_file()


def page_routes() -> list[Route]:
    """Return a route for each file of the page and nothing else; without a page, a route that reports it missing."""
    if not page_is_built():
        return [Route("/", _no_page, methods=["GET"])]
    found = {f"/{path.name}": path for path in sorted(page_folder().iterdir()) if path.suffix in _TYPES}
    found["/"] = found["/index.html"]
    return [Route(name, _Served(path), methods=["GET"]) for name, path in found.items()]


class _Served:
    """Application that answers with one file."""

    def __init__(self, path: Path) -> None:
        self._path = path

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        await FileResponse(self._path, media_type=_TYPES[self._path.suffix])(scope, receive, send)


async def _no_page(request: Request) -> Response:
    del request
    return PlainTextResponse(NO_PAGE, status_code=503)
