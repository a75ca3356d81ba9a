"""Looking at the page of an output folder."""

from collections.abc import Callable

from playwright.sync_api import Page

Opened = Callable[..., Page]
"""`opened("#cell-17", folder, color_scheme="dark")`: the page in a browser."""


def marked(tab: Page, panel: str) -> list[int]:
    """The cells that a panel marks as chosen."""
    script = "e => [...e.querySelectorAll('.on[data-cell]')].map(c => Number(c.dataset.cell))"
    return list(tab.locator(f"#{panel}").evaluate(script))


def record(tab: Page) -> dict[str, str]:
    """The lines of the chosen cell's record."""
    script = """e => [...e.querySelectorAll("dt")].map(
        d => [d.textContent, d.nextElementSibling.textContent])"""
    return dict(tab.locator("#rows").evaluate(script))
