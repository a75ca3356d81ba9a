"""The frame of a panel: routed openings, fiducials, tooling holes and its name."""

import shapely

from lumitip_fab.boards.model import PlacedComponent, Placement, Slot, Text
from lumitip_fab.boards.silk.outlines import with_outline
from lumitip_fab.design import Box, Component, Panel, Point, Rules, Side
from lumitip_fab.design.components import fiducials

_FROM_END_MM = 10.0
"""Fiducials from the ends of a rail, clear of the tooling holes."""
_NAME_MM, _NAME_STROKE_MM = 1.5, 0.2
_NM = 6


def slots(panel: Panel, board: Placement, tabs: tuple[float, ...]) -> tuple[Slot, ...]:
    """The openings between frame, copies and tabs. Corners of copies are as round as those of the
    board, all others as the cutter leaves them.

    Args:
        panel: its copies and rules.
        board: the board by itself.
        tabs: middle of each tab along its left and right edge.
    """
    box, half = board.outline, panel.rules.tab_mm / 2
    copies = [moved_box(box, at) for at in panel.copies]
    bars = [
        Box(panel.inside.x_min_mm, panel.inside.x_max_mm, at[1] + y - half, at[1] + y + half)
        for at in panel.copies[:: panel.columns]
        for y in tabs
    ]
    kept = shapely.union_all([_rectangle(each) for each in (*copies, *bars)])
    open_ = shapely.difference(_rectangle(panel.inside), kept)
    radius = panel.rules.gap_mm / 2
    return tuple(
        _slot(area, radius, board.corner_mm) for area in shapely.get_parts(shapely.normalize(open_))
    )


def _slot(area: shapely.Polygon, inner_mm: float, outer_mm: float) -> Slot:
    """An opening with radii in the corners that the cutter rounds, and at those of a copy."""
    ring = shapely.get_coordinates(area.simplify(0.0).exterior)[:-1]
    ring = ring[::-1] if not area.exterior.is_ccw else ring
    corners = [(round(float(x), _NM), round(float(y), _NM)) for x, y in ring]
    found = []
    for before, at, after in zip(
        corners[-1:] + corners[:-1], corners, corners[1:] + corners[:1], strict=True
    ):
        turn = (at[0] - before[0]) * (after[1] - at[1]) - (at[1] - before[1]) * (after[0] - at[0])
        if turn:
            found.append((at, inner_mm if turn > 0 else outer_mm))
    return tuple(found)


def tooling(panel: Panel) -> tuple[Point, ...]:
    """The four tooling holes, in the ends of both rails."""
    at = panel.box.grown(-panel.rail_mm / 2)
    return tuple((x, y) for x in (at.x_min_mm, at.x_max_mm) for y in (at.y_min_mm, at.y_max_mm))


def marks(panel: Panel, rules: Rules, sides: tuple[Side, ...]) -> tuple[PlacedComponent, ...]:
    """Three fiducials on each side: two on the left rail and one on the right, so that no turn
    looks alike.

    Args:
        panel: its rails.
        rules: of the silkscreen.
        sides: the sides with parts.
    """
    limits, box = panel.rules, panel.box
    inset = limits.fiducial_edge_mm + limits.fiducial_opening_mm / 2
    left, right = box.x_min_mm + inset, box.x_max_mm - inset
    low, high = box.y_min_mm + _FROM_END_MM, box.y_max_mm - _FROM_END_MM
    places = (left, high), (left, low), (right, low)
    found: list[Component] = []
    for side in sides:
        found += fiducials(places, limits.fiducial_mm, side, first=len(found) + 1)
    return tuple(with_outline(mark, rules) for mark in found)


def label(panel: Panel, board: Placement) -> Text:
    """Name of the panel, along its right rail."""
    words = f"{panel.board} {board.revision}: {panel.columns} x {panel.rows}"
    at = panel.box.x_max_mm - panel.rail_mm / 2
    return Text(words, at, panel.box.y_max_mm / 3, _NAME_MM, _NAME_STROKE_MM, 90.0)


def moved_box(box: Box, by: Point) -> Box:
    """A rectangle in a copy's place."""
    x, y = by
    return Box(
        round(box.x_min_mm + x, _NM),
        round(box.x_max_mm + x, _NM),
        round(box.y_min_mm + y, _NM),
        round(box.y_max_mm + y, _NM),
    )


def _rectangle(box: Box) -> shapely.Polygon:
    return shapely.box(*box.bounds_mm)
