"""The smooth film of the moulds' floor: its drawings against the apertures, and recess, stops and
note of each mould against the film as it is drawn."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import shapely
from ezdxf import units

from lumitip_fab.checks.mould import Probe
from lumitip_fab.checks.readers import MALFORMED, solids
from lumitip_fab.checks.readers.mask_page import PageError, read_page
from lumitip_fab.checks.readers.plain_dxf import read_plain_dxf
from lumitip_fab.checks.result import Measure, Measurement, Subject, measured, unreadable
from lumitip_fab.design import Design, Finger, Insert
from lumitip_fab.design.frames import applied
from lumitip_fab.design.insert import LAND_MM, LEAST_MARGIN_MM
from lumitip_fab.errors import OutputError

READS = ("mould/*_mould.stl", "mould/*_casting.md", "mould/insert*")
PAPERS = ("a4", "letter")
LEVEL_MM = 0.02  # of the film's face, off the floor beside it
PLAY_MM = 0.05  # off the clearance of the design
LEAST_PLAY_MM = 0.2
SIZE_MM = 0.01
_OVER_FLOOR_MM = 0.05  # where stops and walls are cut
_BESIDE_MM = 0.2  # from the side of the recess, where the floor is probed
_STEP_MM = 0.5
_SIZE = re.compile(r"never outside: ([\d.]+) x ([\d.]+) mm")


@dataclass(frozen=True, eq=False)
class Laid(Subject):
    """The film as it is drawn, in the mould of a finger."""

    film: Any
    """Its outline, in the sensor frame."""
    probe: Probe
    note: str
    insert: Insert
    finger: Finger
    design: Design


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """The film's drawing and pages, then both moulds."""
    for insert in design.inserts:
        drawn = Subject("insert", f"mould/{insert.name}.dxf")
        try:
            film = _read_film(outputs / drawn.subject)
        except OutputError as error:
            yield unreadable("insert.readable", drawn.subject, str(error))
            continue
        yield drawn.figure("readable", len(film.exterior.coords) - 1, 4, 4, "corners")
        for paper in PAPERS:
            yield _page(outputs, f"mould/{insert.name}_{paper}.pdf", film, design)
        for finger in design.fingers:
            subject = f"mould/{finger.name}_mould.stl"
            try:
                probe = Probe(solids.read_mesh(outputs / subject), design)
                note = (outputs / f"mould/{finger.name}_casting.md").read_text(encoding="utf-8")
            except (OutputError, OSError, ValueError) as error:
                yield unreadable("insert.mould", subject, str(error))
                continue
            laid = Laid("insert", subject, film, probe, note, insert, finger, design)
            yield from measured(MEASURES, laid)


def _read_film(path: Path) -> Any:
    """The one closed line of the drawing, which is all that it has.

    Raises:
        OutputError: if the file is missing, damaged, not in mm, or shows something else.
    """
    try:
        document = read_plain_dxf(path)
        drawn = list(document.modelspace())
        kinds = [(e.dxf.layer, e.dxftype()) for e in drawn]
        if document.units != units.MM or kinds != [("CUT", "LWPOLYLINE")] or not drawn[0].closed:
            raise OutputError(f"shows {kinds}; one closed line in mm on layer CUT is needed")
        return shapely.Polygon([point[:2] for point in drawn[0].get_points()])
    except (OSError, ezdxf.DXFError, *MALFORMED) as error:
        raise OutputError(f"cannot be read: {error!r:.200}") from error


def _page(outputs: Path, file: str, film: Any, design: Design) -> Measurement:
    """The line on paper, as it comes out of the printer whose rulers were measured."""
    try:
        page = read_page(outputs / file)
        stroked = [run for p in page.painted if p.stroked for run in p.subpaths]
        if len(stroked) != 1:
            raise PageError(f"{len(stroked)} lines are drawn; one is needed")
    except PageError as error:
        return unreadable("insert.page", file, str(error))
    left, low, right, high = stroked[0].extent
    printed = np.array((right - left, high - low)) * design.mask.measured_ruler_mm / 100
    off = float(np.abs(printed - _size_mm(film)).max())
    return Measurement("insert.page", file, off, 0, SIZE_MM, "mm", "of its sides from the drawing")


