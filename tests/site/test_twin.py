"""The twin in the page beside that in Python: the same values within 0.01 counts."""

from collections.abc import Callable
from dataclasses import asdict, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page

from lumitip.layout import Layout
from lumitip.twin import Cable, Corner, HalfPlane, Model, Thing, Twin
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.site.page import twin_data
from page_colours import ramp
from site_page import Opened, marked

pytestmark = pytest.mark.slow

COUNT = 0.01
VALUES = """([record, shapes]) => {
    const twin = new Twin(record);
    return shapes.map(shape => twin.values(shape));
}"""


def edge(place: np.ndarray) -> tuple[dict[str, object], Thing]:
    """An edge, as page and Python have it."""
    x, y, angle, _ = place.tolist()
    radians = np.radians(angle)
    offset = float(y * np.cos(radians) - x * np.sin(radians))
    return {"kind": "edge", "x": x, "y": y, "angle_deg": angle}, HalfPlane(offset, angle)


def cable(place: np.ndarray) -> tuple[dict[str, object], Thing]:
    """A cable, likewise."""
    shape, line = edge(place)
    diameter = (1.0, 3.0, 4.5)[int(place[3] * 3)]
    return (
        shape | {"kind": "cable", "diameter": diameter},
        Cable(line.offset_mm, line.angle_deg, diameter_mm=diameter),  # type: ignore[attr-defined]
    )


def corner(place: np.ndarray) -> tuple[dict[str, object], Thing]:
    """A corner, likewise."""
    x, y, angle, _ = place.tolist()
    shape = {"kind": "corner", "x": x, "y": y, "angle_deg": angle}
    return shape, Corner(x, y, angle)


@cache
def places(count: int) -> np.ndarray:
    """Places (mm), angles (degrees) and a number from 0 to below 1, shape `(count, 4)`."""
    chance = np.random.default_rng(7)
    return chance.uniform((-18, -15, -180, 0), (18, 15, 180, 1), (count, 4))


def of_page(tab: Page, layout: Layout, model: Model, shapes: list[object]) -> np.ndarray:
    record = twin_data(layout) | {"model": asdict(model)}
    return np.array(tab.evaluate(VALUES, [record, shapes]))


@pytest.mark.parametrize("kind", [edge, cable, corner])
def test_values_are_those_of_python(
    opened: Opened, site: Path, kind: Callable[..., object]
) -> None:
    layout = Layout.load(site / "layout.json")
    pairs = [kind(place) for place in places(200)]
    shapes, things = zip(*pairs, strict=True)  # type: ignore[arg-type]
    twin = Twin(layout)
    wanted = np.array([twin.values(thing) for thing in things])
    found = np.array(
        opened().evaluate("shapes => shapes.map(s => lumitip.grasp.twin.values(s))", list(shapes))
    )
    assert np.ptp(wanted) > 250
    assert np.abs(found - wanted).max() < COUNT


@pytest.mark.parametrize("kind", [edge, cable, corner])
@pytest.mark.parametrize(
    ("preset", "changes"),
    [
        ("dense", {}),
        ("asymmetric", {"hole_shape": "circle", "gap_mm": 4.0, "alpha": 0.3, "gain": 1.4}),
        ("published", {"hole_share": 3}),
    ],
)
def test_other_grids_and_optics(
    opened: Opened,
    design_dir: Path,
    preset: str,
    changes: dict[str, object],
    kind: Callable[..., object],
) -> None:
    layout = derive(load(design_dir / "presets" / f"{preset}.toml")).layout
    changes = dict(changes)
    if seed := changes.pop("hole_share", 0):
        sizes = np.random.default_rng(seed).uniform(0.7, 1.4, len(layout))
        layout = replace(layout, hole_share=sizes.round(1))
    model = Model.from_layout(layout).changed(**changes)
    pairs = [kind(place) for place in places(30)]
    shapes, things = zip(*pairs, strict=True)  # type: ignore[arg-type]
    twin = Twin(layout, model)
    wanted = np.array([twin.values(thing) for thing in things])
    found = of_page(opened(), layout, model, list(shapes))
    assert np.abs(found - wanted).max() < COUNT


def test_dragging_moves_the_object_and_chooses_no_cell(opened: Opened) -> None:
    tab = opened("#cell-0")
    grid = tab.locator("#grid")
    grid.scroll_into_view_if_needed()
    before = tab.evaluate("[...lumitip.grasp.values]")
    ((x, y),) = tab.evaluate(
        """() => [15].map(cell => {
            const box = document.querySelector(`#grid [data-cell="${cell}"]`)
                .getBoundingClientRect();
            return [box.x + box.width / 2, box.y + box.height / 2];
        })"""
    )
    tab.mouse.move(x, y)
    tab.mouse.down()
    tab.mouse.move(x + 40, y + 30, steps=4)
    tab.mouse.up()
    after = tab.evaluate("[...lumitip.grasp.values]")
    assert np.abs(np.subtract(after, before)).max() > 50
    assert marked(tab, "view") == [0]
    tab.mouse.click(x, y)
    assert marked(tab, "view") == [15]


