"""The moulds: what the silicone and the finger will meet, measured from the STL files.

Everything is in the mould's own frame: it stands on z = 0, open side up.
"""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from shapely.errors import GEOSException

from lumitip_fab.checks.mould_grip import measure_grip
from lumitip_fab.checks.mould_note import measure_note, measure_volume
from lumitip_fab.checks.printed import as_moulds, measure_span
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.result import Measurement, Subject, unreadable
from lumitip_fab.checks.walls import Mask, beside, measure_relief, walls
from lumitip_fab.design import Box, Design, Finger, Insert
from lumitip_fab.design.frames import applied, backing_bed_to_sensor, mould_bed_to_sensor
from lumitip_fab.design.making import tip_stop_mm
from lumitip_fab.errors import OutputError

READS = ("mould/*", "backing/*_backing.stl")
NAMES = (
    "mould.watertight",
    "mould.bodies",
    "mould.fits_bed",
    "mould.span",
    "mould.thickness",
    "mould.tip_thickness",
    "mould.stops",
    "mould.gap",
    "mould.draft",
    "mould.undercut",
    "mould.min_wall",
    "mould.volume",
    "mould.masses",
    "mould.note",
    "mould.clamped",
    "mould.grip",
    "mould.seat",
    "mould.letter",
)
THICKNESS_MM = 0.02
STOPS_MM = 0.02
SHARED_MM3 = 0.05
GRID_MM = 0.8
_PAD_INNER, _PAD_OUTER = 0.95, 1.13  # of a pad's radius: on it, and beside its drafted foot
_LINE_MM = 0.15  # how far under the plate the tip line is probed
GAP_MM = (0.10, 0.30)
LEAST_DRAFT_DEG = 2.0
DRAFT_MESH_DEG = 0.25  # of triangles on curved walls
_BESIDE_MM = 0.5  # from the stop at the tip to where the silicone is as thick as it should be
_ABOVE_MM = 0.05  # stops and weir end at the rim itself
_STEP_MM = 0.5
_GAP_SIDE_MM = 0.01  # on the side of a recess itself nothing is probed
_UPRIGHT = math.sin(math.radians(0.5))  # a facet that leans by less is an upright wall's mesh
_ON_BED_MM = 1e-3


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Hold each finger's mould against the design."""
    for finger in design.fingers:
        file, measured = f"mould/{finger.name}_mould.stl", set[str]()
        try:
            mesh = solids.read_mesh(outputs / file)
            for measurement in _measured(mesh, file, outputs, design, finger):
                measured.add(measurement.check)
                yield measurement
        except (OutputError, ArithmeticError, LookupError, ValueError, GEOSException) as error:
            reason = str(error) if isinstance(error, OutputError) else f"not measurable: {error!r}"
            yield from (unreadable(name, file, reason) for name in NAMES if name not in measured)


def _measured(
    mesh: Any, file: str, outputs: Path, design: Design, finger: Finger
) -> Iterator[Measurement]:
    yield from measure_note(outputs, design, finger)
    of = Subject("mould", file)
    yield of.figure("watertight", solids.open_edges(mesh), 0, 0, "edges")
    yield of.figure("bodies", solids.bodies(mesh), 1, 1, "bodies")
    room = np.array(design.printing.bed_mm) - mesh.extents
    yield of.figure("fits_bed", room.min(), 0, math.inf, note="room left")
    yield of.near("fits_bed", mesh.bounds[0, 2], 0, 0.001, "height over the bed", at="foot")
    yield measure_span(of, mesh, as_moulds(design))
    probe = Probe(mesh, design)
    yield _thickness(probe, file)
    yield _tip_thickness(probe, file)
    yield from _stops(probe, file)
    yield from measure_grip(probe.depths_mm, file, design)
    yield from _walls(mesh, file, design, finger.notch)
    letter = design.mould.letter
    yield measure_relief("mould.letter", file, mesh, finger, letter)
    exempt = (beside(letter, design.printing),)
    yield from walls("mould.min_wall", file, mesh, design.printing.min_wall_mm, exempt)
    body = solids.solid(mesh, "the mould")
    yield measure_volume(body, file, outputs, design, finger)
    yield _seat(body, file, outputs, design, finger)


