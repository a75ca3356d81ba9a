"""The layers and drills of a zip, as areas and holes, against the board file."""

import math
from collections.abc import Iterator, Mapping

import numpy as np
import shapely
from shapely import affinity, box
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard, lands
from lumitip_fab.checks.order_names import measure_names
from lumitip_fab.checks.order_nets import measure_nets
from lumitip_fab.checks.order_roles import measure_roles
from lumitip_fab.checks.readers.gerber import drilled, gerber_area
from lumitip_fab.checks.readers.kicad_font import inked
from lumitip_fab.checks.readers.kicad_silk import Word
from lumitip_fab.checks.result import Measurement, Subject
from lumitip_fab.design import Box

PLACE_MM = 0.001
MASK_GAP_MM = 0.1  # an opening round a pad, each side, at most
INK_SHARE = 0.03  # of the room of a word, at least
WHITE_PERCENT = 15.0
"""Of the side with the cells, at most: white ink scatters some 0.8 of the infrared, so that the
board's mean rises by at most 0.12, as much as solder masks differ by (assumed)."""
_CHORD_MM = 0.01  # of arcs, off their chords: what differs by less than twice this is not seen
_ROUND_MM2 = 0.01  # what chords of round pens leave of all lines of a side
_SIDES = ("front", "back")
Holes = list[tuple[float, float, float]]
"""x, y and diameter of each (mm)."""
Painted = dict[bytes, BaseGeometry]
"""Layers that were read before, by their bytes: the zips share most of them."""


def measure_layers(
    path: str, read: ReadBoard, layers: Mapping[str, bytes], painted: Painted
) -> Iterator[Measurement]:
    """Copper, mask, paste, silkscreen, edge and drills."""

    def area(key: str) -> BaseGeometry:
        data = layers[key]
        if data not in painted:
            painted[data] = gerber_area(data.decode())
        return painted[data]

    outline = _in_sensor(read, read.outline)
    yield measure_roles(path, layers)
    sides = zip(_SIDES, (read.board.layers[0], read.board.layers[-1]), strict=True)
    yield measure_names(path, read, {on: layers[f"{s} copper"].decode() for s, on in sides})
    copper = [area(f"{side} copper") for side in _SIDES]
    yield from measure_nets(path, read, copper, drilled(layers["plated"].decode()))
    for side, layer in zip(_SIDES, (read.board.layers[0], read.board.layers[-1]), strict=True):
        of = Subject("orders", f"{path}: {side}")
        yield from _copper(of, read, layer, area(f"{side} copper"))
        yield from _mask(of, read, layer, area(f"{side} mask"))
        soldered = _in_sensor(read, _soldered(read, layer))
        off = area(f"{side} paste").symmetric_difference(soldered).area
        yield of.figure("paste", off, 0, PLACE_MM, "mm²", "differs from the pads of mounted parts")
        bare = shapely.union(area(f"{side} mask"), shapely.difference(_all(outline), outline))
        yield from _silk(of, read, side == "front", area(f"{side} silk"), bare)
        if read.cells_hold and side == "front":
            white = 100 * area(f"{side} silk").area / outline.area
            yield of.figure("white", white, 0, WHITE_PERCENT, "%", "of the board, in white ink")
    yield from _edge(path, outline, area("outline"))
    yield from _drills(path, read, layers)


def measure_stiffener(path: str, layers: Mapping[str, bytes], wanted: Box) -> Measurement:
    """How far the closed line that is drawn for a stiffener is from its edges, in its middle."""
    drawn = gerber_area(layers["stiffener"].decode())
    off = math.nan
    if isinstance(drawn, shapely.Polygon) and len(drawn.interiors) == 1:
        middle = np.add(drawn.exterior.bounds, drawn.interiors[0].bounds) / 2
        edges = wanted.bounds_mm
        off = float(np.abs(middle - edges).max())
    return Measurement("orders.stiffener", path, off, 0, PLACE_MM, "mm", "its outline")


def _copper(
    of: Subject, read: ReadBoard, layer: str, painted: BaseGeometry
) -> Iterator[Measurement]:
    areas = [p.area for p in read.board.copper() if layer in p.layers]
    copper = _in_sensor(read, shapely.union_all(areas))
    off = painted.symmetric_difference(copper).buffer(-_CHORD_MM).area
    yield of.figure("copper", off, 0, PLACE_MM, "mm²", "differs from the board's")


def _mask(of: Subject, read: ReadBoard, layer: str, open_: BaseGeometry) -> Iterator[Measurement]:
    areas = [copper.area for _, _, copper in lands(read.board, layer)]
    covered = _in_sensor(read, shapely.union_all(areas)) - open_
    yield of.figure("mask", covered.area, 0, PLACE_MM, "mm²", "of pads under the mask")
    bare = open_ - _in_sensor(read, _openable(read, layer))
    yield of.figure("exposed", bare.area, 0, PLACE_MM, "mm²", "open away from pads and holes")


def _silk(
    of: Subject, read: ReadBoard, front: bool, printed: BaseGeometry, bare: BaseGeometry
) -> Iterator[Measurement]:
    """Silkscreen: the board's lines, ink in the box of each word, and nothing else."""
    silk = read.board.silk
    lines = _in_sensor(
        read, shapely.union_all([line.area for line in silk.lines if line.front == front])
    )
    rooms = [_in_sensor(read, _room(word)) for word in silk.words if word.front == front]
    lost = shapely.difference(lines, printed).area
    more = shapely.difference(printed, shapely.union_all([lines, *rooms]).buffer(PLACE_MM)).area
    note = "differs from the board's lines and words"
    yield of.figure("silk", lost + more, 0, _ROUND_MM2, "mm²", note)
    shares = [_inside(printed, room) / room.area for room in rooms]
    least, note = min(shares, default=math.nan), "the least that has ink"
    yield of.figure("words", least, INK_SHARE, 1.0, "of a word's room", note)
    misread = list(_misread(read, front, printed, lines))
    yield of.count("letters", misread, "words whose ink is not that of their letters")
    off = shapely.intersection(printed, bare).area
    yield of.figure("silk_clear", off, 0, PLACE_MM, "mm²", "printed on pads or off the board")


