"""Who may use the laboratory: those who state its token, in the printed address, in a cookie or in a header."""

import secrets
from contextlib import closing

import anyio
import httpx
import pytest
from starlette.responses import PlainTextResponse
from starlette.routing import Route
from tests.lab.browser import TOKEN, enter, new_page, shown
from tests.lab.conftest import laboratory

from stylobate.errors import ParameterError
from stylobate.lab import create_app
from stylobate.lab.app import endpoints
from stylobate.lab.entrance import Entrance, new_token
from stylobate.lab.guards import Guard

HOST = "127.0.0.1:8642"
APP = create_app(hosts={HOST}, token=TOKEN)
ROUTES = [
    *((method, route.path) for route in APP.routes if isinstance(route, Route) for method in sorted(route.methods)),
    *((one.method.upper(), one.path.replace("{identity}", "0")) for one in endpoints()),
    *(("GET", path) for path in ("/index.html", "/api/nowhere", "/nowhere", "/api/../")),
]
WRONG = {
    "none": "",
    "another": "token-of-another",
    "truncated": TOKEN[:-1],
    "longer": f"{TOKEN}x",
    "doubled": TOKEN + TOKEN,
    "in capitals": TOKEN.upper(),
    "not ASCII": f"{TOKEN}ü",
}


def ask(path, method="GET", app=None, host=HOST, entrance=None, **headers):
    """Return the answer of the guard before an application that answers everything, or of `app`."""
    guarded = app or Guard(PlainTextResponse("answered"), hosts={HOST, host}, entrance=entrance or Entrance(TOKEN))

    async def asked():
        place = {"transport": httpx.ASGITransport(guarded), "base_url": f"http://{host}"}
        async with httpx.AsyncClient(**place) as client:
            lines = [(name.replace("_", "-"), one) for name, value in headers.items() for one in listed(value)]
            return await client.request(method, path, headers=[(name, value.encode()) for name, value in lines])

    return anyio.run(asked)


def listed(value):
    return value if isinstance(value, list) else [value]


def cookie_of(answer):
    return answer.headers["set-cookie"].split(";")[0]


@pytest.mark.parametrize(("method", "path"), ROUTES)
def test_every_route_refuses_without_the_token(method, path):
    answer = ask(path, method, APP)
    assert answer.status_code == 401
    assert answer.headers["www-authenticate"].startswith("Bearer")
    assert method == "HEAD" or "stylobate lab" in answer.text
    assert "set-cookie" not in answer.headers
    assert answer.headers["referrer-policy"] == "no-referrer"


@pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)
def test_only_the_whole_token_is_accepted(wrong):
    right = cookie_of(ask(f"/?token={TOKEN}"))
    name, _, value = right.partition("=")
    assert ask("/", cookie=right).text == ask("/api/about", authorization=f"Bearer {TOKEN}").text == "answered"
    assert ask(httpx.URL("/", params={"token": wrong})).status_code == 401
    for stated in (
        {"authorization": f"Bearer {wrong}"},
        {"authorization": [f"Bearer {TOKEN}", f"Bearer {wrong}"]},
        {"authorization": f"Basic {TOKEN}"},
        {"authorization": TOKEN},
        {"cookie": f"{name}={wrong}"},
        {"cookie": f"{name}={TOKEN}"},
        {"cookie": f"{name}={value[:-1]}"},
        {"cookie": f"{name}={value}{value}"},
    ):
        assert ask("/api/about", **stated).status_code == 401
        assert ask("/", **stated).status_code == 401


def test_the_token_in_the_address_moves_to_a_cookie_that_no_script_and_no_other_site_has():
    opened = ask(f"/?token={TOKEN}")
    assert (opened.status_code, opened.headers["location"]) == (303, "/")
    _, *rules = opened.headers["set-cookie"].split("; ")
    assert {"HttpOnly", "SameSite=strict", "Path=/"} <= set(rules)
    assert TOKEN not in opened.headers["set-cookie"]
    for query in ("again", "token=of-an-earlier-start"):  # never in the address from which links are copied
        answer = ask(f"/index.html?{query}", cookie=cookie_of(opened))
        assert (answer.status_code, answer.headers["location"]) == (303, "/index.html")


@pytest.mark.parametrize(
    "path", [f"/?token={TOKEN}&token={TOKEN}", f"/api/about?token={TOKEN}", f"/main.js?token={TOKEN}"]
)
def test_an_address_opens_the_page_only_and_states_the_token_once(path):
    answer = ask(path)
    assert answer.status_code == 401
    assert TOKEN not in answer.text


def test_the_cookie_of_another_port_or_another_start_is_not_accepted():
    cookie = cookie_of(ask(f"/?token={TOKEN}"))
    other = cookie_of(ask(f"/?token={TOKEN}", host="127.0.0.1:9000"))
    assert cookie.split("=")[0] != other.split("=")[0]
    assert ask("/api/about", cookie=other).status_code == 401
    assert ask("/api/about", cookie=f"{other}; {cookie}").text == "answered"
    answer = ask("/", cookie=cookie, entrance=Entrance(new_token()))
    assert answer.status_code == 401
    assert "was started again" in answer.text


