"""Boards with their panels, for the tests of the panels' checks."""

import shutil
from pathlib import Path

from lumitip_fab.boards.files import board_files
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design.encoding import design_text

NAMES = ("receiver", "flange")
"""One with cells, and one with headers that reach over its edges and with parts on both sides."""
PANELLED = """\
extends = "published.toml"
name = "Panelled"
[grid]
columns = [3, 2, 3, 2, 3]
[board]
tip_margin_mm = 4.6
panel = "rails"
[supply]
voltage_v = 12.0
[emitter]
current_ma = 12.0
"""


def write_panelled(design_folder: Path, out: Path) -> None:
    """Write the receiver's and the flange's board of a small design, each with its panel."""
    shutil.copytree(design_folder, out / "design")
    file = out / "design" / "presets" / "panelled.toml"
    file.write_text(PANELLED, encoding="utf-8")
    design = derive(load(file))
    (out / "design.json").write_text(design_text(design), encoding="utf-8")
    for board in (*design.fingers, *design.auxiliary_boards):
        for artefact in board_files(design, board) if board.name in NAMES else ():
            path = out / artefact.path
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(artefact.data)
