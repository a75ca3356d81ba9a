"""Libraries and rules of a board's project, as KiCad finds them."""

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from damages import cut_short, edit, excerpt, failing, swap

pytestmark = pytest.mark.slow
RECEIVER = "boards/receiver"
PRETTY = f"{RECEIVER}/lumitip.pretty"
DETECTOR, CHIP = f"{PRETTY}/PTRC2012X80N.kicad_mod", f"{PRETTY}/SOP65P640X110-16N.kicad_mod"
BOARD = f"{RECEIVER}/receiver.kicad_pcb"
SYMBOLS, PROJECT = f"{RECEIVER}/lumitip.kicad_sym", f"{RECEIVER}/receiver.kicad_pro"
Damage = Callable[[Path], None]


def edited(file: str, old: str, new: str) -> Damage:
    return lambda folder: edit(folder / file, old, new)


def on_the_back(folder: Path) -> None:
    """The photodetector's pads on the other side."""
    path = folder / DETECTOR
    path.write_text(path.read_text().replace('"F.Cu" "F.Paste" "F.Mask"', '"B.Cu" "B.Mask"'))


def pad_moved_on_the_board(folder: Path) -> None:
    path = folder / f"{RECEIVER}/receiver.kicad_pcb"
    text = path.read_text()
    changed = re.sub(r'(\(pad "1" smd rect \(at )-?[\d.]+ ', r"\g<1>-1.3 ", text, count=1)
    assert changed != text
    path.write_text(changed)


def all_halved(folder: Path) -> None:
    """Every length of the rules and classes, so that they still agree with each other."""
    path = folder / PROJECT
    path.write_text(
        re.sub(r"(_width|clearance|meter|drill)\": [\d.]+", r'\1": 0.05', path.read_text())
    )


def in_settings(more: dict[str, object]) -> Damage:
    """More settings of the board."""

    def damage(folder: Path) -> None:
        path = folder / PROJECT
        record = json.loads(path.read_text())
        record["board"]["design_settings"] |= more
        path.write_text(json.dumps(record))

    return damage


def supply_clearance(folder: Path) -> None:
    """A gap round supplies that no board has."""
    path = folder / PROJECT
    record = json.loads(path.read_text())
    (supply,) = (c for c in record["net_settings"]["classes"] if c["name"] == "supply")
    supply["clearance"] = 2
    path.write_text(json.dumps(record))


def zones_shrunk(folder: Path) -> None:
    """Outlines of 1 mm round fills that stay as they are until KiCad fills again."""
    path = folder / BOARD
    corners = "(pts (xy 150 100) (xy 151 100) (xy 151 101) (xy 150 101))"
    text, found = re.subn(r"(\n    \(polygon )\(pts.*\)(\)\n)", rf"\1{corners}\2", path.read_text())
    assert found == 2
    path.write_text(text)


def in_setup(setting: str) -> Damage:
    return edited(BOARD, "(setup ", f"(setup {setting} ")


def kept_out(folder: Path) -> None:
    """An area that KiCad leaves free of copper, on one side of a filled board."""
    path = folder / BOARD
    zone = """
  (zone (net 0) (net_name "") (layer "F.Cu") (hatch edge 0.5) (connect_pads (clearance 0))
    (min_thickness 0.2)
    (keepout (tracks allowed) (vias allowed) (pads allowed) (copperpour not_allowed))
    (fill (thermal_gap 0.25) (thermal_bridge_width 0.3))
    (polygon (pts (xy 100 50) (xy 200 50) (xy 200 150) (xy 100 150))))
)
"""
    path.write_text(path.read_text().rstrip()[:-1] + zone.lstrip("\n"))


