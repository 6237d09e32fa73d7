"""The folder of the laboratory on a web server, without a connection once it has been loaded."""

import os
import time

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


def written(folder, style, *, age=0.0):
    """Write a small site with the worker of the page, `age` seconds ago: a server states the time in whole seconds."""
    files = {"index.html": b"<!doctype html><title>site</title>", "main.css": style}
    worker = (page_folder() / "offline.js").read_text(encoding="utf-8")
    files["offline.js"] = f"const offline = {static_site._listed(files)};\n{worker}".encode()
    for name, content in files.items():
        (folder / name).write_bytes(content)
        os.utime(folder / name, (time.time() - age,) * 2)


STYLE = "async () => (await fetch('main.css')).text()"


def test_a_changed_site_takes_over_when_its_last_page_is_closed(context, tmp_path):
    site = tmp_path / "site"
    site.mkdir()
    written(site, b"old {}", age=60.0)
    (tmp_path / "index.html").write_text("<!doctype html><title>beside the site</title>", encoding="utf-8")
    with serving(tmp_path) as root:
        address = f"{root}site/"
        page = new_page(context)
        page.goto(address)
        page.evaluate("async () => { await navigator.serviceWorker.register('offline.js'); }")
        page.wait_for_function("() => navigator.serviceWorker.controller !== null")
        written(site, b"new {}")
        assert page.evaluate(STYLE) == "old {}"
        page.evaluate("async () => { await (await navigator.serviceWorker.ready).update(); }")
        page.wait_for_function("async () => (await navigator.serviceWorker.ready).waiting !== null")
        page.reload()
        assert page.evaluate(STYLE) == "old {}"  # no page has files of two sites
        beside = new_page(context)  # no page of the site, whose old worker ends soon after its last page
        beside.goto(root)
        page.close()
        beside.wait_for_function("async () => !(await navigator.serviceWorker.getRegistration('site/')).waiting")
        beside.wait_for_function("async () => (await caches.keys()).length === 1")
        beside.goto(address)
        assert beside.evaluate(STYLE) == "new {}"
