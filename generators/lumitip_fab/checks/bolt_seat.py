"""Seats of the bolts' heads on the written parts: sections of the land between head and gripper."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import section
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Design, Finger
from lumitip_fab.design.frames import backing_bed_to_sensor, mount_to_sensor
from lumitip_fab.design.seat import Foot, Seated, pull_n

INSIDE_MM = 0.1  # of mount plane and seat: where the faces are, other checks tell
STEP_MM = 0.25
RINGS = 8  # on which the land may shear, between hole and edge of the head
_BEYOND_MM = 0.05  # the edge of the hole, which is a polygon
_FAR_MM = 1e3


def finger_seat(outputs: Path, design: Design, finger: Finger) -> Seated:
    """The worst bolt of a finger under its rated force, by the written part with the coupling.

    Raises:
        OutputError: if its file is missing or holds no mesh.
    """
    path, to_sensor = f"backing/{finger.name}_backing.stl", backing_bed_to_sensor
    if design.interfaces:
        path, to_sensor = f"interface/{finger.name}_interface.stl", mount_to_sensor
    to_mount = np.linalg.inv(mount_to_sensor(design.mount, design.stack))
    at = to_mount @ to_sensor(design.mount, design.stack)
    tip = to_mount @ (0.0, design.closing.contact_y_mm, design.stack.rim_z_mm, 1.0)
    return _seated(solids.moved(solids.read_mesh(outputs / path), at), design, float(tip[2]))


def _seated(held: Any, design: Design, arm_mm: float) -> Seated:
    """By a mesh in the mount frame."""
    mount = design.mount
    half = mount.block_width_mm / 2
    base = shapely.clip_by_rect(section(held, INSIDE_MM), -half, -_FAR_MM, half, _FAR_MM)
    if base.is_empty:
        return Seated(math.inf, math.inf, math.inf)
    low_u, _, high_u, back = base.bounds
    foot = Foot(min(back, mount.seat_back_w_mm), min(-low_u, high_u, mount.seat_width_mm / 2))
    pull = pull_n(design.strength.rated_force_n, arm_mm, mount, foot)
    levels = np.arange(INSIDE_MM, mount.land_mm - INSIDE_MM, STEP_MM)
    cuts = [section(held, float(h)) for h in (*levels, mount.land_mm - INSIDE_MM)]
    seats = [_seat(cuts, (u, mount.bolt_w_mm), design) for u in mount.bolt_u_mm]
    area, shear = (max(each) for each in zip(*seats, strict=True))
    return Seated(pull, pull * area, pull * shear)


def _seat(cuts: list[Any], axis: tuple[float, float], design: Design) -> tuple[float, float]:
    """Pressure under a head and shear round it, by 1 N."""
    mount, middle = design.mount, shapely.Point(axis)
    head = design.threads[mount.bolt].cap_head_mm / 2
    seat, deep = cuts[-1], mount.land_mm / len(cuts)
    area = seat.intersection(middle.buffer(head, 64)).area
    if area <= 0:
        return math.inf, math.inf
    worst = 0.0
    for radius in np.linspace(mount.bolt_hole_mm / 2 + _BEYOND_MM, head, RINGS):
        disc = middle.buffer(radius, 64)
        round_mm2 = deep * sum(cut.intersection(disc.exterior).length for cut in cuts)
        share = seat.intersection(disc).area / area
        worst = max(worst, share / max(round_mm2, 1e-9))
    return 1 / area, worst


def measure_seats(outputs: Path, design: Design, finger: Finger) -> Iterator[Measurement]:
    """Safety of the plastic under the worst bolt's head, and round it."""
    found, least = finger_seat(outputs, design, finger), design.strength.safety
    part = "interface" if design.interfaces else "backing"
    subject = f"{part}/{finger.name}_{part}.stl"
    filament, bolt = design.slicing.of(subject), design.threads[design.mount.bolt]
    pulled = f"{bolt.name} pulled by {found.pull_n:.0f} N; an estimate"
    for check, value, what in (
        ("bolt_head", filament.bearing_mpa / found.bearing_mpa, f"under {bolt.cap_head_mm:g} mm"),
        ("bolt_seat", filament.layer_mpa / found.shear_mpa, "shear of the land round the head"),
    ):
        yield Measurement(
            f"strength.{check}",
            subject,
            value,
            least,
            math.inf,
            "times the load",
            f"{what}, {pulled}",
        )
