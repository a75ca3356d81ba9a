"""The page of `show`, opened in a browser without a network."""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from build123d import Box, Pos, Sphere
from PIL import Image
from playwright.sync_api import Page, sync_playwright

import lumitip_fab
from lumitip_fab.parts.export import part_files
from programs import WITH_3D, program

pytestmark = pytest.mark.slow

BACKGROUND = np.array([255, 255, 255])
FAINT = 30
LONGEST_S = 40  # on a busy machine
BROWSERS = 3  # one that lost its drawing context on a busy machine draws nothing ever after


def _pixels(tab: Page) -> np.ndarray:
    return np.asarray(Image.open(BytesIO(tab.screenshot())).convert("RGB"), int)


@pytest.fixture
def seen() -> Callable[[Path], np.ndarray]:
    """`seen(page)`: the colours (height, width, 3) that a browser shows."""

    def look(page: Path) -> np.ndarray:
        with sync_playwright() as playwright:
            for _ in range(BROWSERS):
                browser = playwright.chromium.launch(
                    executable_path=program("chromium"), args=WITH_3D
                )
                tab = browser.new_context(offline=True).new_page()
                tab.goto(page.as_uri())
                pixels = _drawn(tab)
                browser.close()
                if _marked(pixels).any():
                    break
        return pixels

    return look


def _drawn(tab: Page) -> np.ndarray:
    """The colours once something is drawn and stands still, or after `LONGEST_S`."""
    before = _pixels(tab)
    for _ in range(LONGEST_S):
        tab.wait_for_timeout(1000)
        pixels = _pixels(tab)
        if _marked(pixels).any() and np.array_equal(before, pixels):
            break
        before = pixels
    return pixels


def _marked(pixels: np.ndarray) -> np.ndarray:
    """Which pixels (height, width) differ from the background."""
    return (abs(pixels - BACKGROUND) > FAINT).any(axis=2)


def test_shapes_and_files_are_drawn_each_in_its_colour(
    tmp_path: Path, seen: Callable[[Path], np.ndarray]
) -> None:
    for artefact in part_files("ball", Sphere(8), np.eye(4), frame=""):
        (tmp_path / artefact.path).write_bytes(artefact.data)
    page = lumitip_fab.show(
        Pos(-25, 0, 0) * Box(12, 12, 12), tmp_path / "ball.stl", open_page=False
    )
    pixels = seen(page)
    drawn = _marked(pixels)
    assert 0.02 < drawn.mean() < 0.6
    assert not drawn[0].any() and not drawn[:, 0].any() and not drawn[:, -1].any()  # whole parts
    red, _, blue = pixels[drawn].T
    assert ((blue > red + 20).mean() > 0.1) and ((red > blue + 20).mean() > 0.1)


@pytest.mark.parametrize("ending", ["step", "stl", "3mf"])
def test_every_kind_of_file_opens(tmp_path: Path, ending: str) -> None:
    files = {a.path: a.data for a in part_files("box", Box(3, 4, 5), np.eye(4), frame="")}
    file = tmp_path / f"box.{ending}"
    file.write_bytes(files[file.name])
    opened: list[str] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("webbrowser.open", opened.append)
        page = lumitip_fab.show(str(file))
    assert opened == [page.as_uri()]
    assert page.stat().st_size > 100_000  # the viewer is in the page


def test_what_is_no_part_is_named_all_at_once(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="build the design first") as error:
        lumitip_fab.show(tmp_path / "gone.stl", tmp_path / "bom.csv", 3)  # type: ignore[arg-type]
    assert len(str(error.value).splitlines()) == 3
    with pytest.raises(ValueError, match="at least one part"):
        lumitip_fab.show()
