"""Lugs for cable ties on the written parts: a tie goes through, and the material round it is thick.

Everything is measured in the frame in which a part is printed; a plate that lies on its front has
no lugs.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import manifold3d
import numpy as np
import shapely

from lumitip_fab.checks.readers import solids
from lumitip_fab.checks.readers.solids import Vectors, cast, section
from lumitip_fab.checks.result import Measure, Measurement, Subject, measured, unreadable
from lumitip_fab.design import Design, TieLug
from lumitip_fab.errors import OutputError

READS = ("backing/*.stl", "interface/*.stl", "holder/*.stl")
LEAST_WALL_MM = 1.5
BESIDE_MM = 1.0  # of the tie on either side of its lug
SHARED_MM3 = 0.01
FLAPS_MM = 2.0
FREE_MM = 1.4  # from a lug to what stands before its ends: the tie bends there
_REACH_MM = 30.0
_SECTIONS = (0.1, 0.5, 0.9)  # of a lug's length
_ACROSS = np.array([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, 1.0, 0, 0], [0, 0, 0, 1.0]])
"""From the frame of a part to that of its sections: out of the wall, up, and along it."""


@dataclass(frozen=True, eq=False)
class _Lugged(Subject):
    """A part with its lugs."""

    mesh: Any
    lugs: tuple[TieLug, ...]
    finger: bool
    """Whether the mask's flaps fold before them."""
    least_mm: float
    """Least thickness round an opening."""


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every lug of both fingers and of the holders."""
    least = max(LEAST_WALL_MM, design.printing.min_wall_mm)
    held = design.held
    parts = [(f"{held}/{f.name}_{held}.stl", design.mount.lugs, True) for f in design.fingers]
    parts += [(f"holder/{h.name}.stl", (*h.lugs, *h.arm_lugs), False) for h in design.holders]
    for subject, lugs, finger in parts:
        if not lugs:
            continue
        try:
            mesh = solids.read_mesh(outputs / subject)
        except OutputError as error:
            yield unreadable("tie_lugs.readable", subject, str(error))
            continue
        part = _Lugged("tie_lugs", subject, mesh, lugs, finger, least)
        yield part.figure("readable", len(mesh.faces), 4, np.inf, "triangles")
        yield from measured(MEASURES, part)


def measure_opening(part: _Lugged) -> Iterator[Measurement]:
    """Material in the way of a straight tie through each lug, its middle in the opening's."""
    body = solids.solid(part.mesh, "the part")
    for lug in part.lugs:
        wide, thick = lug.tie_mm
        out, up = lug.opening.centre_mm
        length = lug.along_mm[1] - lug.along_mm[0] + 2 * BESIDE_MM
        corner = (
            lug.side * (lug.face_mm + out) - thick / 2,
            lug.along_mm[0] - BESIDE_MM,
            up - wide / 2,
        )
        tie = manifold3d.Manifold.cube((thick, length, wide)).translate(corner)
        shared = solids.shared_mm3(body, tie)
        note = f"in the way of a tie of {wide:g} x {thick:g} mm"
        yield part.figure("opening", shared, 0.0, SHARED_MM3, "mm³", note, lug.name)


def measure_wall(part: _Lugged) -> Iterator[Measurement]:
    """Material round each opening, in sections across the wall: from the hole to the outside."""
    for lug in part.lugs:
        first, last = lug.along_mm
        walls = [_wall_mm(part, lug, first + share * (last - first)) for share in _SECTIONS]
        yield part.figure("wall", min(walls), part.least_mm, math.inf, at=lug.name)


def measure_reach(part: _Lugged) -> Iterator[Measurement]:
    """Where each lug ends: out of its wall, and along it."""
    for lug in part.lugs:
        up = lug.profile[2][1] - lug.wall_mm / 2
        end = _first(part, lug, (lug.out_mm + 5.0, sum(lug.along_mm) / 2, up), (-1.0, 0.0, 0.0))
        yield part.near("reach", 5.0 - end, 0.0, 0.05, at=lug.name)
        middle = lug.opening.x_max_mm + lug.wall_mm / 2
        ends = [
            FREE_MM - _first(part, lug, (middle, at + way * FREE_MM, up), (0.0, -way, 0.0))
            for at, way in zip(lug.along_mm, (-1.0, 1.0), strict=True)
        ]
        yield part.near("length", ends, 0.0, 0.05, at=lug.name)


def measure_flaps(part: _Lugged) -> Iterator[Measurement]:
    """From each lug of a finger to the plate's back, onto which the mask's flaps fold."""
    for lug in part.lugs if part.finger else ():
        outs = np.linspace(0.1, 0.9, 5) * lug.out_mm
        ups = np.linspace(lug.profile[1][1] + 0.1, lug.profile[2][1] - 0.1, 5)
        apart = [
            _first(part, lug, (out, lug.along_mm[0] - 0.01, up), (0.0, -1.0, 0.0))
            for out in outs
            for up in ups
        ]
        yield part.figure("flaps", min(apart) + 0.01, FLAPS_MM, math.inf, at=lug.name)


def _wall_mm(part: _Lugged, lug: TieLug, along_mm: float) -> float:
    """The thinnest material of a lug round its opening in a section; NaN where that is no hole.

    What is behind the opening is the part's own wall, which other checks measure.
    """
    cut = section(solids.moved(part.mesh, _ACROSS), along_mm)
    out, up = lug.opening.centre_mm
    middle = shapely.Point(lug.side * (lug.face_mm + out), up)
    for piece in shapely.get_parts(cut):
        holes = [hole for hole in piece.interiors if shapely.Polygon(hole).contains(middle)]
        if holes:
            ends = sorted((lug.side * lug.face_mm, lug.side * (lug.face_mm + _REACH_MM)))
            outside = shapely.box(ends[0], -_REACH_MM, ends[1], 2 * _REACH_MM)
            return float(holes[0].distance(piece.exterior.intersection(outside)))
    return math.nan


def _first(
    part: _Lugged,
    lug: TieLug,
    at: tuple[float, float, float],
    way: tuple[float, float, float],
) -> float:
    start, ray = _placed(lug, at, way)
    return float(cast(part.mesh, start, ray, _REACH_MM).first(1)[0][0])


def _placed(
    lug: TieLug, at: tuple[float, float, float], way: tuple[float, float, float]
) -> tuple[Vectors, Vectors]:
    """A ray out of the wall, along it and up, in the frame of the part."""
    start = np.array([(lug.side * (lug.face_mm + at[0]), at[1], at[2])])
    return start, np.array([(lug.side * way[0], way[1], way[2])])


MEASURES: tuple[Measure[_Lugged], ...] = (
    measure_opening,
    measure_wall,
    measure_reach,
    measure_flaps,
)
