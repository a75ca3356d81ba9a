"""A further board needs its components alone: files and checks follow."""

import dataclasses
from collections.abc import Callable
from pathlib import Path

import pytest

from damages import failing
from lumitip_fab.boards.files import board_files
from lumitip_fab.derive.boards.connectors import NARROW
from lumitip_fab.design import AuxiliaryBoard, Box, Design, Tie
from lumitip_fab.design.components import wires
from lumitip_fab.design.encoding import design_text

pytestmark = pytest.mark.slow
SIGNALS = ("GND", "5V", "SDA", "SCL")
JOINT = AuxiliaryBoard(
    name="joint",
    title="cable joint",
    title_at=(0.0, 0.0),
    box=Box(-12.0, 12.0, -10.0, 10.0),
    corner_mm=1.0,
    holes=((-9.0, 0.0), (9.0, 0.0)),
    hole_mm=2.2,
    ties=(
        Tie("J1", ((-5.0, -6.0), (5.0, -6.0)), 1.6, 1.0),
        Tie("J2", ((-5.0, 6.0), (5.0, 6.0)), 1.6, 1.0),
    ),
    components=(
        wires("J1", SIGNALS, NARROW, (0.0, -6.0)),
        wires("J2", SIGNALS, NARROW, (0.0, 6.0)),
    ),
    notes=(),
    supplies=("GND", "5V"),
    keep_outs=(),
    hot_loop=(),
)


def test_a_board_of_wire_pads_alone_is_made_and_passes(
    designs: Callable[[str], Design], tmp_path: Path
) -> None:
    design = dataclasses.replace(designs("small"), auxiliary_boards=(JOINT,))
    for artefact in board_files(design, JOINT):
        path = tmp_path / artefact.path
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(artefact.data)
    (tmp_path / "design.json").write_text(design_text(design), encoding="utf-8")
    assert failing(tmp_path, "board", "joint") == set()
    assert failing(tmp_path, "orders", "joint") == set()
    file = tmp_path / "boards/joint/joint.kicad_pcb"
    text = file.read_text(encoding="utf-8")
    track = text.index("(segment ")
    file.write_text(text[:track] + text[text.index("\n", track) :], encoding="utf-8")
    assert "open" in failing(tmp_path, "board", "joint")
