"""The drawing that cuts a mask from an opaque film: every layer against the cells and the film's
own drawing."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import ezdxf
import numpy as np
import shapely
from ezdxf import units
from scipy.spatial import cKDTree

from lumitip_fab.checks.mask_drawings import Film, read_film
from lumitip_fab.checks.mask_holes import apart, edges_apart, sizes_at
from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.mask_page import PageError, Points
from lumitip_fab.checks.readers.plain_dxf import read_plain_dxf
from lumitip_fab.checks.result import Measure, Measurement, Subject, measured, unreadable
from lumitip_fab.design import Design, Finger

READS = ("mask/*_cut.dxf", "mask/*_mask.dxf")
PLACE_MM = 0.01
SAME_MM = 0.01  # against the film's drawing
WEB_MM = 0.4  # less tears
_LAYERS = frozenset({"CUT", "HOLES", "WINDOW", "FOLD"})
_MIRROR = np.array([-1.0, 1.0])  # the drawing shows the inside


@dataclass(frozen=True, eq=False)
class Drawn:
    """What a drawing has, in the sensor frame."""

    edges: tuple[Points, ...]
    windows: tuple[Points, ...]
    centres: Points
    diameters_mm: Points
    folds: tuple[Points, ...]
    others: tuple[str, ...]
    """What is on other layers, or of a kind that its layer does not take."""


@dataclass(frozen=True, eq=False)
class Cut(Subject):
    """The drawing of one finger, and the film that it must equal."""

    drawn: Drawn
    film: Film
    finger: Finger
    design: Design


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """The drawings of both fingers."""
    for finger in design.fingers:
        subject = f"mask/{finger.name}_cut.dxf"
        try:
            drawn = _read(outputs / subject)
            film = read_film(outputs, finger.name, design.mask)
        except PageError as error:
            yield unreadable("mask_cut.readable", subject, str(error))
            continue
        read = Cut("mask_cut", subject, drawn, film, finger, design)
        yield read.count("readable", drawn.others, "on other layers, or of another kind")
        yield from measured(MEASURES, read)


def _read(path: Path) -> Drawn:
    """Read a drawing by its layers.

    Raises:
        PageError: if the file is missing, damaged or not in mm.
    """
    rings: dict[str, list[Points]] = {"CUT": [], "WINDOW": []}
    circles, folds, others = [], [], []
    try:
        document = read_plain_dxf(path)
        if document.units != units.MM:
            raise PageError("its unit is not the millimetre")
        for e in document.modelspace():
            kind = e.dxf.layer, e.dxftype()
            if kind[0] in rings and kind[1] == "LWPOLYLINE" and e.closed:
                rings[kind[0]].append(
                    np.array([p[:2] for p in e.get_points()], dtype=float) * _MIRROR
                )
            elif kind == ("HOLES", "CIRCLE"):
                circles.append((-e.dxf.center.x, e.dxf.center.y, 2 * e.dxf.radius))
            elif kind == ("FOLD", "LINE"):
                ends = [(p.x, p.y) for p in (e.dxf.start, e.dxf.end)]
                folds.append(np.array(ends) * _MIRROR)
            else:
                others.append(" ".join(kind))
        others += sorted(_LAYERS - {layer.dxf.name for layer in document.layers})
    except FileNotFoundError as error:
        raise PageError("no such file") from error
    except (OSError, ezdxf.DXFError, *MALFORMED) as error:
        raise PageError(f"cannot be read: {error!r:.200}") from error
    holes = np.array(circles, dtype=float).reshape(-1, 3)
    edges, windows = map(tuple, rings.values())
    return Drawn(edges, windows, holes[:, :2], holes[:, 2], tuple(folds), tuple(others))


def measure_holes(read: Cut) -> Iterator[Measurement]:
    """A circle at each cell and none more, of the apertures' diameter."""
    cells = np.array(read.finger.cells)
    yield read.figure("count", len(read.drawn.centres), len(cells), len(cells), "circles")
    far = cKDTree(read.drawn.centres).query(cells)[0].max() if len(read.drawn.centres) else math.nan
    yield read.figure("position", far, 0, PLACE_MM, note="worst cell to its circle")
    wanted = sizes_at(read.drawn.centres, cells, read.design.mask)
    yield read.near("size", read.drawn.diameters_mm, wanted, PLACE_MM, "diameter")


def measure_web(read: Cut) -> Iterator[Measurement]:
    """The least web between two circles, or from one to window or edge."""
    radii = read.drawn.diameters_mm / 2
    within = read.design.grid.pitch_mm + radii.max()
    one, other = cKDTree(read.drawn.centres).query_pairs(within, output_type="ndarray").T
    apart_mm = np.linalg.norm(read.drawn.centres[one] - read.drawn.centres[other], axis=1)
    between = (apart_mm - radii[one] - radii[other]).min(initial=within)
    centres = shapely.points(read.drawn.centres)
    rings = map(shapely.LinearRing, (*read.drawn.edges, *read.drawn.windows))
    around = [float((shapely.distance(centres, ring) - radii).min()) for ring in rings]
    yield read.figure("web", min(float(between), *around), WEB_MM, math.inf)


def measure_outline(read: Cut) -> Iterator[Measurement]:
    """One edge, that of the film; one window."""
    for name, rings, wanted in (
        ("outline", read.drawn.edges, read.film.cut),
        ("window", read.drawn.windows, read.film.black.window),
    ):
        off = edges_apart(rings[0], wanted) if len(rings) == 1 else math.inf
        yield read.figure(name, off, 0, SAME_MM, note=f"{len(rings)} against the film's one")


def measure_folds(read: Cut) -> Iterator[Measurement]:
    """The folds of the film."""
    same = len(read.drawn.folds) == len(read.film.folds)
    off = (
        apart(np.concatenate(read.drawn.folds), np.concatenate(read.film.folds))
        if same
        else math.inf
    )
    note = f"{len(read.drawn.folds)} against {len(read.film.folds)} on the film"
    yield read.figure("folds", off, 0, SAME_MM, note=note)


MEASURES: tuple[Measure[Cut], ...] = (measure_holes, measure_web, measure_outline, measure_folds)
