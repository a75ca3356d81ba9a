"""A recording of the page is named and can be downloaded."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from live_page import opened
from lumitip.recording import Reader
from lumitip.view.server import ViewServer

pytestmark = pytest.mark.slow

Serve = Callable[..., ViewServer]
WaitFor = Callable[[Callable[[], bool]], None]


def test_recording_shows_its_name_and_is_downloaded_whole(
    serve: Serve, page: Page, wait_for: WaitFor, tmp_path: Path
) -> None:
    server = serve("twin://cable?rate=200", token="hand-made")
    opened(page, server)
    line = page.locator(".recorded")
    expect(line.locator("a")).to_be_hidden()
    page.locator(".record").click()
    expect(line).to_have_text(re.compile(r"recording twin-cable-001\.mcap: \d+ frames"))
    expect(line.locator("a")).to_be_hidden()
    answer = page.request.get(f"{server.url.partition('?')[0]}api/recordings/twin-cable-001.mcap")
    assert answer.status == 404
    assert "Stop it first" in answer.text()
    wait_for(
        lambda: (server.registry.fingers[1].status()["recording"] or {}).get("frames", 0) > 100
    )
    page.locator(".record").click()
    link = line.get_by_role("link", name="twin-cable-001.mcap")
    expect(link).to_be_visible()
    with page.expect_download() as begun:
        link.click()
    assert begun.value.suggested_filename == "twin-cable-001.mcap"
    saved = tmp_path / "saved.mcap"
    begun.value.save_as(saved)
    assert saved.read_bytes() == (tmp_path / "recordings/twin-cable-001.mcap").read_bytes()
    assert len(list(Reader(saved))) > 100
    expect(line).to_contain_text(f"{len(list(Reader(saved)))} frames")
    # The name is still there on a page that is loaded later, and in the list of recordings.
    opened(page, server)
    expect(link).to_be_visible()
    page.keyboard.press("p")
    with page.expect_download() as again:
        page.locator("#recordings").get_by_role("link", name="Download").click()
    again.value.save_as(tmp_path / "again.mcap")
    assert (tmp_path / "again.mcap").read_bytes() == saved.read_bytes()


def test_a_download_needs_the_token(serve: Serve, browser: Browser, tmp_path: Path) -> None:
    folder = tmp_path / "recordings"
    folder.mkdir()
    (folder / "run.mcap").write_bytes(b"frames")
    (tmp_path / "secret.mcap").write_bytes(b"secret")
    server = serve("twin://edge", token="hand-made")
    root = server.url.partition("?")[0]
    context = browser.new_context()
    assert context.request.get(f"{root}api/recordings/run.mcap").status == 401
    assert context.request.get(server.url).status == 200  # takes the cookie
    answer = context.request.get(f"{root}api/recordings/run.mcap")
    assert answer.status == 200
    assert answer.body() == b"frames"
    assert answer.headers["content-disposition"] == 'attachment; filename="run.mcap"'
    assert answer.headers["x-content-type-options"] == "nosniff"
    for name in ("none.mcap", "../secret.mcap", "..%2fsecret.mcap", "%2e%2e%2fsecret.mcap"):
        assert context.request.get(f"{root}api/recordings/{name}").status == 404
    context.close()
