"""The fit test plate: every coupon really is as much looser than the backing as its value says."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely

from lumitip_fab.checks.fit_corner import PLACE_MM, TIGHT_MM, FitCoupons, measure_corners
from lumitip_fab.checks.printed import (
    circles,
    holes_at,
    measure_bed,
    measure_closed,
)
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, cast, section
from lumitip_fab.checks.result import Measure, Measurement, measured, unreadable
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

READS = ("fit/*.stl",)
SIZE_MM = 0.05
VOLUME_FRACTION = 0.05
LEAST_BED_MM2 = 25.0  # of a coupon
RINGS = 1.02  # area over sleeves, by that of their rings
_FILE = "fit/fit_plate.stl"
_DOWN = np.array([0.0, 0.0, -1.0])
# Places in parts of a character's height from its lower left corner, and which of them are sunk.
_PLACES = {
    "a": (0.3, 0.915),
    "b": (0.515, 0.71),
    "c": (0.515, 0.29),
    "d": (0.3, 0.085),
    "e": (0.085, 0.29),
    "f": (0.085, 0.71),
    "g": (0.3, 0.5),
    "p": (0.3, 0.68),
    "q": (0.3, 0.25),
}
_SUNK = {"0": "abcdef", "1": "adgpq", "5": "acdfg", "-": "g", "+": "gpq", " ": ""}
_CHARACTERS, _CHARACTER_PITCH = 3, 0.85


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of the plate."""
    try:
        mesh = solids.read_mesh(outputs / _FILE)
    except OutputError as error:
        yield unreadable("fit_plate.readable", _FILE, str(error))
        return
    plate = FitCoupons("fit_plate", _FILE, mesh, design)
    yield plate.figure("readable", len(mesh.faces), 4, np.inf, "triangles")
    yield from measured(MEASURES, plate)


def measure_body(plate: FitCoupons) -> Iterator[Measurement]:
    """Closed bodies, one for each step, of the stated size and volume."""
    mesh, wanted = plate.mesh, plate.design.fit_plate
    yield from measure_closed(plate, mesh, len(wanted.steps))
    off = mesh.bounds - np.array([(0.0, 0.0, 0.0), wanted.size_mm])
    yield plate.near("size", off.ravel(), 0.0, SIZE_MM)
    least, most = ((1 + side * VOLUME_FRACTION) * wanted.volume_ml for side in (-1, 1))
    yield plate.figure("volume", float(mesh.volume) / 1000, least, most, "mL")


def measure_print(plate: FitCoupons) -> Iterator[Measurement]:
    """Prints without support: only pins hang over, and the hole of a bolt over its sleeve; no line
    is long over nothing."""
    design, mesh = plate.design, plate.mesh
    wanted, mount = design.fit_plate, design.mount
    pins = len(wanted.corners) * sum(f.pin_mm * design.stack.pcb_mm for f in wanted.steps)
    shown = len(plate.mounted(0, mount.bolt_u_mm)) if mount.sleeved else 0
    rings = [np.pi / 4 * (f.gripper_pin_mm**2 - f.bolt_hole_mm**2) for f in wanted.steps]
    most = pins + RINGS * shown * float(sum(rings))
    least = LEAST_BED_MM2 * len(wanted.steps)
    yield from measure_bed(plate, mesh, design.printing, most, least)


def measure_bolts(plate: FitCoupons) -> Iterator[Measurement]:
    """The bolt's hole in each slice: place and diameter."""
    wanted, mount = plate.design.fit_plate, plate.design.mount
    low = wanted.pin_depth_mm if mount.sleeved else 0.0
    rings = holes_at(plate.mesh, (low + wanted.thickness_mm) / 2)
    for step, name in enumerate(plate.names()):
        bolts = plate.mounted(step, mount.bolt_u_mm)
        off, wide = circles(rings, bolts, mount.bolt_hole_mm / 2)
        yield plate.near("bolt", off, 0.0, PLACE_MM, at=name)
        hole = mount.bolt_hole_mm + 2 * plate.looser_mm(step)
        yield plate.near("bolt_hole", wide, hole, TIGHT_MM, at=name)


