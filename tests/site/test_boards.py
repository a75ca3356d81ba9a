"""The drawings of the boards: layers, both sides, references; and tables on a phone."""

from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page
from shapely import union_all

from lumitip_fab.checks.readers.kicad_board import read_board
from site_page import SIZES, Opened

pytestmark = pytest.mark.slow

SHOWN = "selector => all(selector).filter(e => e.getClientRects().length).length"
PHONE = {"viewport": SIZES["phone"], "is_mobile": True, "has_touch": True}


def text_place(tab: Page, text: str) -> float:
    """Where a word stands on the receiver's drawing, from its left (0) to its right (1)."""
    script = """text => {
        const svg = document.querySelector("#board-receiver svg");
        const shown = all("text", svg).filter(e => e.getClientRects().length);
        const word = shown.find(e => e.textContent === text);
        const [box, own] = [svg, word].map(e => e.getBoundingClientRect());
        return (own.x + own.width / 2 - box.x) / box.width;
    }"""
    return float(tab.evaluate(script, text))


def test_the_switches_stand_above_the_boards(opened: Opened) -> None:
    tab = opened("", viewport=SIZES["desk"])
    switches, board = (tab.locator(name).bounding_box() for name in (".layers", "#board-receiver"))
    assert switches is not None and board is not None
    assert 0 <= board["y"] - switches["y"] - switches["height"] < 40
    assert tab.locator(".layers legend").text_content() == "Drawings of all boards"


@pytest.mark.parametrize("layer", ["openings", "silk"])
def test_mask_openings_and_silkscreen_can_be_seen(opened: Opened, layer: str) -> None:
    tab = opened()
    boards = tab.locator("svg.board").count()
    assert tab.evaluate(SHOWN, f".{layer}") == 0
    tab.locator(f"#{layer}").check()
    assert tab.evaluate(SHOWN, f".{layer}[data-side=front]") == boards
    assert tab.evaluate(SHOWN, f".{layer}[data-side=back]") == 0
    tab.locator("#side").select_option("back")
    assert tab.evaluate(SHOWN, f".{layer}[data-side=front]") == 0
    assert tab.evaluate(SHOWN, f".{layer}[data-side=back]") > 0


def test_marked_copper_is_seen_where_copper_is_off(opened: Opened) -> None:
    tab = opened("#cell-17")
    for side in ("front", "back"):
        tab.locator(f"#{side}").uncheck()
    copper = "#board-receiver .layer path"
    marks = tab.evaluate(SHOWN, f"{copper}.own") + tab.evaluate(SHOWN, f"{copper}.shared")
    assert 0 < marks == tab.evaluate(SHOWN, copper)
    tab.locator("#query").fill("board.clearance flange")
    tab.locator("#check-table tbody .show").first.click()
    assert tab.evaluate(SHOWN, "#boards .layer path.lit") > 0


def test_openings_are_as_wide_as_the_pads_and_the_clearance(site: Path) -> None:
    board = read_board(site / "boards/receiver/receiver.kicad_pcb")
    for front, layer in ((True, board.layers[0]), (False, board.layers[-1])):
        copper = (t.copper for part in board.parts for t in part.terminals)
        pads = union_all([c.area for c in copper if c is not None and layer in c.layers])
        free = union_all([o.area for o in board.openings if o.front == front])
        assert free.buffer(-0.049).contains(pads) or not pads.area
        covered = [c for c in board.loose if not c.area.within(free)]
        assert len(covered) > 0.9 * len(board.loose)