def test_tokens_are_compared_in_constant_time(monkeypatch):
    compared = []

    def compare(one, other):
        compared.append((one, other))
        return one == other

    entrance = Entrance(TOKEN)
    cookie = cookie_of(ask(f"/?token={TOKEN}", entrance=entrance))
    monkeypatch.setattr(secrets, "compare_digest", compare)
    wrong = b"of-the-wrong-kind"
    ask(f"/?token={wrong.decode()}", entrance=entrance)
    ask("/api/about", entrance=entrance, authorization=f"Bearer {wrong.decode()}")
    ask("/api/about", entrance=entrance, cookie=f"{cookie.split('=')[0]}={wrong.decode()}")
    known = {other for one, other in compared if one == wrong}
    assert known == {TOKEN.encode(), cookie.split("=")[1].encode()}


def test_the_address_that_a_browser_is_started_with_is_valid_once():
    entrance = Entrance(TOKEN)
    key = entrance.key()
    assert ask(f"/?token={key}", entrance=entrance).status_code == 303
    assert ask(f"/?token={key}", entrance=entrance).status_code == 401
    assert ask("/api/about", entrance=entrance, authorization=f"Bearer {entrance.key()}").status_code == 401


def test_random_tokens_differ_and_chosen_ones_must_be_long():
    assert len({new_token() for _ in range(100)}) == 100
    assert len(new_token()) == 32  # 128 bits
    for chosen in ("", "short", "x" * 129, "a token of words", "token;of=signs", "token-of-ünits"):
        with pytest.raises(ParameterError, match="12 to 128") as error:
            Entrance(chosen)
        assert not chosen or chosen not in str(error.value)


def test_a_socket_is_closed():
    sent = []

    async def run():
        async def receive():
            return {"type": "websocket.connect"}

        async def send(message):
            sent.append(message["type"])

        await Guard(PlainTextResponse("answered"), {HOST}, Entrance(TOKEN))({"type": "websocket"}, receive, send)

    anyio.run(run)
    assert sent == ["websocket.close"]


# In the browser


@pytest.fixture
def context(browser):
    with closing(browser.new_context()) as found:
        yield found


def entered(page, token):
    page.get_by_label("Token").fill(token)
    page.get_by_role("button", name="Open the laboratory").click()


def lesson(page):
    shown(page)
    return page.evaluate("() => window.stylobate.state().lesson")


def test_a_person_is_asked_for_the_token_and_then_sees_the_case_of_the_link(context, address):
    page = new_page(context)
    page.goto(f"{address}/#lesson=rocks")
    assert "stylobate lab" in page.get_by_role("alert").inner_text()
    entered(page, "not-the-right-token")
    page.get_by_text("the one in this address is not valid").wait_for()
    entered(page, TOKEN)
    assert lesson(page) == "rocks"
    assert page.url == f"{address}/#lesson=rocks"
    assert page.evaluate("() => document.cookie + document.referrer") == ""
    other = new_page(context)  # another tab
    other.goto(f"{address}/#lesson=stands")
    assert lesson(other) == "stands"


def test_the_printed_address_keeps_the_case_of_its_link(context, address):
    page = new_page(context)
    enter(page, address, "#lesson=rolls")
    assert lesson(page) == "rolls"
    assert page.url == f"{address}/#lesson=rolls"


def test_a_link_on_another_site_opens_its_case_with_the_cookie_and_the_form_without(context, address, tmp_path):
    (tmp_path / "site.html").write_text(f'<a href="{address}/#lesson=spin">Open</a>')
    page = new_page(context)
    page.goto((tmp_path / "site.html").as_uri())
    page.get_by_text("Open").click()
    page.get_by_role("alert").wait_for()
    entered(page, TOKEN)
    assert lesson(page) == "spin"
    page.goto((tmp_path / "site.html").as_uri())
    page.get_by_text("Open").click()
    assert lesson(page) == "spin"
    assert page.url == f"{address}/#lesson=spin"


@pytest.mark.slow
def test_a_page_whose_laboratory_was_started_again_asks_for_the_new_token_and_goes_on(context):
    page = new_page(context)
    with laboratory() as address:
        enter(page, address, "#lesson=rocks")
        shown(page)
    with laboratory(port=int(address.rpartition(":")[2]), token="token-of-the-next-start"):  # noqa: S106
        banner = page.get_by_role("alert").get_by_text("was started again and has a new token")
        banner.wait_for()
        page.get_by_role("button", name="Enter the token").click()
        page.get_by_text("was started again and has a new one").wait_for()
        entered(page, "token-of-the-next-start")
        assert lesson(page) == "rocks"
        page.close()
