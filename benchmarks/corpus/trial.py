"""A random design's two boards: placed, routed, and judged by our rules and by KiCad's."""

import json
import os
import subprocess
import tempfile
import time
import traceback
from dataclasses import dataclass
from pathlib import Path

from acceptance.trial import Refusal
from lumitip_fab.boards.fab.picture import picture_files
from lumitip_fab.boards.files import finished
from lumitip_fab.boards.kicad.project import project_files
from lumitip_fab.boards.model import BoardModel, Placement
from lumitip_fab.boards.placement import place
from lumitip_fab.boards.verify import verify
from lumitip_fab.config.load import load
from lumitip_fab.derive import derive
from lumitip_fab.design import Design, Finger
from lumitip_fab.errors import BuildError, InputError

STOCK_MM, STOCK_VIA_MM = 0.2, 0.5
"""Gap and via of the rules that KiCad ships with."""
FINER = {"clearance", "copper_edge_clearance", "drill_out_of_range", "via_diameter"}
"""What KiCad's own rules say of copper that is finer on purpose."""
CRASHES = 3
"""KiCad's own crashes are rare and come at random: it is run again."""


@dataclass(frozen=True)
class Board:
    """One board of a design."""

    name: str
    cells: int
    seconds: float
    """To place and route it, and to pour its ground."""
    unrouted: str = ""
    """Why it has no copper, in words."""
    vias: int = 0
    faults: tuple[str, ...] = ()
    """Broken rules, ours and KiCad's."""
    picture: bytes = b""
    """Its back, as PNG."""


@dataclass(frozen=True)
class Trial:
    """Both boards of a design, or why there are none."""

    name: str
    boards: tuple[Board, ...] = ()
    refusals: tuple[Refusal, ...] = ()
    crash: str = ""


def try_boards(file: Path, kicad: bool) -> Trial:
    """Derive a user file, and make the boards of both fingers.

    Args:
        file: the user file.
        kicad: whether KiCad reads the boards, too.
    """
    try:
        design = derive(load(file))
        return Trial(file.stem, tuple(_board(design, f, file, kicad) for f in design.fingers))
    except InputError as error:
        refusals = tuple(Refusal(p.field, p.message) for p in error.problems)
        return Trial(file.stem, refusals=refusals)
    except Exception:  # noqa: BLE001 - whatever it is, it is what is counted
        return Trial(file.stem, crash=traceback.format_exc())


def _board(design: Design, finger: Finger, file: Path, kicad: bool) -> Board:
    name, cells, begun = f"{file.stem} {finger.name}", len(design.layout), time.process_time()
    try:
        model = finished(place(design, finger))
    except BuildError as error:
        return Board(name, cells, time.process_time() - begun, unrouted=str(error))
    seconds = time.process_time() - begun
    faults = tuple(f"{fault.rule} {' '.join(fault.nets)}" for fault in verify(model))
    if kicad:
        faults += stock_errors(model, design.stack.pcb_mm)
    pictures = picture_files(model, finger.finish.mask)
    back = next(data for path, data in pictures.items() if path.endswith("back.png"))
    return Board(name, cells, seconds, "", len(model.routing.vias), faults, back)


def stock_errors(model: BoardModel, thickness_mm: float) -> tuple[str, ...]:
    """Errors that KiCad finds in a board by the rules that it ships with, each kind once."""
    board = model.placement
    path = f"{board.name}.kicad_pcb"
    with tempfile.TemporaryDirectory(prefix="corpus") as folder:
        file, report = Path(folder) / path, Path(folder) / "drc.json"
        # Without its project file KiCad takes its own rules.
        file.write_bytes(project_files(model, thickness_mm)[path])
        command = ["kicad-cli", "pcb", "drc", "--severity-error", "--format", "json"]
        for _ in range(CRASHES):
            done = subprocess.run(
                [*command, "-o", str(report), str(file)],
                env={**os.environ, "HOME": folder, "XDG_CONFIG_HOME": folder},
                capture_output=True,
                text=True,
                check=False,
            )
            if done.returncode >= 0:
                break
        if done.returncode:
            return (f"kicad-cli: {done.stderr.strip()}",)
        told = json.loads(report.read_text(encoding="utf-8"))
    fine = FINER if _fine(board) else set()
    kinds = sorted({fault["type"] for fault in told["violations"]} - fine)
    unjoined = ["unconnected"] if told["unconnected_items"] else []
    return tuple(f"kicad {kind}" for kind in (*kinds, *unjoined))


def _fine(board: Placement) -> bool:
    return any(c.clearance_mm < STOCK_MM or c.via_mm < STOCK_VIA_MM for c in board.classes)
