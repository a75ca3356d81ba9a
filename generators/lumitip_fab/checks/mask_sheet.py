"""The mask as a printed sheet: its STL and 3MF against cells, printer and the film's cut."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely
from scipy.spatial import cKDTree
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.mask_drawings import Film, read_film
from lumitip_fab.checks.mask_holes import edges_apart, sizes_at
from lumitip_fab.checks.printed import measure_closed
from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.mask_page import PageError
from lumitip_fab.checks.readers.tables import unpacked
from lumitip_fab.checks.readers.three_mf import three_mf_triangles
from lumitip_fab.checks.result import Measure, Measurement, Subject, measured, unreadable
from lumitip_fab.design import Box, Design, Finger
from lumitip_fab.design.frames import sheet_bed_to_sensor
from lumitip_fab.errors import OutputError

READS = ("mask/*_sheet.stl", "mask/*_sheet.3mf", "mask/*_mask.dxf")
HOLE_MM = 0.05  # place and size of a hole
SAME_MM = 0.01  # of outline and window, against the film's
LEVEL_MM = 0.001  # of a face, off a whole layer
FOLD_MM2 = 0.5  # grooves beside the folds: 3 µm of a default mask's length
_WITHIN = 0.5  # of a layer: where it is cut
_UPRIGHT = 1e-3  # upward part of a wall's normal
_LETTER_MM2 = 1.0  # least area of the letter's strokes
_ISLANDS = {"E": 0, "R": 1}


@dataclass(frozen=True, eq=False)
class PrintedMask(Subject):
    """The sheet of one finger as it was read, in the sensor frame but for its heights."""

    mesh: Any
    """On its bed."""
    low: BaseGeometry
    """Section of the first layer."""
    high: BaseGeometry
    """Section of the last layer."""
    film: Film
    outputs: Path
    finger: Finger
    design: Design


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Both sheets."""
    for finger in design.fingers:
        subject = f"mask/{finger.name}_sheet.stl"
        try:
            mesh = solids.read_mesh(outputs / subject)
            film = read_film(outputs, finger.name, design.mask)
        except (OutputError, PageError) as error:
            yield unreadable("mask_sheet.readable", subject, str(error))
            continue
        sheet = design.mask.sheet
        top = sheet.layers - 1 + _WITHIN
        low, high = (_seen(mesh, n * sheet.layer_mm) for n in (_WITHIN, top))
        read = PrintedMask("mask_sheet", subject, mesh, low, high, film, outputs, finger, design)
        yield read.figure("readable", len(mesh.faces), 4, math.inf, "triangles")
        yield from measured(MEASURES, read)


def _seen(mesh: Any, z_mm: float) -> BaseGeometry:
    """A section above the bed, in the sensor frame."""
    return shapely.transform(
        solids.section(mesh, z_mm), lambda xy: xy @ sheet_bed_to_sensor()[:2, :2].T
    )


def measure_closed_body(read: PrintedMask) -> Iterator[Measurement]:
    """One closed body."""
    yield from measure_closed(read, read.mesh)


def measure_thickness(read: PrintedMask) -> Iterator[Measurement]:
    """All layers, on the bed; every face but the walls is at a whole layer; the bed's size."""
    sheet, printing = read.design.mask.sheet, read.design.printing
    heights = read.mesh.vertices[:, 2]
    thick = sheet.layers * printing.layer_mm
    yield read.near("thickness", [heights.max(), thick + heights.min()], thick, LEVEL_MM)
    level = np.abs(read.mesh.face_normals[:, 2]) > _UPRIGHT
    faces = read.mesh.triangles[level][:, :, 2] / printing.layer_mm
    off = float(np.abs(faces - np.round(faces)).max()) * printing.layer_mm
    yield read.figure("layers", off, 0, LEVEL_MM, note="of a face off a whole layer")
    size = np.ptp(read.mesh.bounds, axis=0)[:2]
    room = float((np.array(printing.bed_mm[:2]) - size).min())
    yield read.figure("fits_bed", room, *_least(read, 0.0), note="left on the bed")


def measure_holes(read: PrintedMask) -> Iterator[Measurement]:
    """The hole of each cell in the first and in the last layer: place and size, and none more."""
    cells, mask = np.array(read.finger.cells), read.design.mask
    for layer, cut in (("first", read.low), ("last", read.high)):
        holes = _holes(read, cut)
        at = f"{layer} layer"
        yield read.figure("count", len(holes), len(cells), len(cells), "holes", at=at)
        centres = np.array([(h.centroid.x, h.centroid.y) for h in holes]).reshape(-1, 2)
        found = cKDTree(centres).query(cells)[0] if len(holes) else np.full(len(cells), math.nan)
        note = "worst cell to the middle of its hole"
        yield read.figure("position", float(found.max()), 0, HOLE_MM, note=note, at=at)
        round_ = mask.hole_shape == "circle"
        share = math.pi / 4 if round_ else math.sqrt(3) / 2  # of the square round it
        by_area = [math.sqrt(h.area / share) for h in holes]
        narrow = [2 * h.exterior.distance(h.centroid) for h in holes]
        across = "diameter" if round_ else "across flats"
        wanted = np.tile(sizes_at(centres, cells, mask), 2) + mask.sheet.hole_loss_mm
        yield read.near("size", by_area + narrow, wanted, HOLE_MM, across, at=at)


