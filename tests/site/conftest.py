"""The page of the published design, and browsers that show it without a network."""

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page, sync_playwright

from lumitip_fab.cli import main
from programs import WITH_3D, program
from site_page import Opened


def write_page(out: Path) -> None:
    """Check an output folder and write its page, as `make outputs` does."""
    assert main(["check", "--quiet", "--out", str(out), "--report", str(out / "checks.json")]) == 0
    assert main(["page", "--quiet", "--out", str(out)]) == 0


@pytest.fixture(scope="session")
def site(once: Callable[..., Path], outputs: Path) -> Path:
    """The published design's output folder with its page. Do not change it."""

    def fill(folder: Path) -> None:
        shutil.copytree(outputs, folder, dirs_exist_ok=True)
        write_page(folder)

    return once("site", fill)


@pytest.fixture
def edited(site: Path, tmp_path: Path) -> Path:
    """A copy of that folder, to change."""
    return Path(shutil.copytree(site, tmp_path / "edited"))


@pytest.fixture(scope="module")  # while it is open, no other test of a process can open one
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=program("chromium"), args=WITH_3D)
        yield opened
        opened.close()


@pytest.fixture
def opened(browser: Browser, site: Path) -> Iterator[Opened]:
    """`opened("#cell-17", folder, color_scheme="dark")`: the page in a browser. At the end nothing
    may have been written to the console, and nothing asked for but the page."""
    contexts, said, asked = [], [], []

    def open_page(place: str = "", folder: Path = site, **options: Any) -> Page:
        context = browser.new_context(offline=True, reduced_motion="reduce", **options)
        contexts.append(context)
        tab = context.new_page()
        tab.on("console", lambda message: said.append(message.text))
        tab.on("pageerror", lambda error: said.append(str(error)))
        tab.on("request", lambda request: asked.append(request.url))
        tab.goto((folder / "index.html").as_uri() + place)
        return tab

    yield open_page
    for context in contexts:
        context.close()
    # Pictures of a view that a processor draws are slow, and Chromium says so.
    assert [text for text in said if "GPU stall due to ReadPixels" not in text] == []
    assert len([url for url in asked if not url.startswith(("data:", "blob:"))]) == len(contexts)
