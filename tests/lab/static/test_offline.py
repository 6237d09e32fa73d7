"""The folder of the laboratory on a web server, without a connection once it has been loaded."""

import pytest
from tests.lab.browser import new_page, shown
from tests.lab.static.cases import LESSONS, refusals
from tests.lab.static.conftest import serving

from stylobate.lab import static_site
from stylobate.lab.pages import page_folder

INSTALLED = "async () => (await navigator.serviceWorker.ready).active.scriptURL"


@pytest.fixture
def context(browser):
    context = browser.new_context()
    yield context
    context.close()


def test_all_lessons_run_without_a_connection(context, served):
    page = new_page(context)
    page.goto(served)
    shown(page)
    assert page.evaluate(INSTALLED) == f"{served}offline.js"
    page.wait_for_function("() => navigator.serviceWorker.controller !== null")
    context.set_offline(True)
    for place, lesson in enumerate(LESSONS):
        page.get_by_role("button", name=f"Lesson {place + 1}: {lesson.title}").click()
        page.wait_for_function(
            "kind => window.stylobate.laboratory.answer.toml.includes(kind)", arg=lesson.description["model"]["kind"]
        )
        page.wait_for_function("() => document.querySelector('.said').textContent !== ''")
        assert page.locator(".problems").is_hidden()
        assert refusals(page) == []
    page.goto(f"{served}#lesson=rolls")
    page.reload()
    shown(page)
    assert page.get_by_role("heading", name=LESSONS[2].question).is_visible()


def written(folder, style):
    """Write a small site with the worker of the page."""
    files = {"index.html": b"<!doctype html><title>site</title>", "main.css": style}
    worker = (page_folder() / "offline.js").read_text(encoding="utf-8")
    files["offline.js"] = f"const offline = {static_site._listed(files)};\n{worker}".encode()
    for name, content in files.items():
        (folder / name).write_bytes(content)


STYLE = "async () => (await fetch('main.css')).text()"


def test_a_changed_site_takes_over_when_its_last_page_is_closed(context, tmp_path):
    written(tmp_path, b"old {}")
    with serving(tmp_path) as address:
        page = new_page(context)
        page.goto(address)
        page.evaluate("async () => { await navigator.serviceWorker.register('offline.js'); }")
        page.wait_for_function("() => navigator.serviceWorker.controller !== null")
        written(tmp_path, b"new {}")
        assert page.evaluate(STYLE) == "old {}"
        page.evaluate("async () => { await (await navigator.serviceWorker.ready).update(); }")
        page.wait_for_function("async () => (await navigator.serviceWorker.ready).waiting !== null")
        page.reload()
        assert page.evaluate(STYLE) == "old {}"  # no page has files of two sites
        page.close()
        for _ in range(50):  # the old worker ends soon after its last page
            again = new_page(context)
            again.goto(address)
            found = again.evaluate(STYLE), len(again.evaluate("() => caches.keys()"))
            again.close()
            if found[0] == "new {}":
                break
        assert found == ("new {}", 1)
