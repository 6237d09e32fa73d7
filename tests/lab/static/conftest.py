"""The laboratory as static files, written once, from a web server and from one file on disk."""

import json
import threading
from contextlib import contextmanager
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer

import pytest
from tests.lab.browser import Watched, found_browser, new_page, shown
from tests.lab.static.cases import FOLDER
from tests.lab.test_page_mistakes import EXACT

from stylobate.lab import kernels, recorded, static_site


class Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


@pytest.fixture(scope="session")
def written(tmp_path_factory):
    """Write the files, with exact orbits that are not computed; give the folder of the server and the sizes."""
    found_browser()
    root = tmp_path_factory.mktemp("site")
    programs = kernels.run_programs()
    needed = {kernels.program_of(case.values) for case in recorded.cases()} | {
        "slender_rest",
        "slender_smooth",
        "planar_rocking_harmonic",
    }
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(recorded._ANSWERED, "exact", lambda _: json.dumps(EXACT).encode())
        patch.setattr(kernels, "run_programs", lambda: {name: programs[name] for name in programs if name in needed})
        sizes = static_site.write(root / FOLDER, progress=False)
    return root, sizes


@pytest.fixture(scope="session")
def site(written):
    return written[0]


@contextmanager
def serving(folder):
    """Serve the files of a folder, and give the address."""
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(folder))) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_port}/"
        finally:
            server.shutdown()
            thread.join()


@pytest.fixture(scope="session")
def served(site):
    """Serve the files below a folder of a web server, and give the address."""
    with serving(site) as address:
        yield f"{address}{FOLDER}/"


@pytest.fixture(params=["folder", "one file"])
def place(request, site):
    """Give the address of the page: in a folder of a web server, and in one file on disk."""
    if request.param == "folder":
        return request.getfixturevalue("served")
    return (site / FOLDER / static_site.SINGLE_FILE).as_uri()


@pytest.fixture
def opened(browser, place):
    context = browser.new_context(viewport={"width": 1280, "height": 860})
    found = Watched(new_page(context), place)
    asked = []
    found.page.on("request", lambda request: asked.append(request.url))
    found.page.goto(place)
    shown(found.page)
    yield found
    context.close()
    assert found.foreign == []
    assert found.said == []
    if place.startswith("file:"):
        # a worker's script is read from the page itself
        assert {address.partition("#")[0] for address in asked if not address.startswith("blob:null/")} == {place}


@pytest.fixture(scope="module")
def page_of_sources(served, browser):
    """Open a page whose source is asked."""
    page = new_page(browser)
    page.goto(served)
    page.wait_for_function("() => window.stylobate?.source")
    yield page
    page.close()