def test_a_board_is_seen_from_its_back(opened: Opened) -> None:
    tab = opened()
    before = text_place(tab, "U1")
    tab.locator("#side").select_option("back")
    assert text_place(tab, "U1") == pytest.approx(1 - before, abs=0.01)
    front = "#board-receiver .layer:last-child"
    assert tab.locator(front).get_attribute("data-layer") == "B.Cu"
    label = str(tab.locator("#board-receiver svg").get_attribute("aria-label"))
    assert "from its back" in label
    readable = "es => es.every(e => { const m = e.getScreenCTM(); return m.a * m.d > m.b * m.c; })"
    tab.locator("#silk").check()
    words = tab.locator("#board-receiver .silk[data-side=back] text")
    assert words.count() > 0
    assert words.evaluate_all(readable)
    assert tab.locator("#board-receiver .part text").evaluate_all(readable)
    tab.locator("#side").select_option("front")
    assert text_place(tab, "U1") == pytest.approx(before, abs=0.001)
    assert tab.locator(front).get_attribute("data-layer") == "F.Cu"


def test_parts_and_pads_have_their_names(opened: Opened, site: Path) -> None:
    tab = opened("", viewport=SIZES["desk"])
    for board in ("receiver", "emitter", "breakout", "flange"):
        parts = read_board(site / f"boards/{board}/{board}.kicad_pcb").parts
        for part in parts:
            group = tab.locator(f'#board-{board} [data-part="{board}.{part.ref}"]')
            if group.count():
                assert part.ref in group.locator("text:not(.pin)").all_text_contents()
    pins = tab.locator('[data-part="receiver.U3"] .pin')
    assert sorted(map(int, pins.all_text_contents())) == list(range(1, 17))
    tab.locator("#board-receiver .larger").click()
    box = pins.first.bounding_box()
    assert box is not None and box["height"] > 8


@pytest.mark.parametrize("table", ["#prints", "#bill", "#checks"])
def test_the_button_of_a_row_is_within_the_width_of_a_phone(opened: Opened, table: str) -> None:
    tab = opened("", **PHONE)
    button, frame = (
        tab.locator(f"{table} .wide {name}".strip()).first.bounding_box() for name in (".show", "")
    )
    assert button is not None and frame is not None
    assert frame["x"] <= button["x"]
    assert button["x"] + button["width"] <= frame["x"] + frame["width"] <= 390
    assert tab.locator(f"{table} .wide").first.evaluate("e => e.scrollLeft") == 0


def test_the_diagram_of_the_wires_is_wide_enough_on_a_phone(opened: Opened) -> None:
    tab = opened("", **PHONE)
    box = tab.locator(".wiring").bounding_box()
    assert box is not None and box["width"] >= 700
    assert tab.evaluate("document.documentElement.scrollWidth") <= 390


@pytest.mark.parametrize("size", SIZES)
def test_an_address_with_a_cell_opens_there(opened: Opened, size: str) -> None:
    tab = opened("#cell-17", viewport=SIZES[size])
    box = tab.locator("#record-h").bounding_box()
    assert box is not None and 0 < box["y"] < SIZES[size]["height"]
    tab.evaluate("scrollTo(0, 2000)")
    tab.evaluate("choose(3)")
    assert tab.evaluate("scrollY") == 2000


def test_a_page_that_is_loaded_again_stays_where_it_was(browser: Browser, site: Path) -> None:
    tab = browser.new_context(offline=True, reduced_motion="reduce").new_page()
    tab.goto((site / "index.html").as_uri() + "#cell-17")
    tab.evaluate("scrollTo(0, 2000)")
    tab.reload()
    tab.wait_for_function("scrollY === 2000")


def test_numbers_of_multiplexers_stand_in_the_middle_of_their_row(opened: Opened) -> None:
    tab = opened("", viewport=SIZES["desk"])
    middles = tab.evaluate(
        """all("#inputs tbody tr").map(row => {
            const range = document.createRange();
            range.selectNodeContents(row.cells[0]);
            return [range, row.querySelector("button")].map(e => {
                const { top, bottom } = e.getBoundingClientRect();
                return (top + bottom) / 2;
            });
        })"""
    )
    assert len(middles) == 4
    assert all(abs(label - button) < 1.5 for label, button in middles)
