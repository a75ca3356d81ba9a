"""Whether the coupons of the fit test plate print as what they stand for: surfaces that a fit is
read from lie to the bed as those of the backing, or of a compliant finger's interface."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, cast
from lumitip_fab.checks.result import Measure, Measurement, Subject, measured, unreadable
from lumitip_fab.design import Design, PocketCorner
from lumitip_fab.design.frames import fit_corner_to_sensor, mount_to_sensor
from lumitip_fab.errors import OutputError
from lumitip_fab.pipeline import manifest

READS = ("fit/fit_plate.stl", "backing/*.stl", "interface/*.stl", "manifest.json")
ALIKE_DEG = 0.5
INSIDE_MM = 0.3
_FILE = "fit/fit_plate.stl"
_REACH_MM = 20.0
_TURNS = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)


@dataclass(frozen=True, eq=False)
class _Both(Subject):
    """The plate and the part that it stands for, as their files have them."""

    plate: Any
    part: Any
    path: str
    """File of the part."""
    design: Design
    outputs: Path


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Angles between each surface of a coupon and the same one of the part, to the bed."""
    path = f"{design.held}/receiver_{design.held}.stl"
    read = []
    for file in (_FILE, path):
        try:
            read.append(solids.read_mesh(outputs / file))
        except OutputError as error:
            yield unreadable("fit_orientation.readable", file, str(error))
            return
    both = _Both("fit_orientation", _FILE, read[0], read[1], path, design, outputs)
    yield both.figure("readable", len(both.plate.faces), 4, np.inf, "triangles")
    yield from measured(MEASURES, both)


def measure_frame(both: _Both) -> Iterator[Measurement]:
    """The bed's upward axis in the sensor frame, by the matrices of the manifest."""
    if both.design.fit_plate.corners:
        files = manifest.read(both.outputs).files
        up, wanted = (np.array(files[file].to_sensor)[:3, 2] for file in (_FILE, both.path))
        yield _angle(both, "frame", up, wanted)


def measure_floor(both: _Both) -> Iterator[Measurement]:
    """The pocket's floor, beside the pin."""
    for corner in both.design.fit_plate.corners:
        at = _in_pocket(both, corner)
        front = at + np.array([0.0, 0.0, both.design.stack.pcb_mm])
        yield from _surface(both, corner, "floor", front, np.array([0.0, 0.0, -1.0]))


def measure_roof(both: _Both) -> Iterator[Measurement]:
    """The pocket's end at the tip, over which a printer builds outward."""
    for corner in both.design.fit_plate.corners:
        at = _in_pocket(both, corner)
        yield from _surface(both, corner, "roof", at, np.array([0.0, 1.0, 0.0]))


def measure_wall(both: _Both) -> Iterator[Measurement]:
    """The pocket's side."""
    for corner in both.design.fit_plate.corners:
        at = _in_pocket(both, corner)
        yield from _surface(both, corner, "wall", at, np.array([-1.0, 0.0, 0.0]))


def measure_pin(both: _Both) -> Iterator[Measurement]:
    """The axis of the locating pin."""
    stack = both.design.stack
    for corner in both.design.fit_plate.corners:
        around = np.column_stack([np.cos(_TURNS), np.sin(_TURNS), 0 * _TURNS])
        middle = np.array([*corner.pin, stack.pocket_z_mm + stack.pcb_mm / 3])
        starts = middle + both.design.board.hole_mm * 0.6 * around
        wanted = _axis(_normals(both.part, *_moved(_part(both), starts, -around)))
        for step in range(len(both.design.fit_plate.steps)):
            rays = _moved(_coupon(both, corner, step), starts, -around)
            found = _axis(_normals(both.plate, *rays))
            yield _angle(both, "pin", found, wanted, both.design.fit_plate.label_of(step))


