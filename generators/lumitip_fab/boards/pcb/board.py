"""The whole `.kicad_pcb`."""

from collections.abc import Iterator

from lumitip_fab.boards.model import BoardModel, Placement
from lumitip_fab.boards.openings import MASK_MM
from lumitip_fab.boards.pcb.copper import keep_outs, tracks, vias, zones
from lumitip_fab.boards.pcb.drawing import edges, silkscreen
from lumitip_fab.boards.pcb.flexible import FLEX_LAYERS, regions, stack_up
from lumitip_fab.boards.pcb.footprint import hole_footprint, placed_footprint
from lumitip_fab.boards.pcb.sexpr import FORMAT, Node, Quoted, written
from lumitip_fab.frames import BOARD_ON_PAGE_MM

_LAYERS = (
    (0, "F.Cu", "signal", ""), (31, "B.Cu", "signal", ""),
    (32, "B.Adhes", "user", "B.Adhesive"), (33, "F.Adhes", "user", "F.Adhesive"),
    (34, "B.Paste", "user", ""), (35, "F.Paste", "user", ""),
    (36, "B.SilkS", "user", "B.Silkscreen"), (37, "F.SilkS", "user", "F.Silkscreen"),
    (38, "B.Mask", "user", ""), (39, "F.Mask", "user", ""),
    (44, "Edge.Cuts", "user", ""), (45, "Margin", "user", ""),
    (46, "B.CrtYd", "user", "B.Courtyard"), (47, "F.CrtYd", "user", "F.Courtyard"),
    (48, "B.Fab", "user", ""), (49, "F.Fab", "user", ""),
)  # fmt: skip


def board_file(model: BoardModel, thickness_mm: float) -> bytes:
    """The board as KiCad opens it: routed, poured, ready to plot.

    Args:
        model: the finished board.
        thickness_mm: of the finished board.
    """
    return written(("kicad_pcb", *_contents(model, thickness_mm))).encode()


def _contents(model: BoardModel, thickness_mm: float) -> Iterator[Node]:
    board = model.placement
    numbers = {net.name: number for number, net in enumerate(board.nets, start=1)}
    yield ("version", FORMAT)
    yield ("generator", "lumitip")
    yield ("general", ("thickness", thickness_mm))
    yield ("paper", Quoted("A4"))
    yield _title(board)
    more = FLEX_LAYERS if board.flexible else ()
    yield ("layers", *(_layer(*layer) for layer in (*_LAYERS, *more)))
    yield (
        "setup", *([stack_up(board.flexible)] if board.flexible else []),
        ("pad_to_mask_clearance", MASK_MM), ("aux_axis_origin", *BOARD_ON_PAGE_MM),
        ("grid_origin", *BOARD_ON_PAGE_MM),
    )  # fmt: skip
    yield ("net", 0, Quoted(""))
    yield from (("net", number, Quoted(name)) for name, number in numbers.items())
    yield from (placed_footprint(c, numbers, board.finger) for c in board.components)
    for number, at in enumerate(board.holes, start=1):
        yield hole_footprint(number, at, board.hole_mm, board.finger)
    yield from edges(board)
    yield from silkscreen(board)
    if board.flexible:
        yield from regions(board, board.flexible)
    yield from tracks(model, numbers)
    yield from vias(model, numbers)
    yield from zones(model, numbers)
    yield from keep_outs(model)


def _title(board: Placement) -> Node:
    return (
        "title_block", ("title", Quoted(board.name)), ("rev", Quoted(board.revision)),
        ("comment", 1, Quoted(f"Design {board.design_hash}")),
        ("comment", 2, Quoted(f"{board.finger} board, seen from its front with the tip up")),
    )  # fmt: skip


def _layer(number: int, name: str, kind: str, shown: str) -> Node:
    told = (Quoted(shown),) if shown else ()
    return (str(number), Quoted(name), kind, *told)
