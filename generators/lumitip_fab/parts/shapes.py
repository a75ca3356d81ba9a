"""Faces and solids from the design's curves and rectangles, exact: no curve becomes a polygon."""

from typing import Any

import numpy as np
from build123d import Edge, Face, Location, Plane, Solid, Vector, Wire

from lumitip_fab.design import Box, Outline, Point
from lumitip_fab.design.frames import Matrix
from lumitip_fab.errors import BuildError


def outline_edges(outline: Outline) -> list[Edge]:
    """The outline's pieces at z = 0: cubics as Bézier curves, straight pieces as lines."""
    edges = []
    for piece in outline.curve:
        a, b, _, d = np.array(piece)
        straight = np.allclose(b, a + (d - a) / 3, atol=1e-9)
        corners = [(x, y, 0.0) for x, y in ((piece[0], piece[3]) if straight else piece)]
        edges.append(Edge.make_line(*corners) if straight else Edge.make_bezier(*corners))
    return edges


def outline_face(outline: Outline) -> Face:
    """The silhouette at z = 0, facing +z."""
    return Face(Wire(outline_edges(outline)))


def polygon_face(corners: list[Point]) -> Face:
    """A face with straight edges at z = 0."""
    return Face(Wire.make_polygon([(x, y, 0.0) for x, y in corners], close=True))


def box_face(box: Box, radius_mm: float = 0.0) -> Face:
    """A rectangle at z = 0, its corners rounded if wanted."""
    face = polygon_face(
        [
            (box.x_min_mm, box.y_min_mm),
            (box.x_max_mm, box.y_min_mm),
            (box.x_max_mm, box.y_max_mm),
            (box.x_min_mm, box.y_max_mm),
        ]
    )
    return face.fillet_2d(radius_mm, face.vertices()) if radius_mm > 0 else face


def prism(face: Face, z_min_mm: float, z_max_mm: float) -> Solid:
    """A face at z = 0 drawn out along z between two heights."""
    lower = face.moved(Location((0, 0, z_min_mm)))
    return Solid.extrude(lower, Vector(0, 0, z_max_mm - z_min_mm))


def box_solid(box: Box, z_min_mm: float, z_max_mm: float, radius_mm: float = 0.0) -> Solid:
    """A block on a rectangle, its upright edges rounded if wanted."""
    return prism(box_face(box, radius_mm), z_min_mm, z_max_mm)


def cylinder(centre: Point, diameter_mm: float, z_min_mm: float, z_max_mm: float) -> Solid:
    """An upright cylinder."""
    plane = Plane((centre[0], centre[1], z_min_mm))
    return Solid.make_cylinder(diameter_mm / 2, z_max_mm - z_min_mm, plane)


def side_prism(corners: list[Point], x_min_mm: float, x_max_mm: float) -> Solid:
    """A polygon in the (y, z) plane drawn out along x."""
    face = Face(Wire.make_polygon([(x_min_mm, y, z) for y, z in corners], close=True))
    return Solid.extrude(face, Vector(x_max_mm - x_min_mm, 0, 0))


def one_solid(made: Any, part: str, change: str = "the outline or the coupling") -> Solid:
    """The result of the CAD kernel, if it is one valid solid.

    Args:
        made: what it made.
        part: its name.
        change: what a user may change so that it succeeds.

    Raises:
        BuildError: if it is none, or several.
    """
    solids = made.solids()
    if len(solids) != 1 or not solids[0].is_valid:
        raise BuildError(
            f"{part}: the CAD kernel made {len(solids)} solids of it, one valid solid is needed; "
            f"change {change} a little"
        )
    return solids[0]


def placed(shape: Any, matrix: Matrix) -> Any:
    """A shape moved by a rigid 4x4 matrix of `lumitip_fab.design.frames`."""
    where = Plane(tuple(matrix[:3, 3]), x_dir=tuple(matrix[:3, 0]), z_dir=tuple(matrix[:3, 2]))
    return shape.moved(Location(where))
