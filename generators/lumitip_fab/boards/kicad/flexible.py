"""Additions to the file of a flexible board: stack-up, bend and stiffener."""

from collections.abc import Iterator

from lumitip_fab.boards.kicad.sexpr import Node, Quoted
from lumitip_fab.boards.model import (
    Placement,
    stable_uuid,
)
from lumitip_fab.design import Flexible
from lumitip_fab.design.frames import on_board_page

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
