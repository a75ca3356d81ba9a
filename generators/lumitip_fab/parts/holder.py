"""Holder of an auxiliary board: a tray on a cradle, with two arms that clip round the gripper."""

import math

import numpy as np
from build123d import Edge, Face, Plane, Solid, Wire

from lumitip_fab.design import Box, Design, Holder, Point
from lumitip_fab.design.frames import Matrix, holder_bed_to_auxiliary
from lumitip_fab.parts import export
from lumitip_fab.parts.shapes import box_solid, cylinder, one_solid, placed, polygon_face, prism
from lumitip_fab.parts.tie_lug import lug_openings, lug_solids
from lumitip_fab.pipeline.artefact import Artefact

BEYOND_MM = 1.0  # how far a cutter reaches past what it cuts
_ALONG_Y = np.array([[1.0, 0, 0, 0], [0, 0, -1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
"""From a section's frame (x, z, -y) to the auxiliary board's."""


def holder_files(_design: Design, holder: Holder) -> tuple[Artefact, ...]:
    """The holder: STEP in its board's frame, STL and 3MF standing on the bed."""
    solid, bed = holder_solid(holder), holder_bed_to_auxiliary(holder)
    return export.part_files(f"holder/{holder.name}", solid, bed, "auxiliary")


def holder_solid(holder: Holder) -> Solid:
    """The holder in its auxiliary board's frame.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    whole = _tray(holder) + [_arm(holder, side) for side in (-1, 1)]
    whole = whole - _body(holder)
    whole = whole + [_end(holder, side) for side in (-1, 1)]
    whole = whole + [_boss(holder, at) for at in holder.holes]
    taken = [cutter for at in holder.holes for cutter in _screw(holder, at)]
    taken += [_strap(holder, side, y) for side in (-1, 1) for y in holder.strap_y_mm]
    bed, lugs = holder_bed_to_auxiliary(holder), (*holder.lugs, *holder.arm_lugs)
    whole = whole + [placed(lug, bed) for lug in lug_solids(lugs)]
    taken += [placed(cutter, bed) for cutter in lug_openings(lugs)]
    whole = (whole - taken).clean()
    return one_solid(whole, "holder", "[holder]")


def _tray(holder: Holder) -> Solid:
    """The block down to where its sides meet the arms, without the inside of the tray."""
    outer, across = holder.outer, holder.cradle_mm + holder.wall_mm
    low = holder.axis_z_mm + math.sqrt(across**2 - outer.x_max_mm**2)
    block = box_solid(outer, low, holder.top_z_mm)
    inside = Box(
        holder.tray.x_min_mm,
        holder.tray.x_max_mm,
        holder.tray.y_min_mm - BEYOND_MM,
        holder.tray.y_max_mm + BEYOND_MM,
    )
    return block - box_solid(inside, holder.floor_z_mm, holder.top_z_mm + BEYOND_MM)


def _body(holder: Holder) -> Solid:
    """The gripper's body with the clearance round it."""
    y = holder.outer.y_max_mm + BEYOND_MM
    plane = Plane((0.0, y, holder.axis_z_mm), x_dir=(1, 0, 0), z_dir=(0, -1, 0))
    return Solid.make_cylinder(holder.cradle_mm, 2 * y, plane)


def _arm(holder: Holder, side: int) -> Solid:
    """Half a ring from the middle of the tray to where its end begins."""
    inner, outer = holder.cradle_mm, holder.cradle_mm + holder.wall_mm
    bow = [
        Edge.make_circle(radius, Plane.XY, 90.0 - holder.wrap_deg, 90.0)
        for radius in (inner, outer)
    ]
    ends = [Edge.make_line(bow[0] @ t, bow[1] @ t) for t in (0.0, 1.0)]
    ring = prism(Face(Wire([*bow, *ends])), holder.outer.y_min_mm, holder.outer.y_max_mm)
    mirrored = ring.mirror(Plane.YZ) if side < 0 else ring
    return placed(mirrored, _at_axis(holder))


def _end(holder: Holder, side: int) -> Solid:
    """The round bar along an arm's end, whose inner side is the rib that presses on the body."""
    turn = math.radians(90.0 - holder.wrap_deg)
    radius, middle = holder.end_mm
    at = (side * middle * math.cos(turn), middle * math.sin(turn))
    bar = cylinder(at, 2 * radius, holder.outer.y_min_mm, holder.outer.y_max_mm)
    return placed(bar, _at_axis(holder))


def _at_axis(holder: Holder) -> Matrix:
    """From a section's frame with the axis at its origin to the auxiliary board's."""
    matrix = _ALONG_Y.copy()
    matrix[2, 3] = holder.axis_z_mm
    return matrix


def _boss(holder: Holder, at: Point) -> Solid:
    """A block under a screw, its sides along y at 45° so that it prints standing."""
    length, top, foot = (size / 2 for size in holder.boss_mm)
    below = holder.floor_z_mm - holder.wall_mm / 2
    corners = [
        (-foot, below),
        (foot, below),
        (foot, holder.floor_z_mm),
        (top, 0.0),
        (-top, 0.0),
        (-foot, holder.floor_z_mm),
    ]
    profile = prism(polygon_face(corners), -length, length)
    along_x = np.array([[0, 0, 1.0, at[0]], [1.0, 0, 0, at[1]], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
    return placed(profile, along_x)


def _screw(holder: Holder, at: Point) -> tuple[Solid, Solid]:
    """A screw's hole, and the pocket of its nut from the cradle."""
    far = holder.axis_z_mm
    hole = cylinder(at, holder.screw_mm, far, BEYOND_MM)
    radius = holder.nut_mm / math.sqrt(3)
    corners = [
        (
            at[0] + radius * math.cos(math.radians(60 * k)),
            at[1] + radius * math.sin(math.radians(60 * k)),
        )
        for k in range(6)
    ]
    return hole, prism(polygon_face(corners), far, holder.seat_z_mm)


def _strap(holder: Holder, side: int, y_mm: float) -> Solid:
    """A hole through an arm, from the axis outward."""
    turn = math.radians(holder.strap_deg)
    out = (side * math.sin(turn), 0.0, math.cos(turn))
    plane = Plane((0.0, y_mm, holder.axis_z_mm), z_dir=out)
    reach = holder.cradle_mm + holder.wall_mm + BEYOND_MM
    return Solid.make_cylinder(holder.strap_hole_mm / 2, reach, plane)
