"""Rays against walls: their thickness, and the letter that is sunk into one."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import trimesh
from numpy.typing import NDArray

from lumitip_fab.checks.readers.solids import Vectors, cast
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Finger, Letter, Printing
from lumitip_fab.text import table_of

Mask = NDArray[np.bool_]

SAMPLES = 3000
MESH_MM = 0.02  # two chord errors: a wall of exactly the limit must pass
_FACING = -np.cos(np.radians(30.0))  # less than that is an edge, not a wall
_SEED = 1
RELIEF_MM = 0.08
_START_MM = 2.0  # of the rays, before the wall
_BESIDE_MM = 0.7  # or the thinnest wall: walls between the letter and the end of its wall
_ASPECT = 0.7
_AROUND = ((-0.08, 0.5), (_ASPECT + 0.08, 0.5), (_ASPECT + 0.08, 0.08), (_ASPECT + 0.08, 0.92))


@dataclass(frozen=True)
class Exempt:
    """A region that may be thinner than other walls, for a reason."""

    name: str
    least_mm: float
    holds: Callable[[Vectors], Mask]
    """Which points of shape `(n, 3)` lie in it."""


def thicknesses(mesh: Any, reach_mm: float) -> tuple[Vectors, Vectors]:
    """Points on the surface with a wall behind them, and its thickness.

    A wall is two faces within 30° of facing away from each other, nearer than `reach_mm`.
    """
    spread, on = trimesh.sample.sample_surface(mesh, SAMPLES, seed=_SEED)
    points = np.concatenate([spread, mesh.triangles_center])
    owner = np.concatenate([on, np.arange(len(mesh.faces))])
    inward = -mesh.face_normals[owner]
    distance, far = cast(mesh, points + inward * 1e-4, inward, reach_mm).first(len(points))
    found = far >= 0
    facing = np.einsum("ij,ij->i", mesh.face_normals[far], mesh.face_normals[owner]) < _FACING
    wall = found & facing
    return points[wall], distance[wall] + 1e-4


def walls(
    check: str, subject: str, mesh: Any, least_mm: float, exempt: Sequence[Exempt]
) -> Iterator[Measurement]:
    """The thinnest wall, and the thinnest in each exempt region with its own limit."""
    reach_mm = 2 * max((least_mm, *(region.least_mm for region in exempt)))
    points, thickness = thicknesses(mesh, reach_mm)
    free = np.ones(len(points), dtype=np.bool_)
    for region in exempt:
        held = region.holds(points)
        free &= ~held
        thin = float(thickness[held].min(initial=reach_mm))
        yield Measurement(
            check, f"{subject}: {region.name}", thin, region.least_mm - MESH_MM, unit="mm"
        )
    thin, note = reach_mm, ""
    if free.any():
        at = int(np.flatnonzero(free)[thickness[free].argmin()])
        thin, (x, y, z) = float(thickness[at]), points[at]
        note = f"at ({x:.1f}, {y:.1f}, {z:.1f}) of the file's frame"
    yield Measurement(check, subject, thin, least_mm - MESH_MM, unit="mm", note=note)


def measure_relief(
    check: str, subject: str, mesh: Any, finger: Finger, letter: Letter
) -> Measurement:
    """How far the wall (mm) strays from a sunken first letter of the name of the finger whose part
    it should be; the mesh is in the frame of the letter."""
    wanted = finger.name[0].upper()
    off = {name: _off_mm(mesh, letter, name) for name in table_of("checks/letters.toml")}
    reads = [name for name, by in off.items() if by <= RELIEF_MM]
    note = f"reads {reads[0]}" if reads else f"reads neither {' nor '.join(off)}"
    return Measurement(check, subject, off[wanted], 0, RELIEF_MM, "mm", f"{note}, {wanted} wanted")


def beside(letter: Letter, printing: Printing) -> Exempt:
    """Walls between and around the letter's strokes, each one printed line wide."""
    box = letter.box.grown(max(_BESIDE_MM, printing.min_wall_mm))

    def holds(points: Vectors) -> Mask:
        across, out, up = points.T
        inside = (np.abs(across - box.centre_mm[0]) < box.width_mm / 2) & (out <= letter.wall_mm)
        inside &= np.abs(up - box.centre_mm[1]) < box.length_mm / 2
        return np.asarray(inside & (out > letter.wall_mm - letter.depth_mm - 0.01))

    return Exempt("letter", printing.line_mm, holds)


def _off_mm(mesh: Any, letter: Letter, name: str) -> float:
    places_of = table_of("checks/letters.toml")[name]
    sunk, standing = places_of["sunk"], (*places_of["standing"], *_AROUND)
    box, places = letter.box, np.array([*sunk, *standing]) * letter.box.length_mm
    starts = np.column_stack(
        [
            box.x_max_mm - places[:, 0],
            np.full(len(places), letter.wall_mm + _START_MM),
            box.y_min_mm + places[:, 1],
        ]
    )
    reach = _START_MM + 2 * letter.depth_mm
    distance, _ = cast(mesh, starts, np.array([0.0, -1.0, 0.0]), reach).first(len(places))
    wanted = np.repeat([letter.depth_mm, 0.0], [len(sunk), len(standing)])
    return float(np.abs(distance - _START_MM - wanted).max())
