"""Access control of the laboratory: only its own pages, and only those who know its token."""

from collections.abc import Collection

from starlette.datastructures import MutableHeaders
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from stylobate.lab.entrance import PAGE, Entrance
from stylobate.lab.policy import POLICY, written_policy

_HEADERS = {
    "Content-Security-Policy": written_policy(POLICY),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Frame-Options": "DENY",
    "Cache-Control": "no-store",
}


def _follows_a_link(request: Request) -> bool:
    """Return whether a browser opens the page in its own tab, for a link on any site."""
    headers, navigation = request.headers, {"sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}
    opens = request.method == "GET" and request.url.path in PAGE
    return opens and all(headers.get(name) == value for name, value in navigation.items())


class Guard:
    """Middleware that refuses foreign hosts and origins and prevents pages from loading foreign content.

    A site that the user visits may send requests to this machine, and may resolve its own name to this machine (DNS
    rebinding): the first has a foreign Origin, the second a foreign Host. A link on another site only opens the page.

    Parameters
    ----------
    app
        The guarded application.
    hosts
        Accepted values of the header Host, such as "127.0.0.1:8642".
    entrance
        Answers requests that do not state the token.
    """

    def __init__(self, app: ASGIApp, hosts: Collection[str], entrance: Entrance) -> None:
        self._app = app
        self._entrance = entrance
        self._hosts = frozenset(host.lower() for host in hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or pass it to the application."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        if scope["type"] != "http":  # the laboratory has no web sockets
            await receive()
            await send({"type": "websocket.close", "code": 1008})
            return

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.update({name: value for name, value in _HEADERS.items() if name not in headers})
            await send(message)

        request = Request(scope)
        answer = self._refusal(request) or self._entrance.answer(request) or self._app
        await answer(scope, receive, with_headers)

    def _refusal(self, request: Request) -> Response | None:
        problem = self._problem(request)
        return None if problem is None else JSONResponse({"problems": [problem]}, status_code=403)

    def _problem(self, request: Request) -> str | None:
        headers = request.headers
        host = headers.get("host", "").lower()
        if host not in self._hosts:
            return f"Host {host!r} is not allowed. Open {self._address} or start with --allow-host."
        origin = headers.get("origin")
        if origin is not None and origin.lower() not in {f"http://{known}" for known in self._hosts}:
            return f"Origin {origin!r} may not use this laboratory"
        if headers.get("sec-fetch-site", "same-origin") not in ("same-origin", "none") and not _follows_a_link(request):
            return "requests from other sites are not answered"
        return None

    @property
    def _address(self) -> str:
        return f"http://{min(self._hosts)}"
