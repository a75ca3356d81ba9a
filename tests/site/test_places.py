"""Lines of the page's tables lead to places: parts, nets, bodies, boards and prints."""

from functools import cache
from pathlib import Path
from typing import Any

import pytest

from lumitip_fab.site.checks import check_rows
from lumitip_fab.site.folder import Folder
from lumitip_fab.site.tables import prints
from lumitip_fab.site.targets import Targets
from site_page import SIZES, Opened

pytestmark = pytest.mark.slow

PLACELESS = {"bom", "derivation", "firmware", "gauge_card", "heat", "manifest", "manual_pages"}
PLACELESS |= {"mould", "packs", "printing"}  # notes: amounts, hours, settings
MOULD_NOTES = {"mould.masses", "mould.note"}


def test_every_name_that_a_line_shows_is_in_a_panel(opened: Opened) -> None:
    tab = opened()
    lost = """[...new Set([...data.checks.flatMap(row => row.show),
        ...all(".show").flatMap(button => button.dataset.show.split(" "))])].filter(name =>
        !parts.has(name) && !nets.has(name) && !shown.has(name) && !panelsOf(name).length)"""
    assert tab.evaluate(lost) == []
    assert tab.locator("#bill .show").count() > 20
    prints = tab.evaluate("all('option', byId('bed-part')).map(option => option.value)")
    names = tab.evaluate("data.checks.flatMap(row => row.show)")
    files = {name.removeprefix("print.").partition("@")[0] for name in names if "print." in name}
    assert files and files <= set(prints)


def test_checks_of_parts_and_boards_lead_to_a_place(opened: Opened) -> None:
    rows = opened().evaluate("data.checks.map(row => [row.check, row.note, row.show])")
    nowhere = {check for check, _, show in rows if not show}
    assert {check.partition(".")[0] for check in nowhere} <= PLACELESS
    assert not any(check.startswith("mould.") for check in nowhere - MOULD_NOTES)
    gaps = [(note, show) for check, note, show in rows if check == "board.clearance"]
    assert len(gaps) == 4
    for note, show in gaps:  # such as "track of S0 and pad of GND"
        nets = {word for word in note.split()[2::4] if word != "GND"}
        assert nets and nets <= {name.partition(":")[2] for name in show}
    bodies = next(
        show
        for check, note, show in rows
        if check == "assembly.interference" and note.startswith("backing and silicone")
    )
    assert {name.partition(".")[2] for name in bodies} == {"backing", "silicone"}


@cache
def _rows(folder: Path) -> list[dict[str, Any]]:
    files = Folder.of(folder)
    return check_rows(files, Targets(files, [part.file for part in prints(files)]))


def _show(folder: Path, check: str, subject: str) -> set[str]:
    """All that the lines of a check of a subject show."""
    rows = [row for row in _rows(folder) if row["check"] == check]
    return {name for row in rows if row["subject"].startswith(subject) for name in row["show"]}


def test_a_line_shows_the_finger_of_its_file(site: Path) -> None:
    drawn = _show(site, "assembly.drawing", "assembly/receiver_exploded.svg place")
    assert drawn == {"receiver.Q5", "receiver.board"}
    size = _show(site, "assembly.drawing", "assembly/emitter_exploded.svg size")
    assert size == {"emitter.film"}


def test_a_cell_without_a_finger_is_an_led_and_a_photodetector(site: Path) -> None:
    """The emitter has a Q1 too, its MOSFET."""
    assert _show(site, "assembly.facing", "assembly/assembly.glb") == {"emitter.D1", "receiver.Q1"}


def test_a_print_that_a_note_names_is_shown(site: Path) -> None:
    casting = "mould/emitter_casting.md"
    assert _show(site, "mould.volume", casting) == {"print.mould/emitter_mould.stl"}
    assert _show(site, "mould.clamped", casting) == {"print.mould/clamp.stl"}
    assert "print.mould/prop.stl" in _show(site, "manifest.frames", "manifest.json: mould/prop")
    (worst,) = _show(site, "bom.prints", "bom.csv")
    assert worst.startswith("print.")


def test_a_net_lights_up_on_its_board(opened: Opened) -> None:
    tab = opened()
    tab.locator("#query").fill("board.clearance receiver")
    tab.locator("#check-table tbody .show").first.click()
    lit = tab.evaluate("all('[data-net].lit').map(e => e.getAttribute('data-net'))")
    assert lit and all(name.startswith("receiver:") for name in lit)


LIT_IN_VIEW = """() => all("svg .lit").filter(element => {
    const { left, right, top, bottom } = element.getBoundingClientRect();
    return left >= 0 && top >= 0 && right <= innerWidth && bottom <= innerHeight;
}).map(element => element.dataset.part || element.dataset.net)"""


@pytest.mark.parametrize("viewport", SIZES.values(), ids=SIZES)
def test_what_lights_up_on_a_board_is_in_view(opened: Opened, viewport: dict[str, int]) -> None:
    tab = opened("", viewport=viewport)
    for board in ("receiver", "flange", "emitter"):
        tab.locator("#query").fill(f"board.clearance {board}")
        tab.locator("#check-table tbody .show").first.click()
        assert any(name.startswith(board) for name in tab.evaluate(LIT_IN_VIEW)), board
    tab.get_by_role("button", name="Show circuit 74HC4051PW").click()
    assert "receiver.U1" in tab.evaluate(LIT_IN_VIEW)
    assert set(tab.evaluate("[...lumitip.model.marked]")) >= {"receiver.U1", "receiver.U4"}


def test_a_body_without_a_drawing_is_shown_in_3d(opened: Opened) -> None:
    tab = opened()
    tab.locator("#query").fill("assembly.interference emitter")
    tab.locator("#check-table tbody .show").first.click()
    box = tab.locator("#canvas").bounding_box()
    assert box is not None and 0 <= box["y"] < 720
