"""A finger's coupling with what is measured on the gripper for it: mount face and section."""

import math
from collections.abc import Container, Iterable

import manifold3d
import numpy as np
import shapely

from lumitip_fab.design import Mount, Point
from lumitip_fab.parts.export import welded
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.dimensions import (
    Span,
    circle,
    dimension_rows,
    line,
    pointers,
    rectangle,
    write,
)
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette, visible_lines

SCALE = 2.8
FROM_GRIPPER = View(np.array([[1.0, 0, 0], [0, -1, 0], [0, 0, -1]]))
FROM_SIDE = View(np.array([[0.0, 0, 1], [0, -1, 0], [1, 0, 0]]))
"""Views of the mount frame (u, w, h), with w down the page."""
LEAST_MM = 1.5  # of a line that is drawn: shorter ones are the ends of hidden edges
PAPER, CUT = "#f4f6f8", "#cfd9e2"
GAP_MM = 8.0
"""From a view to its first dimension."""
_FOOT_MM = 6.0  # from the lowest dimension to what the views are
_NAMES_MM = 48.0  # width of the names between two views
THREAD = "thread"
"""Among the figures that are shown: how far the bolt goes into the gripper."""
Label = tuple[str, Point]


def coupling_view(mount: Mount, foot: Mesh, figures: Container[str]) -> str:
    """Mount face, seen from the gripper, and section through a bolt, as SVG.

    Args:
        mount: the coupling.
        foot: of the finger, in the mount frame.
        figures: names, as a gripper's entry has them, of those that are shown.
    """
    sheet = Sheet()
    wide = max(mount.seat_width_mm, mount.block_width_mm) / 2
    _face(sheet, mount, foot, wide, figures)
    thread = mount.into_gripper_mm if THREAD in figures else 0.0
    right = wide + thread + (_NAMES_MM + 22.0) / SCALE
    _section(sheet, mount, foot, right, figures)
    low = float(sheet.low[1]) - _FOOT_MM
    write(sheet, (0.0, low), "seen from the gripper", "middle")
    write(sheet, (SCALE * right, low), "section: gripper on the left, tip on the right", "middle")
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


def _face(sheet: Sheet, m: Mount, foot: Mesh, wide: float, figures: Container[str]) -> None:
    """The mount face with all that is measured across it; `wide` is half the width of the view."""
    draw_body(sheet, foot, FROM_GRIPPER, SCALE)
    bolt, back, end = m.bolt_w_mm, m.block_back_w_mm, wide + 1.5
    pad, seat, rear = bolt - m.pad_w_mm, m.seat_width_mm / 2, m.seat_back_w_mm
    sheet.lines(
        [
            line(_page(-end, 0), _page(end, 0)),
            line(_page(-end, bolt), _page(end, bolt)),
            line(_page(-seat, rear), _page(-seat, pad), _page(seat, pad), _page(seat, rear)),
            *(line(_page(u, bolt - 6), _page(u, bolt + 6)) for u in m.bolt_u_mm),
        ],
        "axis",
    )
    heads = [circle(_page(u, bolt), SCALE * m.counterbore_mm / 2) for u in m.bolt_u_mm]
    sheet.lines(heads, "hidden")
    above, below = _widths(m)
    dimension_rows(sheet, _shown(above, figures), SCALE * max(0.0, -pad) + GAP_MM, 1)
    dimension_rows(sheet, _shown(below, figures), -SCALE * back - GAP_MM, -1)
    depths = _shown(_depths(m, pad, end), figures)
    dimension_rows(sheet, depths, -SCALE * end - GAP_MM, -1, upright=True)
    names = [(name, at) for name, at in _round(m) if name in figures]
    names += [
        ("w = 0: front of the board", _page(end, 0)),
        ("pad of its own fingertip", _page(seat, pad)),
    ]
    pointers(sheet, names, SCALE * end + 10.0, 3.0)


def _shown(spans: Iterable[Span], figures: Container[str]) -> list[Span]:
    return [span for span in spans if span[0] in figures]


def _widths(m: Mount) -> tuple[list[Span], list[Span]]:
    """Widths across the middle, above and below the mount face."""
    back = m.block_back_w_mm

    def across(name: str, width: float, w: float) -> Span:
        return name, _page(-width / 2, w), _page(width / 2, w)

    above = [across("bolt_spacing_mm", _apart(m.bolt_u_mm), m.bolt_w_mm)]
    above.append(across("pins.spacing_mm", _apart(m.pin_u_mm), m.bolt_w_mm))
    if m.nose:
        above.append(across("nose.front_width_mm", m.nose.front_width_mm, m.nose.front_w_mm))
    below = [
        across("block_width_mm", m.block_width_mm, back - m.block_corner_mm),
        across("seat_width_mm", m.seat_width_mm, back),
    ]
    return above, below


