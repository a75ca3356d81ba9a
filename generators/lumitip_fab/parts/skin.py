"""The finger's skin: the silicone that a mould casts on it, the film over that, and the stops
that set the thickness. All in the sensor frame.

Side view of the silicone, gripping face up:

     gripper end                                             tip
        ╭───────────────────────────────────────╮ face
        │ end_round                              ╲ taper
        └─────────────────────────────────────────┘ rim plane; tip_silicone left at the edge
"""

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from build123d import Edge, Face, Plane, Solid, Vector, Wire
from numpy.typing import NDArray

from lumitip_fab.design import Board, Box, Cubic, Mould, Outline, Point, Stack
from lumitip_fab.design.making import tip_stop_mm
from lumitip_fab.parts.shapes import box_face, box_solid

FOOT_MM = 0.1  # a stop widens by this at the most
TIP_LAND_MM = 0.3  # how far the tip line reaches under the plate; with the gap, one printed line
_PARTS = (
    4  # of each curved piece: the kernel's triangles leave a wall that is longer and bends less
)
_SAMPLES = 7  # points that fix each of them: off by less than 0.0005 mm
_BEYOND_MM = 1.0
_FAR_MM = 400.0


def silicone_solid(
    stack: Stack, outline: Outline, board: Board, mould: Mould, filled: list[Solid]
) -> Solid:
    """The silicone of a finger, from the plate to its face, as the mould's stops leave it, with
    what fills the plate's keys and the room round its tip.

    The parts on the board are still to be taken out of it.
    """
    body = drafted_prism(stack, outline, mould, stack.face_z_mm, _above(stack))
    body = body & side_solid(stack, outline, mould)
    body = body + filled if filled else body
    taken = stops(stack, outline, mould)
    if not stack.sunk:
        taken.append(box_solid(board.box, stack.face_z_mm, stack.rim_z_mm))
    return (body - taken).solid()


def film_solid(stack: Stack, outline: Outline, mould: Mould) -> Solid:
    """The film on the face, the taper and the rounded end, without its apertures."""
    body = drafted_prism(stack, outline, mould, stack.face_z_mm, _above(stack))
    body = body & side_solid(stack, outline, mould, stack.film_mm)
    return (body - side_solid(stack, outline, mould)).solid()


def wall_offset_mm(stack: Stack, mould: Mould, z_mm: float) -> float:
    """Distance from the outline to the mould's wall at a height: it opens towards the back."""
    return mould.wall_gap_mm + (stack.face_z_mm - z_mm) * math.tan(math.radians(mould.draft_deg))


def drafted_prism(
    stack: Stack, outline: Outline, mould: Mould, z_min_mm: float, z_max_mm: float
) -> Solid:
    """Volume inside the mould's wall between two heights."""
    rings = [offset_wire(outline, wall_offset_mm(stack, mould, z), z) for z in (z_min_mm, z_max_mm)]
    return Solid.make_loft(rings, ruled=True)


def offset_wire(outline: Outline, by_mm: float, z_mm: float) -> Wire:
    """The outline grown by a distance, at a height.

    Wires of different distances have the same pieces with the same parameters, so that a loft
    between two of them is square to the outline everywhere.
    """
    return Wire([e for piece in outline.curve for e in _offset_edges(piece, by_mm, z_mm)])


def side_solid(stack: Stack, outline: Outline, mould: Mould, shift_mm: float = 0.0) -> Solid:
    """Everything behind the skin's side view, drawn along x past the finger.

    Args:
        stack: heights.
        outline: for tip and gripper end.
        mould: taper, thickness at the tip, rounding.
        shift_mm: how far the skin is moved out, for the film's outer face.
    """
    face_z = stack.silicone_z_mm + shift_mm
    tip_y, taper = outline.tip_y_mm, mould.taper_length_mm
    slope = (stack.cover_mm - mould.tip_silicone_mm) / taper
    out_y = tip_y + _BEYOND_MM
    out_z = face_z - slope * (taper + _BEYOND_MM)
    back_z = stack.back_z_mm - _FAR_MM
    radius = mould.end_round_mm + shift_mm
    # The rounding starts upright on the wall; below it the wall is the skin.
    wall_y = outline.end_y_mm - shift_mm
    wall_y -= wall_offset_mm(stack, mould, stack.silicone_z_mm - mould.end_round_mm)
    end_y, diagonal = wall_y + radius, radius * math.sqrt(0.5)
    start, finish = (wall_y, face_z - radius), (end_y, face_z)
    middle = (end_y - diagonal, face_z - radius + diagonal)
    corners = [
        finish,
        (tip_y - taper, face_z),
        (out_y, out_z),
        (out_y, back_z),
        (wall_y - _FAR_MM, back_z),
        start,
    ]
    edges = [Edge.make_line(_yz(a), _yz(b)) for a, b in pairwise(corners)]
    edges.append(Edge.make_three_point_arc(_yz(start), _yz(middle), _yz(finish)))
    return Solid.extrude(Face(Wire(edges)), Vector(2 * _FAR_MM, 0, 0))


