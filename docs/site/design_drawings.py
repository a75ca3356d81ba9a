"""Dimensioned drawings of the published design: the face of a finger, and its section.

Every point is one of the derived design; a test compares each length with its parameter.
"""

from functools import cache
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Polygon, Rectangle, RegularPolygon

from dimensioned import Dimension, Drawing
from lumitip_fab.config.load import load
from lumitip_fab.derive import resolve
from lumitip_fab.design import Design
from lumitip_fab.design.shape import Box
from repository_pages import ROOT

PRESET = ROOT / "design/presets/published.toml"
_HEIGHTS = 3.0
_LAYERS = {"plate": "#c9d3e3", "board": "#8fb58b", "silicone": "#e8eef4", "film": "#333333"}


@cache
def drawn_design() -> Design:
    """The design that is drawn."""
    return resolve(load(PRESET)).design


def outline_points(design: Design) -> np.ndarray:
    """The outline of a finger (mm), shape `(n, 2)`."""
    t = np.linspace(0.0, 1.0, 24)[:, None]
    weights = ((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3)
    curves = [np.array(cubic) for cubic in design.outline.curve]
    return np.concatenate([sum(w * p for w, p in zip(weights, c, strict=True)) for c in curves])


def paint_face(axes: Axes, design: Design, holes: bool = True) -> None:
    """Outline, board and cells of the receiver, seen at its gripping face, tip up."""
    layout, optics = design.layout, design.layout.optics
    axes.add_patch(Polygon(outline_points(design), fc=_LAYERS["plate"], ec="#333", lw=0.9))
    axes.add_patch(_rectangle(design.board.box, fc="#dcebd9", ec="#3c6e3a", lw=0.8))
    sides, turn = (6, np.pi / 6) if optics.hole_shape == "hexagon" else (48, 0.0)
    radius = optics.hole_mm / 2 / np.cos(np.pi / sides)
    for at in zip(layout.x_mm, layout.y_mm, strict=True):
        axes.add_patch(RegularPolygon(at, sides, radius=radius, orientation=turn, fc="#333"))
    for at in design.receiver.holes if holes else ():
        radius = design.board.hole_mm / 2
        axes.add_patch(RegularPolygon(at, 48, radius=radius, fc="white", ec="#3c6e3a", lw=0.8))


def _rectangle(box: Box, **look: Any) -> Rectangle:
    return Rectangle((box.x_min_mm, box.y_min_mm), box.width_mm, box.length_mm, **look)


def _face() -> Drawing:
    design = drawn_design()
    board, layout = design.board.box, design.layout
    outline = outline_points(design)
    tip, end = float(outline[:, 1].max()), float(outline[:, 1].min())
    wide = float(outline[:, 0].max())
    shoulder = float(outline[outline[:, 0].argmax(), 1])
    waist = float(outline[(outline[:, 1] < board.y_min_mm + 5) & (outline[:, 0] > 0), 0].max())
    corner = float(outline[np.isclose(outline[:, 1], end), 0].max())
    right, top = float(layout.x_mm.max()), float(layout.y_mm.max())
    hole = layout.optics.hole_mm / 2
    low = float(layout.y_mm[layout.x_mm == right].min())
    hole_at = max(design.receiver.holes, key=lambda at: (at[1], at[0]))
    left, past = -38.0, 38.0
    dimensions = [
        Dimension("grid.pitch_mm", (0.0, low), (0.0, low + 6.0), (left, low + 3.0), -2.0),
        Dimension("mask.hole_mm", (-right, low - hole), (-right, low + hole), (left, -16.0), -3.0),
        Dimension("board.side_margin_mm", (right, low), (board.x_max_mm, low), (past, low)),
        Dimension("board.tip_margin_mm", (-right, top), (-right, board.y_max_mm), (left, 14.0)),
        Dimension("board.hole_edge_mm", hole_at, (hole_at[0], board.y_max_mm), (past, 24.0), 2.0),
        Dimension("outline.tip_margin_mm", (-4.0, board.y_max_mm), (-4.0, tip), (left, 19.0)),
        Dimension("outline.shoulder_at_mm", (wide, shoulder), (wide, tip), (past, 17.0), 3.0),
        Dimension(
            "outline.shoulder_margin_mm", (board.x_max_mm, shoulder), (wide, shoulder), (past, 10.0)
        ),
        Dimension("outline.waist_margin_mm", (board.x_max_mm, -22), (waist, -22), (past, -21)),
        Dimension("outline.end_margin_mm", (-10.0, end), (-10.0, board.y_min_mm), (left, -30.0)),
        Dimension("outline.end_corner_mm", (corner, end), (waist, end), (past, -35.0), -2.0),
    ]
    title = "Face of a finger, seen at the silicone with the tip up"
    return Drawing(
        title, "grid", (7.4, 6.2), lambda axes: paint_face(axes, design), dimensions=dimensions
    )


def _paint_section(axes: Axes) -> None:
    design = drawn_design()
    stack, tip, pocket = design.stack, design.tip, design.board.pocket
    start, end = tip.slant_start_y_mm, float(outline_points(design)[:, 1].max())
    low = design.mount.origin_y_mm
    face, back, skin = stack.face_z_mm, stack.back_z_mm, stack.silicone_z_mm
    thin = face + design.mould.tip_silicone_mm
    taper = end - design.mould.taper_length_mm
    plate = [(low, face), (end, face), (end, face - tip.edge_mm), (start, back), (low, back)]
    axes.add_patch(Polygon(plate, fc=_LAYERS["plate"], ec="#333", lw=0.8))
    room = pocket.y_min_mm, stack.pocket_z_mm, pocket.length_mm, stack.pcb_mm
    axes.add_patch(Rectangle(room[:2], room[2], room[3], fc="white", ec="#333", lw=0.5))
    board = design.board.box
    at = board.y_min_mm, stack.pocket_z_mm
    axes.add_patch(
        Rectangle(at, board.length_mm, stack.pcb_mm, fc=_LAYERS["board"], ec="#333", lw=0.5)
    )
    silicone = [(low, face), (end, face), (end, thin), (taper, skin), (low, skin)]
    axes.add_patch(Polygon(silicone, fc=_LAYERS["silicone"], ec="#333", lw=0.5))
    film = [(low, skin), (taper, skin), (end, thin), (end, thin + stack.film_mm)]
    film += [(taper, 0.0), (low, 0.0)]
    axes.add_patch(Polygon(film, fc=_LAYERS["film"], ec="none"))
    for words, y, z in (
        ("film", -31.0, 0.5),
        ("silicone", -12.0, (skin + face) / 2),
        ("board", -12.0, face - stack.pcb_mm / 2),
        ("printed plate, with a wedge at the tip", -12.0, back - 0.8),
    ):
        axes.text(y, z, words, ha="left", va="center")


def _section() -> Drawing:
    design = drawn_design()
    stack, tip = design.stack, design.tip
    end = float(outline_points(design)[:, 1].max())
    low = design.mount.origin_y_mm
    face, skin = stack.face_z_mm, stack.silicone_z_mm
    thin, pocket, back = face + design.mould.tip_silicone_mm, stack.pocket_z_mm, stack.back_z_mm
    start, taper = tip.slant_start_y_mm, end - design.mould.taper_length_mm
    left, past = low - 5.0, end + 4.0
    dimensions = [
        Dimension("stack.film_mm", (low, 0.0), (low, skin), (left, 0.9), -2.0),
        Dimension("stack.silicone_mm", (low, skin), (low, face), (left, -0.5), -2.0),
        Dimension("stack.pcb_mm", (low, face), (low, pocket), (left, -2.2), -2.0),
        Dimension("stack.floor_mm", (low, pocket), (low, back), (left, -4.0), -2.0),
        Dimension("tip.slant_start_mm", (start, back), (end, back), (past, -5.2), -0.7),
        Dimension("tip.edge_mm", (end, face - tip.edge_mm), (end, face), (past, -2.6), 1.5),
        Dimension("mould.tip_silicone_mm", (end, face), (end, thin), (past, -1.4), 1.5),
        Dimension("mould.taper_length_mm", (taper, 0.0), (end, 0.0), (past, 1.2), 0.5),
    ]
    title = (
        "Section of a finger along its middle, the tip to the right; heights three times as large"
    )
    return Drawing(title, "stack", (8.6, 3.3), _paint_section, _HEIGHTS, dimensions)


@cache
def drawings() -> dict[str, Drawing]:
    """Drawings by the name of their file."""
    return {"face": _face(), "section": _section()}
