"""Polygons by their outline, against the raster and the rays."""

import numpy as np
import pytest

from lumitip import Layout
from lumitip.grid import Floats, hexagonal_grid, hexagonal_neighbours
from lumitip.links.twin import published_layout
from lumitip.twin import HalfPlane, Polygon, Sheet, Twin
from lumitip.twin.outline import Outline

STAR = np.array(
    [
        (
            9.0 * (1.0 - 0.5 * (i % 2)) * np.cos(i * np.pi / 5.0),
            9.0 * (1.0 - 0.5 * (i % 2)) * np.sin(i * np.pi / 5.0),
        )
        for i in range(10)
    ]
)
BOW = [(-6.0, -6.0), (6.0, 6.0), (6.0, -6.0), (-6.0, 6.0)]


def rms(one: Floats, two: Floats) -> float:
    return float(np.sqrt(np.mean((one - two) ** 2)))


def on_raster(twin: Twin, polygon: Polygon) -> Floats:
    """The same by drawing every pixel, and its scattered light apart."""
    at = twin.plane(polygon.height)
    taken = at(polygon.coverage(at.x_mm, at.y_mm, at.pixel_mm).astype(np.float32))
    light = 1.0 - (1.0 - polygon.clear) * taken
    if polygon.diffuse:
        light = light + polygon.diffuse * twin._scattered(polygon)
    return twin.calibrated(light)


def turned(degrees: float, x_mm: float, y_mm: float) -> Floats:
    angle = np.radians(degrees)
    cos, sin = np.cos(angle), np.sin(angle)
    return STAR @ np.array([[cos, sin], [-sin, cos]]) + (x_mm, y_mm)


@pytest.mark.parametrize(
    "material", [{}, {"clear": 0.3}, {"clear": 0.2, "diffuse": 0.3}, {"height": 0.2}]
)
@pytest.mark.parametrize("place", [(0.0, 0.0, 0.0), (33.0, -5.0, 4.0), (100.0, 11.0, -14.0)])
def test_outline_and_raster_agree(
    twin: Twin, material: dict[str, float], place: tuple[float, float, float]
) -> None:
    polygon = Polygon(turned(*place), **material)
    assert polygon.simple
    assert rms(twin.values(polygon), on_raster(twin, polygon)) < 1.5


def test_outline_and_rays_agree(twin: Twin) -> None:
    for degrees, x_mm in ((10.0, 1.0), (70.0, -6.0)):
        polygon = Polygon(turned(degrees, x_mm, 2.0))
        assert rms(twin.values(polygon), twin.calibrated(twin._mixed().light([polygon]))) < 3.0


def test_either_order_of_the_corners_covers_the_same(twin: Twin) -> None:
    assert np.allclose(twin.values(Polygon(STAR)), twin.values(Polygon(STAR[::-1])), atol=0.01)


def test_a_polygon_beyond_the_fingertip_is_a_half_plane_or_a_sheet(twin: Twin) -> None:
    far = 300.0
    half = Polygon([(-far, -far), (far, -far), (far, 0.0), (-far, 0.0)])
    assert rms(twin.values(half), twin.values(HalfPlane())) < 0.5
    whole = Polygon([(-far, -far), (far, -far), (far, far), (-far, far)])
    assert np.abs(twin.values(whole) - twin.values(Sheet())).max() < 0.1
    away = Polygon(STAR + far)
    assert np.abs(twin.values(away) - 255.0).max() < 0.1


def test_an_edge_moves_smoothly(twin: Twin) -> None:
    """No steps of a row: a cell darkens alike for each tenth of a pixel."""
    square = np.array([(-9.0, -30.0), (9.0, -30.0), (9.0, 0.0), (-9.0, 0.0)])
    ways = np.arange(-1.0, 1.0, 0.05)
    values = np.array([twin.values(Polygon(np.add(square, (0.0, way)))) for way in ways])
    cell = int(np.ptp(values, axis=0).argmax())
    steps = np.diff(values[:, cell])
    assert np.abs(np.diff(steps)).max() < 0.25 * np.abs(steps).max()


def test_what_crosses_itself_or_has_a_hem_is_drawn(twin: Twin) -> None:
    bow = Polygon(BOW)
    assert not bow.simple
    assert np.allclose(twin.values(bow), on_raster(twin, bow), atol=0.01)
    hemmed = Polygon(STAR, clear=0.5, hem_mm=2.0)
    assert twin.values(hemmed).sum() < twin.values(Polygon(STAR, clear=0.5)).sum() - 50.0


@pytest.mark.parametrize(
    ("points", "simple"),
    [
        ([(0, 0), (1, 0), (0, 1)], True),
        ([(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)], True),
        ([(0, 0), (4, 0), (4, 4), (2, -1), (0, 4)], False),
        ([(0, 0), (4, 0), (4, 4), (2, 0), (0, 4)], False),
        (BOW, False),
    ],
)
def test_which_polygons_cross_themselves(points: list[tuple[float, float]], simple: bool) -> None:
    assert Polygon(points).simple == simple


def test_many_cells_are_drawn_as_before() -> None:
    columns = (9, 8) * 4
    grid = hexagonal_grid(columns, 4.0)
    index = np.arange(grid.x_mm.size)
    layout = Layout(
        grid.x_mm,
        grid.y_mm,
        grid.column,
        grid.row,
        hexagonal_neighbours(columns),
        index // 8,
        index % 8,
        np.array([f"A{i}" for i in index // 8]),
        4.0,
        published_layout().optics,
    )
    twin = Twin(layout)
    assert not Outline.fits(twin.plane())
    for diffuse in (0.0, 0.3):
        polygon = Polygon(STAR, diffuse=diffuse)
        assert np.allclose(twin.values(polygon), on_raster(twin, polygon), atol=0.01)
