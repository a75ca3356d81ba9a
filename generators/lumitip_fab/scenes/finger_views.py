"""Drawings of work on a finger: the board above its place, the cable's way along the back, and the
flaps of the mask in the order of folding."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import shapely

from lumitip_fab.design import Finger, Mount, Stack, frames
from lumitip_fab.design.cabling import COLOURS, codes_of
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.cut import rings_of
from lumitip_fab.scenes.drawing import Points, Sheet, View, silhouette, view, visible_lines
from lumitip_fab.scenes.glb import tints

AZIMUTH_DEG, ELEVATION_DEG = 32.0, 38.0
SCALE, PLAN_SCALE = 1.6, 2.0
RAISED_MM = 22.0  # of the board over its place
_BEHIND = np.diag([-1.0, 1.0, -1.0, 1.0])  # half a turn about y: the back up, the tip away
_PLAN = View(np.eye(3)).enlarged(PLAN_SCALE)
_WORDS_MM = 44.0
_CABLE_MM = 72.0  # tall at most, above the ways of the cables
_CABLE_WORDS = 1.3  # of a drawing on a full page
_PAST_MM = 22.0  # of the cable, beyond the mount face
_ABREAST_MM = 0.5  # from wire to wire of a cable, as it is drawn
_NUMBERS_SCALE = 1.25  # of the flaps: two drawings stand beside each other
_NUMBER_DOWN_MM = 1.75  # of a number's base line, to have it in the middle
_ANGLES = {"data-azimuth-deg": AZIMUTH_DEG, "data-elevation-deg": ELEVATION_DEG}
_STEPS = 8  # chords of a wire from point to point


def board_view(finger: Finger, layers: Mapping[str, Mesh], parts: Sequence[Mesh]) -> str:
    """The board with its parts, above its place on the backing.

    Args:
        finger: for the holes that find each other.
        layers: interface, backing and board in the sensor frame.
        parts: on the board's front.
    """
    sheet, eye = Sheet(), view(AZIMUTH_DEG, ELEVATION_DEG).enlarged(SCALE)
    raised = frames.translation(0.0, 0.0, RAISED_MM)
    lower = {name: layers[name] for name in ("interface", "backing") if name in layers}
    paint(sheet, eye, lower)
    board = layers["board"]
    top_mm, low_mm = float(board.points_mm[:, 2].max()), float(board.points_mm[:, 2].min())
    ways = [np.array([(x, y, low_mm), (x, y, top_mm + RAISED_MM)]) for x, y in finger.holes]
    sheet.lines([eye.seen(way)[:, :2] for way in ways], "axis")
    paint(sheet, eye, {"board": board.moved(raised)})
    paint_parts(sheet, eye, [part.moved(raised) for part in parts])
    return sheet.svg(_ANGLES)


def cable_view(
    finger: Finger,
    layers: Mapping[str, Mesh],
    colours: Sequence[str],
    mount: Mount,
    stack: Stack,
) -> str:
    """The wires from the board's pads through the notch and along the block, seen from behind.

    Args:
        finger: for its pads and notch.
        layers: interface, backing and board in the sensor frame.
        colours: of the wires, pad by pad, by the codes of IEC 60757.
        mount: for its lugs; without any the cable leaves in the middle.
        stack: for the plate.
    """
    sheet = Sheet(words_scale=_CABLE_WORDS)
    behind = {name: mesh.moved(_BEHIND) for name, mesh in layers.items()}
    eye = view(AZIMUTH_DEG, ELEVATION_DEG).enlarged(SCALE).fitted(behind.values(), _CABLE_MM)
    paint(sheet, eye, {"board": behind["board"]})
    hidden, open_ways = _wires(finger, mount, stack, len(colours))
    _lay(sheet, eye, colours, hidden)
    paint(sheet, eye, {k: behind[k] for k in ("backing", "interface") if k in behind})
    _lay(sheet, eye, colours, open_ways)
    labels = [(("Wires", "through the notch, under the block"), open_ways[0][0])]
    if mount.lugs:
        labels.append((("Cable lug", "tie the cable to it"), open_ways[0][_STEPS]))
    placed = [(words, _page(eye, at)) for words, at in labels]
    sheet.leaders_beside(placed, _CABLE_WORDS * _WORDS_MM)
    return sheet.svg(_ANGLES)


def folded_view(
    layers: Mapping[str, Mesh], flaps: Sequence[Mapping[str, Any]], lip_y_mm: float | None = None
) -> str:
    """The back of the finger with the mask's flaps on it, each with its number.

    Args:
        layers: interface, backing and board in the sensor frame.
        flaps: number and area on the back of each, as the mask's facts have them.
        lip_y_mm: where silicone that is wrapped round the tip ends, under the first flap.
    """
    sheet = Sheet(words_scale=_NUMBERS_SCALE)
    seen = {name: layers[name] for name in ("backing", "interface") if name in layers}
    paint(sheet, _PLAN, {name: mesh.moved(_BEHIND) for name, mesh in seen.items()})
    laid = sorted((f for f in flaps if f["on_back"]), key=lambda flap: int(flap["number"]))
    areas = [shapely.Polygon(np.array(f["on_back"]) * (-PLAN_SCALE, PLAN_SCALE)) for f in laid]
    for area in areas:
        sheet.area(rings_of(area), "body", tints()["film"])
    if lip_y_mm is not None and areas:
        left, low, right, high = areas[0].bounds
        if low < (end := lip_y_mm * PLAN_SCALE) < high:
            under = areas[0] & shapely.LineString([(left, end), (right, end)])
            sheet.lines([np.array(under.coords)], "hidden")
    for k, (flap, area) in enumerate(zip(laid, areas, strict=True)):
        free = max(shapely.get_parts(area - shapely.union_all(areas[k + 1 :])), key=_size)
        at = shapely.maximum_inscribed_circle(free).coords[0]
        sheet.words(at[0], at[1] - _NUMBER_DOWN_MM, str(flap["number"]), "number", "middle")
    return sheet.svg({"data-scale": PLAN_SCALE})


def paint(sheet: Sheet, eye: View, bodies: Mapping[str, Mesh]) -> None:
    """Bodies from the farthest to the nearest, in this order, with the lines that are seen."""
    lines = visible_lines(list(bodies.values()), eye)
    for (name, mesh), found in zip(bodies.items(), lines, strict=True):
        with sheet.group(name):
            sheet.area(silhouette(mesh, eye), "body", tints()[name])
            sheet.lines(found, "line")


def paint_parts(sheet: Sheet, eye: View, parts: Sequence[Mesh]) -> None:
    """Parts of a board, the nearest last."""
    for part in sorted(parts, key=lambda mesh: _near(mesh, eye)):
        sheet.area(silhouette(part, eye), "part", "#fff")


def _near(mesh: Mesh, eye: View) -> float:
    return float(eye.seen(mesh.points_mm)[:, 2].mean())


def _size(area: shapely.Geometry) -> float:
    return float(area.area)


def _page(eye: View, at: Points) -> Points:
    """Places of the sensor frame on the page, the finger's back up."""
    return np.asarray(eye.seen(at * np.diag(_BEHIND)[:3])[..., :2])


