"""A laboratory that listens on a free port, one for all tests of a module; its clients have its token."""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import httpx
import pytest
from tests.lab.browser import TOKEN, Watched, enter, in_own_case, new_page, open_browser, shown
from tests.lab.conformity import conforms

from stylobate.lab import Limits, create_app
from stylobate.lab.serving import listening, server_of


@contextmanager
def laboratory(limits: Limits | None = None, port: int = 0, token: str = TOKEN) -> Iterator[str]:
    """Serve a laboratory in a thread of this process and give its address, without the token."""
    with listening("127.0.0.1", port) as place:
        host = f"127.0.0.1:{place.getsockname()[1]}"
        server = server_of(create_app(hosts={host}, token=token, limits=limits))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [place]})
        thread.start()
        while not server.started:
            time.sleep(0.02)
        try:
            yield f"http://{host}"
        finally:
            server.should_exit = True
            thread.join()


def client_of(address: str, timeout: float = 120.0) -> httpx.Client:
    """Return a client that raises where an answer is not what the laboratory's description says."""
    headers = {"authorization": f"Bearer {TOKEN}"}
    return httpx.Client(base_url=address, timeout=timeout, headers=headers, event_hooks={"response": [conforms]})


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with laboratory(Limits(run_time=240.0)) as found:  # other tests keep the processors busy
        yield found


@pytest.fixture(scope="module")
def client(address) -> Iterator[httpx.Client]:
    with client_of(address) as found:
        yield found


@pytest.fixture(scope="module")
def browser():
    with open_browser() as found:
        yield found


@pytest.fixture
def watched(browser, address):
    context = browser.new_context(viewport={"width": 1280, "height": 860})
    found = Watched(new_page(context), address)
    enter(found.page, address)
    shown(found.page)
    in_own_case(found.page)
    yield found
    context.close()
    assert found.foreign == []


@pytest.fixture
def page(watched):
    return watched.page
