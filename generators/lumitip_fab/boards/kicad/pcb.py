"""The `.kicad_pcb` of a board: outline, silkscreen, copper, zones, and the stack-up of flexible
boards."""

from collections.abc import Iterator

from lumitip_fab.boards.kicad import nodes, sexpr
from lumitip_fab.boards.kicad.footprint import effects, hole_footprint, placed_footprint
from lumitip_fab.boards.model import (
    CLEARANCE_MM,
    MASK_MM,
    MIN_WIDTH_MM,
    SIDES,
    THERMAL_GAP_MM,
    THERMAL_SPOKE_MM,
    BoardModel,
    Fill,
    Placement,
    stable_uuid,
)
from lumitip_fab.boards.outline import EDGE_MM, corners, fractured, straight_edges
from lumitip_fab.boards.silk.strokes import upright
from lumitip_fab.design import Box, Point
from lumitip_fab.design.frames import BOARD_ON_PAGE_MM, on_board_page
from lumitip_fab.text import table_of

COPPER = {"front": "F.Cu", "back": "B.Cu"}


def tracks(model: BoardModel, numbers: dict[str, int]) -> Iterator[sexpr.Node]:
    """Every piece of track."""
    for count, track in enumerate(model.routing.tracks):
        yield (
            "segment",
            ("start", *on_board_page(track.start)),
            ("end", *on_board_page(track.end)),
            ("width", track.width_mm),
            ("layer", sexpr.Quoted(COPPER[track.side])),
            ("net", numbers[track.net]),
            ("tstamp", stable_uuid(model.placement.name, "track", str(count))),
        )


def vias(model: BoardModel, numbers: dict[str, int]) -> Iterator[sexpr.Node]:
    """Every via."""
    for count, via in enumerate(model.routing.vias):
        yield (
            "via",
            ("at", *on_board_page((via.x_mm, via.y_mm))),
            ("size", via.diameter_mm),
            ("drill", via.drill_mm),
            ("layers", sexpr.Quoted("F.Cu"), sexpr.Quoted("B.Cu")),
            ("net", numbers[via.net]),
            ("tstamp", stable_uuid(model.placement.name, "via", str(count))),
        )


def zones(model: BoardModel, numbers: dict[str, int]) -> Iterator[sexpr.Node]:
    """The pour of each side: the whole board as its outline, and filled as it will be."""
    for net, outline in model.placement.poured:
        for side in SIDES:
            fills = tuple(f for f in model.fills if (f.side, f.net) == (side, net))
            if fills:
                yield _zone(model.placement, numbers, outline, fills)


def _zone(
    board: Placement, numbers: dict[str, int], outline: Box, fills: tuple[Fill, ...]
) -> sexpr.Node:
    net, side = fills[0].net, fills[0].side
    layer, copy = ("layer", sexpr.Quoted(COPPER[side])), (net,) if board.pours else ()
    return (
        "zone",
        ("net", numbers[net]),
        ("net_name", sexpr.Quoted(net)),
        layer,
        ("tstamp", stable_uuid(board.name, "zone", side, *copy)),
        ("hatch", "edge", 0.5),
        ("connect_pads", ("clearance", CLEARANCE_MM)),
        ("min_thickness", MIN_WIDTH_MM),
        ("filled_areas_thickness", "no"),
        (
            "fill",
            "yes",
            ("thermal_gap", THERMAL_GAP_MM),
            ("thermal_bridge_width", THERMAL_SPOKE_MM),
        ),
        ("polygon", _points(_corners(outline))),
        *(("filled_polygon", layer, _points(fractured(fill.area))) for fill in fills),
    )


def keep_outs(model: BoardModel) -> Iterator[sexpr.Node]:
    """Areas of both sides that KiCad keeps free of copper."""
    board = model.placement
    for count, box in enumerate(board.keep_outs):
        yield (
            "zone",
            ("net", 0),
            ("net_name", sexpr.Quoted("")),
            ("layers", *(sexpr.Quoted(COPPER[side]) for side in SIDES)),
            ("tstamp", stable_uuid(board.name, "keep-out", str(count))),
            ("hatch", "edge", 0.5),
            ("connect_pads", ("clearance", 0)),
            ("min_thickness", MIN_WIDTH_MM),
            (
                "keepout",
                ("tracks", "not_allowed"),
                ("vias", "not_allowed"),
                ("pads", "not_allowed"),
                ("copperpour", "not_allowed"),
                ("footprints", "allowed"),
            ),
            ("fill", ("thermal_gap", THERMAL_GAP_MM), ("thermal_bridge_width", THERMAL_SPOKE_MM)),
            ("polygon", _points(_corners(box))),
        )


