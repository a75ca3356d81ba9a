"""The drawings of the page: mount face and section of the coupling, and the gripper's body."""

import math
from collections.abc import Iterable

import manifold3d
import numpy as np
import shapely

from lumitip_fab.catalogue.grippers import Gripper
from lumitip_fab.design import Point
from lumitip_fab.grippers.dimensions import (
    Span,
    circle,
    dimension_rows,
    line,
    pointers,
    rectangle,
    write,
)
from lumitip_fab.grippers.figures import value_of
from lumitip_fab.parts.export import welded
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette, visible_lines

SCALE = 4.0  # of the coupling's views on the page
BODY_MM = 110.0  # length of a gripper on the page, or its width if that is more
FROM_GRIPPER = View(np.array([[1.0, 0, 0], [0, -1, 0], [0, 0, -1]]))
FROM_SIDE = View(np.array([[0.0, 0, 1], [0, -1, 0], [1, 0, 0]]))
"""Views of the mount frame (u, w, h), with w down the page."""
LEAST_MM = 1.5  # of a line that is drawn: shorter ones are the ends of hidden edges
PAPER, CUT = "#f4f6f8", "#cfd9e2"
_GAP_MM = 8.0  # from a view to its first dimension
_NAMES_MM = 48.0  # width of the names between two views
_TIP_MM = 18.0  # length of the gripper's own fingertip on that page
_FINGER_MM = 12.0  # thickness of a finger in the drawing of the body


def coupling_drawing(gripper: Gripper, gauge: Mesh) -> str:
    """Mount face, seen from the gripper, and section through a bolt, as SVG.

    Args:
        gripper: the figures to show.
        gauge: the foot of its coupling, in the mount frame.
    """
    sheet = Sheet()
    wide = max(gripper.seat_width_mm, gripper.block_width_mm) / 2
    _face(sheet, gripper, gauge, wide)
    _section(sheet, gripper, gauge, wide + (_NAMES_MM + 22.0) / SCALE)
    return sheet.svg({})


def draw_body(sheet: Sheet, body: Mesh, seen_by: View, scale: float, right_mm: float = 0.0) -> None:
    """A body with its visible lines, moved to the right before it is scaled to the page."""

    def placed(lines: list[Points]) -> list[Points]:
        return [scale * _moved(points, right_mm) for points in lines]

    sheet.area(placed(silhouette(body, seen_by)), "body", PAPER)
    lines = [
        points for points in visible_lines([body], seen_by)[0] if _length_mm(points) > LEAST_MM
    ]
    sheet.lines(placed(lines), "line")


def _moved(points: Points, right_mm: float) -> Points:
    return np.asarray(points + np.array([right_mm, 0.0]))


def _length_mm(points: Points) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def _page(u: float, w: float) -> Point:
    return SCALE * u, -SCALE * w


def _face(sheet: Sheet, g: Gripper, gauge: Mesh, wide: float) -> None:
    """The mount face with all that is measured across it; `wide` is half the width of the view."""
    draw_body(sheet, gauge, FROM_GRIPPER, SCALE)
    bolt, back, end = g.bolt_w_mm, g.block_back_w_mm, wide + 1.5
    pad, seat, bolts = bolt - g.pad_w_mm, g.seat_width_mm / 2, _bolts_u(g)
    rear = g.seat_back_w_mm or back
    sheet.lines(
        [
            line(_page(-end, 0), _page(end, 0)),
            line(_page(-end, bolt), _page(end, bolt)),
            line(_page(-seat, rear), _page(-seat, pad), _page(seat, pad), _page(seat, rear)),
            *(line(_page(u, bolt - 6), _page(u, bolt + 6)) for u in bolts),
        ],
        "axis",
    )
    heads = [circle(_page(u, bolt), SCALE * g.counterbore_mm / 2) for u in bolts]
    sheet.lines(heads, "hidden")
    front = value_of(g, "nose.front_w_mm")
    above = (("bolt_spacing_mm", bolt), ("pins.spacing_mm", bolt), ("nose.front_width_mm", front))
    below = (("block_width_mm", back - g.block_corner_mm), ("seat_width_mm", back))
    dimension_rows(sheet, _levels(g, above), SCALE * max(0.0, -pad) + _GAP_MM, 1)
    dimension_rows(sheet, _levels(g, below), -SCALE * back - _GAP_MM, -1)
    dimension_rows(sheet, _depths(g, pad, end), -SCALE * end - _GAP_MM, -1, upright=True)
    pointers(sheet, _round(g, end), SCALE * end + 10.0, 3.0)


