"""The sensor frame on the grid, and that nothing covers the numbers."""

from collections.abc import Callable
from itertools import combinations

import numpy as np
import pytest
from playwright.sync_api import Page

from live_page import GRID, opened, pixels, places, until
from lumitip import Layout
from lumitip.twin import Cable, Twin
from lumitip.view.finger import Finger
from lumitip.view.server import ViewServer

pytestmark = pytest.mark.slow

Serve = Callable[..., ViewServer]
StillFinger = Callable[[Layout, np.ndarray], Finger]
GREY = np.array([128, 138, 153])
COLUMNS = {8: (3, 2, 3), 32: (5, 4, 5, 4, 5, 4, 5), 64: (8,) * 8}


def test_axes_cross_at_the_origin_and_rulers_have_the_mm_of_the_frame(
    serve: Serve, page: Page, still: StillFinger, layout: Layout
) -> None:
    opened(page, serve(still(layout, np.full(len(layout), 20))))
    words = {word[0]: word[1:] for word in page.evaluate(f"{GRID}.words")}
    assert {"x mm", "y mm, to the tip", "0", "10", "−10"} <= set(words)
    ((x0, y0),) = places(page, np.zeros((1, 2)))
    assert words["x mm"][0] > x0
    assert words["y mm, to the tip"][1] < y0
    for x_mm, y_mm in ((9.2, 6.1), (-9.2, -6.1)):  # between the numbers
        on_x, on_y = places(page, np.array([[x_mm, 0.0], [0.0, y_mm]]))
        for at, way in ((on_x, (0, 1)), (on_y, (1, 0))):
            line = np.array([at + np.multiply(way, d) for d in (-1, 0, 1)])
            assert np.abs(pixels(page, np.floor(line)) - GREY).max(axis=1).min() < 40


@pytest.mark.parametrize("cells", COLUMNS)
@pytest.mark.parametrize("width", [390, 1280])
def test_labels_do_not_overlap(
    serve: Serve,
    page: Page,
    still: StillFinger,
    make_layout: Callable[..., Layout],
    cells: int,
    width: int,
) -> None:
    layout = make_layout(COLUMNS[cells])
    assert len(layout) == cells
    page.set_viewport_size({"width": width, "height": 800})
    opened(page, serve(still(layout, np.full(cells, 20))))
    words = page.evaluate(f"{GRID}.words")
    assert len(words) >= 6
    wide, high = page.evaluate(f"[{GRID}.canvas.clientWidth, {GRID}.canvas.clientHeight]")
    radius, centres = page.evaluate(f"[{GRID}.radius, {GRID}.centres]")
    for name, left, top, long, tall in words:
        assert left >= 0 <= top, name
        assert left + long <= wide, name
        assert top + tall <= high, name
        for x, y in centres:  # outside of all cells
            near = np.hypot(max(left - x, 0, x - left - long), max(top - y, 0, y - top - tall))
            assert near > 0.85 * radius, name
    for (one, l1, t1, w1, h1), (two, l2, t2, w2, h2) in combinations(words, 2):
        apart = l1 + w1 + 2 < l2 or l2 + w2 + 2 < l1 or t1 + h1 <= t2 or t2 + h2 <= t1
        assert apart, f"{one} and {two}"
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_no_line_covers_the_number_of_a_cell(
    serve: Serve, page: Page, still: StillFinger, layout: Layout
) -> None:
    codes = np.rint(255.0 - Twin(layout).values(Cable(offset_mm=0.0, angle_deg=2.0)))
    opened(page, serve(still(layout, codes)))
    until(page, "lumitip.panels.get(1).estimate?.kind === 'cable'")
    grid = np.stack(np.meshgrid(np.arange(-12, 13), np.arange(-5, 6)), -1).reshape(-1, 2)
    for cell in np.flatnonzero(np.abs(layout.y_mm) < 4.0):
        at = np.floor(page.evaluate(f"{GRID}.centres[{cell}]")) + grid
        with_lines = pixels(page, at)
        page.keyboard.press("o")
        bare = pixels(page, at)
        page.keyboard.press("o")
        ink = np.abs(bare - np.median(bare, axis=0)).max(axis=1) > 100
        assert ink.sum() > 8
        assert np.abs(with_lines[ink] - bare[ink]).max() < 60