def _misread(
    read: ReadBoard, front: bool, printed: BaseGeometry, lines: BaseGeometry
) -> Iterator[str]:
    """Words that lack a stroke of KiCad's font, or have one more in their room."""
    words = [word for word in read.board.silk.words if word.front == front]
    letters = [_in_sensor(read, inked(word)) for word in words]
    drawn = shapely.union_all([lines, *letters])
    off = shapely.get_parts(printed.symmetric_difference(drawn).buffer(-_CHORD_MM))
    tree = shapely.STRtree(off)
    for word in words:
        if tree.query(_in_sensor(read, _room(word)), predicate="intersects").size:
            x, y = _in_sensor(read, shapely.Point(word.at)).coords[0]
            yield f"{word.text} at ({x:.1f}, {y:.1f})"


def _inside(printed: BaseGeometry, room: BaseGeometry) -> float:
    """Area (mm²) of what is printed in a room; the rest of the board is cut off first."""
    return float(shapely.clip_by_rect(printed, *room.bounds).intersection(room).area)


def _room(word: Word) -> BaseGeometry:
    """Where the letters of a word may be, on the page."""
    half = (0.2 + 0.55 * len(word.text) * word.height_mm, 0.95 * word.height_mm)
    flat = box(-half[0], -half[1], half[0], half[1])
    return affinity.translate(affinity.rotate(flat, -word.angle_deg, origin=(0, 0)), *word.at)


def _edge(path: str, outline: BaseGeometry, drawn: BaseGeometry) -> Iterator[Measurement]:
    """The drawn edge, and what a router that follows the middle of its lines leaves or takes."""
    rings = [line for part in shapely.get_parts(drawn) for line in part.interiors]
    pen = np.subtract(drawn.bounds, outline.bounds) * (-1, -1, 1, 1)
    inner = shapely.unary_union([shapely.Polygon(ring) for ring in rings])
    left = inner.buffer(float(pen.mean())).symmetric_difference(outline).buffer(-_CHORD_MM)
    of, pens = Subject("orders", path), float(np.ptp(pen))
    yield of.figure("outline", pens, 0, PLACE_MM, "mm", "from the board's edge")
    yield of.figure("routed", left.area, 0, PLACE_MM, "mm²", "differs from the board")


def _drills(path: str, read: ReadBoard, layers: Mapping[str, bytes]) -> Iterator[Measurement]:
    plated = [(t.at, t.drill_mm) for _, t, _ in lands(read.board) if t.drill_mm]
    vias = [
        ((p.area.centroid.x, p.area.centroid.y), p.drill_mm)
        for p in read.board.loose
        if p.kind == "via"
    ]
    holes = [(t.at, t.drill_mm) for t in read.holes]
    for key, expected in (("plated", plated + vias), ("unplated", holes)):
        places = read.sensor([at for at, _ in expected]).tolist()
        wanted = [(x, y, size) for (x, y), (_, size) in zip(places, expected, strict=True)]
        off = farthest_mm(drilled(layers[key].decode()), wanted)
        note = f"worst of {len(expected)} {key} holes"
        yield Measurement("orders.drills", path, off, 0, PLACE_MM, "mm", note)


def _openable(read: ReadBoard, layer: str) -> BaseGeometry:
    """Where the mask may be open on a layer: pads and holes with a gap, marks with their ring."""
    areas = []
    for part in read.board.parts:
        for t in part.terminals:
            if t.copper is None:
                areas.append(shapely.Point(t.at).buffer(t.drill_mm / 2 + MASK_GAP_MM))
            elif layer in t.copper.layers:
                left, _, right, _ = t.copper.area.bounds
                ring = (right - left) / 2 if part.footprint.startswith("Fiducial") else 0.0
                areas.append(t.copper.area.buffer(ring + MASK_GAP_MM))
    return shapely.union_all(areas)


def _soldered(read: ReadBoard, layer: str) -> BaseGeometry:
    """Pads on a layer of the parts that are mounted on it."""
    return shapely.union_all(
        [
            copper.area
            for part, t, copper in lands(read.board, layer)
            if part.bought and not t.drill_mm
        ]
    )


def farthest_mm(found: Holes, wanted: Holes) -> float:
    """Worst distance, or difference in diameter, of a hole from the nearest of the others.

    Args:
        found: x, y and diameter of each hole (mm).
        wanted: the same, in any order.

    Returns:
        NaN if there are more or fewer than wanted.
    """
    if len(found) != len(wanted) or not found:
        return math.nan
    apart = np.abs(np.array(wanted)[:, None] - np.array(found)).max(axis=2)
    return float(max(apart.min(axis=0).max(), apart.min(axis=1).max()))


def _in_sensor(read: ReadBoard, area: BaseGeometry) -> BaseGeometry:
    return shapely.transform(area, read.sensor)


def _all(outline: BaseGeometry) -> BaseGeometry:
    """Far more than the board."""
    return box(*outline.bounds).buffer(100.0)