def _bolts_u(g: Gripper) -> tuple[float, ...]:
    return (-g.bolt_spacing_mm / 2, g.bolt_spacing_mm / 2) if g.bolt_spacing_mm else (0.0,)


def _levels(g: Gripper, rows: Iterable[tuple[str, float]]) -> list[Span]:
    """Widths across the middle, each with the w of its feature."""
    widths = ((name, value_of(g, name), w) for name, w in rows)
    return [(n, _page(-width / 2, w), _page(width / 2, w)) for n, width, w in widths if width]


def _depths(g: Gripper, pad: float, end: float) -> list[Span]:
    """Distances w, to the left of the mount face."""
    zero, bolt = _page(-end, 0), _page(-end, g.bolt_w_mm)
    spans = [
        ("bolt_w_mm", bolt, zero),
        (
            "block_back_w_mm",
            _page(g.block_corner_mm - g.block_width_mm / 2, g.block_back_w_mm),
            zero,
        ),
        ("pad_w_mm", bolt, _page(-g.seat_width_mm / 2, pad)),
    ]
    if g.seat_back_w_mm:
        spans.append(("seat_back_w_mm", _page(-g.seat_width_mm / 2, g.seat_back_w_mm), zero))
    if g.nose:
        front = _page(-g.nose.front_width_mm / 2, g.nose.front_w_mm)
        spans.append(("nose.front_w_mm", front, zero))
    return spans


def _round(g: Gripper, end: float) -> list[tuple[str, Point]]:
    """Holes, corners and the nose's angle, named to the right of the mount face."""

    def on(u: float, w: float, diameter: float, angle_deg: float) -> Point:
        turn = math.radians(angle_deg)
        return _page(u + diameter / 2 * math.cos(turn), w - diameter / 2 * math.sin(turn))

    bolt = _bolts_u(g)[-1], g.bolt_w_mm
    corner = g.block_corner_mm * (1 - math.sqrt(0.5))
    labels = [
        ("w = 0: front of the board", _page(end, 0)),
        ("pad of its own fingertip", _page(g.seat_width_mm / 2, g.bolt_w_mm - g.pad_w_mm)),
        ("counterbore_mm", on(*bolt, g.counterbore_mm, 45)),
        ("bolt_hole_mm", on(*bolt, g.bolt_hole_mm, 15)),
        ("block_corner_mm", _page(g.block_width_mm / 2 - corner, g.block_back_w_mm - corner)),
    ]
    if g.pins:
        labels.append(("pins.hole_mm", on(g.pins.spacing_mm / 2, g.bolt_w_mm, g.pins.hole_mm, -50)))
    if g.nose:
        turn = math.radians(g.nose.half_angle_deg)
        u, w = g.nose.front_width_mm / 2 + 1.5 * math.sin(turn), 1.5 * math.cos(turn)
        labels.append(("nose.half_angle_deg", _page(u, g.nose.front_w_mm + w)))
    return labels


def _section(sheet: Sheet, g: Gripper, gauge: Mesh, right: float) -> None:
    """The section through a bolt's axis, with all that is measured along the bolt."""
    bolt_u = _bolts_u(g)[-1]
    half = _half(gauge, bolt_u)
    high = float(half.points_mm[:, 2].max())
    draw_body(sheet, half, FROM_SIDE, SCALE, right)
    sheet.area([SCALE * _moved(ring, right) for ring in _cut(half, bolt_u)], "body", CUT)
    lean = math.tan(math.radians(g.tilt_deg))
    tip = _page(right + high + 6, -lean * (high + 6))
    sheet.lines(
        [
            line(_page(right - 3, g.bolt_w_mm), _page(right + high + 6, g.bolt_w_mm)),
            line(_page(right - 1, 0), _page(right + high + 6, 0)),
            line(_page(right, -3), _page(right, g.block_back_w_mm + 1)),
            line(_page(right, 0), tip),
        ],
        "axis",
    )
    spans = [
        ("land_mm", _page(right, g.block_back_w_mm), _page(right + g.land_mm, g.block_back_w_mm))
    ]
    above = []
    if g.pins:
        low = g.bolt_w_mm + g.pins.hole_mm / 2
        pin = rectangle((right, right + g.pins.depth_mm), (2 * g.bolt_w_mm - low, low))
        sheet.lines([pin * (SCALE, -SCALE)], "hidden")
        spans.append(("pins.depth_mm", _page(right, low), _page(right + g.pins.depth_mm, low)))
    if g.nose:
        front, top = g.nose.front_w_mm, right + g.nose.height_mm
        above.append(("nose.height_mm", _page(right, front), _page(top, front)))
    dimension_rows(sheet, spans, -SCALE * g.block_back_w_mm - _GAP_MM, -1)
    dimension_rows(sheet, above, _GAP_MM, 1)
    names = [("tilt_deg", tip), ("bolt", _page(right + high + 6, g.bolt_w_mm))]
    pointers(sheet, names, SCALE * (right + high + 6) + 8.0, 10.0)


