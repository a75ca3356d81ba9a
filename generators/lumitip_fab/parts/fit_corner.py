"""A corner of the pocket that stands on the bed as on the backing, for the fit test plate."""

import math
from dataclasses import dataclass, replace

import numpy as np
from build123d import Face, Solid, Vector, Wire

from lumitip_fab.design import Box, Design, Fits, PocketCorner
from lumitip_fab.design.frames import fit_corner_to_sensor
from lumitip_fab.parts.backing import pin_solid, pocket_solid
from lumitip_fab.parts.plate import BEYOND_MM
from lumitip_fab.parts.shapes import box_solid, placed, side_prism

SHARED = 0.5  # of the floor, that gussets and pin reach into it


@dataclass(frozen=True)
class _Leaning:
    """A plane that leans as the plate does: its y on the bed by its z."""

    foot_y_mm: float
    lean: float

    def y_mm(self, z_mm: float) -> float:
        return self.foot_y_mm - z_mm * self.lean


def corner_solid(corner: PocketCorner, fits: Fits, design: Design, foot_mm: float) -> Solid:
    """The corner of the first coupon on the bed.

    Args:
        corner: its place.
        fits: gap and pin.
        design: for stack, tilt and board.
        foot_mm: thickness of its foot.
    """
    stack, box, gap = design.stack, design.board.box, fits.pocket_gap_mm
    to_bed = np.asarray(np.linalg.inv(fit_corner_to_sensor(corner, design.mount, stack)))
    tilt = math.radians(design.mount.tilt_deg)
    front = _Leaning(corner.foot.y_min_mm, math.tan(tilt))
    floor = replace(front, foot_y_mm=front.foot_y_mm + stack.pcb_mm / math.cos(tilt))
    back = replace(front, foot_y_mm=front.foot_y_mm + stack.plate_mm / math.cos(tilt))
    ends = (0.0, corner.height_mm)
    profile = [(front.y_mm(z), z) for z in ends] + [(back.y_mm(z), z) for z in reversed(ends)]
    sunk = SHARED * stack.floor_mm
    behind = [box_solid(corner.foot, 0.0, foot_mm), *_gussets(corner, back, foot_mm, sunk)]
    body = side_prism(profile, corner.x_min_mm, corner.x_max_mm) + behind
    open_to = corner.x_max_mm - corner.origin_mm[0] + BEYOND_MM
    low = corner.pin[1] - 2 * corner.height_mm
    room = Box(box.x_min_mm - gap, open_to, low, box.y_max_mm + gap)
    pocket = placed(pocket_solid(stack, replace(design.board, pocket=room)), to_bed)
    bottom = stack.pocket_z_mm - sunk
    pin = pin_solid(corner.pin, fits.pin_mm, bottom, stack.rim_z_mm, stack.pcb_mm)
    inner = corner.origin_mm[0] + room.x_min_mm
    return body - [pocket, *_leads(corner, inner, floor)] + placed(pin, to_bed)


def _gussets(corner: PocketCorner, back: _Leaning, foot_mm: float, sunk_mm: float) -> list[Solid]:
    """A triangle behind the plate at either side."""
    reach, high = corner.gusset_mm
    end = back.foot_y_mm + reach
    profile = [
        (back.y_mm(0.0) - sunk_mm, 0.0),
        (end, 0.0),
        (end, foot_mm),
        (back.y_mm(high), high),
        (back.y_mm(high) - sunk_mm, high),
    ]
    sides = (corner.x_min_mm, corner.x_max_mm - corner.wall_mm)
    return [side_prism(profile, x, x + corner.wall_mm) for x in sides]


def _leads(corner: PocketCorner, inner_mm: float, floor: _Leaning) -> list[Solid]:
    """Chamfers of the pocket's floor and wall at the bed, where a first layer is squeezed wide."""
    lead, below = corner.lead_mm, -BEYOND_MM
    wide = lead + BEYOND_MM
    at_floor = [
        (floor.y_mm(lead), lead),
        (floor.y_mm(lead) + wide, below),
        (floor.y_mm(lead) - BEYOND_MM, below),
        (floor.y_mm(lead) - BEYOND_MM, lead),
    ]
    near, far = inner_mm, inner_mm + BEYOND_MM
    y = corner.foot.y_min_mm - BEYOND_MM
    at_wall = [(near, lead), (near - wide, below), (far, below), (far, lead)]
    face = Face(Wire.make_polygon([(x, y, z) for x, z in at_wall], close=True))
    return [
        side_prism(at_floor, inner_mm, corner.x_max_mm + BEYOND_MM),
        Solid.extrude(face, Vector(0, floor.foot_y_mm - y, 0)),
    ]
