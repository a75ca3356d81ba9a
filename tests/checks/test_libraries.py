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
    "clearance": (edited(PROJECT, '"min_clearance": 0.', '"min_clearance": 1.'), {"project"}),
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