def measure_web(read: PrintedMask) -> Iterator[Measurement]:
    """The least web between two holes, or from a hole to window, edge or groove."""
    holes = np.array(_holes(read, read.high), dtype=object)
    tree = shapely.STRtree(holes)
    pairs = tree.query(holes, predicate="dwithin", distance=read.design.grid.pitch_mm)
    one, other = pairs[:, pairs[0] < pairs[1]]
    between = shapely.distance(holes[one], holes[other]).min(initial=math.inf)
    parts = [p for p in shapely.get_parts(read.high) if p.geom_type == "Polygon"]
    edges = [p.exterior for p in parts] + [shapely.LinearRing(read.film.black.window)]
    around = min(float(shapely.distance(holes, edge).min()) for edge in edges)
    web = min(float(between), around)
    yield read.figure("web", web, *_least(read, read.design.mask.sheet.line_mm))


def measure_outline(read: PrintedMask) -> Iterator[Measurement]:
    """Edge and window against the film's, as its DXF has them."""
    (whole,) = shapely.get_parts(read.low)
    apart = edges_apart(np.array(whole.exterior.coords)[:-1], read.film.cut)
    yield read.figure("outline", apart, 0, SAME_MM, note="against the film's cut")
    window = shapely.Polygon(read.film.black.window)
    found = [h for h in map(shapely.Polygon, whole.interiors) if h.intersects(window)]
    off = edges_apart(np.array(found[0].exterior.coords)[:-1], read.film.black.window)
    yield read.figure("window", off, 0, SAME_MM, note="against the film's window")


def measure_folds(read: PrintedMask) -> Iterator[Measurement]:
    """Grooves above the first layer, against the film's folds; the letter on the tip flap."""
    sheet, mark = read.design.mask.sheet, _area(read.design.mask.mark)
    sunk = read.low.difference(read.high)
    wide = shapely.buffer(
        list(map(shapely.LineString, read.film.folds)), sheet.fold_mm / 2, cap_style=3
    )
    wanted = shapely.union_all(wide).intersection(shapely.Polygon(read.film.cut))
    wrong = sunk.difference(mark).symmetric_difference(wanted).area
    note = f"of grooves beside {len(read.film.folds)} folds"
    yield read.figure("folds", wrong, 0, FOLD_MM2, "mm²", note)
    letter = sunk.intersection(mark)
    inner = [p for p in shapely.get_parts(read.high) if mark.contains(p)]
    wrong_islands = abs(len(inner) - _ISLANDS[read.finger.name[0].upper()])
    # Read from the inside, the stem is on the left, which is the right of the sensor frame.
    stem = letter.centroid.x - mark.centroid.x if letter.area > _LETTER_MM2 else math.nan
    right = wrong_islands == 0 and stem > 0
    missing = not right if sheet.letter else letter.area > 0
    yield read.figure("letter", missing, 0, 0, "letters", "missing, mirrored or another")


def measure_three_mf(read: PrintedMask) -> Iterator[Measurement]:
    """The same corners in the 3MF, and how to print it."""
    path, sheet = read.subject.replace(".stl", ".3mf"), read.design.mask.sheet
    try:
        corners = three_mf_triangles(read.outputs / path).reshape(-1, 3)
        model = unpacked(read.outputs / path)["3D/3dmodel.model"].decode()
        there = cKDTree(corners).query(read.mesh.vertices)[0].max()
        back = cKDTree(read.mesh.vertices).query(corners)[0].max()
    except (OutputError, OSError, ValueError, LookupError, SyntaxError) as error:
        yield unreadable("mask_sheet.three_mf", path, f"cannot be read: {error!r:.200}")
        return
    off, name = float(max(there, back)), "mask_sheet.three_mf"
    yield Measurement(name, path, off, 0, LEVEL_MM, "mm", "worst corner")
    words = (f"{sheet.layers} layers of {sheet.layer_mm:g} mm", f"lines of {sheet.line_mm:g} mm")
    missing = [word for word in (*words, sheet.filament) if word not in model]
    yield Measurement(name, f"{path}: words", len(missing), 0, 0, "missing", "; ".join(missing))


MEASURES: tuple[Measure[PrintedMask], ...] = (
    measure_closed_body,
    measure_thickness,
    measure_holes,
    measure_web,
    measure_outline,
    measure_folds,
    measure_three_mf,
)


def _least(read: PrintedMask, least: float) -> tuple[float, float]:
    """The range of what must be at least so much if the mask is printed; else any."""
    return (least if read.design.mask.route == "tpu" else -math.inf), math.inf


def _holes(read: PrintedMask, cut: BaseGeometry) -> list[shapely.Polygon]:
    """The holes of a section but for the window."""
    window = shapely.Polygon(read.film.black.window)
    parts = [p for p in shapely.get_parts(cut) if p.geom_type == "Polygon"]
    mark = _area(read.design.mask.mark)
    rings = [shapely.Polygon(ring) for part in parts for ring in part.interiors]
    return [r for r in rings if not r.intersects(window) and not r.intersects(mark)]


def _area(box: Box) -> shapely.Polygon:
    return shapely.box(*box.bounds_mm)
