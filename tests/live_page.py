"""Looking at the page of the live view: places and colours of its canvases."""

import time

import numpy as np
from playwright.sync_api import Page

from lumitip.view.server import ViewServer

GRID = "lumitip.panels.get(1).grid"
ESTIMATE = np.array([0xD8, 0x1B, 0x8C])
"""Colour of the estimate."""


def opened(page: Page, server: ViewServer) -> Page:
    """The page with its first frame."""
    page.goto(server.url)
    page.wait_for_selector(".finger[data-seq]")
    return page


def pixels(page: Page, points: np.ndarray, canvas: str = f"{GRID}.canvas") -> np.ndarray:
    """Colours, shape `(n, 3)`, at places of a canvas (CSS pixels)."""
    return np.array(
        page.evaluate(
            f"""(points) => {{
                const canvas = {canvas};
                const brush = canvas.getContext("2d");
                const ratio = canvas.width / canvas.getBoundingClientRect().width;
                return points.map(([x, y]) =>
                    [...brush.getImageData(x * ratio, y * ratio, 1, 1).data].slice(0, 3));
            }}""",
            points.tolist(),
        )
    )


def places(page: Page, points_mm: np.ndarray) -> np.ndarray:
    """Places on the grid's canvas of points of the sensor frame (mm)."""
    script = f"points => points.map((p) => {GRID}.at(p))"
    return np.array(page.evaluate(script, points_mm.tolist()))


def until(page: Page, condition: str, timeout_s: float = 30.0) -> None:
    """Wait for a condition of the page: Playwright's own way is forbidden by its policy."""
    end_s = time.monotonic() + timeout_s
    while not page.evaluate(f"Boolean({condition})"):
        assert time.monotonic() < end_s, condition
        page.wait_for_timeout(20)
