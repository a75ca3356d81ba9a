"""The silicone mould of a finger, printed open side up."""

import math

import numpy as np
from build123d import Face, Location, Solid, Vector, Wire

from lumitip_fab.design import (
    Board,
    Box,
    Clamp,
    Design,
    Finger,
    Insert,
    Mould,
    Outline,
    Stack,
)
from lumitip_fab.design.frames import mould_bed_to_sensor
from lumitip_fab.design.making import FOOT_CHAMFER_MM, LEDGE_MM
from lumitip_fab.parts import export, skin
from lumitip_fab.parts.clamp import CHANGED, rails
from lumitip_fab.parts.letters import letter_cutter
from lumitip_fab.parts.shapes import box_face, box_solid, one_solid, side_prism
from lumitip_fab.parts.wrap import fillings
from lumitip_fab.pipeline.artefact import Artefact

CHORD_MM = 0.002  # finer than other parts: the draft is measured on walls 1.6 mm high
WEIR_FRACTION = 0.8  # of the wire notch, through which wires and surplus leave
WEIR_DRAFT_DEG = 15.0
GRIP_SLOPE_DEG = 45.0
BEYOND_MM = 1.0


def mould_files(design: Design, finger: Finger) -> tuple[Artefact, ...]:
    """The mould of one finger; its facts have the silicone that stays on the finger."""
    stack, outline, mould = design.stack, design.outline, design.mould
    solid = mould_solid(finger, stack, outline, mould, design.clamps)
    filled = fillings(design.keys, stack, outline, design.tip, mould)
    volume_ml = cast_volume_ml(finger, stack, outline, design.board, mould, filled)
    return export.part_files(
        f"mould/{finger.name}_mould",
        solid,
        mould_bed_to_sensor(stack, mould),
        chord_mm=CHORD_MM,
        facts={"cast_ml": volume_ml},
    )


def cast_volume_ml(
    finger: Finger,
    stack: Stack,
    outline: Outline,
    board: Board,
    mould: Mould,
    filled: list[Solid],
) -> float:
    """Silicone that stays on a finger: the cavity to the rim, what it fills in the plate and round
    its tip, less the parts that dip into it."""
    cavity = float(skin.silicone_solid(stack, outline, board, mould, filled).volume)
    dipped = sum(
        part.size_x_mm * part.size_y_mm * part.height_mm
        for part in finger.parts
        if part.side == "front"
    )
    return (cavity - dipped) / 1000


def mould_solid(
    finger: Finger, stack: Stack, outline: Outline, mould: Mould, clamps: tuple[Clamp, ...]
) -> Solid:
    """The mould in the finger's sensor frame, where its open side looks to -z.

    Args:
        finger: for the wire notch, before which the mould is open, and for its letter.
        stack: heights; the wall ends below the plate's back, so that the plate stands out.
        outline: of the plate.
        mould: the wall and the skin.
        clamps: for the rails on its outside.

    Raises:
        BuildError: if the kernel does not make one valid solid of it.
    """
    top_z = stack.face_z_mm - mould.guided_mm
    outside = mould.outside_mm
    weir_half = WEIR_FRACTION * finger.notch.x_max_mm
    end_y = mould.wall_mm - mould.letter.wall_mm
    catch = Box(-weir_half - LEDGE_MM, weir_half + LEDGE_MM, end_y, mould.weir_y_mm)
    block = _footed(stack, outline, mould, top_z, outside) + _trough_block(
        stack, mould, catch, outside
    )
    block = block + [rail for clamp in clamps for rail in rails(clamp, stack, mould)]
    cavity = skin.drafted_prism(stack, outline, mould, top_z - BEYOND_MM, BEYOND_MM)
    taken = [
        cavity & skin.side_solid(stack, outline, mould),
        _weir(stack, outline, weir_half, outside),
        _trough(stack, mould, catch),
        _grip(stack, outline, mould, outside),
        letter_cutter(finger.name, mould.letter, mould_bed_to_sensor(stack, mould)),
        *(_recess(insert, stack) for insert in mould.inserts),
    ]
    whole = (block - taken) + skin.stops(stack, outline, mould)
    return one_solid(whole, "mould", CHANGED)


