"""Looking at the page of an output folder."""

import importlib.util
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
from PIL import Image
from playwright.sync_api import Page

Opened = Callable[..., Page]
"""`opened("#cell-17", folder, color_scheme="dark")`: the page in a browser."""
SIZES = {"phone": {"width": 390, "height": 844}, "desk": {"width": 1440, "height": 900}}


def axe() -> str:
    """The script of axe-core."""
    spec = importlib.util.find_spec("axe_playwright_python")
    assert spec is not None and spec.origin is not None, "pip install axe-playwright-python"
    return (Path(spec.origin).parent / "axe.min.js").read_text(encoding="utf-8")


def marked(tab: Page, panel: str) -> list[int]:
    """The cells that a panel marks as chosen."""
    script = "e => [...e.querySelectorAll('.on[data-cell]')].map(c => Number(c.dataset.cell))"
    return list(tab.locator(f"#{panel}").evaluate(script))


def record(tab: Page) -> dict[str, str]:
    """The lines of the chosen cell's record."""
    script = """e => [...e.querySelectorAll("dt")].map(
        d => [d.textContent, d.nextElementSibling.textContent])"""
    return dict(tab.locator("#rows").evaluate(script))


def seen(tab: Page) -> np.ndarray:
    """The colours of the view, shape `(height, width, 3)`, once it stands still."""
    tab.evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    shot = tab.locator("#canvas").screenshot()
    return np.asarray(Image.open(BytesIO(shot)).convert("RGB"), int)


def differ(one: np.ndarray, other: np.ndarray) -> float:
    """Share of the pixels that differ."""
    return float((abs(one - other) > 24).any(axis=2).mean())