def measure_pins(plate: FitCoupons) -> Iterator[Measurement]:
    """The holes for the gripper's pins in each slice: place and diameter."""
    wanted, mount = plate.design.fit_plate, plate.design.mount
    rings = holes_at(plate.mesh, wanted.pin_depth_mm / 2)
    for step, name in enumerate(plate.names() if mount.pin_u_mm else ()):
        off, wide = circles(rings, plate.mounted(step, mount.pin_u_mm), mount.pin_mm / 2)
        yield plate.near("gripper_pins", off, 0.0, PLACE_MM, at=name)
        hole = mount.pin_mm + 2 * plate.looser_mm(step)
        yield plate.near("gripper_pin_hole", wide, hole, TIGHT_MM, at=name)


def measure_sleeves(plate: FitCoupons) -> Iterator[Measurement]:
    """How deep the holes for sleeves round the bolts are, from below."""
    wanted, mount = plate.design.fit_plate, plate.design.mount
    turn = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
    radius = (mount.bolt_hole_mm + mount.pin_mm) / 4
    around = radius * np.column_stack([np.cos(turn), np.sin(turn)])
    for step, name in enumerate(plate.names() if mount.sleeved else ()):
        points = np.concatenate([around + at for at in plate.mounted(step, mount.bolt_u_mm)])
        origins = np.column_stack([points, np.full(len(points), -1.0)])
        rise, _ = cast(plate.mesh, origins, -_DOWN, wanted.size_mm[2] + 2).first(len(points))
        yield plate.near("sleeve", rise - 1.0, wanted.pin_depth_mm, PLACE_MM, at=name)


def measure_noses(plate: FitCoupons) -> Iterator[Measurement]:
    """Half the width of each nose on either side, less than its step allows no gap."""
    wanted, mount, nose = plate.design.fit_plate, plate.design.mount, plate.design.mount.nose
    if nose is None:
        return
    angle, box = np.radians(nose.half_angle_deg), wanted.slice
    cut = section(plate.mesh, min(nose.height_mm, wanted.thickness_mm) / 2)
    rows = np.linspace(box.y_min_mm + 0.2, box.y_max_mm - 0.2, 12)
    for step, name in enumerate(plate.names()):
        x, y = wanted.at(step, wanted.slice_at)
        front = nose.front_width_mm / 2 - plate.looser_mm(step) / np.cos(angle)
        half = front + (rows - nose.front_w_mm) * np.tan(angle)
        flank = half < mount.block_width_mm / 2 - 0.2
        reach = box.width_mm / 2 + 0.3
        errors = []
        for w, wide in zip(rows[flank], half[flank], strict=True):
            line = shapely.LineString([(x - reach, y - w), (x + reach, y - w)])
            bounds = line.intersection(cut).bounds
            errors += [bounds[2] - x - wide, x - bounds[0] - wide] if bounds else [np.nan]
        yield plate.near("nose", np.array(errors), 0.0, TIGHT_MM, at=name)


def measure_labels(plate: FitCoupons) -> Iterator[Measurement]:
    """Each value as it is engraved: places that are sunk though they should stand, or stand."""
    wanted = plate.design.fit_plate
    high = wanted.label.length_mm
    for step, name in enumerate(plate.names()):
        x, y = wanted.at(step, (wanted.label.x_min_mm, wanted.label.y_min_mm))
        places, sunk = [], []
        for k, character in enumerate(name.ljust(_CHARACTERS)):
            for stroke, (along, up) in _PLACES.items():
                places.append((x + (k * _CHARACTER_PITCH + along) * high, y + up * high))
                sunk.append(stroke in _SUNK[character])
        heights = _height(plate, np.array(places))
        due = wanted.thickness_mm - np.array(sunk) * wanted.label_mm
        wrong = int((np.abs(heights - due) > PLACE_MM).sum())
        yield plate.figure("label", wrong, 0, 0, f"of {len(places)} places wrong", at=name)


def _height(plate: FitCoupons, points: Vectors) -> Vectors:
    """Height of what is seen from above at points (x, y)."""
    above = float(plate.mesh.bounds[1, 2]) + 1.0
    origins = np.column_stack([points, np.full(len(points), above)])
    drop, _ = cast(plate.mesh, origins, _DOWN, above + 1).first(len(points))
    return np.asarray(above - drop)


MEASURES: tuple[Measure[FitCoupons], ...] = (
    measure_body,
    measure_print,
    measure_corners,
    measure_bolts,
    measure_pins,
    measure_sleeves,
    measure_noses,
    measure_labels,
)
