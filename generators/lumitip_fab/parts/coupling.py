"""The gripper coupling on the back of a finger: block, ramp, and the room for screw and pins.

Side view, the gripper at the left and the tip to the right (w is down):

    h = 0     notch                         plate
      ┊       ┌─────────────────────────────────────
      ┊──────╱ ── front of the block, 45° ──╲___───  flare
      │                                   ╭──╯
      │ bolt ▷ land ┆ counterbore     ╱ 45° ramp
      │─────────────┆───────────────╱
      └─────────────┴─────────────╱
                land
"""

import math

import numpy as np
from build123d import Edge, Face, Plane, Solid, Vector, Wire

from lumitip_fab.design import Box, Mount, Point, Stack
from lumitip_fab.design.frames import Matrix, applied, mount_to_sensor
from lumitip_fab.parts.shapes import cylinder, placed, polygon_face, prism
from lumitip_fab.parts.tie_lug import lug_openings, lug_solids

FILLET_END_DEG = 12.0  # fillets meet the plate at an angle: tangent faces do not fuse
SIDE_FLARE_MM = 1.5  # block's sides into plate; less than the gap kept to reliefs
SHEET_MM = 0.4  # fraction of the floor that block and floor share
BEYOND_MM = 1.0  # how far a cutter reaches past what it cuts
_FAR_MM = 200.0


def coupling_solid(mount: Mount, stack: Stack, notch: Box | None) -> Solid:
    """Block, ramp and flares in the sensor frame, without holes, not yet cut on the mount plane.

    Args:
        mount: the coupling.
        stack: for the plate that it grows from.
        notch: opening of the plate in front of it; without one the block goes down to the bed, and
            has no fillets at its sides.
    """
    to_sensor = mount_to_sensor(mount, stack)
    top_mm = mount.land_mm + 2 * mount.block_back_w_mm + mount.flare_mm
    block = prism(_plan(mount), -BEYOND_MM, top_mm)
    for side in beside_nose(mount):
        block = block - side
    profile = _profile(mount, stack, notch)
    wide = mount.block_width_mm / 2 + 2 * SIDE_FLARE_MM
    body = placed(block, to_sensor) & _across(profile, wide)
    if notch is None:
        return body
    return body + (_side_flares(mount, stack, notch, top_mm) & _across(profile, wide))


def coupling_holes(mount: Mount, stack: Stack) -> list[Solid]:
    """Cutters for screws and gripper pins, in the sensor frame: bolt holes, counterbores open
    towards the tip so that screws and their driver go in, and pin holes."""
    holes = []
    for u in mount.bolt_u_mm:
        axis = (u, mount.bolt_w_mm)
        holes += [
            cylinder(axis, mount.bolt_hole_mm, -BEYOND_MM, mount.land_mm + BEYOND_MM),
            cylinder(axis, mount.counterbore_mm, mount.land_mm, _FAR_MM),
        ]
    holes += [
        cylinder((u, mount.bolt_w_mm), mount.pin_mm, -BEYOND_MM, mount.pin_depth_mm)
        for u in mount.pin_u_mm
    ]
    return [placed(hole, mount_to_sensor(mount, stack)) for hole in holes]


def tie_lugs(mount: Mount, stack: Stack) -> list[Solid]:
    """The lugs beside the block, in the sensor frame."""
    return [placed(lug, mount_to_sensor(mount, stack)) for lug in lug_solids(mount.lugs)]


def tie_openings(mount: Mount, stack: Stack) -> list[Solid]:
    """The openings of those lugs, in the sensor frame."""
    return [placed(cutter, mount_to_sensor(mount, stack)) for cutter in lug_openings(mount.lugs)]


def beyond_mount_plane(mount: Mount, stack: Stack) -> Solid:
    """Everything on the gripper's side of the mount plane, in the sensor frame."""
    square = polygon_face(
        [(-_FAR_MM, -_FAR_MM), (_FAR_MM, -_FAR_MM), (_FAR_MM, _FAR_MM), (-_FAR_MM, _FAR_MM)]
    )
    return placed(prism(square, -_FAR_MM, 0.0), mount_to_sensor(mount, stack))


