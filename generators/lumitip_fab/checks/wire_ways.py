"""The ways of a finger's wires, from the boards that they join."""

import numpy as np

from lumitip_fab.checks.cables import Row
from lumitip_fab.checks.readers.kicad_board import KicadBoard
from lumitip_fab.design import Design
from lumitip_fab.design.frames import applied, board_page_to_sensor


def run_mm(row: Row, breakout: KicadBoard | None, design: Design) -> float:
    """Way of a finger's wire along the gripper: the breakout's wire pads for the receiver, J5, face
    the fingers."""
    if row.end[0] == "supply":
        return design.cabling.supply_mm
    if breakout is None or row.end[0] != "breakout":
        return design.cabling.controller_mm
    near, end = (
        float(np.mean([t.at[1] for p in breakout.parts if p.ref == ref for t in p.terminals]))
        for ref in ("J5", row.end[1].partition(".")[0])
    )
    return design.cabling.controller_mm + abs(near - end)


def reach_mm(board: KicadBoard, design: Design) -> float:
    """From the farthest pad of a finger's wires to the middle of its gripper end."""
    pads = np.array([t.at for p in board.parts if p.ref == "J1" for t in p.terminals])
    places = applied(board_page_to_sensor(design.stack), pads)[:, :2]
    return float((abs(places[:, 0]) + places[:, 1]).max() - design.outline.end_y_mm)
