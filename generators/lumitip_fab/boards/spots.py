"""Free places on a board, and places that are taken twice."""

from collections.abc import Iterator, Sequence

import numpy as np
import shapely

from lumitip_fab.boards.model import PlacedComponent
from lumitip_fab.boards.placed import courtyard, placed_box
from lumitip_fab.design import Board, Box, Point
from lumitip_fab.errors import BuildError

_STEP_MM = 0.25
_REACH_MM = 15.0  # from a corner to its fiducial, along each edge
_NOISE_MM = 1e-6
Named = tuple[str, Box]


def overlaps(boxes: Sequence[Named]) -> Iterator[tuple[Named, Named]]:
    """Pairs of boxes that overlap by more than noise."""
    shapes = shapely.box(*np.array([b.grown(-_NOISE_MM).bounds_mm for _, b in boxes]).T)
    for i, j in shapely.STRtree(shapes).query(shapes, predicate="intersects").T.tolist():
        if i < j:
            yield boxes[i], boxes[j]


def beyond_mm(inner: Box, outer: Box) -> float:
    """How far a box reaches out of another; below zero inside."""
    return max(
        outer.x_min_mm - inner.x_min_mm,
        inner.x_max_mm - outer.x_max_mm,
        outer.y_min_mm - inner.y_min_mm,
        inner.y_max_mm - outer.y_max_mm,
    )


def fiducials(
    board: Board, taken: Sequence[Box], mark: Box, holes: Sequence[Point], edge_mm: float
) -> tuple[Point, Point, Point]:
    """Three free places near the corners, so far apart and so uneven that no turn looks alike.

    Args:
        board: its outline and holes.
        taken: courtyards.
        mark: courtyard of a fiducial.
        holes: locating holes.
        edge_mm: gap to the board's edge and to holes.

    Raises:
        BuildError: if a corner has no room.
    """
    reach = mark.width_mm / 2
    inside = board.box.grown(-reach - edge_mm)
    low_x, low_y, high_x, high_y = np.array([box.bounds_mm for box in taken]).T
    drills = np.array(holes)
    found: list[Point] = []
    for x_side, y_side in ((-1, 1), (1, 1), (-1, -1)):
        steps = np.arange(0.0, _REACH_MM, _STEP_MM)
        corner = (
            inside.x_min_mm if x_side < 0 else inside.x_max_mm,
            inside.y_min_mm if y_side < 0 else inside.y_max_mm,
        )
        in_x, in_y = (axis.ravel() for axis in np.meshgrid(steps, steps))
        order = np.lexsort((in_x, np.round(np.hypot(in_x, in_y), 6)))
        at = np.stack([corner[0] - x_side * in_x, corner[1] - y_side * in_y], axis=1)[order]
        x, y = at.T[:, :, None]
        beside = np.maximum(low_x - x, x - high_x)
        apart = np.maximum(beside, np.maximum(low_y - y, y - high_y))
        free = apart.min(axis=1) >= reach
        gap = np.hypot(x - drills[:, 0], y - drills[:, 1]).min(axis=1)
        free &= gap >= reach + board.hole_mm / 2 + edge_mm
        if not free.any():
            raise BuildError(
                f"no room for a fiducial, {2 * reach:g} mm across, near the corner at "
                f"x {corner[0]:.2f}, y {corner[1]:.2f} mm: give [board] wider margins"
            )
        best = at[int(np.argmax(free))].tolist()
        found.append((round(best[0], 6), round(best[1], 6)))
    return found[0], found[1], found[2]


def refuse_misplaced(name: str, parts: Sequence[PlacedComponent], inside: Box | None) -> None:
    """Refuse courtyards that overlap or leave the board.

    Args:
        name: of the board.
        parts: all that are on it.
        inside: box that they must not leave, if there is one.

    Raises:
        BuildError: if two overlap, or one leaves the box; it names them.
    """
    roomier = "give them more room in [board], or " if inside else ""
    remedy = f"{roomier}choose smaller parts"
    for side in dict.fromkeys(part.side for part in parts):
        yards = [yard for part in parts if part.side == side for yard in _yards(part)]
        for (one, here), (other, there) in overlaps(yards):
            if one == other:
                continue
            raise BuildError(
                f"{name}: {one} at {_corners(here)} and {other} at {_corners(there)} overlap: "
                f"{remedy}"
            )
    for part in parts if inside else ():
        yard = courtyard(part)
        if inside and beyond_mm(yard, inside) > _NOISE_MM:
            raise BuildError(
                f"{name}: {part.ref} at {_corners(yard)} leaves the board at {_corners(inside)}: "
                f"{remedy}"
            )


def _yards(part: PlacedComponent) -> Iterator[Named]:
    """The courtyard, and the shroud of a box header."""
    yield part.ref, courtyard(part)
    if part.footprint.shroud:
        yield part.ref, placed_box(part, part.footprint.shroud.box)


def _corners(box: Box) -> str:
    return (
        f"x {box.x_min_mm:.2f} to {box.x_max_mm:.2f}, y {box.y_min_mm:.2f} to {box.y_max_mm:.2f} mm"
    )
