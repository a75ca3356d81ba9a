"""KiCad itself on the written boards: rules, schematic parity, plots, and its own copper fill."""

import json
import re
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
import shapely

from lumitip_fab.checks.readers.gerber import gerber_area
from lumitip_fab.checks.readers.kicad_board import read_board
from lumitip_fab.design.board_rules import rules_of
from lumitip_fab.design.encoding import read_design
from programs import needs

Boards = Callable[[str], Path]
SLOW = ("fingertip", "published", "asymmetric", "dense", "mux16", "flex")
NO_FLANGE = (("franka_hand", "flange"), ("wsg50", "flange"))
OTHERS = ("by_goals", "franka_hand", "robotiq_2f140", "wsg50")
BOARDS = ("emitter", "receiver", "breakout", "flange")
AUXILIARY_BOARDS = BOARDS[2:]
MODULE = pytest.param("integrated", "flange", marks=pytest.mark.slow)  # controller on the flange
EVERY = (
    *(("small", name) for name in BOARDS),
    *(pytest.param(preset, name, marks=pytest.mark.slow) for preset in SLOW for name in BOARDS),
    MODULE,
)
ALL = (
    *EVERY,
    *(pytest.param("integrated", name, marks=pytest.mark.slow) for name in BOARDS[:2]),
    *(
        pytest.param(preset, name, marks=pytest.mark.slow)
        for preset in OTHERS
        for name in BOARDS
        if (preset, name) not in NO_FLANGE
    ),
)
"""Every board of every preset."""
ALLOWED: dict[str, str] = {}  # names of warnings, each with the reason why it may stand
FINER = {
    "clearance": "copper_gap_mm",
    "copper_edge_clearance": "edge_gap_mm",
    "drill_out_of_range": "via_drill_mm",
    "via_diameter": "via_mm",
}
"""Faults that copper finer than KiCad's defaults has by them, and the design's least figure."""
ROUNDED_MM = 0.001
# Share of KiCad's fill that ours may leave out. Ours drops pieces that lead from one pad to
# nowhere, of which crowded boards have many: 2.3 % of the dense receiver, 3.6 % of the flange with
# the module.
MISSING_SHARE = {
    "asymmetric": 0.02,
    "dense": 0.04,
    "fingertip": 0.02,
    "flex": 0.02,
    "integrated": 0.045,
    "mux16": 0.02,
    "published": 0.02,
}
MISSING_SHARE_ELSEWHERE = 0.01
"""KiCad keeps pieces of pour that end at a single pad; the written fill leaves them out."""
SYSTEM_PYTHON = Path("/usr/bin/python3")
LAYERS = (
    "F_Cu",
    "B_Cu",
    "F_Mask",
    "B_Mask",
    "F_Paste",
    "B_Paste",
    "F_Silkscreen",
    "B_Silkscreen",
    "Edge_Cuts",
)

pytestmark = [needs("kicad-cli"), pytest.mark.slow]


@pytest.mark.parametrize(("preset", "name"), EVERY)
def test_kicad_finds_no_fault(
    boards: Boards, kicad: Callable[..., str], tmp_path: Path, preset: str, name: str
) -> None:
    board = boards(preset) / "boards" / name / f"{name}.kicad_pcb"
    report = tmp_path / "drc.json"
    kicad(
        "kicad-cli",
        "pcb",
        "drc",
        "--severity-all",
        "--schematic-parity",
        "--format",
        "json",
        "-o",
        report,
        board,
    )
    report_of = json.loads(report.read_text())
    assert report_of["unconnected_items"] == []
    assert report_of["schematic_parity"] == []
    assert {v["type"] for v in report_of["violations"]} <= set(ALLOWED), report_of["violations"][:3]


@pytest.mark.parametrize(("preset", "name"), ALL)
def test_kicad_finds_no_error_by_its_default_rules(
    boards: Boards, kicad: Callable[..., str], tmp_path: Path, preset: str, name: str
) -> None:
    """Without the project file KiCad takes the rules that it ships with: 0.5 mm to the edge, two
    spokes, gaps and tracks of 0.2 mm. Finer boards keep their own gaps and tracks."""
    board = Path(shutil.copy(boards(preset) / "boards" / name / f"{name}.kicad_pcb", tmp_path))
    report = tmp_path / "drc.json"
    kicad(
        *("kicad-cli", "pcb", "drc", "--severity-error", "--format", "json"),
        *("-o", report, board),
    )
    report_of = json.loads(report.read_text())
    assert report_of["unconnected_items"] == []
    rules = rules_of(read_design(boards(preset) / "design.json"), name)
    for violation in report_of["violations"]:
        assert violation["type"] in FINER, violation
        found = re.search(r"([\d.]+) mm; actual ([\d.]+) mm", violation["description"])
        assert found, violation
        own = getattr(rules, FINER[violation["type"]])
        assert own < float(found[1]), "the design asks for no finer one"
        assert float(found[2]) >= own - ROUNDED_MM, violation