def _corners(box: Box) -> tuple[Point, ...]:
    return (
        (box.x_min_mm, box.y_min_mm),
        (box.x_max_mm, box.y_min_mm),
        (box.x_max_mm, box.y_max_mm),
        (box.x_min_mm, box.y_max_mm),
    )


def _points(corners: tuple[Point, ...]) -> sexpr.Node:
    return ("pts", *(("xy", *on_board_page(corner)) for corner in corners))


_SILK = {"front": "F.SilkS", "back": "B.SilkS"}


def edges(board: Placement) -> Iterator[sexpr.Node]:
    """The outline: four straight lines, and an arc at each corner if they are round."""
    for count, (start, end) in enumerate(straight_edges(board)):
        yield _edge(board, f"side{count}", "gr_line", ("start", start), ("end", end))
    for count, bow in enumerate(corners(board)):
        ends = ("start", bow.start), ("mid", bow.middle), ("end", bow.end)
        yield _edge(board, f"corner{count}", "gr_arc", *ends)


def silkscreen(board: Placement) -> Iterator[sexpr.Node]:
    """Silkscreen outside the footprints."""
    count = 0
    for side, stroke in board.silk:
        for start, end in zip(stroke.points, stroke.points[1:], strict=False):
            count += 1
            yield (
                "gr_line",
                ("start", *on_board_page(start)),
                ("end", *on_board_page(end)),
                ("layer", sexpr.Quoted(_SILK[side])),
                ("width", stroke.width_mm),
                ("tstamp", stable_uuid(board.name, "silk", str(count))),
            )
    for number, (side, text) in enumerate(board.texts):
        at = on_board_page((text.x_mm, text.y_mm))
        yield (
            "gr_text",
            sexpr.Quoted(text.text),
            ("at", *at, upright(text.angle_deg, side)),
            ("layer", sexpr.Quoted(_SILK[side])),
            ("tstamp", stable_uuid(board.name, "text", str(number))),
            effects(text, side == "back"),
        )


def _edge(board: Placement, name: str, keyword: str, *points: tuple[str, Point]) -> sexpr.Node:
    return (
        keyword,
        *((where, *on_board_page(at)) for where, at in points),
        ("layer", sexpr.Quoted("Edge.Cuts")),
        ("width", EDGE_MM),
        ("tstamp", stable_uuid(board.name, "edge", name)),
    )


def board_file(model: BoardModel, thickness_mm: float) -> bytes:
    """The board as KiCad opens it: routed, poured, ready to plot.

    Args:
        model: the finished board.
        thickness_mm: of the finished board.
    """
    return sexpr.written(("kicad_pcb", *_contents(model, thickness_mm))).encode()


def _contents(model: BoardModel, thickness_mm: float) -> Iterator[sexpr.Node]:
    board = model.placement
    numbers = {net.name: number for number, net in enumerate(board.nets, start=1)}
    yield ("version", sexpr.FORMAT)
    yield ("generator", "lumitip")
    yield ("general", ("thickness", thickness_mm))
    yield ("paper", sexpr.Quoted("A4"))
    yield _title(board)
    more = nodes.FLEX_LAYERS if board.flexible else ()
    yield (
        "layers",
        *(_layer(*layer) for layer in (*table_of("boards/kicad/tables.toml")["layers"], *more)),
    )
    yield (
        "setup",
        *([nodes.stack_up(board.flexible)] if board.flexible else []),
        ("pad_to_mask_clearance", MASK_MM),
        ("aux_axis_origin", *BOARD_ON_PAGE_MM),
        ("grid_origin", *BOARD_ON_PAGE_MM),
    )
    yield ("net", 0, sexpr.Quoted(""))
    yield from (("net", number, sexpr.Quoted(name)) for name, number in numbers.items())
    yield from (placed_footprint(c, numbers, board.name, model.solid) for c in board.components)
    for number, (at, diameter_mm) in enumerate(board.unplated, start=1):
        yield hole_footprint(number, at, diameter_mm, board.name)
    yield from edges(board)
    yield from silkscreen(board)
    if board.flexible:
        yield from nodes.regions(board, board.flexible)
    yield from tracks(model, numbers)
    yield from vias(model, numbers)
    yield from zones(model, numbers)
    yield from keep_outs(model)


def _title(board: Placement) -> sexpr.Node:
    return (
        "title_block",
        ("title", sexpr.Quoted(board.title)),
        ("date", sexpr.Quoted(board.date)),
        ("rev", sexpr.Quoted(board.revision)),
        ("comment", 1, sexpr.Quoted(f"Design {board.design_hash}")),
        ("comment", 2, sexpr.Quoted(f"{board.name} board, seen from its front with the tip up")),
    )


def _layer(number: int, name: str, kind: str, shown: str) -> sexpr.Node:
    shown_as = (sexpr.Quoted(shown),) if shown else ()
    return (str(number), sexpr.Quoted(name), kind, *shown_as)
