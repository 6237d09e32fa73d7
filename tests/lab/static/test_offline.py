"""The folder of the laboratory on a web server, without a connection once it has been loaded."""

import pytest
from tests.lab.browser import new_page, shown
from tests.lab.static.cases import FOLDER, LESSONS, refusals

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


def test_a_changed_site_takes_over_when_its_last_page_is_closed(context, served, site):
    page = new_page(context)
    page.goto(served)
    shown(page)
    page.evaluate(INSTALLED)
    folder = site / FOLDER
    before = {name: (folder / name).read_bytes() for name in ("main.css", "offline.js")}
    try:
        (folder / "main.css").write_bytes(before["main.css"] + b"\n.another-site { color: red }")
        (folder / "offline.js").write_bytes(before["offline.js"].replace(b'"version": "', b'"version": "f'))
        page.evaluate("async () => { await (await navigator.serviceWorker.ready).update(); }")
        page.wait_for_function("async () => (await navigator.serviceWorker.ready).waiting !== null")
        assert "another-site" not in page.evaluate("async () => (await fetch('main.css')).text()")
        page.close()
        again = new_page(context)
        again.goto(served)
        again.wait_for_function("async () => (await (await fetch('main.css')).text()).includes('another-site')")
        assert len(again.evaluate("() => caches.keys()")) == 1
    finally:
        for name, content in before.items():
            (folder / name).write_bytes(content)