def _half(body: Mesh, u: float) -> Mesh:
    """What lies at smaller u."""
    corners, faces = body.points_mm, body.triangles.astype(np.uint64)
    solid = manifold3d.Manifold(manifold3d.Mesh64(corners, faces))
    found = solid.trim_by_plane((-1.0, 0.0, 0.0), -u).to_mesh64()
    return welded(found.vert_properties[:, :3], found.tri_verts.astype(np.int64))


def _cut(half: Mesh, u: float) -> list[Points]:
    """Rings of the cut face, as (h, -w)."""
    corners = half.points_mm[half.triangles]
    flat = np.abs(corners[:, :, 0] - u).max(axis=1) < 1e-4
    whole = shapely.union_all(shapely.polygons(corners[flat][:, :, [2, 1]]), grid_size=1e-4)
    return [
        np.array(ring.coords) * (1.0, -1.0)
        for part in shapely.get_parts(whole)
        for ring in (part.exterior, *part.interiors)
    ]


def body_drawing(gripper: Gripper) -> str:
    """The gripper's body from its end and from its side, as SVG."""
    body, sheet = gripper.envelope, Sheet()
    sizes = np.array(
        [body.width_mm, body.depth_mm, body.corner_mm, body.length_mm, gripper.stroke_mm]
    )
    scale = BODY_MM / max(body.reach_mm, body.width_mm)
    width, depth, corner, length, opening = (sizes * scale).tolist()
    reach, thick = scale * body.reach_mm, scale * _FINGER_MM
    inner = shapely.box(corner, corner - width / 2, depth - corner, width / 2 - corner)
    end = np.array(inner.buffer(corner, quad_segs=18).exterior.coords)
    left, tip = depth + 52.0, depth + 52.0 + reach + _TIP_MM
    sheet.area([end], "area", PAPER)
    sheet.area([rectangle((left, left + length), (-width / 2, width / 2))], "area", PAPER)
    for side in (-1, 1):
        pad = side * opening / 2
        finger = rectangle((left + length, left + reach), (pad, pad + side * thick))
        sheet.area([finger], "area", CUT)
        sheet.area([rectangle((left + reach, tip), (pad, pad + side * thick))], "area", PAPER)
        sheet.lines([rectangle((left + length, tip), (0.0, side * thick))], "axis")
    low = -max(width / 2, opening / 2 + thick)
    sheet.lines([line((-6.0, 0.0), (tip + 8.0, 0.0))], "axis")
    along = [
        ("envelope.length_mm", (left, -width / 2), (left + length, -width / 2)),
        ("envelope.reach_mm (closed)", (left, -width / 2), (left + reach, low)),
    ]
    dimension_rows(sheet, along, low - _GAP_MM, -1)
    across = [("envelope.depth_mm", (0.0, -width / 2), (depth, -width / 2))]
    dimension_rows(sheet, across, low - _GAP_MM, -1)
    up = [("envelope.width_mm", (0.0, -width / 2), (0.0, width / 2))]
    dimension_rows(sheet, up, -_GAP_MM, -1, upright=True)
    open_ = [("stroke_mm", (tip, -opening / 2), (tip, opening / 2))]
    dimension_rows(sheet, open_, tip + _GAP_MM, 1, upright=True)
    inset = corner * (1 - math.sqrt(0.5))
    corner_at = (depth - inset, width / 2 - inset)
    pointers(sheet, [("envelope.corner_mm", corner_at)], depth + 10.0, -low)
    sheet.lines([line((left - 4.0, 6.0), (left, 6.0))], "leader")
    sheet.dot(left, 6.0)
    write(sheet, (left - 38.0, 5.0), "face on the robot")
    own = [("its own fingertip", (tip, opening / 2 + thick / 2))]
    pointers(sheet, own, tip + _GAP_MM + 8.0, -low)
    return sheet.svg({})
