"""Copper that only one of two designs has, for every board and layer."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.readers.kicad_board import KicadBoard, read_board
from lumitip_fab.design.frames import Matrix
from lumitip_fab.diff.folder import Folder, frame_change
from lumitip_fab.diff.values import Shape
from lumitip_fab.errors import OutputError

LEAST_MM2 = 0.0005
"""Areas below are not drawn: places in a board file have 6 decimals, arcs are chords."""
_NEAR_MM = 0.005  # of a drawn contour from what it stands for
_RING_MM = 1.5  # from a difference that is small to the ring round it
_FEW, _SMALL_MM2 = 8, 4.0  # pieces, and their mean area, that get a ring
_MARGIN_MM = 1.0
_POLYGON = 3  # of shapely's types


def layer_differences(a: Folder, b: Folder) -> Iterator[Shape]:
    """Every layer of the boards whose files differ, or that one design alone has.

    Raises:
        OutputError: if a board cannot be read.
    """
    for path in sorted(a.paths(".kicad_pcb") | b.paths(".kicad_pcb")):
        if a.sha256.get(path) == b.sha256.get(path):
            continue
        first = _layers(a, path, None)
        second = _layers(b, path, frame_change(a, b, path))
        name = path.rpartition("/")[2].removesuffix(".kicad_pcb")
        for layer in dict.fromkeys((*first, *second)):
            yield _difference(f"{name} {layer}", first.get(layer), second.get(layer))


def _layers(folder: Folder, path: str, change: Matrix | None) -> dict[str, BaseGeometry]:
    """The copper on each layer, on the page of A's file (mm, y down)."""
    if path not in folder.sha256:
        return {}
    try:
        board = read_board(folder.out / path)
    except OutputError as error:
        raise folder.damaged(path, error) from error
    copper = {layer: _copper(board, layer) for layer in board.layers}
    if change is None:
        return copper
    turn, shift = change[:2, :2], change[:2, 3]
    return {
        n: shapely.transform(area, lambda xy: xy @ turn.T + shift) for n, area in copper.items()
    }


def _copper(board: KicadBoard, layer: str) -> BaseGeometry:
    return shapely.union_all([piece.area for piece in board.copper() if layer in piece.layers])


def _difference(name: str, a: BaseGeometry | None, b: BaseGeometry | None) -> Shape:
    if a is None or b is None:
        return Shape.alone(name, "mm2", *(None if v is None else float(v.area) for v in (a, b)))
    parts = {"both": a & b, "only-a": a - b, "only-b": b - a}
    only = float(parts["only-a"].area), float(parts["only-b"].area)
    drawn = _svg(parts) if max(only) >= LEAST_MM2 else ""
    return Shape(name, "mm2", (float(a.area), float(b.area)), only, drawn)


def _svg(parts: Mapping[str, BaseGeometry]) -> str:
    """The layer as an SVG that takes its colours from the classes of the page."""
    left, top, right, bottom = shapely.total_bounds(list(parts.values()))
    paths = [f'<path class="{name}" d="{_path(area)}"/>' for name, area in parts.items()]
    inside = "".join((*paths, *_rings([parts["only-a"], parts["only-b"]])))
    width, height = right - left + 2 * _MARGIN_MM, bottom - top + 2 * _MARGIN_MM
    view_box = f"{left - _MARGIN_MM:.2f} {top - _MARGIN_MM:.2f} {width:.2f} {height:.2f}"
    return f'<svg viewBox="{view_box}" role="img">{inside}</svg>'


def _rings(differing: Sequence[BaseGeometry]) -> Iterator[str]:
    """A circle round each place, where few and small ones differ."""
    pieces = shapely.get_parts(shapely.get_parts(differing))
    pieces = pieces[shapely.area(pieces) > LEAST_MM2]
    if len(pieces) > _FEW or shapely.area(pieces).sum() > _SMALL_MM2 * len(pieces):
        return
    for place in shapely.get_parts(shapely.union_all(shapely.buffer(pieces, _RING_MM / 2))):
        left, top, right, bottom = place.bounds
        radius = np.hypot(right - left, bottom - top) / 2 + _RING_MM / 2
        x, y = (left + right) / 2, (top + bottom) / 2
        yield f'<circle class="ring" cx="{x:.2f}" cy="{y:.2f}" r="{radius:.2f}"/>'


def _path(area: BaseGeometry) -> str:
    pieces = shapely.get_parts(area)
    shown = pieces[(shapely.get_type_id(pieces) == _POLYGON) & (shapely.area(pieces) > LEAST_MM2)]
    rings = shapely.simplify(shapely.get_rings(shown), _NEAR_MM, preserve_topology=False)
    outlines = (shapely.get_coordinates(ring)[:-1] for ring in rings)
    return "".join(f"M{_points(points)}Z" for points in outlines if len(points) > 2)


def _points(points: NDArray[np.float64]) -> str:
    return " ".join(f"{x:.2f},{y:.2f}" for x, y in points.tolist())
