"""The clamp that holds a finger on the stops of its mould, and the rails that it is screwed to.

It is printed on its flat back, feet and legs up, so that nothing hangs over.
"""

from build123d import Face, Plane, Solid, Vector, Wire

from lumitip_fab.design import Box, Clamp, Design, Mould, Stack
from lumitip_fab.design.clamp import MARK_MM
from lumitip_fab.design.frames import clamp_bed_to_sensor
from lumitip_fab.design.making import FOOT_CHAMFER_MM
from lumitip_fab.parts import export
from lumitip_fab.parts.shapes import box_solid, cylinder, one_solid
from lumitip_fab.pipeline.artefact import Artefact

CHANGED = "mould.wall_mm or the outline"
"""Parameters to change where the kernel fails on mould or clamp."""
BEYOND_MM = 1.0  # how far a cutter reaches past what it cuts


def clamp_files(design: Design, clamp: Clamp) -> tuple[Artefact, ...]:
    """The clamp: STEP in the sensor frame, STL and 3MF on its back."""
    solid = clamp_solid(clamp, design.stack, design.mould)
    return export.part_files(f"mould/{clamp.name}", solid, clamp_bed_to_sensor(design.stack, clamp))


def clamp_solid(clamp: Clamp, stack: Stack, mould: Mould) -> Solid:
    """The clamp in the sensor frame of a finger that lies on its stops.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    bed_z = _bed_z_mm(stack, mould)
    top, under = bed_z - clamp.top_mm, stack.back_z_mm - clamp.foot_mm
    whole = box_solid(clamp.bar, top, under)
    whole = whole + [box_solid(box, top, under) for box in (*clamp.arms, *clamp.lugs)]
    whole = whole + [box_solid(foot, top, stack.back_z_mm) for foot in clamp.feet]
    whole = whole + [box_solid(leg, top, bed_z - clamp.leg_end_mm) for leg in clamp.legs]
    taken = [cylinder(at, clamp.hole_mm, top - BEYOND_MM, under + 1) for at in clamp.screws]
    taken += [_mark(clamp, leg, bed_z) for leg in clamp.legs]
    return one_solid((whole - taken).clean(), "clamp", CHANGED)


def rails(clamp: Clamp, stack: Stack, mould: Mould) -> list[Solid]:
    """Both rails in the sensor frame, each with its mark and the hole for its screw, which is
    countersunk from below."""
    bed_z = _bed_z_mm(stack, mould)
    top = bed_z - clamp.rail_mm
    sink = (clamp.head_mm - clamp.rail_hole_mm) / 2
    made = []
    for rail, at in zip(clamp.rails, clamp.screws, strict=True):
        block = box_solid(rail, top, bed_z)
        on_bed = [edge for edge in block.edges() if abs(edge.center().Z - bed_z) < 1e-6]
        head = Solid.make_cone(
            clamp.rail_hole_mm / 2,
            clamp.head_mm / 2,
            sink,
            Plane((*at, bed_z - sink)),
        )
        hole = cylinder(at, clamp.rail_hole_mm, top - BEYOND_MM, bed_z + BEYOND_MM)
        chamfered = block.chamfer(FOOT_CHAMFER_MM, None, on_bed)
        made.append(
            one_solid(chamfered - [head, hole, _mark(clamp, rail, bed_z)], "mould", CHANGED)
        )
    return made


def _bed_z_mm(stack: Stack, mould: Mould) -> float:
    """z of the mould's bed, in the sensor frame, where z looks down in the mould."""
    return stack.silicone_z_mm + mould.floor_mm


def _mark(clamp: Clamp, box: Box, bed_z_mm: float) -> Solid:
    """Cutter of the mark along the outer side of a leg or rail: a V, with no roof that hangs."""
    z, side = bed_z_mm - clamp.mark_mm, 1 if box.x_min_mm > 0 else -1
    face_x = box.x_max_mm if side > 0 else box.x_min_mm
    start, length = box.y_min_mm - BEYOND_MM, box.length_mm + 2 * BEYOND_MM
    open_mm = MARK_MM + BEYOND_MM
    corners = [
        (face_x - side * MARK_MM, z),
        (face_x + side * BEYOND_MM, z - open_mm),
        (face_x + side * BEYOND_MM, z + open_mm),
    ]
    face = Face(Wire.make_polygon([(x, start, h) for x, h in corners], close=True))
    return Solid.extrude(face, Vector(0, length, 0))
