"""How a page finds its server, comes back to it, and says why it cannot."""

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from live_page import opened
from lumitip.view import app
from lumitip.view.finger import Finger
from lumitip.view.registry import FingerRegistry
from lumitip.view.server import ViewServer

pytestmark = pytest.mark.slow

Serve = Callable[..., ViewServer]
TWIN = "twin://edge"


def test_page_finds_a_server_that_was_started_anew(browser: Browser, tmp_path: Path) -> None:
    page = browser.new_page()
    with ViewServer(FingerRegistry([Finger.open("twin://edge")], tmp_path), port=0) as server:
        opened(page, server)
        port = server.port
    expect(page.locator("#notice")).to_have_text("no connection to lumitip view, trying again")
    with ViewServer(FingerRegistry([Finger.open("twin://disc")], tmp_path), port=port):
        expect(page.locator("h2").first).to_have_text("twin:disc", timeout=20_000)
        page.wait_for_selector(".finger[data-seq]")
        expect(page.locator(".finger")).to_have_count(1)
        page.close()


def test_page_comes_back_with_the_token(serve: Serve, page: Page) -> None:
    server = serve(TWIN, token="hand-made")
    opened(page, server)
    assert "hand-made" not in page.url


def test_the_address_can_be_followed_from_another_site(serve: Serve, page: Page) -> None:
    server = serve(TWIN, token="hand-made")
    link = f"<a href='{server.url}'>here</a>"
    page.route(
        "http://example.org/", lambda route: route.fulfill(body=link, content_type="text/html")
    )
    page.goto("http://example.org/")
    page.locator("a").click()
    page.wait_for_selector(".finger[data-seq]")


def test_a_changed_token_is_said(browser: Browser, tmp_path: Path) -> None:
    context = browser.new_context()
    page, other = context.new_page(), context.new_page()
    with ViewServer(FingerRegistry([], tmp_path), port=0, token="old") as server:
        page.goto(server.url)
        port = server.port
    notice = page.locator("#notice")
    with ViewServer(FingerRegistry([], tmp_path), port=port, token="new") as server:
        said = "The token is missing. Open the address that `lumitip view` has printed."
        expect(notice).to_have_text(said, timeout=20_000)
        other.goto(server.url)
        expect(notice).to_have_text("", timeout=20_000)
        context.close()


def test_one_page_too_many_says_so_and_comes_in_when_another_is_closed(
    serve: Serve, browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(app, "_MOST_BROWSERS", 1)
    server = serve(TWIN)
    one, other = browser.new_page(), browser.new_page()
    opened(one, server)
    other.goto(server.url)
    expect(other.locator("#notice")).to_contain_text("Close one of them", timeout=20_000)
    one.close()
    other.wait_for_selector(".finger[data-seq]")
    other.close()
