"""Measures of the gripper coupling in a backing's mesh, taken in the mount frame (u, w, h)."""

from collections.abc import Iterator

import numpy as np
import shapely

from lumitip_fab.checks.fasteners import round_thread
from lumitip_fab.checks.printed import Printed, circles, holes_at, room
from lumitip_fab.checks.result import Measurement
from lumitip_fab.checks.solids import cast, section

POSITION_MM = 0.05
DIAMETER_MM = 0.1
DEPTH_MM = 0.05
_DOWN, _UP = np.array([0.0, 0.0, -1.0]), np.array([0.0, 0.0, 1.0])


def measure_bolt(part: Printed) -> Iterator[Measurement]:
    """Bolt holes, above the pins, and gripper pins: place, diameter, and room for the bolt."""
    mount = part.design.mount
    rings = holes_at(part.standing, (mount.land_mm + mount.pin_depth_mm) / 2)
    bolts = tuple((u, mount.bolt_w_mm) for u in mount.bolt_u_mm)
    off, wide = circles(rings, bolts, mount.bolt_hole_mm / 2)
    yield part.near("bolt", off, 0.0, POSITION_MM)
    yield part.near("bolt_hole", wide, mount.bolt_hole_mm, DIAMETER_MM)
    bolt, fit_mm = part.design.threads[mount.bolt], part.design.printing.fit_mm
    clear, low, high, _ = round_thread(room(rings, bolts), bolt, fit_mm)
    yield part.figure("bolt_clearance", clear, low, high)
    pins = tuple((u, mount.bolt_w_mm) for u in mount.pin_u_mm)
    if pins:
        rings = holes_at(part.standing, mount.pin_depth_mm / 2)
        off, wide = circles(rings, pins, mount.pin_mm / 2)
        yield part.near("gripper_pins", off, 0.0, POSITION_MM)
        yield part.near("gripper_pin_hole", wide, mount.pin_mm, DIAMETER_MM)
        beside = (mount.pin_mm + mount.bolt_hole_mm) / 4 if mount.sleeved else 0.0
        below = np.array([(u + beside, w, -1.0) for u, w in pins])
        depth, _ = cast(part.standing, below, _UP, 2 * mount.land_mm + 1).first(len(pins))
        yield part.near("gripper_pin_depth", depth - 1.0, mount.pin_depth_mm, DEPTH_MM)


def measure_screw(part: Printed) -> Iterator[Measurement]:
    """The screws' seats, seen from where screw and driver come: nothing may stand above them."""
    mount = part.design.mount
    above = float(part.standing.bounds[1, 2]) + 1.0
    turn = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
    radii = np.linspace(mount.bolt_hole_mm / 2 + 0.15, mount.counterbore_mm / 2 - 0.1, 4)
    radius, angle = (grid.ravel() for grid in np.meshgrid(radii, turn))
    around = np.column_stack(
        [
            radius * np.cos(angle),
            mount.bolt_w_mm + radius * np.sin(angle),
            np.full(radius.size, above),
        ]
    )
    origins = np.concatenate([around + np.array([u, 0.0, 0.0]) for u in mount.bolt_u_mm])
    drop, _ = cast(part.standing, origins, _DOWN, above + 1).first(len(origins))
    yield part.near("screw_seat", above - drop, mount.land_mm, DEPTH_MM)


def measure_nose(part: Printed) -> Iterator[Measurement]:
    """Half the width of the nose on either side, against its trapezoid."""
    mount, nose = part.design.mount, part.design.mount.nose
    if nose is None:
        return
    spread = np.tan(np.radians(nose.half_angle_deg))
    rows = np.linspace(
        mount.block_front_w_mm + 0.3, mount.block_back_w_mm - mount.block_corner_mm, 8
    )
    half = np.minimum(
        nose.front_width_mm / 2 + (rows - nose.front_w_mm) * spread, mount.block_width_mm / 2
    )
    cut = section(part.standing, nose.height_mm / 2)
    reach = mount.block_width_mm / 2 + 1.0  # less than where the plate begins beside the notch
    errors = []
    for w, wanted in zip(rows, half, strict=True):
        bounds = shapely.LineString([(-reach, w), (reach, w)]).intersection(cut).bounds
        errors += [bounds[2] - wanted, -bounds[0] - wanted] if bounds else [np.nan]
    yield part.near("nose", np.array(errors), 0.0, POSITION_MM)
