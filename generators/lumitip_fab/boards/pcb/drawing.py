"""Outline and silkscreen of a board file."""

from collections.abc import Iterator

from lumitip_fab.boards.edges import EDGE_MM, corners, straight_edges
from lumitip_fab.boards.ids import stable_uuid
from lumitip_fab.boards.model import Placement
from lumitip_fab.boards.pcb.sexpr import Node, Quoted
from lumitip_fab.boards.pcb.text import effects
from lumitip_fab.boards.strokes import upright
from lumitip_fab.design import Point
from lumitip_fab.frames import on_board_page

_SILK = {"front": "F.SilkS", "back": "B.SilkS"}


def edges(board: Placement) -> Iterator[Node]:
    """The outline: four straight lines, and an arc at each corner if they are round."""
    for count, (start, end) in enumerate(straight_edges(board)):
        yield _edge(board, f"side{count}", "gr_line", ("start", start), ("end", end))
    for count, bow in enumerate(corners(board)):
        ends = ("start", bow.start), ("mid", bow.middle), ("end", bow.end)
        yield _edge(board, f"corner{count}", "gr_arc", *ends)


def silkscreen(board: Placement) -> Iterator[Node]:
    """What is printed beyond the footprints' own."""
    count = 0
    for side, stroke in board.silk:
        for start, end in zip(stroke.points, stroke.points[1:], strict=False):
            count += 1
            yield (
                "gr_line", ("start", *on_board_page(start)), ("end", *on_board_page(end)),
                ("layer", Quoted(_SILK[side])), ("width", stroke.width_mm),
                ("tstamp", stable_uuid(board.finger, "silk", str(count))),
            )  # fmt: skip
    for number, (side, text) in enumerate(board.texts):
        at = on_board_page((text.x_mm, text.y_mm))
        yield (
            "gr_text", Quoted(text.text), ("at", *at, upright(text.angle_deg, side)),
            ("layer", Quoted(_SILK[side])),
            ("tstamp", stable_uuid(board.finger, "text", str(number))),
            effects(text, side == "back"),
        )  # fmt: skip


def _edge(board: Placement, name: str, keyword: str, *points: tuple[str, Point]) -> Node:
    return (
        keyword, *((where, *on_board_page(at)) for where, at in points),
        ("layer", Quoted("Edge.Cuts")), ("width", EDGE_MM),
        ("tstamp", stable_uuid(board.finger, "edge", name)),
    )  # fmt: skip
