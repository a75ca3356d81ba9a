"""Panels as files: their orders, damaged and whole, and KiCad's own rules."""

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from board_damages import rezip
from damages import cut_short, failing
from programs import needs

pytestmark = pytest.mark.slow

NAME = "receiver_panel"


@pytest.fixture
def hurt(panelled: Path, tmp_path: Path) -> Path:
    """A copy of the boards with panels, to damage."""
    return Path(shutil.copytree(panelled, tmp_path / "hurt"))


def tab_not_routed(files: dict[str, bytes]) -> None:
    (name,) = (n for n in files if n.endswith("Edge_Cuts.gbr"))
    files[name] = files[name].replace(b"D01*", b"D02*", 20)


def fiducials_covered(files: dict[str, bytes]) -> None:
    (name,) = (n for n in files if n.endswith("F_Mask.gbr"))
    files[name], count = re.subn(rb"(%ADD\d+C,)2\.0\*", rb"\g<1>1.2*", files[name])
    assert count


@pytest.mark.parametrize(
    ("damage", "expected"),
    [(tab_not_routed, {"profile"}), (fiducials_covered, {"fiducial_opening"})],
    ids=["profile", "mask"],
)
def test_a_damage_of_an_order(damage: Callable[..., None], expected: set[str], hurt: Path) -> None:
    rezip(hurt / "boards" / NAME / "order" / f"generic_{NAME}.zip", damage)
    assert failing(hurt, "panels", NAME) == expected


def test_a_placement_list_without_a_copy(hurt: Path) -> None:
    def damage(files: dict[str, bytes]) -> None:
        (name,) = (n for n in files if n.endswith("_positions.csv"))
        files[name] = re.sub(rb"\w+_4,.*\r\n", b"", files[name])

    rezip(hurt / "boards" / NAME / "order" / f"generic_{NAME}.zip", damage)
    assert failing(hurt, "orders", NAME) == {"placed", "tables"}


def test_a_panel_that_cannot_be_read(hurt: Path) -> None:
    cut_short(hurt / "boards" / NAME / f"{NAME}.kicad_pcb")
    assert failing(hurt, "panels", NAME) == {"readable"}
    assert failing(hurt, "orders", NAME) == {"board"}


@pytest.mark.parametrize("name", ["receiver_panel", "flange_panel"])
def test_a_panel_passes_every_check(name: str, panelled: Path) -> None:
    assert failing(panelled, "panels", name) == set()
    assert failing(panelled, "orders", name) == set()


@needs("kicad-cli")
@pytest.mark.parametrize("stock", [False, True], ids=["project", "stock"])
@pytest.mark.parametrize("name", ["receiver_panel", "flange_panel"])
def test_kicad_finds_no_fault_in_a_panel(
    panelled: Path, kicad: Callable[..., str], tmp_path: Path, name: str, stock: bool
) -> None:
    """By the rules of its project, and by those that KiCad ships with."""
    board, report = panelled / "boards" / name / f"{name}.kicad_pcb", tmp_path / "drc.json"
    if stock:
        board = Path(shutil.copy(board, tmp_path))
    severity = "--severity-error" if stock else "--severity-all"
    kicad("kicad-cli", "pcb", "drc", severity, "--format", "json", "-o", report, board)
    found = json.loads(report.read_text())
    assert (found["unconnected_items"], found["violations"]) == ([], [])
