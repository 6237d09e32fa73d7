"""Access control of the laboratory: only its own pages, in a browser on this machine."""

import secrets
from collections.abc import Collection, Mapping

from starlette.datastructures import MutableHeaders
from starlette.requests import Request
from starlette.responses import JSONResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

POLICY: Mapping[str, str] = {
    "default-src": "'none'",
    "script-src": "'self'",
    "style-src": "'self'",
    "img-src": "'self' data: blob:",
    "connect-src": "'self'",
    "base-uri": "'none'",
    "form-action": "'none'",
    "frame-ancestors": "'none'",
}
"""Content-Security-Policy of the page: it loads from its own server only."""


def written_policy(policy: Mapping[str, str]) -> str:
    """Return a Content-Security-Policy as it is sent."""
    return "; ".join(f"{name} {sources}" for name, sources in policy.items())


_HEADERS = {
    "Content-Security-Policy": written_policy(POLICY),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "X-Frame-Options": "DENY",
    "Cache-Control": "no-store",
}

_PAGE = ("/", "/index.html")

_UNKNOWN = (
    "token: missing or wrong. Open the address that `stylobate lab` printed, or send the header "
    "Authorization: Bearer with its token."
)


def _follows_a_link(request: Request) -> bool:
    """Return whether a browser opens the page in its own tab, for a link on any site."""
    headers, navigation = request.headers, {"sec-fetch-mode": "navigate", "sec-fetch-dest": "document"}
    opens = request.method == "GET" and request.url.path in _PAGE
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
    token
        Token that requests must contain in the query, in the cookie derived from it, or as `Authorization: Bearer`.
    """

    def __init__(self, app: ASGIApp, hosts: Collection[str], token: str | None = None) -> None:
        self._app = app
        self._token = token
        self._hosts = frozenset(host.lower() for host in hosts)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or pass it to the application."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(_HEADERS)
            await send(message)

        request = Request(scope)
        answer = self._refusal(request) or self._asked_for_token(request) or self._app
        await answer(scope, receive, with_headers)

    def _refusal(self, request: Request) -> Response | None:
        problem = self._problem(request)
        return None if problem is None else JSONResponse({"problems": [problem]}, status_code=403)

    def _asked_for_token(self, request: Request) -> Response | None:
        """Refuse a request without the token; if the address of the page contains the token, set a cookie."""
        if self._token is None:
            return None
        name = f"stylobate-lab-{(request.scope.get('server') or ('', 0))[1]}"
        if self._is_token(request.query_params.get("token")):
            if request.url.path not in _PAGE:
                return None
            opened = RedirectResponse(request.url.path, status_code=303)
            opened.set_cookie(name, self._token, httponly=True, samesite="lax")
            return opened
        scheme, _, shown = request.headers.get("authorization", "").partition(" ")
        if self._is_token(request.cookies.get(name)) or (scheme.lower() == "bearer" and self._is_token(shown)):
            return None
        return JSONResponse({"problems": [_UNKNOWN]}, status_code=401)

    def _is_token(self, shown: str | None) -> bool:
        return self._token is not None and secrets.compare_digest((shown or "").encode(), self._token.encode())

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
