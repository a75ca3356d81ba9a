"""How far the greatest current warms the tracks of supplies."""

import math
from collections.abc import Iterator

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import AuxiliaryBoard, Design
from lumitip_fab.design.board_rules import rules_of
from lumitip_fab.design.cabling import INPUT_END
from lumitip_fab.design.gripper_cable import gripper_cable, sensor_a
from lumitip_fab.design.warming import MOST_K, warming_k

_ROUND_K = 0.01  # a limit of current is computed from this very limit of temperature


def measure_warming(read: ReadBoard) -> Iterator[Measurement]:
    """The warmest track of a supply, as if it carried all that its net does. The supply before the
    fuse feeds the gripper too, where the headers offer it."""
    board = read.auxiliary
    if board is None:
        return
    cables, beside_a = read.design.cabling.cables, _gripper_a(read.design, board)
    found = [(-math.inf, "no track")]
    for piece in read.board.loose:
        if piece.kind == "track" and piece.net in board.supplies and piece.net != "GND":
            amps = sensor_a(cables) + beside_a * piece.net.endswith(INPUT_END)
            warm = warming_k(amps, piece.width_mm, board.finish.copper_um)
            found.append((warm, f"{piece.net}: {amps:.2f} A in {piece.width_mm:g} mm"))
    worst, note = max(found)
    if worst > 0:
        yield read.figure("warming", worst, 0, MOST_K + _ROUND_K, "K", f"{note}, by IPC-2221")


def _gripper_a(design: Design, board: AuxiliaryBoard) -> float:
    """What the gripper draws over a board: all that is offered, where its current is not known."""
    if board.name != "flange":
        return 0.0
    (flange,) = design.flanges
    gripper_a, width_mm = design.mount.supply_a, rules_of(design, board.name).supply_track_mm
    cables = design.cabling.cables
    offered = gripper_cable([board], cables, gripper_a, width_mm, flange.contact_a)
    return (gripper_a or offered.most_a) if offered.feeds else 0.0
