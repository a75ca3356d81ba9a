"""The estimate beside the published method: on the grid, in numbers and over time."""

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from live_page import ESTIMATE, opened, pixels, places, until
from lumitip import Layout
from lumitip.estimation import Estimate, PoseEstimator
from lumitip.twin import Cable, Corner, HalfPlane, Thing, Twin
from lumitip.view.finger import Finger
from lumitip.view.pose import described, reach_of
from lumitip.view.server import ViewServer

pytestmark = pytest.mark.slow

Serve = Callable[..., ViewServer]
StillFinger = Callable[[Layout, np.ndarray], Finger]
WaitFor = Callable[[Callable[[], bool]], None]
SCENES = {
    "edge": HalfPlane(offset_mm=2.0, angle_deg=20.0),
    "cable": Cable(offset_mm=-1.5, angle_deg=35.0),
    "corner": Corner(x_mm=-2.0, y_mm=1.0, angle_deg=-60.0),
}
PANEL = "lumitip.panels.get(1)"


def tables_ready(page: Page) -> None:
    """Wait for the tables of the estimate: half a minute where other work is on."""
    until(page, f"{PANEL}.status?.estimates.state === 'ready'", timeout_s=120.0)


def shown(
    page: Page, serve: Serve, still: StillFinger, layout: Layout, thing: Thing
) -> tuple[Estimate, Finger]:
    """The page of an object that stands still, once the estimate is there."""
    finger = still(layout, np.rint(255.0 - Twin(layout).values(thing)))
    opened(page, serve(finger))
    until(page, f"{PANEL}.estimate")
    tables_ready(page)
    return PoseEstimator(layout)(finger.tip.read().values), finger


@pytest.mark.parametrize("kind", SCENES)
def test_estimate_is_drawn_where_it_is_in_its_own_colour(
    serve: Serve, page: Page, still: StillFinger, layout: Layout, kind: str
) -> None:
    estimate, _ = shown(page, serve, still, layout, SCENES[kind])
    page.keyboard.press("v")
    expect(page.locator(".kind")).to_have_text(kind)
    drawn = described(estimate, reach_of(layout))
    low, high = np.array([[layout.x_mm.min(), layout.y_mm.min()], [15.0, 12.0]])
    for line in drawn["lines"]:
        ends = np.array(line)
        along = ends[0] + np.linspace(0, 1, 400)[:, None] * (ends[1] - ends[0])
        along = along[((along > low) & (along < high)).all(axis=1)]
        near = np.abs(pixels(page, places(page, along)) - ESTIMATE).max(axis=1) < 60
        assert near.mean() > 0.25  # the rest is below lines, markers and dashes
    page.keyboard.press("o")
    off = pixels(page, places(page, along))
    assert (np.abs(off - ESTIMATE).max(axis=1) > 60).all()


@pytest.mark.parametrize("kind", SCENES)
def test_numbers_have_their_error_and_unit(
    serve: Serve, page: Page, still: StillFinger, layout: Layout, kind: str
) -> None:
    estimate, _ = shown(page, serve, still, layout, SCENES[kind])
    text = page.locator("dl.estimate").inner_text().replace("−", "-")
    error = described(estimate, 1.0)["error"]
    expected = {"offset": (estimate.offset_mm, "mm"), "angle": (estimate.angle_deg, "°")}
    if kind == "cable":
        expected["width"] = estimate.width_mm, "mm"
    for name, (value, unit) in expected.items():
        found = re.search(rf"{name}\s+(-?[\d.]+) ± ([\d.]+) ?{unit}", text)
        assert found, name
        # The tracker comes a little closer to the least misfit than a single fit.
        assert float(found[1]) == pytest.approx(value, abs=0.11)
        of = "angle_deg" if name == "angle" else f"{name}_mm"
        assert float(found[2]) == pytest.approx(error[of], rel=0.3, abs=0.11)
    assert ("width" in text) == (kind == "cable")
    headings = page.locator("aside h3").all_inner_texts()
    assert [h.split("\n")[0] for h in headings] == ["Published method", "Estimate", "Link"]
    expect(page.locator("aside")).to_contain_text("band: 95 %")


