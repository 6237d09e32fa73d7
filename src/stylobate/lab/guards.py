"""Who may speak with the laboratory: pages it served itself, in a browser on this machine."""

from collections.abc import Collection

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)

_HEADERS = {
    "Content-Security-Policy": _POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Frame-Options": "DENY",
    "Cache-Control": "no-store",
}


class Guard:
    """Middleware that refuses foreign hosts and origins and lets pages load nothing from elsewhere.

    A site that the user visits may send requests to this machine, and may point a name of its own at it (rebinding of
    DNS): the first has a foreign Origin, the second a foreign Host.

    Parameters
    ----------
    app
        What is guarded.
    hosts
        Values of the header Host that are known, such as "127.0.0.1:8642".
    """

    def __init__(self, app: ASGIApp, hosts: Collection[str]) -> None:
        self._app = app
        self._hosts = frozenset(host.lower() for host in hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or have it answered."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(_HEADERS)
            await send(message)

        problem = self._problem(Headers(scope=scope))
        refused = JSONResponse({"problems": [problem]}, status_code=403)
        await (self._app if problem is None else refused)(scope, receive, with_headers)

    def _problem(self, headers: Headers) -> str | None:
        host = headers.get("host", "").lower()
        if host not in self._hosts:
            return f"Host {host!r} is not known here; open {self._address} or start with --allow-host"
        origin = headers.get("origin")
        if origin is not None and origin.lower() not in {f"http://{known}" for known in self._hosts}:
            return f"Origin {origin!r} may not use this laboratory"
        if headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none"):
            return "requests from other sites are not answered"
        return None

    @property
    def _address(self) -> str:
        return f"http://{min(self._hosts)}"
