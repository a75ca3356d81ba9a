"""Plain bodies are closed, and of a scene only those lines are drawn that can be seen."""

import numpy as np
import pytest
import shapely
import trimesh

from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.drawing import silhouette, view, visible_lines
from lumitip_fab.scenes.system import SECTIONS, block, disc, socket

CIRCLE = SECTIONS / 2 * np.sin(2 * np.pi / SECTIONS)  # area of a ring of chords, of radius² 1


def solid(mesh: Mesh) -> trimesh.Trimesh:
    return trimesh.Trimesh(mesh.points_mm, mesh.triangles, process=False)


BODIES = {
    "disc": (disc(20.0, -2.0, 3.0), CIRCLE * 100 * 5),
    "block": (block((-5, 5), (0, 8), 0.0, 1.0, 3.0), 160.0),
    "block that is round": (block((-5, 5), (-5, 5), 5.0, 0.0, 2.0), CIRCLE * 25 * 2),
    "block with round edges": (block((-5, 5), (0, 8), 2.0, 0.0, 1.0), 80 - 16 + CIRCLE * 4),
    "socket": (socket(20.0, 16.0, 10.0, 4.0), CIRCLE * (1000 - 256)),
}


@pytest.mark.parametrize("name", BODIES)
def test_a_plain_body_is_closed_and_as_large_as_told(name: str) -> None:
    mesh, volume = BODIES[name]
    assert solid(mesh).is_watertight
    assert solid(mesh).volume == pytest.approx(volume, rel=1e-6)


def drawn_mm(meshes: list[Mesh], which: int) -> float:
    lines = visible_lines(meshes, view(30.0, 30.0))[which]
    return float(sum(shapely.LineString(line).length for line in lines))


def edges_mm(size: float) -> float:
    """Nine of the twelve edges of a cube, three of each direction, as long as they look."""
    seen = view(30.0, 30.0).axes[:2] * size
    return float(3 * np.linalg.norm(seen, axis=0).sum())


def cube(x: float, y: float, size: float) -> Mesh:
    half = size / 2
    return block((x - half, x + half), (y - half, y + half), 0.0, -half, half)


def test_of_a_cube_nine_edges_are_seen() -> None:
    assert drawn_mm([cube(0, 0, 10)], 0) == pytest.approx(edges_mm(10), rel=0.02)


def test_what_is_behind_another_body_is_hidden() -> None:
    to_viewer = view(30.0, 30.0).axes[2]
    near = Mesh(cube(0, 0, 40).points_mm + 60 * to_viewer, cube(0, 0, 40).triangles)
    assert drawn_mm([cube(0, 0, 10), near], 0) == 0.0
    assert drawn_mm([cube(0, 0, 10), near], 1) == pytest.approx(edges_mm(40), rel=0.02)


def test_a_silhouette_has_the_hole_that_one_sees_through() -> None:
    ring = trimesh.creation.annulus(r_min=5.0, r_max=10.0, height=1.0)
    told = silhouette(Mesh(np.asarray(ring.vertices), np.asarray(ring.faces)), view(0.0, 90.0))
    areas = sorted(shapely.Polygon(line).area for line in told)
    assert areas == pytest.approx([np.pi * 25, np.pi * 100], rel=0.02)