def notch_cutter(stack: Stack, mount: Mount, notch: Box) -> Solid:
    """The notch through the plate. Its upper end rises at 45° as printed, from the plate's back
    to the pocket, so that nothing hangs over."""
    (low_y, low_z), (high_y, high_z) = _notch_end(mount, stack, notch)
    front = stack.rim_z_mm + BEYOND_MM
    end = notch.y_min_mm - 2 * BEYOND_MM
    slope = (high_y - low_y) / (high_z - low_z)
    back = low_z - BEYOND_MM
    corners = [
        (end, back),
        (low_y - BEYOND_MM * slope, back),
        (high_y, high_z),
        (high_y, front),
        (end, front),
    ]
    face = _yz_face(corners, notch.x_min_mm)
    return Solid.extrude(face, Vector(notch.width_mm, 0, 0))


def beside_nose(mount: Mount) -> list[Solid]:
    """Cutters on either side of the block's nose, in the mount frame.

    Above the nose the block widens at 45°, so that it prints without support.
    """
    nose = mount.nose
    if nose is None:
        return []
    sine = math.sin(math.radians(nose.half_angle_deg))
    cosine = math.cos(math.radians(nose.half_angle_deg))
    reach = mount.block_width_mm
    sides = []
    for side in (-1, 1):
        outward = Vector(side * cosine, -sine, 0)
        along = Vector(side * sine, cosine, 0)
        corner = Vector(side * nose.front_width_mm / 2, nose.front_w_mm, 0) - along * reach
        section = [
            (0.0, -2 * BEYOND_MM),
            (reach, -2 * BEYOND_MM),
            (reach, nose.height_mm + reach),
            (0.0, nose.height_mm),
        ]
        points = [corner + outward * d + Vector(0, 0, h) for d, h in section]
        face = Face(Wire.make_polygon(points, close=True))
        sides.append(Solid.extrude(face, along * (3 * reach)))
    return sides


def _plan(mount: Mount) -> Face:
    """The block in the (u, w) plane, its back corners rounded."""
    half, back, front = mount.block_width_mm / 2, mount.block_back_w_mm, -mount.block_back_w_mm
    face = polygon_face([(-half, front), (half, front), (half, back), (-half, back)])
    corners = [v for v in face.vertices() if v.Y > 0]
    return face.fillet_2d(mount.block_corner_mm, corners)


def _notch_end(mount: Mount, stack: Stack, notch: Box) -> tuple[Point, Point]:
    """The notch's upper end as (y, z) at the plate's back and at the pocket's floor: 45° to the
    bed, which itself is tilted against the plate."""
    slope = math.tan(math.radians(45 + mount.tilt_deg))
    low = (notch.y_max_mm, stack.back_z_mm)
    return low, (notch.y_max_mm + slope * stack.floor_mm, stack.pocket_z_mm)


def _profile(mount: Mount, stack: Stack, notch: Box | None) -> Wire:
    """Block and ramp in the (y, z) plane, closed inside the plate's floor."""
    to_sensor = mount_to_sensor(mount, stack)
    inside_z = stack.back_z_mm + SHEET_MM * stack.floor_mm
    back = _yz(to_sensor, mount.block_back_w_mm, -BEYOND_MM)
    shoulder = _yz(to_sensor, mount.block_back_w_mm, mount.land_mm)
    end, nose, start = _flare(mount, shoulder, stack.back_z_mm)
    sunk = (end[0] + inside_z - end[1], inside_z)
    corners = [sunk, *_front(mount, stack, notch, inside_z), back, shoulder, start, nose]
    return Wire.make_polygon([_point(corner) for corner in corners], close=True)