def _size_mm(film: Any) -> solids.Vectors:
    left, low, right, high = film.bounds
    return np.array((right - left, high - low))


def measure_covers(laid: Laid) -> Iterator[Measurement]:
    """The film beyond every aperture of the finger."""
    reach = np.array(laid.design.mask.holes_mm) / math.sqrt(3)
    cells = shapely.points(np.array(laid.finger.cells))
    to_edge = shapely.distance(cells, laid.film.exterior)
    inside = shapely.contains(laid.film, cells)
    beyond = float((np.where(inside, to_edge, -to_edge) - reach).min())
    note = "film beyond the aperture nearest to its edge"
    yield laid.figure("covers", beyond, LEAST_MARGIN_MM, math.inf, note=note)


def measure_level(laid: Laid) -> Iterator[Measurement]:
    """The film's face against the floor beside it: the recess is as deep as the film is thick."""
    left, low, right, high = laid.film.bounds
    across, up = np.arange(left, right, _STEP_MM), np.arange(low, high, _STEP_MM)
    under = laid.probe.depths_mm(np.stack(np.meshgrid(across, up), axis=-1).reshape(-1, 2))
    beside = laid.film.buffer(laid.insert.clearance_mm + _BESIDE_MM, join_style="mitre").exterior
    places = shapely.line_interpolate_point(beside, np.arange(0, beside.length, _STEP_MM))
    floor = laid.probe.depths_mm(shapely.get_coordinates(places))
    faces = np.concatenate([under - laid.insert.thickness_mm, floor])
    note = f"at {len(faces)} places on film and floor, under the rim"
    yield laid.near("level", faces, laid.design.stack.cover_mm, LEVEL_MM, note)


def measure_play(laid: Laid) -> Iterator[Measurement]:
    """The recess round the film: it lies flat in it, and cannot move far."""
    wanted = laid.insert.clearance_mm
    edge = _edge(laid)
    floor_mm = laid.design.mould.floor_mm - laid.insert.thickness_mm / 2
    gaps = shapely.distance(edge, solids.section(laid.probe.mesh, floor_mm))
    note = "from the film to the side of its recess"
    yield laid.figure("play", gaps.min(), LEAST_PLAY_MM, wanted + PLAY_MM, note=note)
    yield laid.figure("play", gaps.max(), LEAST_PLAY_MM, wanted + PLAY_MM, note=note, at="widest")


def measure_apart(laid: Laid) -> Iterator[Measurement]:
    """The film against stops and walls, and what rises from the floor at both ends."""
    material = solids.section(laid.probe.mesh, laid.design.mould.floor_mm + _OVER_FLOOR_MM)
    gap = float(shapely.distance(_edge(laid), material).min())
    yield laid.figure("apart", gap, LAND_MM, math.inf, note="from the film to stops and walls")


def _edge(laid: Laid) -> Any:
    """Points along the film's edge, in the frame of the mould's bed."""
    ring = laid.film.exterior
    points = shapely.line_interpolate_point(ring, np.arange(0, ring.length, _STEP_MM))
    corners = np.concatenate([shapely.get_coordinates(points), shapely.get_coordinates(ring)])
    return shapely.points(applied(laid.probe.to_bed, corners)[:, :2])


def measure_note(laid: Laid) -> Iterator[Measurement]:
    """The size to cut by the casting note."""
    found = _SIZE.search(laid.note)
    size = np.array([float(found[1]), float(found[2])]) if found else np.full(2, math.nan)
    off = float(np.abs(size - _size_mm(laid.film)).max())
    yield laid.figure("note", off, 0, SIZE_MM, note="of the sides in the casting note")


MEASURES: tuple[Measure[Laid], ...] = (
    measure_covers,
    measure_level,
    measure_play,
    measure_apart,
    measure_note,
)