DAMAGES: dict[str, tuple[Damage, set[str]]] = {
    "kind": (edited(f"{RECEIVER}/fp-lib-table", '"KiCad"', '"Eagle"'), {"tables"}),
    "name": (edited(f"{RECEIVER}/sym-lib-table", '"lumitip"', '"parts"'), {"tables"}),
    "place": (edited(f"{RECEIVER}/sym-lib-table", ".kicad_sym", ".kicad_sim"), {"tables"}),
    "two tables": (
        lambda folder: swap(
            folder / f"{RECEIVER}/fp-lib-table", folder / f"{RECEIVER}/sym-lib-table"
        ),
        {"tables"},
    ),
    "pad moved": (edited(DETECTOR, "(at 1.175 0 0)", "(at 1.275 0 0)"), {"footprints"}),
    "pad wider": (edited(DETECTOR, "(size 1.1 1.25)", "(size 1.2 1.25)"), {"footprints"}),
    "pad turned": (edited(DETECTOR, "(at 1.175 0 0)", "(at 1.175 0 90)"), {"footprints"}),
    "numbers swapped": (edited(CHIP, '(pad "1"', '(pad "17"'), {"footprints"}),
    "courtyard": (edited(DETECTOR, "(start -1.975 0.875)", "(start -1.5 0.875)"), {"footprints"}),
    "model": (edited(DETECTOR, "PTRC2012X80N.step", "PTRC.step"), {"footprints"}),
    "on the back": (on_the_back, {"footprints"}),
    "the board's pad": (pad_moved_on_the_board, {"footprints"}),
    "pad twice": (
        edited(
            DETECTOR,
            '(pad "1"',
            '(pad "2" smd rect (at 1.175 0 0) (size 1.1 1.25) (layers "F.Cu" "F.Paste" "F.Mask"))\n'
            '(pad "1"',
        ),
        {"footprints"},
    ),
    "through holes": (edited(CHIP, "(attr smd)", "(attr through_hole)"), {"footprints"}),
    "footprint gone": (lambda folder: (folder / CHIP).unlink(), {"footprints"}),
    "footprint cut": (lambda folder: cut_short(folder / CHIP, 700), {"footprints"}),
    "pin": (edited(SYMBOLS, "(at 0 3.81 270)", "(at 0 2.54 270)"), {"symbols"}),
    "kind of pin": (edited(SYMBOLS, "pin passive", "pin output"), {"symbols"}),
    "symbol's name": (edited(SYMBOLS, '(symbol "R"', '(symbol "RR"'), {"symbols"}),
    "symbols gone": (lambda folder: (folder / SYMBOLS).unlink(), {"symbols", "tables"}),
    "clearance": (
        edited(PROJECT, '"min_clearance": 0.', '"min_clearance": 1.'),
        {"project", "rules"},
    ),
    "small clearance": (
        edited(PROJECT, '"min_clearance": 0.2', '"min_clearance": 0.01'),
        {"project", "rules"},
    ),
    "no edge": (
        edited(PROJECT, '"min_copper_edge_clearance": 0.', '"min_copper_edge_clearance": -0.'),
        {"project", "rules"},
    ),
    "ignored": (edited(PROJECT, '"error"', '"ignore"'), {"project", "rules"}),
    "track": (
        edited(PROJECT, '"min_track_width": 0.', '"min_track_width": -0.'),
        {"project", "rules"},
    ),
    "severity": (edited(PROJECT, '"error"', '"errors"'), {"project", "rules"}),
    "net": (edited(PROJECT, '"pattern": "GND"', '"pattern": "EARTH"'), {"project", "rules"}),
    "class": (edited(PROJECT, '"name": "signal"', '"name": "other"'), {"project"}),
    "file name": (edited(PROJECT, "receiver.kicad_pro", "emitter.kicad_pro"), {"project"}),
    "no JSON": (edited(PROJECT, "{", "["), {"project", "rules"}),
    "rules and classes": (all_halved, {"rules"}),
    "holes": (edited(PROJECT, '"min_hole_clearance": 0.2', '"min_hole_clearance": 0.1'), {"rules"}),
    "walls": (edited(PROJECT, '"min_hole_to_hole": 0.2', '"min_hole_to_hole": 0.1'), {"rules"}),
    "ring": (
        edited(PROJECT, '"min_via_annular_width": 0.1', '"min_via_annular_width": 0.0'),
        {"rules"},
    ),
    "spokes": (edited(PROJECT, '"min_resolved_spokes": 2', '"min_resolved_spokes": 0'), {"rules"}),
    "edge": (
        edited(PROJECT, '"min_copper_edge_clearance": 0.5', '"min_copper_edge_clearance": 0.1'),
        {"rules"},
    ),
    "track of supplies": (edited(PROJECT, '"track_width": 0.5', '"track_width": 0.2'), {"rules"}),
    "fault of a sheet by default": (edited(PROJECT, '"pin_to_pin": "error",', ""), {"rules"}),
    "faults of the board": (
        in_settings({"rule_severities": {"clearance": "ignore"}}),
        {"rules"},
    ),
    "a wide edge": (
        edited(PROJECT, '"min_copper_edge_clearance": 0.5', '"min_copper_edge_clearance": 5'),
        {"rules"},
    ),
    "wide holes": (
        edited(PROJECT, '"min_hole_clearance": 0.25', '"min_hole_clearance": 3'),
        {"rules"},
    ),
    "a wide class": (supply_clearance, {"rules"}),
    "a further rule": (
        edited(PROJECT, '"min_hole_clearance"', '"min_connection": 2, "min_hole_clearance"'),
        {"rules"},
    ),
    "high letters": (
        edited(PROJECT, '"min_text_height": 0.6', '"min_text_height": 6'),
        {"rules"},
    ),
    "small zone": (zones_shrunk, {"board"}),
    "large zone": (edited(BOARD, "(polygon (pts (xy ", "(polygon (pts (xy 1"), {"board"}),
    "zone that joins nothing": (
        edited(BOARD, "(connect_pads (clearance 0.2))", "(connect_pads no (clearance 0.2))"),
        {"board"},
    ),
    "zone without gaps": (
        edited(BOARD, "(connect_pads (clearance 0.2))", "(connect_pads (clearance 0))"),
        {"board"},
    ),
    "zone of thin spokes": (
        edited(BOARD, "(thermal_bridge_width 0.3)", "(thermal_bridge_width 0.1)"),
        {"board"},
    ),
    "zone of hatches": (
        edited(BOARD, "(fill yes (thermal", "(fill yes (mode hatch) (thermal"),
        {"board"},
    ),
    "zone below another": (
        edited(BOARD, "(min_thickness 0.2)", "(priority 3) (min_thickness 0.2)"),
        {"board"},
    ),
    "no paste": (in_setup("(pad_to_paste_clearance_ratio -0.5)"), {"board"}),
    "less paste": (in_setup("(pad_to_paste_clearance -0.1)"), {"board"}),
    "wide openings": (
        edited(BOARD, "(pad_to_mask_clearance 0.05)", "(pad_to_mask_clearance 0.5)"),
        {"board"},
    ),
    "origin elsewhere": (
        edited(BOARD, "(aux_axis_origin 150 100)", "(aux_axis_origin 0 0)"),
        {"board"},
    ),
    "a part left out": (edited(BOARD, "(attr smd)", "(attr smd dnp)"), {"board"}),
    "a part without paste": (
        edited(BOARD, "(attr smd)", "(attr smd) (solder_paste_ratio -0.5)"),
        {"board"},
    ),
    "a pad that keeps off": (
        edited(BOARD, '(pad "1" smd rect', '(pad "1" smd rect (clearance 5)'),
        {"board"},
    ),
    "a pad joined to nothing": (
        edited(BOARD, '(pad "1" smd rect', '(pad "1" smd rect (zone_connect 0)'),
        {"board"},
    ),
    "fill in a keep-out": (kept_out, {"board"}),
    "exclusions": (in_settings({"drc_exclusions": ["clearance|1|2"]}), {"rules"}),
}


@pytest.fixture
def board(outputs: Path, tmp_path: Path) -> Path:
    """The boards' folders, to damage."""
    return excerpt(outputs, tmp_path / "copied", "boards")


@pytest.mark.parametrize("case", DAMAGES)
def test_a_damaged_project(case: str, board: Path) -> None:
    damage, wanted = DAMAGES[case]
    damage(board)
    assert failing(board, "libraries") == wanted


@pytest.mark.parametrize("preset", ["published", "dense", "integrated", "asymmetric", "flex"])
def test_projects_of_presets_pass(preset: str, built: Callable[[str], Path]) -> None:
    assert failing(built(preset), "libraries") == set()
