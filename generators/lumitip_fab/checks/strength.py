"""The fingers' strength: sections of the written parts, loaded at the tip as a beam."""

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from lumitip_fab.checks.bolt_seat import measure_seats
from lumitip_fab.checks.orientation import measure_orientation
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, moments, section
from lumitip_fab.checks.result import Measurement, unreadable
from lumitip_fab.design import Design, Finger
from lumitip_fab.design.beam import (
    Beam,
    Layer,
    behind,
    board_blocks,
    joined_mm,
    reached_mm,
    rectangles,
)
from lumitip_fab.design.frames import backing_bed_to_sensor, mount_to_sensor
from lumitip_fab.design.strength import Loaded, Loads, loads
from lumitip_fab.errors import OutputError

READS = ("backing/*.stl", "interface/*.stl")
STEP_MM = 0.5
INSIDE_MM = 0.2  # of the ends: where the faces are, other checks tell
_FAR_MM = 1e3
_JUST_MM = 0.02  # behind the glue


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of both fingers."""
    for finger in design.fingers:
        subject = f"backing/{finger.name}_backing.stl"
        try:
            found = finger_loads(outputs, design, finger)
            seats = list(measure_seats(outputs, design, finger))
        except (OutputError, ArithmeticError, ValueError) as error:
            yield unreadable("strength.readable", subject, f"cannot be measured: {error!s:.200}")
            continue
        yield from _limits(subject, found, design)
        yield from measure_orientation(outputs, design, finger, found)
        yield from seats


def _limits(subject: str, found: Loads, design: Design) -> Iterator[Measurement]:
    limit = design.strength
    load = f"{limit.rated_force_n:g} N where the fingers touch first; an estimate"
    aside = f"{limit.rated_force_n:g} N on the cells {found.aside_mm:.1f} mm beside the middle"
    most_mm = limit.offset_share * min(design.mask.holes_mm) / 2
    at = f"{found.layers_h_mm:.0f} mm over the mount plane, {load}"
    for check, value, low, high, unit, note in (
        ("layers", found.safety, limit.safety, math.inf, "times the load", at),
        ("glue", limit.glue_mpa / found.glue_mpa, limit.safety, math.inf, "times the load", load),
        ("board", 100 * found.board_strain, 0.0, 100 * limit.board_strain, "%", f"strain, {load}"),
        ("bend", found.bend_mm, 0.0, limit.most_bend_mm, "mm", load),
        ("light_path", found.offset_mm, 0.0, most_mm, "mm", f"off an aperture's middle, {load}"),
        ("twist", found.twist_deg, 0.0, math.inf, "°", f"{aside}; for information"),
        ("without_glue", found.bare_n, 0.0, math.inf, "N", "layers part; for information"),
    ):
        yield Measurement(f"strength.{check}", subject, value, low, high, unit, note)


def finger_loads(outputs: Path, design: Design, finger: Finger) -> Loads:
    """What the rated force does to a finger, from its written parts.

    Raises:
        OutputError: if a file is missing or holds no mesh.
    """
    to_mount = np.linalg.inv(mount_to_sensor(design.mount, design.stack))
    inverse = np.asarray(to_mount, dtype=np.float64)
    tip = inverse @ (0.0, design.closing.contact_y_mm, design.stack.rim_z_mm, 1.0)
    cells = [inverse @ (x, y, design.stack.rim_z_mm, 1.0) for x, y in finger.cells]
    optics = design.layout.optics
    depth = max(optics.emitter_depth_mm, optics.detector_depth_mm)
    found = loaded(outputs, design, finger, inverse, float(tip[2]))
    return loads(found, design.strength, np.array(cells)[:, [0, 2]], depth)


def loaded(
    outputs: Path, design: Design, finger: Finger, to_mount: Vectors, tip_h_mm: float
) -> Loaded:
    """The finger's layers by sections of its written parts.

    Args:
        outputs: the output folder.
        design: for frames and materials.
        finger: whose parts they are.
        to_mount: from the sensor to the mount frame.
        tip_h_mm: height of the tip over the mount plane.
    """
    stack, limit, slicing = design.stack, design.strength, design.slicing
    mesh = solids.read_mesh(outputs / f"backing/{finger.name}_backing.stl")
    mesh = solids.moved(mesh, to_mount @ backing_bed_to_sensor(design.mount, stack))
    h = np.arange(INSIDE_MM, tip_h_mm - INSIDE_MM, STEP_MM)
    thick = stack.rim_z_mm - stack.back_z_mm + sum(i.pad_mm for i in design.interfaces)
    along = design.mount.origin_y_mm + h / math.cos(math.radians(design.mount.tilt_deg))
    planes = list(zip(h, along, reached_mm(design.mount, thick, h), strict=True))
    cuts = [_borne(section(mesh, z), y, w, design) for z, y, w in planes]
    half = design.mount.block_width_mm / 2
    printed = [(_layer(cuts, limit.backing_mpa, half), slicing.backing.layer_mpa)]
    notch_y = finger.notch.y_max_mm if stack.sunk else -math.inf
    box, pocket = design.board.box, design.board.pocket
    blocks = board_blocks(pocket, box, notch_y, design.mount, stack.pcb_mm, h)
    board = rectangles(limit.board_mpa, half, blocks, glued=stack.sunk)
    glued, glue = board, _width(cuts, design, h) * (board.area_mm2 > 0)
    if design.interfaces:
        mesh = solids.read_mesh(outputs / f"interface/{finger.name}_interface.stl")
        backs = [_borne(section(mesh, z), y, w, design) for z, y, w in planes]
        printed.append((_layer(backs, limit.rigid_mpa, half), slicing.rigid.layer_mpa))
        glued = printed[0][0]
        glue = np.array([np.ptp(b.bounds[::2]) if not b.is_empty else 0.0 for b in backs])
    face = to_mount @ (0.0, design.closing.contact_y_mm, 0.0, 1.0)
    beam = Beam(h, tip_h_mm, (*(layer for layer, _ in printed), board), float(face[1]))
    stiff = beam
    if stack.sunk:
        joined = joined_mm(design.mount, notch_y, h)
        held = [_behind(cut, w) for cut, w in zip(cuts, joined, strict=True)]
        plate = rectangles(limit.board_mpa, half, behind(joined, blocks))
        stiff = beam.alone(_layer(held, limit.backing_mpa, half), plate)
    return Loaded(beam, stiff, tuple(printed), board, glued, glue)


def _behind(cut: Any, low_mm: float) -> Any:
    """A section without what lies before a w."""
    return shapely.clip_by_rect(cut, -_FAR_MM, max(low_mm, -_FAR_MM), _FAR_MM, _FAR_MM)


def _layer(cuts: list[Any], modulus_mpa: float, half_mm: float) -> Layer:
    """A printed part's sections as a layer, and its strips within the block's width and beside."""
    far, strips = _FAR_MM, []
    within = [shapely.clip_by_rect(cut, -half_mm, -far, half_mm, far) for cut in cuts]
    for strip in (within, [cut.difference(core) for cut, core in zip(cuts, within, strict=True)]):
        strips.append(_summed(strip, modulus_mpa))
    return replace(_summed(cuts, modulus_mpa), strips=tuple(strips))


def _summed(cuts: list[Any], modulus_mpa: float) -> Layer:
    """Sections as one layer without strips."""
    rows = []
    for cut in cuts:
        area, (_, w), inertia = moments(cut)
        bounds = (math.nan,) * 4 if cut.is_empty else cut.bounds
        around = inertia[0, 0], inertia[1, 1] + area * w * w
        half = max(-bounds[0], bounds[2])
        rows.append((area, area * w, around[1], around[0], bounds[1], bounds[3], half))
    return Layer(modulus_mpa, *np.nan_to_num(np.array(rows)).T)


def _width(cuts: list[Any], design: Design, h_mm: Vectors) -> Vectors:
    """Material right behind the board, across each section."""
    box, tilt = design.board.box, math.radians(design.mount.tilt_deg)
    behind = -h_mm * math.tan(tilt) + design.stack.pcb_mm / math.cos(tilt) + _JUST_MM
    lines = [shapely.LineString([(box.x_min_mm, w), (box.x_max_mm, w)]) for w in behind]
    found = [line.intersection(cut).length for line, cut in zip(lines, cuts, strict=True)]
    return np.array(found)


def _borne(cut: Any, y_mm: float, reached_mm: float, design: Design) -> Any:
    """What bears load of a section: up to a w, and in pieces that the coupling's block carries, for
    beside the wire notch the plate is two legs that bear nothing. Glue fills the slit at the
    board's end."""
    pocket, stack, half = design.board.pocket, design.stack, design.mount.block_width_mm / 2
    share = (y_mm - pocket.y_max_mm) / design.board.roof_mm if stack.sunk else 1.0
    if 0 < share < 1 and not cut.is_empty:
        front = cut.bounds[1]
        deep = front + (1 - share) * stack.pcb_mm
        cut = cut.union(shapely.box(pocket.x_min_mm, front, pocket.x_max_mm, deep))
    kept = shapely.clip_by_rect(cut, -_FAR_MM, -_FAR_MM, _FAR_MM, reached_mm)
    pieces = shapely.get_parts(kept)
    return shapely.union_all([p for p in pieces if p.bounds[0] < half and p.bounds[2] > -half])