def _apart(places: tuple[float, ...]) -> float:
    """From the first to the last."""
    return places[-1] - places[0] if places else 0.0


def _depths(m: Mount, pad: float, end: float) -> list[Span]:
    """Distances w, to the left of the mount face."""
    zero, bolt, seat = _page(-end, 0), _page(-end, m.bolt_w_mm), -m.seat_width_mm / 2
    corner = _page(m.block_corner_mm - m.block_width_mm / 2, m.block_back_w_mm)
    spans = [
        ("bolt_w_mm", bolt, zero),
        ("block_back_w_mm", corner, zero),
        ("pad_w_mm", bolt, _page(seat, pad)),
        ("seat_back_w_mm", _page(seat, m.seat_back_w_mm), zero),
    ]
    if m.nose:
        front = _page(-m.nose.front_width_mm / 2, m.nose.front_w_mm)
        spans.append(("nose.front_w_mm", front, zero))
    return spans


def _round(m: Mount) -> list[Label]:
    """Holes, corners and the nose's angle, named to the right of the mount face."""

    def on(u: float, diameter: float, angle_deg: float) -> Point:
        turn = math.radians(angle_deg)
        return _page(u + diameter / 2 * math.cos(turn), m.bolt_w_mm - diameter / 2 * math.sin(turn))

    corner = m.block_corner_mm * (1 - math.sqrt(0.5))
    labels = [
        ("counterbore_mm", on(m.bolt_u_mm[-1], m.counterbore_mm, 45)),
        ("bolt_hole_mm", on(m.bolt_u_mm[-1], m.bolt_hole_mm, 15)),
        ("block_corner_mm", _page(m.block_width_mm / 2 - corner, m.block_back_w_mm - corner)),
    ]
    if m.pin_u_mm:
        labels.append(("pins.hole_mm", on(m.pin_u_mm[-1], m.pin_mm, -50)))
    if m.nose:
        turn = math.radians(m.nose.half_angle_deg)
        u, w = m.nose.front_width_mm / 2 + 1.5 * math.sin(turn), 1.5 * math.cos(turn)
        labels.append(("nose.half_angle_deg", _page(u, m.nose.front_w_mm + w)))
    return labels


def _section(sheet: Sheet, m: Mount, foot: Mesh, right: float, figures: Container[str]) -> None:
    """The section through a bolt's axis, with all that is measured along the bolt."""
    bolt_u = m.bolt_u_mm[-1]
    half = _half(foot, bolt_u)
    high = float(half.points_mm[:, 2].max())
    draw_body(sheet, half, FROM_SIDE, SCALE, right)
    sheet.area([SCALE * _moved(ring, right) for ring in _cut(half, bolt_u)], "body", CUT)
    lean = math.tan(math.radians(m.tilt_deg))
    tip = _page(right + high + 6, -lean * (high + 6))
    sheet.lines(
        [
            line(_page(right - 3, m.bolt_w_mm), _page(right + high + 6, m.bolt_w_mm)),
            line(_page(right - 1, 0), _page(right + high + 6, 0)),
            line(_page(right, -3), _page(right, m.block_back_w_mm + 1)),
            *([line(_page(right, 0), tip)] * ("tilt_deg" in figures)),
        ],
        "axis",
    )
    back, low = m.block_back_w_mm, m.bolt_w_mm + m.pin_mm / 2
    spans = [("land_mm", _page(right, back), _page(right + m.land_mm, back))]
    above, into_gripper = [], []
    if THREAD in figures:
        into, side = m.into_gripper_mm, float(m.bolt.removeprefix("M")) / 2
        end = right - into
        bolt = rectangle((end, right), (m.bolt_w_mm - side, m.bolt_w_mm + side))
        sheet.lines([bolt * (SCALE, -SCALE)], "hidden")
        at = m.bolt_w_mm + side
        into_gripper = [(f"{m.bolt}, {into:.1f} mm into it", _page(end, at), _page(right, at))]
    if m.pin_u_mm:
        pin = rectangle((right, right + m.pin_depth_mm), (2 * m.bolt_w_mm - low, low))
        sheet.lines([pin * (SCALE, -SCALE)], "hidden")
        spans.append(("pins.depth_mm", _page(right, low), _page(right + m.pin_depth_mm, low)))
    if m.nose:
        front, top = m.nose.front_w_mm, right + m.nose.height_mm
        above.append(("nose.height_mm", _page(right, front), _page(top, front)))
    below = [*_shown(spans, figures), *into_gripper]
    dimension_rows(sheet, below, -SCALE * back - GAP_MM, -1)
    dimension_rows(sheet, _shown(above, figures), GAP_MM, 1)
    names = [("bolt", _page(right + high + 6, m.bolt_w_mm))]
    names += [("tilt_deg", tip)] * ("tilt_deg" in figures)
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
