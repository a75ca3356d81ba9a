"""The Excellon drill files of a board: plated and unplated holes apart."""

from collections.abc import Iterable

from gerbonara.apertures import ExcellonTool
from gerbonara.cam import FileSettings
from gerbonara.excellon import ExcellonFile
from gerbonara.graphic_objects import Flash
from gerbonara.utils import MM

from lumitip_fab.boards.geometry import placed_pads
from lumitip_fab.boards.model import BoardModel
from lumitip_fab.design import Point

_FORMAT = (3, 4)  # digits before and after the point, which is written
Hole = tuple[Point, float]
"""Middle and finished diameter (mm)."""


def plated_drills(model: BoardModel) -> bytes:
    """Vias and the connector's holes."""
    vias = [((via.x_mm, via.y_mm), via.drill_mm) for via in model.routing.vias]
    pads = [
        ((pad.x_mm, pad.y_mm), pad.pad.drill_mm)
        for part in model.placement.components
        for pad in placed_pads(part)
        if pad.pad.drill_mm
    ]
    return _excellon([*vias, *pads], "Plated,1,2,PTH", plated=True)


def unplated_drills(model: BoardModel) -> bytes:
    """The holes for the locating pins."""
    board = model.placement
    holes = [(at, board.hole_mm) for at in board.holes]
    return _excellon(holes, "NonPlated,1,2,NPTH", plated=False)


def _excellon(holes: Iterable[Hole], function: str, plated: bool) -> bytes:
    """The holes by size, then from left to right."""
    drilled = [
        Flash(*at, ExcellonTool(size, plated, unit=MM), unit=MM, polarity_dark=True)
        for at, size in sorted(holes, key=lambda hole: (hole[1], hole[0]))
    ]
    settings = FileSettings(unit=MM, notation="absolute", number_format=_FORMAT)
    data: bytes = ExcellonFile(objects=drilled).write_to_bytes(settings)
    return data.replace(b"M48\n", f"M48\n; #@! TF.FileFunction,{function}\n".encode(), 1) + b"\n"