def stops(stack: Stack, outline: Outline, mould: Mould) -> list[Solid]:
    """The hard stops between rim plane and face: pads at the gripper end, a line at the tip.

    They reach into the mould's wall, because a slit between pad and wall could not be printed.
    """
    inside = mould.wall_gap_mm + mould.wall_mm / 2
    tip_half = tip_stop_mm(outline.tip_width_mm) / 2
    tip_y = outline.tip_y_mm
    line = Box(-tip_half, tip_half, tip_y - TIP_LAND_MM, tip_y + inside)
    solids = [_drafted(box_face(line), stack, mould)]
    for x, y in mould.pads:
        side, reach = math.copysign(1.0, x), outline.half_width_at(y) + inside
        solids.append(_drafted(_pad(x, side * reach, y, mould.pad_mm / 2), stack, mould))
    return solids


def _drafted(top: Face, stack: Stack, mould: Mould) -> Solid:
    """A stop with its top at the rim plane, wider towards the mould's floor and ending in it."""
    depth = stack.cover_mm + mould.wall_mm / 2
    # Deep silicone must not make feet that reach the board.
    wider = min(depth * math.tan(math.radians(mould.draft_deg)), FOOT_MM)
    ring = top.outer_wire()
    base = ring.offset_2d(wider) if wider > 0 else ring
    rings = [
        ring.moved(Plane((0, 0, stack.face_z_mm)).location),
        base.moved(Plane((0, 0, stack.face_z_mm + depth)).location),
    ]
    return Solid.make_loft(rings, ruled=True)


def _pad(x_mm: float, end_x_mm: float, y_mm: float, radius_mm: float) -> Face:
    """A disc drawn out sideways to the wall."""
    side = math.copysign(1.0, x_mm)
    low, high = y_mm - radius_mm, y_mm + radius_mm
    tip = Vector(x_mm - side * radius_mm, y_mm)
    edges = [
        Edge.make_three_point_arc(Vector(x_mm, high), tip, Vector(x_mm, low)),
        Edge.make_line(Vector(x_mm, low), Vector(end_x_mm, low)),
        Edge.make_line(Vector(end_x_mm, low), Vector(end_x_mm, high)),
        Edge.make_line(Vector(end_x_mm, high), Vector(x_mm, high)),
    ]
    return Face(Wire(edges))


def _offset_edges(piece: Cubic, by_mm: float, z_mm: float) -> Iterator[Edge]:
    corners = np.array(piece)
    straight = np.allclose(corners[1], corners[0] + (corners[3] - corners[0]) / 3, atol=1e-9)
    for start, end in pairwise(np.linspace(0.0, 1.0, 2 if straight else _PARTS + 1)):
        t = np.linspace(start, end, 2 if straight else _SAMPLES)
        points, slopes = _offset(corners, t, by_mm)
        places = [Vector(x, y, z_mm) for x, y in points]
        if straight:
            yield Edge.make_line(*places)
            continue
        ends = [Vector(*slopes[0], 0.0), Vector(*slopes[-1], 0.0)]
        yield Edge.make_spline(places, tangents=ends, parameters=t.tolist(), scale=False)


def _offset(
    corners: NDArray[np.float64], t: NDArray[np.float64], by_mm: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Points of a cubic's offset to its right, and the offset's derivatives by t."""
    t = t[:, None]
    p0, p1, p2, p3 = corners
    place = (1 - t) ** 3 * p0 + 3 * t * (1 - t) ** 2 * p1 + 3 * t * t * (1 - t) * p2 + t**3 * p3
    first = 3 * ((1 - t) ** 2 * (p1 - p0) + 2 * t * (1 - t) * (p2 - p1) + t * t * (p3 - p2))
    second = 6 * ((1 - t) * (p2 - 2 * p1 + p0) + t * (p3 - 2 * p2 + p1))
    speed = np.linalg.norm(first, axis=1, keepdims=True)
    cross = first[:, :1] * second[:, 1:] - first[:, 1:] * second[:, :1]
    right = np.stack([first[:, 1], -first[:, 0]], axis=1) / speed
    return place + by_mm * right, first * (1 + by_mm * cross / speed**3)


def _above(stack: Stack) -> float:
    """A height beyond the film."""
    return stack.film_mm + _BEYOND_MM


def _yz(point: Point) -> Vector:
    return Vector(-_FAR_MM, point[0], point[1])
