"""Cuts and silhouettes of bodies, from which the manual's drawings are made."""

from pathlib import Path

import numpy as np
import pytest
import shapely
import trimesh

from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.cut import cut, rings_of
from lumitip_fab.scenes.drawing import silhouette, view
from lumitip_fab.scenes.system import block, socket


def test_a_cut_keeps_what_is_hollow() -> None:
    whole = block((-5, 5), (0, 8), 0.0, 0.0, 3.0)
    assert cut(whole).area == pytest.approx(24.0)
    assert cut(block((1, 5), (0, 8), 0.0, 0.0, 3.0)).is_empty
    cup = cut(socket(20.0, 16.0, 10.0, 4.0))
    assert cup.area == pytest.approx(20 * 10 - 16 * 4, rel=1e-3)
    inner = block((-2, 2), (2, 6), 0.0, 1.0, 2.0)
    hollow = Mesh(
        np.concatenate([whole.points_mm, inner.points_mm]),
        np.concatenate([whole.triangles, inner.triangles[:, ::-1] + len(whole.points_mm)]),
    )
    area = cut(hollow)
    assert area.area == pytest.approx(24.0 - 4.0)
    assert len(rings_of(area)) == 2


@pytest.mark.slow
@pytest.mark.parametrize("angles", [(0.0, 0.0), (32.0, 38.0), (35.0, 24.0)])
def test_a_silhouette_is_all_that_the_triangles_cover(
    angles: tuple[float, float], outputs: Path
) -> None:
    surface = trimesh.load(outputs / "backing/receiver_backing.stl")
    mesh = Mesh(np.asarray(surface.vertices), np.asarray(surface.faces))
    eye = view(*angles)
    triangles = shapely.polygons(eye.seen(mesh.points_mm)[:, :2][mesh.triangles])
    covered = shapely.union_all(triangles[shapely.area(triangles) > 1e-6], grid_size=0.001)
    whole = shapely.Polygon()
    for ring in silhouette(mesh, eye):
        whole = shapely.symmetric_difference(whole, shapely.Polygon(ring))
    assert whole.area == pytest.approx(covered.area, rel=2e-4)