def measure_bolt(both: _Both) -> Iterator[Measurement]:
    """The axis of the bolt's hole in each slice."""
    plate, mount = both.design.fit_plate, both.design.mount
    outward = np.column_stack([np.cos(_TURNS), np.sin(_TURNS), 0 * _TURNS])
    u = mount.bolt_u_mm[-1]
    high = (mount.pin_depth_mm + mount.land_mm) / 2 if mount.sleeved else mount.land_mm / 2
    starts = np.array([u, mount.bolt_w_mm, high]) + 0 * outward
    wanted = _axis(_normals(both.part, starts, outward))
    low = plate.pin_depth_mm if mount.sleeved else 0.0
    for step in range(len(plate.steps)):
        x, y = plate.at(step, plate.slice_at)
        at = np.array([x - u, y - mount.bolt_w_mm, (low + plate.thickness_mm) / 2])
        found = _axis(_normals(both.plate, at + 0 * outward, outward))
        yield _angle(both, "bolt", found, wanted, plate.label_of(step))


def _surface(
    both: _Both, corner: PocketCorner, check: str, at: Vectors, along: Vectors
) -> Iterator[Measurement]:
    """The angle between a coupon's surface and the part's, where a ray in the sensor frame meets
    them."""
    starts, rays = at[None], along[None]
    (wanted,) = _normals(both.part, *_moved(_part(both), starts, rays))
    for step in range(len(both.design.fit_plate.steps)):
        (found,) = _normals(both.plate, *_moved(_coupon(both, corner, step), starts, rays))
        yield _angle(both, check, found, wanted, both.design.fit_plate.label_of(step))


def _in_pocket(both: _Both, corner: PocketCorner) -> Vectors:
    """A point in the pocket beside the pin, just within the board's edge, in the sensor frame."""
    x, stack = both.design.board.box.x_min_mm + INSIDE_MM, both.design.stack
    return np.array([x, corner.pin[1], stack.pocket_z_mm + stack.pcb_mm / 2])


def _part(both: _Both) -> Vectors:
    """From the sensor frame to the bed of the part."""
    return np.asarray(np.linalg.inv(mount_to_sensor(both.design.mount, both.design.stack)))


def _coupon(both: _Both, corner: PocketCorner, step: int) -> Vectors:
    """From the sensor frame to the bed of the plate, for a step."""
    to_sensor = fit_corner_to_sensor(corner, both.design.mount, both.design.stack)
    matrix = np.asarray(np.linalg.inv(to_sensor))
    matrix[0, 3] += step * both.design.fit_plate.pitch_mm
    return matrix


def _moved(matrix: Vectors, starts: Vectors, rays: Vectors) -> tuple[Vectors, Vectors]:
    turn = matrix[:3, :3].T
    return starts @ turn + matrix[:3, 3], rays @ turn


def _normals(mesh: Any, starts: Vectors, rays: Vectors) -> Vectors:
    """Normals of the triangles that rays meet first; NaN where they meet none."""
    _, triangles = cast(mesh, starts, rays, _REACH_MM).first(len(starts))
    normals = np.array(mesh.face_normals, dtype=np.float64)[triangles]
    normals[triangles < 0] = np.nan
    return normals


def _axis(normals: Vectors) -> Vectors:
    """The direction square to all normals of a round surface."""
    if not np.isfinite(normals).all():
        return np.full(3, np.nan)
    return np.asarray(np.linalg.svd(normals)[2][2])


def _angle(both: _Both, check: str, found: Vectors, wanted: Vectors, at: str = "") -> Measurement:
    """The angle between two directions, of which an axis has no sense."""
    across = np.linalg.norm(np.cross(found, wanted))
    angle = np.degrees(np.arctan2(across, abs(float(found @ wanted))))
    return both.figure(check, angle, 0.0, ALIKE_DEG, "°", f"to {both.path}", at)


MEASURES: tuple[Measure[_Both], ...] = (
    measure_frame,
    measure_floor,
    measure_roof,
    measure_wall,
    measure_pin,
    measure_bolt,
)