class Probe:
    """Heights of a mould's surface below points of the finger."""

    def __init__(self, mesh: Any, design: Design) -> None:
        self.mesh, self.design = mesh, design
        to_sensor = mould_bed_to_sensor(design.stack, design.mould)
        self.to_bed = np.asarray(np.linalg.inv(to_sensor), dtype=np.float64)
        self.rim_mm = design.mould.stops_mm(design.stack.cover_mm)

    def depths_mm(self, points: solids.Vectors) -> solids.Vectors:
        """How far the mould lies below the rim plane at points (x, y) of the sensor frame."""
        at = applied(self.to_bed, points)
        at[:, 2] = self.mesh.bounds[1, 2] + 1.0
        down = np.array([0.0, 0.0, -1.0])
        reach = float(np.ptp(self.mesh.bounds[:, 2])) + 2.0
        distance, _ = solids.cast(self.mesh, at, down, reach).first(len(at))
        return np.asarray(self.rim_mm - (at[:, 2] - distance))


def _thickness(probe: Probe, file: str) -> Measurement:
    """The silicone over the board; the stops stand beside it."""
    box = probe.design.board.box
    x = np.arange(box.x_min_mm, box.x_max_mm, GRID_MM)
    y = np.arange(box.y_min_mm, box.y_max_mm, GRID_MM)
    at = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    film_mm, free = _film_mm(at, probe.design.inserts)
    depth = (probe.depths_mm(at) - film_mm)[free]
    stack = probe.design.stack
    wanted = stack.silicone_mm
    proud = 0.0 if stack.sunk else stack.pcb_mm  # of the board before the plate
    # The finger lies on the stops, so its board is as high as they really are.
    depth -= (
        float(np.min([probe.depths_mm(np.array([pad]))[0] for pad in probe.design.mould.pads]))
        + proud
    )
    note = f"farthest from {wanted:g} at {len(depth)} places over the board, from the pads' tops"
    worst, by = depth[np.abs(depth - wanted).argmax()], THICKNESS_MM
    return Subject("mould", file).figure("thickness", worst, wanted - by, wanted + by, note=note)


def _film_mm(at: solids.Vectors, inserts: tuple[Insert, ...]) -> tuple[solids.Vectors, Mask]:
    """Thickness of the film on the floor at some places, and which are not in the gap round it."""
    film_mm, free = np.zeros(len(at)), np.ones(len(at), dtype=np.bool_)
    for insert in inserts:
        film, recess = (_within(at, box) for box in (insert.box, insert.recess.grown(_GAP_SIDE_MM)))
        film_mm[film] = insert.thickness_mm
        free &= film | ~recess
    return film_mm, free


def _within(at: solids.Vectors, box: Box) -> Mask:
    left, low, right, high = box.bounds_mm
    return np.asarray(((at >= (left, low)) & (at <= (right, high))).all(axis=1))


def _tip_thickness(probe: Probe, file: str) -> Measurement:
    """The silicone at the tip edge, beside the stop in its middle."""
    outline, wanted = probe.design.outline, probe.design.mould.tip_silicone_mm
    right = np.linspace(
        tip_stop_mm(outline.tip_width_mm) / 2 + _BESIDE_MM, 0.475 * outline.tip_width_mm, 10
    )
    x = np.concatenate([-right, right])
    depth = probe.depths_mm(np.column_stack([x, np.full(len(x), outline.tip_y_mm)]))
    note = "at the tip edge, beside the stop"
    worst, by = depth[np.abs(depth - wanted).argmax()], THICKNESS_MM
    return Subject("mould", file).figure(
        "tip_thickness", worst, wanted - by, wanted + by, note=note
    )


def _stops(probe: Probe, file: str) -> Iterator[Measurement]:
    """Pads and tip line end at the rim plane, and stand where the design has them."""
    mould, outline = probe.design.mould, probe.design.outline
    angle = np.linspace(0, 2 * np.pi, 48, endpoint=False)
    for number, (x, y) in enumerate(mould.pads, 1):
        # A pad is joined to the wall on its outer side.
        ring = np.column_stack([np.cos(angle), np.sin(angle)]) * mould.pad_mm / 2
        free = ring[ring[:, 0] * x < 0.0]
        tops = probe.depths_mm(ring * _PAD_INNER + (x, y))
        feet = probe.depths_mm(free * _PAD_OUTER + (x, y)) - probe.design.stack.cover_mm
        worst = float(max(np.abs(tops).max(), np.abs(feet).max()))
        note = "top against the rim plane, and floor around it"
        yield Measurement("mould.stops", f"{file}: pad {number}", worst, 0, STOPS_MM, "mm", note)
    along = np.linspace(-0.45, 0.45, 9) * tip_stop_mm(outline.tip_width_mm)
    line = probe.depths_mm(np.column_stack([along, np.full(9, outline.tip_y_mm - _LINE_MM)]))
    of, note = Subject("mould", file), "top against the rim plane"
    yield of.figure("stops", np.abs(line).max(), 0, STOPS_MM, note=note, at="tip line")


