"""Token of the laboratory: every request must state it; the page that asks for it sets a cookie.

The printed address contains the token. The page's first request with it sets the cookie and is redirected to the
address without it; browsers keep the fragment, which names the case. Programs send `Authorization: Bearer TOKEN`.
"""

import hashlib
import re
import secrets
from html import escape

from starlette.requests import Request
from starlette.responses import HTMLResponse, JSONResponse, RedirectResponse, Response

from stylobate.errors import ParameterError
from stylobate.lab.policy import POLICY, digest_of, written_policy

PAGE = ("/", "/index.html")
"""Paths of the page."""

_BYTES = 16
_CHOSEN = re.compile(r"[A-Za-z0-9._~-]{12,128}")
"""Chosen tokens: what addresses, cookies and headers hold without quotes, and too long to be tried out."""


def new_token() -> str:
    """Return a random token of 128 bits, which a double click selects."""
    return secrets.token_hex(_BYTES)


def require_token(token: str) -> str:
    """Return a chosen token, or raise ParameterError without repeating it."""
    if _CHOSEN.fullmatch(token):
        return token
    raise ParameterError(
        f"token: must be 12 to 128 of the characters A to Z, a to z, 0 to 9, '-', '.', '_' and '~' "
        f"(got {len(token)} characters). Choose another one, or leave it out for a random one."
    )


class Entrance:
    """Answers requests that do not state the token.

    Parameters
    ----------
    token
        Token that requests must state.
    """

    def __init__(self, token: str) -> None:
        self._token = require_token(token)
        # Browsers send a cookie to every port of its host: another server there must not learn the token itself.
        self._cookie = hashlib.sha256(f"cookie of {token}".encode()).hexdigest()
        self._keys: set[str] = set()

    def key(self) -> str:
        """Return a token that opens the page once: the list of processes shows the address that a browser is given."""
        self._keys.add(key := new_token())
        return key

    def answer(self, request: Request) -> Response | None:
        """Return the answer to a request that does not state the token, or moves it to a cookie; None lets it pass."""
        path = request.url.path
        if path not in PAGE or request.method not in ("GET", "HEAD"):
            return None if self._is_known(request) or self._has_cookie(request) else _refusal(request)
        shown = request.query_params.getlist("token")
        if len(shown) == 1 and self._opens(shown[0]):
            opened = RedirectResponse(path, status_code=303)
            opened.set_cookie(_name(request), self._cookie, httponly=True, samesite="strict", path="/")
            return opened
        if self._has_cookie(request):
            return RedirectResponse(path, status_code=303) if request.url.query else None
        return None if self._is_known(request) else _page(request, bool(shown))

    def _opens(self, shown: str) -> bool:
        used = {key for key in self._keys if _same(shown, key)}
        self._keys -= used
        return _same(shown, self._token) or bool(used)

    def _has_cookie(self, request: Request) -> bool:
        return _same(request.cookies.get(_name(request), ""), self._cookie)

    def _is_known(self, request: Request) -> bool:
        stated = request.headers.getlist("authorization")
        scheme, _, shown = "".join(stated).partition(" ")
        return len(stated) == 1 and scheme.lower() == "bearer" and _same(shown, self._token)


def _same(shown: str, known: str) -> bool:
    """Compare in a time that does not depend on the number of equal characters."""
    return secrets.compare_digest(shown.encode(), known.encode())


def _name(request: Request) -> str:
    """Return the name of the cookie; it has the port, since browsers keep one set of cookies for all ports."""
    return f"stylobate-lab-{(request.scope.get('server') or ('', 0))[1]}"


# Refusals

_CHALLENGE = {"WWW-Authenticate": 'Bearer realm="stylobate laboratory"'}

_WHERE = "It stands in the address that `stylobate lab` printed, unless it was chosen at the start."


def _problem(request: Request, in_address: bool) -> str:
    if in_address:
        return "token: the one in this address is not valid."
    if _name(request) in request.cookies:
        return "token: the laboratory was started again and has a new one."
    return "token: wrong." if "authorization" in request.headers else "token: missing."


def _refusal(request: Request) -> Response:
    line = f"{_problem(request, False)} {_WHERE} Send the header Authorization: Bearer TOKEN, or open that address."
    return JSONResponse({"problems": [line]}, 401, _CHALLENGE)


_STYLE = """
:root { color-scheme: light dark; font: 1rem/1.5 system-ui, sans-serif }
body { max-width: 34rem; margin: 12vh auto 0; padding: 0 1.5rem }
h1 { font-size: 1.3rem } h1 span { font-weight: 400 }
form { display: flex; gap: .6rem; flex-wrap: wrap; align-items: end; margin-top: 1.5rem }
label { flex: 1 1 16rem } input, button { font: inherit; padding: .45rem .7rem; box-sizing: border-box }
input { display: block; width: 100% }
"""

# A request that another site begins has no cookie. The same request once more, by this page, has it.
_AGAIN = 'location.replace(location.pathname + "?again" + location.hash)'

_FORM = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Token of the stylobate laboratory</title>
<style>{style}</style>
{script}</head>
<body>
<h1>stylobate <span>laboratory</span></h1>
<p role="alert">{problem} {where}</p>
<form>
<label>Token <input name="token" type="password" autocomplete="off" spellcheck="false" required autofocus></label>
<button>Open the laboratory</button>
</form>
</body>
</html>
"""


def _page(request: Request, in_address: bool) -> Response:
    """Return the page with a form for the token; without an action, a form keeps the fragment of the address."""
    again = request.headers.get("sec-fetch-site") == "cross-site"
    policy = {**POLICY, "style-src": digest_of(_STYLE), "script-src": digest_of(_AGAIN), "form-action": "'self'"}
    text = _FORM.format(
        style=_STYLE,
        script=f"<script>{_AGAIN}</script>\n" if again else "",
        problem=escape(_problem(request, in_address)),
        where=re.sub("`(.*?)`", r"<code>\1</code>", _WHERE),
    )
    return HTMLResponse(text, 401, {**_CHALLENGE, "Content-Security-Policy": written_policy(policy)})