def test_misfit_is_said_in_words_without_moving_the_page(
    serve: Serve, page: Page, still: StillFinger, layout: Layout
) -> None:
    codes = np.zeros(len(layout))
    codes[::3] = 250
    opened(page, serve(still(layout, codes), still(layout, np.zeros(len(layout)))))
    tables_ready(page)
    words = page.locator(".words").first
    expect(words).to_contain_text("misfit: no edge, cable or corner explains these cells")
    assert words.evaluate("e => e.scrollHeight <= e.clientHeight")
    expect(page.locator(".kind").nth(1)).to_have_text("none")
    heights = page.locator("aside").evaluate_all("all => all.map((e) => e.scrollHeight)")
    assert heights[0] == heights[1]


def test_a_trusted_estimate_says_too_that_the_finger_is_not_tared(
    serve: Serve, page: Page, still: StillFinger, layout: Layout
) -> None:
    estimate, finger = shown(page, serve, still, layout, SCENES["edge"])
    assert estimate.flags == ()
    words = page.locator(".words")
    expect(words).to_have_text("Not tared yet")
    finger.tip.calibration = replace(finger.tip.calibration, empty=np.full(len(layout), 255.0))
    expect(words).to_have_text("")


def test_a_doubted_estimate_says_both(
    serve: Serve, page: Page, still: StillFinger, layout: Layout
) -> None:
    codes = np.zeros(len(layout))
    codes[::3] = 250
    opened(page, serve(still(layout, codes)))
    tables_ready(page)
    text = re.compile(r"^misfit: no edge, .*; the error may be larger.*\. Not tared yet$")
    expect(page.locator(".words")).to_have_text(text)


def test_a_layout_without_estimates_says_why(
    serve: Serve, page: Page, still: StillFinger, make_layout: Callable[..., Layout]
) -> None:
    few = make_layout((1, 2))
    opened(page, serve(still(few, np.full(3, 20))))
    expect(page.locator(".words")).to_contain_text("no estimate: layout has 3 cells")


def test_pose_is_plotted_with_units_and_named_zero(
    serve: Serve, page: Page, still: StillFinger, layout: Layout, wait_for: WaitFor
) -> None:
    estimate, _ = shown(page, serve, still, layout, SCENES["edge"])
    captions = page.locator(".time figcaption").all_inner_texts()
    assert any(re.search(r"offset \(mm\); 0: line through the origin", c) for c in captions)
    assert any(re.search(r"angle \(°\); 0: line along x", c) for c in captions)
    wait_for(lambda: page.evaluate(f"{PANEL}.estimates.points.length") > 30)
    for i, value in enumerate((estimate.offset_mm, estimate.angle_deg)):
        trend = f"{PANEL}.trends[{i}]"
        until(page, f"{trend}.words?.includes('0')")
        right, at, low, high = page.evaluate(
            f"(({{ right, y, low, high }}) => [right, y({value}), low, high])({trend}.axes)"
        )
        assert low <= min(0, value) <= max(0, value) <= high
        column = np.array([[right - 6, at + away] for away in (-2, -1, 0, 1, 2)])
        found = pixels(page, column, f"{trend}.canvas")
        assert np.abs(found - ESTIMATE).max(axis=1).min() < 60
    # The published method is there too.
    points = page.evaluate(f"{PANEL}.published.points.slice(-5)")
    assert all(abs(p["offset"] - 2.0) < 1.0 and abs(p["angle"] - 20.0) < 10.0 for p in points)


def test_estimates_come_at_the_rate_of_the_display(
    serve: Serve, page: Page, wait_for: WaitFor
) -> None:
    server = serve("twin://demo?rate=200")
    opened(page, server)
    points = f"{PANEL}.estimates.points"
    wait_for(lambda: page.evaluate(f"{points}.length") > 100)
    times = np.array(page.evaluate(f"{points}.map((p) => p.t)"))
    assert np.median(np.diff(times)) < 0.5  # 0.03 where nothing else is at work
    assert len(times) / np.ptp(times) < 35.0
    assert server.registry.fingers[1].tip.stats.overflowed == 0
