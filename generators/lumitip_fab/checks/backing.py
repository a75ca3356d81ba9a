"""The backings as files: printable, and everything that goes into or onto them fits."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import shapely

from lumitip_fab.checks import letters, packages, solids
from lumitip_fab.checks.coupling import measure_bolt, measure_nose, measure_screw
from lumitip_fab.checks.plate import (
    measure_notch,
    measure_outline,
    measure_pins,
    measure_pocket,
    measure_reliefs,
    measure_tip,
)
from lumitip_fab.checks.printed import Printed
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.checks.solids import Vectors
from lumitip_fab.checks.walls import Exempt, Mask, walls
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError
from lumitip_fab.frames import applied, mount_to_sensor

READS = ("backing/*.stl", "backing/*.3mf", "backing/*.step")

PUBLISHED_OVERHANG_MM2 = 341.0  # of the published part, standing on its mount face
LEAST_BED_MM2 = 120.0  # on which a finger 55 mm tall stays up
SIZE_MM = 0.05


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of both backings."""
    to_sensor = mount_to_sensor(design.mount, design.stack)
    for finger in design.fingers:
        subject = f"backing/{finger.name}_backing.stl"
        try:
            standing = solids.read_mesh(outputs / subject)
        except OutputError as error:
            yield unreadable("backing.readable", subject, str(error))
            continue
        sensor = solids.moved(standing, to_sensor)
        part = Printed(subject, standing, sensor, finger, design)
        yield part.figure("readable", float(len(standing.faces)), 4, np.inf, "triangles")
        yield from _measured(part)
        yield from packages.measure_files(outputs, part)


def _measured(part: Printed) -> Iterator[Measurement]:
    steps: tuple[Callable[[Printed], Iterator[Measurement]], ...] = (
        measure_surface, measure_print, measure_size, measure_walls,
        measure_outline, measure_pocket, measure_pins, measure_reliefs, measure_notch, measure_tip,
        measure_bolt, measure_screw, measure_nose, measure_letter,
    )  # fmt: skip
    for step in steps:
        try:
            yield from step(part)
        except (ArithmeticError, LookupError, ValueError, shapely.errors.ShapelyError) as error:
            name = step.__name__.removeprefix("measure_")
            yield unreadable(f"backing.{name}", part.subject, f"cannot be measured: {error!r:.200}")


def measure_surface(part: Printed) -> Iterator[Measurement]:
    """One closed body."""
    yield part.figure("watertight", solids.open_edges(part.standing), 0, 0, "open edges")
    yield part.figure("bodies", solids.bodies(part.standing), 1, 1, "bodies")


def measure_print(part: Printed) -> Iterator[Measurement]:
    """What the printer lays over air, and what holds the part on the bed."""
    hang, bed = solids.overhang_mm2(part.standing), solids.bed_contact_mm2(part.standing)
    yield part.figure("overhang", hang, 0.0, PUBLISHED_OVERHANG_MM2, "mm²")
    yield part.figure("bed_contact", bed, LEAST_BED_MM2, np.inf, "mm²")


def measure_size(part: Printed) -> Iterator[Measurement]:
    """The box round the part as it stands, against outline and coupling."""
    design = part.design
    stack, tip_y = design.stack, design.outline.tip_y_mm
    half = float(np.abs(design.outline.polygon()[:, 0]).max())
    edges = np.array(
        [(0.0, tip_y, stack.rim_z_mm), (0.0, tip_y, stack.rim_z_mm - design.tip.edge_mm)]
    )
    inverse = np.asarray(np.linalg.inv(mount_to_sensor(design.mount, stack)), dtype=np.float64)
    front, back = applied(inverse, edges)
    height = max(front[2], back[2])
    wanted = np.array(
        [[-half, min(front[1], 0.0), 0.0], [half, design.mount.block_back_w_mm, height]]
    )
    yield part.near("size", (part.standing.bounds - wanted).ravel(), 0.0, SIZE_MM)


def measure_letter(part: Printed) -> Iterator[Measurement]:
    """The letter on the back of the coupling's block."""
    letter = part.design.mount.letter
    yield letters.measure_letter("backing.letter", part.subject, part.standing, part.finger, letter)


def measure_walls(part: Printed) -> Iterator[Measurement]:
    """The thinnest walls. Thinner ones are listed here by name, each with its own limit."""
    design, mount = part.design, part.design.mount
    to_sensor = mount_to_sensor(mount, design.stack)

    def on_tip(points: Vectors) -> Mask:
        return np.asarray(applied(to_sensor, points)[:, 1] > design.tip.slant_start_y_mm)

    def between(points: Vectors) -> Mask:
        far = max(*mount.pin_u_mm, *mount.bolt_u_mm) + max(mount.pin_mm, mount.bolt_hole_mm) / 2
        beside = np.abs(points[:, 1] - mount.bolt_w_mm) < mount.bolt_hole_mm / 2
        low = points[:, 2] < mount.land_mm
        return np.asarray(beside & low & (np.abs(points[:, 0]) < far))

    exempt = [
        Exempt("tip edge", design.tip.edge_mm, on_tip),
        letters.beside(mount.letter, design.printing),
    ]
    if mount.pin_u_mm and not mount.sleeved:
        away = abs(max(mount.pin_u_mm) - max(mount.bolt_u_mm))
        apart = away - (mount.pin_mm + mount.bolt_hole_mm) / 2
        least = min(apart, design.printing.min_wall_mm)
        exempt.append(Exempt("bolt to gripper pins", least, between))
    yield from walls(
        "backing.min_wall", part.subject, part.standing, design.printing.min_wall_mm, exempt
    )
