"""The plate of a finger with the wedge at its tip, and the keys through it that silicone fills."""

from dataclasses import replace

import numpy as np
from build123d import Plane, Solid

from lumitip_fab.design import Box, Key, Outline, Stack, Tip
from lumitip_fab.parts import shapes

BEYOND_MM = 1.0  # how far a cutter reaches past what it cuts


def plate_solid(stack: Stack, outline: Outline, tip: Tip) -> Solid:
    """The plate, reaching past the gripper end so that the tilted mount plane cuts it all."""
    plate = _whole(stack, outline)
    taken = [_tip_cutter(stack, outline, tip)] if tip.angle_deg > 0 else []
    taken += [_slot(slot, stack) for slot in tip.slots]
    return plate - taken if taken else plate


def key_cutters(keys: tuple[Key, ...], stack: Stack, tip: Tip) -> list[Solid]:
    """What is cut out of the plate for its keys: each a hole with a cone of 90° in the back."""
    return [_key(key, stack, tip) for key in keys]


def key_fillings(keys: tuple[Key, ...], stack: Stack, outline: Outline, tip: Tip) -> list[Solid]:
    """The silicone in the keys, level with the plate's back."""
    if not keys:
        return []
    plate = plate_solid(stack, outline, tip)
    return [(cutter & plate).solid() for cutter in key_cutters(keys, stack, tip)]


def _key(key: Key, stack: Stack, tip: Tip) -> Solid:
    (x, y), radius = key.at, key.hole_mm / 2
    low = stack.back_z_mm - BEYOND_MM  # on the wedge, too: there the cone leaves the back deeper
    deep = tip.back_z_mm(stack, y) + key.sink_mm - low
    cone = Solid.make_cone(radius + deep, radius, deep, Plane((x, y, low)))
    return shapes.cylinder(key.at, key.hole_mm, low, stack.face_z_mm + BEYOND_MM) + cone


def _whole(stack: Stack, outline: Outline) -> Solid:
    """The plate without its wedge."""
    half = outline.end_width_mm / 2
    foot = Box(-half, half, outline.end_y_mm - BEYOND_MM, outline.end_y_mm)
    plate = shapes.prism(shapes.outline_face(outline), stack.back_z_mm, stack.face_z_mm)
    return plate + shapes.box_solid(foot, stack.back_z_mm, stack.face_z_mm)


def _slot(slot: Box, stack: Stack) -> Solid:
    """Cutter that sets the tip edge back."""
    reaching = replace(slot, y_max_mm=slot.y_max_mm + BEYOND_MM)
    return shapes.box_solid(reaching, stack.back_z_mm - BEYOND_MM, stack.face_z_mm + BEYOND_MM)


def _tip_cutter(stack: Stack, outline: Outline, tip: Tip) -> Solid:
    """Volume that the wedge cuts from the back of the plate."""
    edge_z = stack.face_z_mm - tip.edge_mm
    rise = (edge_z - stack.back_z_mm) / (outline.tip_y_mm - tip.slant_start_y_mm)
    end_y, far_z = outline.tip_y_mm + BEYOND_MM, stack.back_z_mm - BEYOND_MM
    start_y = tip.slant_start_y_mm
    half = float(np.abs(outline.polygon()[:, 0]).max()) + BEYOND_MM
    corners = [
        (start_y, stack.back_z_mm),
        (end_y, edge_z + rise * BEYOND_MM),
        (end_y, far_z),
        (start_y, far_z),
    ]
    return shapes.side_prism(corners, -half, half)
