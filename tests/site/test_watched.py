"""The page of a folder that `lumitip-fab watch --page` builds."""

from pathlib import Path

import pytest
from playwright.sync_api import Browser

from lumitip_fab.cli import page

pytestmark = pytest.mark.slow


def test_an_open_page_is_loaded_again_at_its_cell(browser: Browser, edited: Path) -> None:
    file = page.write_page(edited, watched=True)
    tab = browser.new_context(offline=True).new_page()
    tab.goto(file.as_uri() + "#cell-17")
    stamp = edited / ".page.js"
    old = stamp.read_text().split('"')[1]
    tab.wait_for_timeout(2500)
    tab.evaluate("document.title = 'still here'")
    tab.wait_for_timeout(1500)
    assert tab.title() == "still here", "the same stamp loads nothing"
    text = file.read_text().replace(old, "0" * 64)
    file.write_text(text.replace("<title>", "<title>Again: "))
    stamp.write_text(stamp.read_text().replace(old, "0" * 64))
    tab.wait_for_function("document.title.startsWith('Again: ')", timeout=20_000)
    assert tab.evaluate("location.hash") == "#cell-17"


def test_the_page_of_a_folder_that_is_not_watched_asks_for_nothing(edited: Path) -> None:
    page.write_page(edited, watched=True)
    assert (edited / ".page.js").is_file()
    file = page.write_page(edited)
    assert not (edited / ".page.js").exists()
    assert ".page.js" not in file.read_text()
