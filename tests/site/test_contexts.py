"""The 3D views keep their WebGL contexts, and draw again if the browser has taken one."""

import numpy as np
import pytest
from playwright.sync_api import Page

from site_page import Opened, differ, seen

pytestmark = pytest.mark.slow

FRAMES = "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))"


def test_scrolling_past_the_prints_makes_no_further_context(opened: Opened) -> None:
    """Chromium ends the oldest of 16."""
    tab = opened()
    tab.locator("#bed").scroll_into_view_if_needed()
    tab.wait_for_selector("#bed canvas")
    tab.evaluate(
        """() => {
            window.made = 0;
            const real = HTMLCanvasElement.prototype.getContext;
            HTMLCanvasElement.prototype.getContext = function(...arguments_) {
                window.made += 1;
                return real.apply(this, arguments_);
            };
        }"""
    )
    for _ in range(2):
        for place in ("cells", "bed"):
            tab.evaluate(f"byId('{place}').scrollIntoView()")
            tab.evaluate(FRAMES)
    assert tab.evaluate("made") == 0


def _context(tab: Page, what: str) -> None:
    """End or bring back the context of the model, as a browser does."""
    tab.evaluate(
        f"""new Promise(done => {{
            const {{ renderer, canvas }} = lumitip.model;
            canvas.addEventListener("webglcontext{what}", () => done(), {{ once: true }});
            window.loss ??= renderer.getContext().getExtension("WEBGL_lose_context");
            loss.{"loseContext" if what == "lost" else "restoreContext"}();
        }})"""
    )


def test_a_view_that_the_browser_stopped_says_so_and_is_drawn_again(opened: Opened) -> None:
    tab = opened("", color_scheme="light", viewport={"width": 1440, "height": 900})
    first = seen(tab)
    tab.evaluate("console.log = console.warn = console.error = () => {}")  # of three.js
    _context(tab, "lost")
    note = tab.locator("#no-model")
    assert str(note.text_content()).startswith("The browser has stopped this 3D view.")
    assert note.is_visible()
    _context(tab, "restored")
    assert not note.is_visible()
    again = seen(tab)
    assert np.ptp(again) > 100
    assert differ(first, again) < 0.001