def test_each_drag_moves_the_object_as_far_as_the_pointer(opened: Opened) -> None:
    """Text that an earlier drag selected would be dragged instead, and the object would stop."""
    tab = opened("#cell-17", viewport={"width": 1440, "height": 900})
    grid = tab.locator("#grid")
    grid.scroll_into_view_if_needed()
    box = grid.bounding_box()
    assert box is not None
    wide = float(str(grid.get_attribute("viewBox")).split()[2])
    height = box["y"] + box["height"] / 2
    for start, end in ((0.5, 0.3), (0.3, 0.6), (0.6, 0.4)):
        before = tab.evaluate("GRASP.x")
        tab.mouse.move(box["x"] + box["width"] * start, height)
        tab.mouse.down()
        tab.mouse.move(box["x"] + box["width"] * end, height + 20, steps=10)
        tab.mouse.up()
        assert tab.evaluate("GRASP.x") - before == pytest.approx((end - start) * wide, abs=0.2)
    assert tab.evaluate("String(getSelection())") == ""


def test_an_object_that_was_released_outside_stays(opened: Opened) -> None:
    tab = opened("#cell-17", viewport={"width": 1440, "height": 900})
    grid = tab.locator("#grid")
    grid.scroll_into_view_if_needed()
    box = grid.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    before = tab.evaluate("GRASP.x")
    # The pointer leaves before it has moved far enough to be a drag, and is released there.
    tab.mouse.move(box["x"] + 1, y)
    tab.mouse.down()
    tab.mouse.move(box["x"] - 20, y)
    tab.mouse.up()
    tab.mouse.move(x, y, steps=5)
    assert tab.evaluate("GRASP.x") == before
    for button in ("right", "middle"):
        tab.mouse.down(button=button)
        tab.mouse.move(x + 40, y, steps=5)
        tab.mouse.up(button=button)
        assert tab.evaluate("GRASP.x") == before, button


def test_a_finger_moves_the_object_and_not_the_page(opened: Opened) -> None:
    options = {"is_mobile": True, "has_touch": True, "viewport": {"width": 390, "height": 844}}
    tab = opened("", **options)
    tab.evaluate("byId('grid').scrollIntoView({ block: 'center' })")
    box = tab.locator("#grid").bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] * 0.7
    scrolled, before = tab.evaluate("[scrollY, GRASP.y]")
    protocol = tab.context.new_cdp_session(tab)
    for kind, up in (("Start", 0), *(("Move", 10 * n) for n in range(1, 11))):
        touch = {"type": f"touch{kind}", "touchPoints": [{"x": x, "y": y - up}]}
        protocol.send("Input.dispatchTouchEvent", touch)
    protocol.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    assert tab.evaluate("scrollY") == scrolled
    assert tab.evaluate("GRASP.y") - before > 5
    margin = box["x"]
    assert margin > 12, "room at the side of the grid, where a finger scrolls the page"


def test_the_object_moves_a_pitch_beyond_the_cells(opened: Opened, site: Path) -> None:
    layout = Layout.load(site / "layout.json")
    tab = opened()
    for way, along in (("x", layout.x_mm), ("y", layout.y_mm)):
        slider = tab.locator(f"#grasp-{way}")
        low, high = (float(str(slider.get_attribute(end))) for end in ("min", "max"))
        assert 0 <= along.min() - layout.pitch_mm - low < 1
        assert 0 <= high - along.max() - layout.pitch_mm < 1
        assert float(slider.input_value()) == tab.evaluate(f"GRASP.{way}")


def test_each_pixel_shows_its_value_in_its_colour(opened: Opened) -> None:
    tab = opened("#cell-17")
    tab.locator("#grasp-kind").select_option("corner")
    tab.locator("#grasp-angle").fill("-60")
    shown = tab.locator("#grid .value").all_text_contents()
    values = tab.evaluate("[...lumitip.grasp.values]")
    assert [int(text) for text in shown] == [round(value) for value in values]
    assert min(values) < 30 and max(values) == 255
    colours = tab.evaluate(
        "[...document.querySelectorAll('#grid .cell polygon')].map(p => getComputedStyle(p).fill)"
    )
    wanted = [f"rgb({', '.join(map(str, ramp(value).astype(int)))})" for value in values]
    assert colours == wanted
    reads = str(tab.locator("#reads").text_content())
    assert reads == f"Cell 17 reads {round(values[17])} of 255."
    tab.locator("#grasp-kind").select_option("none")
    assert set(tab.locator("#grid .value").all_text_contents()) == {"255"}
