"""One cell through all panels of the page."""

import csv
import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from lumitip.layout import Layout
from lumitip_fab.checks.connections import read_channels
from lumitip_fab.checks.readers.kicad_board import Part, read_board
from lumitip_fab.cli import main
from lumitip_fab.site.folder import Folder
from lumitip_fab.site.page import page
from site_page import Opened, marked, record

pytestmark = pytest.mark.slow


def _part(folder: Path, board: str, ref: str) -> Part:
    parts = read_board(folder / f"boards/{board}/{board}.kicad_pcb").parts
    return next(part for part in parts if part.ref == ref)


PANELS = ("view", "board-receiver", "board-emitter", "mask-receiver", "mask-emitter", "inputs")


def embedded(folder: Path) -> dict[str, object]:
    """The data in a page."""
    text = (folder / "index.html").read_text(encoding="utf-8")
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)
    assert found
    return dict(json.loads(found[1]))


@pytest.mark.parametrize("panel", PANELS)
def test_a_click_in_any_panel_marks_the_cell_in_all(opened: Opened, panel: str) -> None:
    tab = opened()
    tab.locator(f'#{panel} [data-cell="17"]').first.click()
    for other in PANELS:
        assert marked(tab, other) == [17], other
    assert tab.evaluate("location.hash") == "#cell-17"
    assert tab.locator("#record-h").text_content() == "Cell 17"
    assert int(tab.locator("#number").input_value()) == 17


def test_its_copper_leads_there_too(opened: Opened, site: Path) -> None:
    led = _part(site, "emitter", "D18")
    tab = opened()
    tab.evaluate(
        """document.querySelector('[data-net="receiver:Q18"][data-follow]')
        .dispatchEvent(new MouseEvent("click", {bubbles: true}))"""
    )
    assert marked(tab, "view") == [17]
    own = tab.evaluate("[...document.querySelectorAll('.own')].map(e => e.dataset.net)")
    beyond = {net for net in own if net.startswith("breakout:")}
    assert set(own) - beyond == {"receiver:Q18", *(f"emitter:{t.net}" for t in led.terminals)}
    line = Layout.load(site / "layout.json").adc_pin[17]
    assert f"breakout:{line}" in beyond


def test_the_place_in_the_address_is_a_cell(opened: Opened) -> None:
    tab = opened("#cell-17")
    assert marked(tab, "board-emitter") == [17]
    tab.evaluate("location.hash = '#cell-3'")
    tab.wait_for_function("follow.cell === 3")
    assert marked(tab, "board-emitter") == [3]
    assert marked(opened("#cell-99"), "view") == marked(opened(), "view")


def test_keys_go_from_cell_to_cell(opened: Opened) -> None:
    tab = opened("#cell-16")
    tab.locator('#view [data-cell="16"]').focus()
    tab.keyboard.press("ArrowDown")
    assert marked(tab, "mask-emitter") == [17]
    tab.keyboard.press("ArrowRight")
    assert marked(tab, "view") in ([21], [22])
    stops = tab.locator('#view [tabindex="0"]')
    assert stops.count() == 1
    tab.locator('#board-emitter [data-cell="4"]').focus()
    tab.keyboard.press("Enter")
    assert marked(tab, "view") == [4]
    tab.locator("#after").click()
    assert marked(tab, "view") == [5]
    tab.locator("#number").fill("31")
    tab.locator("#number").press("Enter")
    tab.locator("#number").fill("")
    tab.locator("#number").press("Enter")
    assert tab.locator("#number").input_value() == "31"
    tab.locator("#after").click()
    assert marked(tab, "view") == [0]


def test_every_record_is_that_of_the_files(site: Path) -> None:
    """Compared with the layout, and with the copper as another reader follows it."""
    layout = Layout.load(site / "layout.json")
    channels = read_channels(site / "boards/receiver/receiver.kicad_pcb").best
    emitter = {p.ref: p for p in read_board(site / "boards/emitter/emitter.kicad_pcb").parts}
    records = embedded(site)["cells"]
    assert isinstance(records, list)
    assert [r["index"] for r in records] == list(range(len(layout)))
    for index, of_page in enumerate(records):
        rows, parts = dict(of_page["rows"]), of_page["parts"]
        mux, channel = parts["multiplexer"].removeprefix("receiver."), layout.channel[index]
        assert mux == f"U{layout.mux[index] + 1}"
        assert rows["Channel"].startswith(f"{channel} ")
        detector = parts["detector"].removeprefix("receiver.")
        assert {str(k): v for k, v in channels[mux].items()}[str(channel)] == detector
        led = emitter[parts["led"].removeprefix("emitter.")]
        assert led.at[0] - 150 == pytest.approx(-layout.x_mm[index], abs=1e-3)
        assert 100 - led.at[1] == pytest.approx(layout.y_mm[index], abs=1e-3)
        assert rows["Analog input"].startswith(layout.adc_pin[index])
        assert rows["Wire"].split()[1].rstrip(",") == layout.adc_pin[index]
        assert rows["Firmware"] == f"MUX[{index}] = {layout.mux[index]}, CHANNEL[{index}] = " + str(
            channel
        )
        assert of_page["faults"] == []


