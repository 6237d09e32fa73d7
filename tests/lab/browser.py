"""A browser of the system for the tests of the page; without one, or without the page, they are skipped."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, sync_playwright

from stylobate.lab.pages import page_is_built

REQUIRED = os.environ.get("STYLOBATE_BROWSER") == "required"
# Drawn by the processor, as on machines without a graphics card.
DRAWN = ("--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader-webgl", "--enable-unsafe-swiftshader")
# Each new window would load pages for its address bar, which take as long as the page of the laboratory. The last
# option of this name counts, so features that the driver switches off follow.
OFF = (
    *("WebUIOmniboxPopup", "WebUIOmniboxAimPopup"),
    *("AimEnabled", "PreconnectToSearch", "NetworkTimeServiceQuerying", "OptimizationHints", "MediaRouter"),
    *("HttpsUpgrades", "HttpsFirstBalancedModeAutoEnable", "ThirdPartyStoragePartitioning", "PaintHolding"),
    *("AvoidCorsURLLoaderRestartOnRedirect", "AvoidUnnecessaryBeforeUnloadCheckSync", "DestroyProfileOnBrowserClose"),
)
# A page that plays keeps more than one core busy if the processor draws every frame of the screen.
SEVEN_FRAMES_A_SECOND = """
window.everyFrame = ((request, cancel) => () => {
  window.requestAnimationFrame = request;
  window.cancelAnimationFrame = cancel;
})(window.requestAnimationFrame, window.cancelAnimationFrame);
window.requestAnimationFrame = (draw) => setTimeout(() => draw(performance.now()), 150);
window.cancelAnimationFrame = clearTimeout;
"""


TOKEN = "token-of-the-tests"  # noqa: S105


def found_browser() -> str:
    """Return the path of the browser; skip, or fail where a browser is required, if the page cannot be tested."""
    path = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    missing = "no chromium" if path is None else None if page_is_built() else "the page is not built: make page"
    if missing and REQUIRED:
        pytest.fail(missing)
    if missing:
        pytest.skip(missing)
    assert path is not None
    return path


@contextmanager
def open_browser() -> Iterator[Browser]:
    """Start the browser, without a window."""
    path = found_browser()
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=[*DRAWN, f"--disable-features={','.join(OFF)}"])
        try:
            yield browser
        finally:
            browser.close()


def new_page(where: Browser | BrowserContext) -> Page:
    """Return a new page that waits as long as the first start of a process may take on a busy machine.

    It draws seven frames a second, or after `window.everyFrame()` those of the screen.
    """
    page = where.new_page()
    page.add_init_script(SEVEN_FRAMES_A_SECOND)
    page.set_default_timeout(120_000.0)
    return page


def enter(page: Page, address: str, fragment: str = "") -> None:
    """Open a laboratory by its token; the browser then has its cookie."""
    page.goto(f"{address}/?token={TOKEN}{fragment}")


class Watched:
    """A page with what it said in its console and which requests left for elsewhere."""

    def __init__(self, page: Page, address: str) -> None:
        self.page = page
        self.said: list[str] = []
        self.foreign: list[str] = []
        page.on("console", lambda message: self._heard(message.type, message.text))
        page.on("pageerror", lambda error: self.said.append(str(error)))
        page.on("request", lambda request: self._seen(request.url, address))

    def _heard(self, kind: str, text: str) -> None:
        if kind in ("error", "warning") and "GPU stall" not in text:  # of the software that draws
            self.said.append(text)

    def _seen(self, url: str, address: str) -> None:
        if not url.startswith((address, "data:", "blob:")):
            self.foreign.append(url)


def shown(page: Page) -> None:
    """Wait until the page shows the motion of what is set."""
    page.wait_for_function("() => window.stylobate?.laboratory.answer && !document.querySelector('.stage.busy')")


def in_own_case(page: Page) -> None:
    """Leave the lesson with which the page opens for the first preset, with all controls in view."""
    page.get_by_label("Preset").select_option("circle-strong")
    page.wait_for_function("() => window.stylobate.state().lesson === null && document.querySelector('.lesson').hidden")
    open_sections(page)
    shown(page)


def open_sections(page: Page) -> None:
    """Unfold all controls."""
    page.evaluate("() => document.querySelectorAll('details.section').forEach((one) => { one.open = true; })")


def moved(page: Page, name: str, value: float) -> None:
    """Set the number of this name in its field."""
    field = page.locator(f".controls input.number[id^='{name}']").first
    field.fill(str(value))
    field.press("Enter")
