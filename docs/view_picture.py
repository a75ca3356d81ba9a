"""Draw the picture of the live view: a real page of a real server, in Chromium."""

import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

from lumitip.view.finger import Finger
from lumitip.view.registry import FingerRegistry
from lumitip.view.server import ViewServer

PICTURE = Path(__file__).parent / "images" / "view.png"
SHOWN = "twin://corner?rate=200"
SELECTED = (7, 16)  # cells that the object covers and leaves within the time that is plotted
PANEL = "lumitip.panels.get(1)"
NEWEST = f"{PANEL}.newest.contact"
WANTED = (
    f"{NEWEST}.shape === 'corner' && {NEWEST}.markers.length > 24"
    f" && {PANEL}.estimate.kind === 'corner'"
    f" && ['', 'Not tared yet'].includes({PANEL}.find('.words').textContent)"
    f" && !{PANEL}.estimate.flags.length"
)
PLOT_FILLED_MS = 14_000


def main(chromium: str) -> None:
    """Open the page, select cells, wait until the plot is filled, take the picture."""
    with (
        tempfile.TemporaryDirectory() as folder,
        ViewServer(FingerRegistry([Finger.open(SHOWN)], Path(folder)), port=0) as server,
        sync_playwright() as playwright,
    ):
        browser = playwright.chromium.launch(
            executable_path=chromium, args=["--no-sandbox", "--disable-gpu"]
        )
        page = browser.new_page(viewport={"width": 1280, "height": 800}, color_scheme="light")
        page.goto(server.url)
        page.wait_for_selector(".finger[data-seq]")
        for cell in SELECTED:
            x, y = page.evaluate(f"lumitip.panels.get(1).grid.centres[{cell}]")
            page.locator(".grid").click(position={"x": x, "y": y})
        page.mouse.move(0, 0)
        page.wait_for_timeout(PLOT_FILLED_MS)
        while not page.evaluate(WANTED):
            page.wait_for_timeout(20)
        page.screenshot(path=PICTURE)
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "/usr/bin/chromium")
