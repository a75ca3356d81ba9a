"""The drawing of a finger that is clamped in its mould: from above, and from the side, as its marks
are looked at. In the frame of the mould's bed."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import shapely

from lumitip_fab.design import Clamp, frames
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.casting_page import LABEL_MM, SIDE, WORDS_MM, Cast, Words, inks
from lumitip_fab.scenes.cut import rings_of
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette, view, visible_lines
from lumitip_fab.scenes.glb import tints

AZIMUTH_DEG, ELEVATION_DEG = 38.0, 30.0
SCALE = 1.4
_ABOVE = view(AZIMUTH_DEG, ELEVATION_DEG).enlarged(SCALE)
_BESIDE = SIDE.enlarged(SCALE)
_GAP_MM = 10.0  # from the drawing above to the one below
_PAGE_MM = 148.0  # width of a drawing up to which words have their usual size: the manual sets a
# wider one smaller
_ZOOM, _LENS_MM = 5.0, 15.0
"""Of the marks' detail: how much larger it is, and its radius on the page."""
_CHORDS = 48
Bodies = list[tuple[str, Mesh]]
Label = tuple[Words, Points]


def clamped_view(
    cast: Cast, clamp: Clamp | None, printed: Mesh | None, nuts: tuple[Mesh, ...] = ()
) -> str:
    """The finger in its mould, and the clamp that holds it, if there is one.

    Args:
        cast: mould and finger.
        clamp: for its marks.
        printed: its mesh, where it lies on the finger.
        nuts: on the clamp.
    """
    sheet, lean = Sheet(), frames.rotation_x(cast.lean_deg)
    bodies: Bodies = [("mould", cast.mould)]
    bodies += [
        (name, cast.layers[name]) for name in ("interface", "backing") if name in cast.layers
    ]
    bodies += [("screw", mesh) for mesh in cast.screws]
    bodies += [] if printed is None else [("clamp", printed)]
    bodies += [("screw", mesh) for mesh in nuts]
    prop: Bodies = [] if cast.prop is None else [("prop", cast.prop)]
    stood = [(name, mesh.moved(lean)) for name, mesh in (*prop, *bodies)]
    ways = [way @ lean[:3, :3].T for way in cast.ways(0.0)]
    _wires(sheet, cast, [_ABOVE.seen(way)[:, :2] for way in ways])
    _paint(sheet, _ABOVE, stood, np.zeros(3))
    labels = [] if clamp is None else [_nut_label(clamp, lean)]
    down = np.array([0.0, 0.0, _below(sheet, stood)])
    _wires(sheet, cast, [_BESIDE.seen(way + down)[:, :2] for way in ways])
    beside = _paint(sheet, _BESIDE, stood, down)
    level = float(sheet.low[1])
    sheet.lines([np.array([(sheet.low[0], level), (sheet.high[0], level)])], "leader")
    labels += _side_labels(cast, ways, lean, down)
    sheet.words_scale = max(1.0, float(sheet.high[0] - sheet.low[0]) / _PAGE_MM)
    right, words_mm = float(sheet.high[0]) + LABEL_MM, WORDS_MM * sheet.words_scale
    sheet.leaders(labels, right, "start")
    sheet.cover(right + words_mm, level)
    if clamp is not None:
        at, nut = _mark_at(clamp, lean, down), _nut_label(clamp, lean)[1]
        _enlarge(sheet, beside, at, np.array([right + words_mm / 2, (nut[1] + at[1]) / 2]))
    return sheet.svg({"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG})


@dataclass(frozen=True, eq=False)
class _Drawn:
    """Bodies as they lie on the page."""

    areas: list[tuple[str, list[Points]]]
    """Tint and contours of each, from the farthest to the nearest."""
    lines: list[list[Points]]
    """Pieces of the edges of each that are seen."""


def _paint(sheet: Sheet, eye: View, bodies: Bodies, by_mm: Points) -> _Drawn:
    """Bodies from the farthest to the nearest, then the lines that are seen of all."""
    placed = [(name, Mesh(mesh.points_mm + by_mm, mesh.triangles)) for name, mesh in bodies]
    lines = visible_lines([mesh for _, mesh in placed], eye)
    areas = []
    for name, mesh in placed:
        areas.append((tints()[_TINTS.get(name, name)], silhouette(mesh, eye)))
        with sheet.group(name):
            sheet.area(areas[-1][1], "body", areas[-1][0])
    for found in lines:
        sheet.lines(found, "line")
    return _Drawn(areas, lines)


def _enlarge(sheet: Sheet, drawn: _Drawn, at: Points, to: Points) -> None:
    """The marks once more, larger, in a circle with a line to their place."""
    small = shapely.Point(at).buffer(_LENS_MM / _ZOOM, _CHORDS)

    def moved(points: Points) -> Points:
        return np.asarray((points - at) * _ZOOM + to)

    with sheet.group("detail"):
        sheet.area([moved(np.array(small.exterior.coords))], "behind", "#fff")
        for tint, rings in drawn.areas:
            area = shapely.build_area(shapely.MultiLineString(rings)) & small
            if not area.is_empty:
                sheet.area([moved(ring) for ring in rings_of(area)], "behind", tint)
        for found in drawn.lines:
            sheet.lines([moved(line) for line in _within(found, small)], "line")
    rings = [np.array(small.exterior.coords), moved(np.array(small.exterior.coords))]
    way = (to - at) / np.hypot(*(to - at))
    join = np.array([at + way * _LENS_MM / _ZOOM, to - way * _LENS_MM])
    sheet.lines([*rings, join], "leader")
    x, y = float(to[0]), float(to[1]) - _LENS_MM
    sheet.words(x, y - 4.5 * sheet.words_scale, "Marks", "name", "middle")
    sheet.words(x, y - 8.1 * sheet.words_scale, "of leg and mould in one line", "detail", "middle")


def _within(lines: list[Points], area: shapely.Geometry) -> Iterator[Points]:
    """The pieces of lines in an area."""
    for piece in shapely.get_parts(shapely.MultiLineString(lines) & area):
        if piece.geom_type == "LineString" and not piece.is_empty:
            yield np.array(piece.coords)


def _mark_at(clamp: Clamp, lean: frames.Matrix, down: Points) -> Points:
    """Where the marks of a leg and of its rail meet, on the page, seen from the side."""
    leg = min(clamp.legs, key=lambda box: (-box.x_max_mm, box.y_min_mm))
    mark = lean[:3, :3] @ (leg.x_max_mm, -leg.y_max_mm, clamp.mark_mm)
    return np.asarray(_BESIDE.seen(mark + down)[:2])


_TINTS = {"prop": "clamp", "screw": "coupling"}


def _wires(sheet: Sheet, cast: Cast, lines: list[Points]) -> None:
    for wire, line in zip(cast.wires, lines, strict=True):
        sheet.wire(line, inks(wire.colour))


def _below(sheet: Sheet, bodies: Bodies) -> float:
    """Height by which bodies are moved to be seen from the side below what is drawn."""
    highest = max(float(_BESIDE.seen(mesh.points_mm)[:, 1].max()) for _, mesh in bodies)
    return (float(sheet.low[1]) - _GAP_MM - highest) / SCALE


def _nut_label(clamp: Clamp, lean: frames.Matrix) -> Label:
    """The nut that is nearest to the viewer; the sensor frame's y is -y here."""
    nuts = [lean[:3, :3] @ (x, -y, clamp.top_mm) for x, y in clamp.screws]
    nut = max(nuts, key=lambda at: float(_ABOVE.seen(at)[2]))
    return ("Nut", "on each screw, turned by hand"), _ABOVE.seen(nut)[:2]


def _side_labels(cast: Cast, ways: list[Points], lean: frames.Matrix, down: Points) -> list[Label]:
    """What is looked at from the side."""
    labels: list[Label] = []
    for way in ways[:1]:
        over = way[np.argmin(np.abs(way[:, 1] - cast.mould.points_mm[:, 1].max()))]
        labels.append((("Wires", "over the weir"), _BESIDE.seen(over + down)[:2]))
    if cast.prop is not None:
        prop = cast.prop.points_mm
        at = lean[:3, :3] @ (0.0, prop[:, 1].max() - 1.0, prop[:, 2].min() + 1.0)
        labels.append((("Prop", "left under the mould"), _BESIDE.seen(at + down)[:2]))
    return labels