def test_wires_and_shared_parts_are_marked(opened: Opened, site: Path) -> None:
    with (site / "wiring/cables.csv").open(encoding="utf-8", newline="") as file:
        cables = list(csv.DictReader(file))
    layout = Layout.load(site / "layout.json")
    others = set(layout.adc_pin) - {layout.adc_pin[17]}
    needed = [w for w in cables if w["signal"] not in others]
    supplies = {("receiver", "GND"), ("receiver", "3V3"), ("breakout", "24V"), ("breakout", "5V")}
    assert supplies < {(w["from_board"], w["signal"]) for w in needed}
    tab = opened("#cell-17")
    wires = tab.evaluate("[...document.querySelectorAll('.wire.on')].map(e => e.dataset.wire)")
    assert sorted(wires) == sorted(w["wire"] for w in needed)
    roles = tab.evaluate("[...document.querySelectorAll('.role')].map(e => e.dataset.part)")
    assert {"receiver.U3", "receiver.Q18", "emitter.D18"} < set(roles)
    assert "J1." in record(tab)["Breakout"]


def test_firmware_that_disagrees_is_named(edited: Path, opened: Opened) -> None:
    _replace(edited / "firmware/layout.h", "{\n    4, 2, 6,", "{\n    4, 3, 6,")
    assert main(["page", "--quiet", "--out", str(edited)]) == 0
    tab = opened("#cell-1", edited)
    assert tab.locator("#faults").text_content() == "firmware/layout.h reads U1, channel 3"
    tab.locator("#after").click()
    assert tab.locator("#faults").text_content() == ""


def test_copper_that_disagrees_is_named(edited: Path, opened: Opened) -> None:
    path = edited / "boards/receiver/receiver.kicad_pcb"
    blocks = path.read_text(encoding="utf-8").split("(footprint ")
    at = next(n for n, block in enumerate(blocks) if 'reference "U1"' in block)
    swapped = {'"Q2")': '"Q3")', '"Q3")': '"Q2")'}
    blocks[at] = re.sub('"Q[23]"\\)', lambda found: swapped[found[0]], blocks[at])
    path.write_text("(footprint ".join(blocks), encoding="utf-8")
    assert main(["page", "--quiet", "--out", str(edited)]) == 0
    fault = opened("#cell-1", edited).locator("#faults").text_content()
    assert fault == "layout.json names channel 2 (pin 15), the copper ends at pin 2"


@pytest.mark.parametrize("preset", ["flex", "integrated"])
def test_cells_of_other_designs_are_followed(
    built: Callable[[str], Path], opened: Opened, tmp_path: Path, preset: str
) -> None:
    folder = Path(shutil.copytree(built(preset), tmp_path / preset))
    assert main(["page", "--quiet", "--out", str(folder)]) == 0
    tab = opened("#cell-5", folder)
    assert marked(tab, "board-emitter") == [5]
    assert tab.evaluate("data.cells.flatMap(cell => cell.faults)") == []
    assert {"String", "Net", "Channel", "Wire", "Firmware"} <= set(record(tab))


def test_a_layout_that_was_changed_stops_the_page(
    edited: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _replace(edited / "layout.json", '"channel": [4, 2, 6', '"channel": [4, 3, 6')
    assert main(["page", "--quiet", "--out", str(edited)]) == 2
    assert "layout.json: cannot be read" in capsys.readouterr().err


def _replace(path: Path, old: str, new: str) -> None:
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def test_a_mask_without_a_hole_stops_the_page(
    edited: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = edited / "mask/receiver_mask.svg"
    text = path.read_text(encoding="utf-8")
    runs = re.findall(r"M[^M\"]+Z", text)
    hole = next(run for run in runs if 100 < len(run) < 120)
    path.write_text(text.replace(hole, "", 1), encoding="utf-8")
    assert main(["page", "--out", str(edited)]) == 2
    assert "has no aperture" in capsys.readouterr().err


def test_the_same_files_give_the_same_bytes(site: Path, tmp_path: Path) -> None:
    moved = Path(shutil.copytree(site, tmp_path / "elsewhere"))
    assert page(Folder.of(moved), [], {}) == page(Folder.of(site), [], {})
