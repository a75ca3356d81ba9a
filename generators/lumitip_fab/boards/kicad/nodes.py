"""Nodes of a board file beyond copper: bodies, courtyards, 3D models, a flexible board's layers."""

from collections.abc import Iterator

import shapely

from lumitip_fab.boards.kicad.sexpr import Node, Quoted, Value, written
from lumitip_fab.boards.model import (
    PlacedComponent,
    Placement,
    Stroke,
    stable_uuid,
)
from lumitip_fab.boards.silk.names import notch
from lumitip_fab.design import Box, Flexible, Footprint
from lumitip_fab.design.frames import on_board_page
from lumitip_fab.design.pcb import MODELS

_FAB_MM = 0.1
_COURTYARD_MM = 0.05
_FOLDER = f"${{KIPRJMOD}}/../{MODELS.rpartition('/')[2]}"


def body_strokes(shape: Footprint) -> Iterator[Stroke]:
    """The body seen from above; of a box header also the shroud with its notch."""
    yield around(shape.body, _FAB_MM)
    if shape.shroud:
        yield around(shape.shroud.box, _FAB_MM)
        yield from (Stroke(ends, _FAB_MM) for ends in notch(shape.shroud))


def courtyard_strokes(part: PlacedComponent) -> Iterator[Stroke]:
    """The courtyard, with that of the shroud as one outline where they meet: KiCad takes lines
    that cross for a fault."""
    yards = [yard for yard in (part.courtyard, part.shroud_yard) if yard]
    joined = shapely.union_all([shapely.box(*yard.bounds_mm) for yard in yards])
    for area in shapely.get_parts(joined.normalize()):
        yield Stroke(tuple(area.exterior.coords), _COURTYARD_MM)


def around(box: Box, width_mm: float) -> Stroke:
    """A rectangle as a closed polyline."""
    left, right, low, high = box.x_min_mm, box.x_max_mm, box.y_min_mm, box.y_max_mm
    corners = (left, low), (right, low), (right, high), (left, high), (left, low)
    return Stroke(corners, width_mm)


def model(shape: Footprint) -> Iterator[Node]:
    """The 3D model, in the footprint's frame; none of bare copper."""
    if not shape.model:
        return
    yield (
        "model",
        Quoted(f"{_FOLDER}/{shape.model}"),
        ("offset", ("xyz", 0, 0, 0)),
        ("scale", ("xyz", 1, 1, 1)),
        ("rotate", ("xyz", 0, 0, 0)),
    )


FLEX_LAYERS = ((50, "User.1", "user", "Stiffener"), (51, "User.2", "user", "Bend"))
LINE_MM = 0.1
_POLYIMIDE = ("material", Quoted("Polyimide"))


def stack_up(flexible: Flexible) -> Node:
    """The layers from front to back, each with its thickness."""

    def ply(name: str, kind: str, *more: Node) -> Node:
        return ("layer", Quoted(name), ("type", Quoted(kind)), *more)

    def coverlay(name: str, kind: str) -> Node:
        return ply(name, kind, ("thickness", round(flexible.coverlay_mm, 6)), _POLYIMIDE)

    copper = ("thickness", round(flexible.copper_mm, 6))
    return (
        "stackup",
        ply("F.SilkS", "Top Silk Screen"),
        coverlay("F.Mask", "Top Solder Mask"),
        ply("F.Cu", "copper", copper),
        ply(
            "dielectric 1",
            "core",
            ("thickness", round(flexible.core_mm, 6)),
            _POLYIMIDE,
            ("epsilon_r", 3.2),
            ("loss_tangent", 0.004),
        ),
        ply("B.Cu", "copper", copper),
        coverlay("B.Mask", "Bottom Solder Mask"),
        ply("B.SilkS", "Bottom Silk Screen"),
        ("copper_finish", Quoted("ENIG")),
        ("dielectric_constraints", "no"),
    )


def regions(board: Placement, flexible: Flexible) -> Iterator[Node]:
    """Stiffener and bend as rectangles on layers of their own."""
    for (_, layer, _, name), box in zip(
        FLEX_LAYERS, (flexible.stiffener, flexible.bend), strict=True
    ):
        yield (
            "gr_rect",
            ("start", *on_board_page((box.x_min_mm, box.y_max_mm))),
            ("end", *on_board_page((box.x_max_mm, box.y_min_mm))),
            ("layer", Quoted(layer)),
            ("width", LINE_MM),
            ("fill", "none"),
            ("tstamp", stable_uuid(board.name, "region", name)),
        )


def library_table(kind: str, name: str, file: str, words: str) -> str:
    """The table of one library beside the board; `kind` is `"fp"` or `"sym"`."""
    values = {"name": name, "type": "KiCad", "uri": "${KIPRJMOD}/" + file, "options": ""}
    fields = (values | {"descr": words}).items()
    entry: Value = ("lib", *((key, Quoted(value)) for key, value in fields))
    return written((f"{kind}_lib_table", entry))
