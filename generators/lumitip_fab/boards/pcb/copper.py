"""Tracks, vias and filled zones of a board file."""

from collections.abc import Iterator

from lumitip_fab.boards.contours import fractured
from lumitip_fab.boards.ids import stable_uuid
from lumitip_fab.boards.model import SIDES, BoardModel, Side
from lumitip_fab.boards.pcb.sexpr import Node, Quoted
from lumitip_fab.boards.pour_rules import (
    CLEARANCE_MM,
    MIN_WIDTH_MM,
    THERMAL_GAP_MM,
    THERMAL_SPOKE_MM,
)
from lumitip_fab.design import Box, Point
from lumitip_fab.frames import on_board_page

COPPER = {"front": "F.Cu", "back": "B.Cu"}


def tracks(model: BoardModel, numbers: dict[str, int]) -> Iterator[Node]:
    """Every piece of track."""
    for count, track in enumerate(model.routing.tracks):
        yield (
            "segment", ("start", *on_board_page(track.start)), ("end", *on_board_page(track.end)),
            ("width", track.width_mm), ("layer", Quoted(COPPER[track.side])),
            ("net", numbers[track.net]),
            ("tstamp", stable_uuid(model.placement.finger, "track", str(count))),
        )  # fmt: skip


def vias(model: BoardModel, numbers: dict[str, int]) -> Iterator[Node]:
    """Every via."""
    for count, via in enumerate(model.routing.vias):
        yield (
            "via", ("at", *on_board_page((via.x_mm, via.y_mm))), ("size", via.diameter_mm),
            ("drill", via.drill_mm), ("layers", Quoted("F.Cu"), Quoted("B.Cu")),
            ("net", numbers[via.net]),
            ("tstamp", stable_uuid(model.placement.finger, "via", str(count))),
        )  # fmt: skip


def zones(model: BoardModel, numbers: dict[str, int]) -> Iterator[Node]:
    """The pour of each side: the whole board as its outline, and filled as it will be."""
    for side in SIDES:
        if any(fill.side == side for fill in model.fills):
            yield _zone(model, numbers, side)


def _zone(model: BoardModel, numbers: dict[str, int], side: Side) -> Node:
    board, layer = model.placement, ("layer", Quoted(COPPER[side]))
    return (
        "zone", ("net", numbers[board.ground]), ("net_name", Quoted(board.ground)), layer,
        ("tstamp", stable_uuid(board.finger, "zone", side)), ("hatch", "edge", 0.5),
        ("connect_pads", ("clearance", CLEARANCE_MM)), ("min_thickness", MIN_WIDTH_MM),
        ("filled_areas_thickness", "no"),
        (
            "fill", "yes", ("thermal_gap", THERMAL_GAP_MM),
            ("thermal_bridge_width", THERMAL_SPOKE_MM),
        ),
        ("polygon", _points(_corners(board.outline))),
        *(
            ("filled_polygon", layer, _points(fractured(fill.area)))
            for fill in model.fills
            if fill.side == side
        ),
    )  # fmt: skip


def keep_outs(model: BoardModel) -> Iterator[Node]:
    """Areas of both sides that KiCad keeps free of copper."""
    board = model.placement
    for count, box in enumerate(board.keep_outs):
        yield (
            "zone", ("net", 0), ("net_name", Quoted("")),
            ("layers", *(Quoted(COPPER[side]) for side in SIDES)),
            ("tstamp", stable_uuid(board.finger, "keep-out", str(count))), ("hatch", "edge", 0.5),
            ("connect_pads", ("clearance", 0)), ("min_thickness", MIN_WIDTH_MM),
            ("keepout", ("tracks", "not_allowed"), ("vias", "not_allowed"), ("pads", "not_allowed"),
             ("copperpour", "not_allowed"), ("footprints", "allowed")),
            ("fill", ("thermal_gap", THERMAL_GAP_MM),
             ("thermal_bridge_width", THERMAL_SPOKE_MM)),
            ("polygon", _points(_corners(box))),
        )  # fmt: skip


def _corners(box: Box) -> tuple[Point, ...]:
    return ((box.x_min_mm, box.y_min_mm), (box.x_max_mm, box.y_min_mm),
            (box.x_max_mm, box.y_max_mm), (box.x_min_mm, box.y_max_mm))  # fmt: skip


def _points(corners: tuple[Point, ...]) -> Node:
    return ("pts", *(("xy", *on_board_page(corner)) for corner in corners))