@pytest.mark.parametrize(("preset", "name"), EVERY)
def test_gerbers_paint_what_kicad_plots(
    boards: Boards, kicad: Callable[..., str], tmp_path: Path, preset: str, name: str
) -> None:
    folder = boards(preset) / "boards" / name
    kicad(
        "kicad-cli",
        "pcb",
        "export",
        "gerbers",
        "--layers",
        "F.Cu,B.Cu,F.Mask,B.Mask,F.Paste,B.Paste,F.SilkS,B.SilkS,Edge.Cuts",
        "--use-drill-file-origin",
        "--precision",
        "6",
        "--no-protel-ext",
        "-o",
        f"{tmp_path}/",
        folder / f"{name}.kicad_pcb",
    )
    package = zipfile.ZipFile(folder / "order" / f"generic_{name}.zip")
    ours = {n: gerber_area(package.read(f"{name}-{n}.gbr").decode()) for n in LAYERS}
    plotted = {n: gerber_area((tmp_path / f"{name}-{n}.gbr").read_text()) for n in LAYERS}
    copper = plotted["F_Cu"].area + plotted["B_Cu"].area
    apart = {n: ours[n].symmetric_difference(plotted[n]).area / copper for n in LAYERS}
    assert max(apart.values()) < 0.001, apart
    assert {n for n in LAYERS if ours[n].area} == {n for n in LAYERS if plotted[n].area}
    bare = {"B_Paste", "F_Paste"} if name == "breakout" else {"B_Paste"}  # all parts have leads
    assert {n for n in LAYERS if not ours[n].area} <= bare


# KiCad's Python module now and then crashes when the interpreter takes its objects down in whatever
# order: the process leaves before that, with the board saved.
REFILL = """
import os
import sys
import pcbnew
board = pcbnew.LoadBoard(sys.argv[1])
pcbnew.ZONE_FILLER(board).Fill(board.Zones())
board.Save(sys.argv[2])
os._exit(0)
"""


@pytest.mark.parametrize(("preset", "name"), EVERY)
def test_the_written_fill_is_what_kicad_fills(
    boards: Boards, kicad: Callable[..., str], tmp_path: Path, preset: str, name: str
) -> None:
    written = boards(preset) / "boards" / name / f"{name}.kicad_pcb"
    shutil.copy(written.with_suffix(".kicad_pro"), tmp_path / "again.kicad_pro")
    shutil.copy(written, tmp_path / "again.kicad_pcb")
    refilled = tmp_path / "refilled.kicad_pcb"
    kicad(SYSTEM_PYTHON, "-c", REFILL, tmp_path / "again.kicad_pcb", refilled)
    ours, theirs = read_board(written), read_board(refilled)
    for layer in ours.layers:
        pads = shapely.union_all(
            [
                t.copper.area
                for part in ours.parts
                for t in part.terminals
                if t.copper is not None and layer in t.copper.layers
            ]
        )
        areas = [
            shapely.union_all([p.area for p in b.loose if p.kind == "fill" and layer in p.layers])
            - pads  # which KiCad's bridges cross from end to end
            for b in (ours, theirs)
        ]
        # No copper where KiCad has none, and nearly all that it has.
        assert (areas[0] - areas[1]).area < 0.001 * areas[1].area, layer
        missing = MISSING_SHARE.get(preset, MISSING_SHARE_ELSEWHERE)
        assert (areas[1] - areas[0]).area < missing * areas[1].area, layer


@pytest.mark.parametrize(
    ("preset", "name"), [*(("small", name) for name in AUXILIARY_BOARDS), MODULE]
)
def test_kicad_finds_no_fault_in_an_auxiliary_boards_schematic(
    boards: Boards, kicad: Callable[..., str], tmp_path: Path, preset: str, name: str
) -> None:
    sheet = boards(preset) / "boards" / name / f"{name}.kicad_sch"
    report = tmp_path / "erc.json"
    kicad("kicad-cli", "sch", "erc", "--severity-all", "--format", "json", "-o", report, sheet)
    report_of = json.loads(report.read_text())
    assert [v for page in report_of["sheets"] for v in page["violations"]] == []


def test_a_broken_rule_is_found(damaged_boards: Path, kicad: Callable[..., str]) -> None:
    """The rules reach KiCad: a narrow track in the file is a fault in its report."""
    board = damaged_boards / "boards" / "emitter" / "emitter.kicad_pcb"
    text = board.read_text()
    board.write_text(text.replace("(width 0.25) (layer", "(width 0.15) (layer", 1))
    report = damaged_boards / "drc.json"
    kicad("kicad-cli", "pcb", "drc", "--severity-all", "--format", "json", "-o", report, board)
    assert "track_width" in {v["type"] for v in json.loads(report.read_text())["violations"]}


def test_net_classes_reach_kicad(boards: Boards, kicad: Callable[..., str]) -> None:
    board = boards("small") / "boards" / "receiver" / "receiver.kicad_pcb"
    code = (
        "import os, sys, pcbnew; nets = pcbnew.LoadBoard(sys.argv[1]).GetNetInfo().NetsByName(); "
        "print({str(n): net.GetNetClassName() for n, net in nets.items()}, flush=True); "
        "os._exit(0)"
    )
    printed = kicad(SYSTEM_PYTHON, "-c", code, board)
    assert "'3V3': 'supply'" in printed
    assert "'Q1': 'signal'" in printed