def _lay(sheet: Sheet, eye: View, colours: Sequence[str], ways: Sequence[Points]) -> None:
    for colour, way in zip(colours, ways, strict=True):
        sheet.wire(_page(eye, way), [COLOURS[code][1] for code in codes_of(colour)])


def _wires(
    finger: Finger, mount: Mount, stack: Stack, count: int
) -> tuple[list[Points], list[Points]]:
    """Each wire's way in the sensor frame: from its pad to the side of the block, between board and
    block, and from there past the cable lug along the gripper; without a lug straight on."""
    to_sensor = frames.mount_to_sensor(mount, stack)
    low_y, high_y = finger.notch.y_min_mm, finger.notch.y_max_mm
    hidden, open_ways = [], []
    for k, (x, y) in enumerate(finger.connector.pads[:count]):
        abreast = _ABREAST_MM * (k - (count - 1) / 2)
        points = [
            np.array([x, y, stack.pocket_z_mm]),
            np.array([0.9 * x, (low_y + high_y) / 2 + abreast, stack.pocket_z_mm - 0.5]),
        ]
        for lug in mount.lugs[:1]:
            out = lug.side * (lug.face_mm + lug.out_mm + 0.5)
            along = sum(lug.along_mm) / 2 + abreast
            up = (lug.opening.y_min_mm + lug.opening.y_max_mm) / 2
            points.append(np.array([0.8 * out, low_y + 2.0 + abreast, stack.back_z_mm]))
            points += [(to_sensor @ (out, along, h, 1.0))[:3] for h in (up, up - _PAST_MM)]
        if not mount.lugs:
            points += [np.array([0.9 * x, low_y - h, stack.back_z_mm]) for h in (0, _PAST_MM)]
        way = smooth(points)
        hidden.append(way[: 2 * _STEPS + 1])
        open_ways.append(way[2 * _STEPS :])
    return hidden, open_ways


def smooth(points: Sequence[Points]) -> Points:
    """A line through points without corners (Catmull-Rom)."""
    ends = [2 * points[0] - points[1], *points, 2 * points[-1] - points[-2]]
    t = np.linspace(0.0, 1.0, _STEPS, endpoint=False)[:, None]
    pieces = []
    for a, b, c, d in zip(ends, ends[1:], ends[2:], ends[3:], strict=False):
        slope_b, slope_c = (c - a) / 2, (d - b) / 2
        pieces.append(
            b * (1 - t) ** 2 * (1 + 2 * t)
            + c * t**2 * (3 - 2 * t)
            + slope_b * t * (1 - t) ** 2
            - slope_c * t**2 * (1 - t)
        )
    return np.concatenate([*pieces, points[-1][None]])
