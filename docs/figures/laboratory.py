"""Takes the pictures of the laboratory, light and dark, into docs/_static/laboratory.

Run it with `python docs/figures/laboratory.py`, once the page is built and with chromium at hand; it takes a minute.
"""

import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from io import BytesIO

from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright
from saving import STATIC

from stylobate.lab import create_app
from stylobate.lab.entrance import new_token
from stylobate.lab.serving import listening, server_of

FOLDER = STATIC / "laboratory"
DRAWN = ("--no-sandbox", "--use-angle=swiftshader-webgl", "--enable-unsafe-swiftshader")


@contextmanager
def served() -> Iterator[str]:
    """Serve the laboratory on a free port and give its address with the token."""
    with listening("127.0.0.1", 0) as place:
        host = f"127.0.0.1:{place.getsockname()[1]}"
        token = new_token()
        server = server_of(create_app(hosts={host}, token=token))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [place]})
        thread.start()
        try:
            yield f"http://{host}/?token={token}"
        finally:
            server.should_exit = True
            thread.join()


def opened(browser: Browser, address: str, theme: str) -> Page:
    """Open an address in a light or dark theme, and wait for the motion."""
    page = browser.new_page(
        viewport={"width": 1280, "height": 860},
        device_scale_factor=2,
        color_scheme=theme,
    )
    page.set_default_timeout(180_000.0)  # a machine may be busy
    page.goto(address)
    page.wait_for_function("() => window.stylobate?.laboratory?.answer")
    return page


def enter(page: Page, number: str) -> None:
    """Enter the number that the lesson asks for."""
    field = page.locator(".lesson .number")
    field.fill(number)
    field.press("Enter")


def to(page: Page, time: float) -> None:
    """Hold the motion at a time [s] and wait until it is drawn."""
    page.evaluate(
        "(time) => { const { clock } = window.stylobate.laboratory; clock.pause(); clock.seek(time); }",
        time,
    )
    page.wait_for_timeout(1500)


def keep(page: Page, name: str) -> None:
    """Save what a page shows, and close it."""
    picture = Image.open(BytesIO(page.screenshot())).convert("RGB")
    picture.quantize(256, dither=Image.Dither.NONE).save(FOLDER / name, optimize=True)
    print(f"laboratory/{name}")
    page.close()


def critical(browser: Browser, address: str) -> None:
    """The lesson of the critical frequency, just below it, with the map of its branches."""
    page = opened(browser, f"{address}#lesson=critical", "light")
    enter(page, "0.42")
    page.get_by_text("a swing of the tilt").wait_for()
    page.get_by_role("tab", name="Overturning map").click()
    panel = page.locator(".plane-panel.map")
    panel.get_by_role("button", name="Compute").click()
    panel.get_by_text("625 runs of").wait_for()
    to(page, 40.0)
    keep(page, "light.png")


def temple(browser: Browser, address: str) -> None:
    """The temple column under an earthquake, with small variations."""
    page = opened(browser, f"{address}#lesson=earthquake", "dark")
    enter(page, "1")
    page.get_by_text("It falls.").wait_for()
    page.get_by_role("button", name="Vary it").click()
    page.get_by_text("64 small variations, ").wait_for()
    to(page, 9.4)
    keep(page, "dark.png")


if __name__ == "__main__":
    with sync_playwright() as playwright, served() as address:
        found = playwright.chromium.launch(
            executable_path=shutil.which("chromium"), args=DRAWN
        )
        critical(found, address)
        temple(found, address)
        found.close()