def _seat(
    body: solids.Solid, file: str, outputs: Path, design: Design, finger: Finger
) -> Measurement:
    """The backing lying on the stops touches nothing else: neither wall nor weir."""
    part = f"backing/{finger.name}_backing.stl"
    try:
        backing = solids.solid(solids.read_mesh(outputs / part), "the backing")
    except OutputError as error:
        return unreadable("mould.seat", part, str(error))
    to_bed = np.linalg.inv(mould_bed_to_sensor(design.stack, design.mould))
    seated = solids.placed(backing, to_bed @ backing_bed_to_sensor(design.mount, design.stack))
    note = f"shared with {part} when it lies on the stops"
    shared_mm3 = solids.shared_mm3(body, seated)
    return Measurement("mould.seat", file, shared_mm3, 0, SHARED_MM3, "mm³", note)


def _walls(mesh: Any, file: str, design: Design, notch: Box) -> Iterator[Measurement]:
    """Gap at the rim, draft above it, and faces that hold the finger back.

    Args:
        mesh: the mould on its bed.
        file: its name.
        design: the design.
        notch: the finger's wire notch, where the wall may be open.
    """
    mould, stack = design.mould, design.stack
    rim_mm = mould.stops_mm(stack.cover_mm)
    silhouette = shapely.Polygon(design.outline.polygon() * (1, -1))  # as seen from above
    places = along(silhouette, -design.outline.end_y_mm, notch)
    near = distances(mesh, rim_mm + _ABOVE_MM, places)
    yield Measurement("mould.gap", file, float(near.min()), *GAP_MM, "mm", "least at the rim")
    widest, note = float(near.max()), "but for the weir at the gripper end"
    yield Measurement("mould.gap", f"{file}: widest", widest, *GAP_MM, "mm", note)
    rise = stack.plate_mm / 2  # the wall guides at least half the plate
    far = distances(mesh, rim_mm + _ABOVE_MM + rise, places)
    draft = float(np.degrees(np.arctan2(far - near, rise)).min())
    least = min(LEAST_DRAFT_DEG, mould.draft_deg) - DRAFT_MESH_DEG
    note = f"least above the rim; designed {mould.draft_deg:g}"
    yield Measurement("mould.draft", file, draft, least, unit="deg", note=note)
    note = "that hangs over, seen along the pull"
    yield Measurement(
        "mould.undercut", file, _undercut_mm2(mesh, silhouette, design), 0, 0.01, "mm²", note
    )


def along(silhouette: Any, end_y_mm: float, notch: Box) -> Any:
    """Points along an outline as seen from above, without those before the weir at its end."""
    edge = silhouette.exterior
    points = shapely.line_interpolate_point(edge, np.arange(0.0, edge.length, _STEP_MM))
    at = shapely.get_coordinates(points)
    at_end = np.abs(at[:, 1] - end_y_mm) < 1e-6
    return points[~(at_end & (np.abs(at[:, 0]) < notch.x_max_mm))]


def distances(mesh: Any, z_mm: float, places: Any) -> solids.Vectors:
    """From places to a mesh's section at a height; infinite where there is none."""
    material = solids.section(mesh, z_mm)
    if material.is_empty:
        return np.full(len(places), np.inf)
    return np.asarray(shapely.distance(places, material))


def _undercut_mm2(mesh: Any, silhouette: Any, design: Design) -> float:
    """Faces that look down, from the wall's middle inward and above the bed, as they are seen
    along the pull: a facet of a curved wall may lean, but hangs over next to nothing."""
    mould = design.mould
    inner = silhouette.buffer(mould.wall_gap_mm + mould.wall_mm / 2)
    above_bed = mesh.triangles[:, :, 2].min(axis=1) > mesh.bounds[0, 2] + _ON_BED_MM
    down = (mesh.face_normals[:, 2] < -_UPRIGHT) & above_bed
    centres = mesh.triangles_center[down]
    held = shapely.contains_xy(inner, centres[:, 0], centres[:, 1])
    overhung = mesh.area_faces * -mesh.face_normals[:, 2]
    return float(overhung[down][held].sum())