def _front(mount: Mount, stack: Stack, notch: Box | None, inside_z_mm: float) -> list[Point]:
    """The block's front, from the sheet inside the floor down to below the mount plane."""
    to_sensor = mount_to_sensor(mount, stack)
    foot = _yz(to_sensor, mount.block_front_w_mm, -BEYOND_MM)
    if notch is None:
        return [(foot[0], inside_z_mm)]
    (low_y, low_z), (high_y, high_z) = _notch_end(mount, stack, notch)
    rise = (high_y - low_y) / (high_z - low_z)
    at_floor = (low_y + rise * (inside_z_mm - low_z), inside_z_mm)
    front_h = _front_top_h(mount, to_sensor, (low_y, low_z))
    return [at_floor, _yz(to_sensor, mount.block_front_w_mm, front_h), foot]


def _front_top_h(mount: Mount, to_sensor: Matrix, notch_end: Point) -> float:
    """Height h where the block's front meets the 45° slope through the notch's end."""
    y, z = notch_end
    dy, dz = y - to_sensor[1, 3], z - to_sensor[2, 3]
    w = to_sensor[1, 1] * dy + to_sensor[2, 1] * dz
    h = to_sensor[1, 2] * dy + to_sensor[2, 2] * dz
    return float(h - (mount.block_front_w_mm - w))


def _flare(mount: Mount, shoulder: Point, back_z_mm: float) -> list[Point]:
    """The flare in (y, z): from the plate's back at its end, down to the ramp."""
    steep, depth = math.tan(math.radians(45 - mount.tilt_deg)), mount.flare_depth_mm
    foot_y = shoulder[0] + (back_z_mm - shoulder[1]) / steep
    end_y, nose = foot_y + mount.flare_mm, mount.flare_end_mm
    return [
        (end_y, back_z_mm),
        (end_y - nose, back_z_mm - nose),
        (foot_y - depth / steep, back_z_mm - depth),
    ]


def _side_flares(mount: Mount, stack: Stack, notch: Box, length_mm: float) -> Solid:
    """Hollow fillets between the block's sides and the plate's back, drawn along y."""
    half, radius = mount.block_width_mm / 2, SIDE_FLARE_MM
    back, inside = stack.back_z_mm, stack.back_z_mm + SHEET_MM * stack.floor_mm
    start_y = _notch_end(mount, stack, notch)[1][0]
    flat = math.radians(FILLET_END_DEG)
    centre = (half + radius, back - radius * math.cos(flat))
    arc = [
        (centre[0] - radius * math.cos(a), centre[1] + radius * math.sin(a))
        for a in (0.0, (math.pi / 2 - flat) / 2, math.pi / 2 - flat)
    ]

    def at(point: Point, side: int) -> Vector:
        return Vector(side * point[0], start_y, point[1])

    edges = []
    for side in (-1, 1):
        low, middle, high = (at(p, side) for p in arc)
        edges.append(Edge.make_three_point_arc(low, middle, high))
        edges.append(Edge.make_line(high, at((arc[2][0], inside), side)))
    edges.append(Edge.make_line(at(arc[0], -1), at(arc[0], 1)))
    edges.append(Edge.make_line(at((arc[2][0], inside), -1), at((arc[2][0], inside), 1)))
    return Solid.extrude(Face(Wire(edges)), Vector(0, length_mm, 0))


def _across(profile: Wire, half_width_mm: float) -> Solid:
    """A profile at x = 0 drawn out to both sides."""
    face = Face(profile).moved(Plane((-half_width_mm, 0, 0)).location)
    return Solid.extrude(face, Vector(2 * half_width_mm, 0, 0))


def _yz(to_sensor: Matrix, w_mm: float, h_mm: float) -> Point:
    point = applied(to_sensor, np.array([[0.0, w_mm, h_mm]]))[0]
    return float(point[1]), float(point[2])


def _point(yz: Point) -> Vector:
    return Vector(0, yz[0], yz[1])


def _yz_face(corners: list[Point], x_mm: float) -> Face:
    return Face(Wire.make_polygon([(x_mm, y, z) for y, z in corners], close=True))