def _footed(
    stack: Stack, outline: Outline, mould: Mould, top_z_mm: float, outside_mm: float
) -> Solid:
    """The outer body, chamfered where it stands on the bed."""
    bed_z = stack.silicone_z_mm + mould.floor_mm
    shoulder_z = bed_z - FOOT_CHAMFER_MM
    top, shoulder = (skin.offset_wire(outline, outside_mm, z) for z in (top_z_mm, shoulder_z))
    foot = skin.offset_wire(outline, outside_mm - FOOT_CHAMFER_MM, bed_z)
    return Solid.make_loft([top, shoulder, foot], ruled=True)


def _trough_block(stack: Stack, mould: Mould, catch: Box, outside_mm: float) -> Solid:
    """The block that holds the trough, joined to the body."""
    bed_z = stack.silicone_z_mm + mould.floor_mm
    inside_y = catch.y_max_mm + LEDGE_MM + outside_mm / 2
    outer = Box(
        catch.x_min_mm - mould.wall_mm,
        catch.x_max_mm + mould.wall_mm,
        catch.y_min_mm - mould.wall_mm,
        inside_y,
    )
    lip = box_solid(outer, stack.face_z_mm, bed_z, mould.wall_mm / 2)
    on_bed = [edge for edge in lip.edges() if abs(edge.center().Z - bed_z) < 1e-6]
    return lip.chamfer(FOOT_CHAMFER_MM, None, on_bed)


def _weir(stack: Stack, outline: Outline, half_mm: float, outside_mm: float) -> Solid:
    """The opening of the wall at the gripper end, down to the rim plane."""
    rise = stack.plate_mm
    wider = half_mm + rise * math.tan(math.radians(WEIR_DRAFT_DEG))
    rim, over = stack.face_z_mm, stack.face_z_mm - rise
    start = outline.end_y_mm - outside_mm - BEYOND_MM
    length = outside_mm + 2 * BEYOND_MM
    corners = [(-half_mm, rim), (-wider, over), (wider, over), (half_mm, rim)]
    face = Face(Wire.make_polygon([(x, start, z) for x, z in corners], close=True))
    return Solid.extrude(face, Vector(0, length, 0))


def _trough(stack: Stack, mould: Mould, catch: Box) -> Solid:
    """The basin for the surplus, over a floor half as thick as the walls."""
    rim, floor = stack.face_z_mm, stack.silicone_z_mm + mould.floor_mm - mould.wall_mm / 2
    slope = math.tan(math.radians(WEIR_DRAFT_DEG))
    over = LEDGE_MM  # above the rim, where there is nothing left to cut
    rings = [
        box_face(catch.grown(slope * over)).outer_wire().moved(_height(rim - over)),
        box_face(catch.grown(-slope * (floor - rim))).outer_wire().moved(_height(floor)),
    ]
    return Solid.make_loft(rings, ruled=True)


def _recess(insert: Insert, stack: Stack) -> Solid:
    """The place of the insert in the floor."""
    floor = stack.silicone_z_mm
    return box_solid(insert.recess, floor - stack.cover_mm / 2, floor + insert.thickness_mm)


def _grip(stack: Stack, outline: Outline, mould: Mould, outside_mm: float) -> Solid:
    """The gaps in both side walls, as one cutter across the mould."""
    grip = mould.grip
    bottom, over = stack.face_z_mm - grip.bottom_mm, stack.back_z_mm
    wider = (bottom - over) * math.tan(math.radians(GRIP_SLOPE_DEG))
    far = float(np.abs(outline.polygon()[:, 0]).max()) + outside_mm + BEYOND_MM
    corners = [
        (grip.y_min_mm, bottom),
        (grip.y_min_mm - wider, over),
        (grip.y_max_mm + wider, over),
        (grip.y_max_mm, bottom),
    ]
    return side_prism(corners, -far, far)


def _height(z_mm: float) -> Location:
    return Location((0, 0, z_mm))
