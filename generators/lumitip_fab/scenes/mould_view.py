"""The top view of a mould: what each part of it is for, and where plate and board lie in it."""

import math
from dataclasses import dataclass

import numpy as np
import shapely

from lumitip_fab.design import Board, Box, Clamp, Mould, Outline, Point
from lumitip_fab.design.making import tip_stop_mm
from lumitip_fab.parts.surface import Mesh
from lumitip_fab.scenes.cut import rings_of
from lumitip_fab.scenes.drawing import Label, Points, Sheet, View, silhouette, visible_lines
from lumitip_fab.scenes.glb import tints

_ABOVE = View(np.diag([-1.0, -1.0, 1.0])).enlarged(1.3)  # of the mould's bed: the tip up
_LABEL_MM, _WORDS_MM = 6.0, 38.0
_IN_MM = 6.0  # from the tip's corner to where the silicone is poured
_RING_MM, _RING_STEPS = 1.6, 24
_TIP_LINE_MM = 1.0  # of the stop at the tip within the outline, at most
_WEIR_MM, _TROUGH_MM = 1.0, 5.0  # from the edge beside to where a label points at


@dataclass(frozen=True)
class _Page:
    """Places of the sensor frame on the page: in the mould the finger lies face down."""

    view: View
    """Of the mould's bed."""

    def at(self, x_mm: float, y_mm: float) -> Points:
        """One place."""
        return np.asarray(self.placed(np.array([[x_mm, y_mm]]))[0])

    def placed(self, points: Points) -> Points:
        """Several, shape `(n, 2)`."""
        on_bed = np.column_stack([points[:, 0], -points[:, 1], np.zeros(len(points))])
        return np.asarray(self.view.seen(on_bed)[:, :2])


def mould_view(
    printed: Mesh, outline: Outline, board: Board, mould: Mould, clamps: tuple[Clamp, ...]
) -> str:
    """The mould from above, the tip up, with the silicone round its stops, and plate and board as
    dashed lines.

    Args:
        printed: the mould in the frame of its bed.
        outline: of the plate.
        board: for its edge.
        mould: for its stops, and the film on its floor.
        clamps: for the rails.
    """
    sheet, box, page = Sheet(), board.box, _Page(_ABOVE.fitted([printed]))
    sheet.area(silhouette(printed, page.view), "body", tints()["mould"])
    with sheet.group("silicone"):
        filled = rings_of(_filled(outline, mould))
        sheet.area([page.placed(ring) for ring in filled], "part", tints()["silicone"])
    sheet.lines(visible_lines([printed], page.view)[0], "line")
    edges = [outline.polygon(16), np.array(shapely.box(*box.bounds_mm).exterior.coords)]
    with sheet.group("dashed"):
        sheet.lines([page.placed(np.concatenate([edge, edge[:1]])) for edge in edges], "hidden")
    pour = _pour_at(outline)
    turn = np.linspace(0.0, 2 * math.pi, _RING_STEPS)
    ring = _RING_MM * np.column_stack([np.cos(turn), np.sin(turn)])
    sheet.lines([page.at(*pour) + ring], "mark")
    trough_y = _TROUGH_MM - float(printed.points_mm[:, 1].max())
    right: list[Label] = [
        (("Pour", "at a corner of the tip"), page.at(*pour)),
        (("Board", "dashed, face down"), page.at(box.x_min_mm, _low_y(box))),
        (("Weir", "for wires and surplus"), page.at(-1.0, outline.end_y_mm - _WEIR_MM)),
        (("Trough", "for the surplus"), page.at(-1.0, trough_y)),
    ]
    right += [
        (("Rail", "with a screw for the clamp"), page.at(*clamp.screws[0])) for clamp in clamps
    ]
    left = _stops(outline, mould, page)
    sides = float(sheet.low[0]) - _LABEL_MM, float(sheet.high[0]) + _LABEL_MM
    sheet.leaders(left, sides[0], "end")
    sheet.leaders(right, sides[1], "start")
    sheet.cover(sides[0] - _WORDS_MM, float(sheet.low[1]))
    sheet.cover(sides[1] + _WORDS_MM, float(sheet.low[1]))
    return sheet.svg({"data-scale": page.view.scale})


def _filled(outline: Outline, mould: Mould) -> shapely.Geometry:
    """Where silicone is under the plate: round the stops, in the sensor frame."""
    line_y, half = outline.tip_y_mm - _TIP_LINE_MM, tip_stop_mm(outline.tip_width_mm) / 2
    stops = [shapely.box(-half, line_y, half, outline.tip_y_mm)]
    for x, y in mould.pads:
        out = math.copysign(outline.half_width_at(y), x)
        stops.append(shapely.LineString([(x, y), (out, y)]).buffer(mould.pad_mm / 2))
    return shapely.Polygon(outline.polygon(16)) - shapely.union_all(stops)


def _stops(outline: Outline, mould: Mould, page: _Page) -> list[Label]:
    """What the plate rests on, and where it is taken out: on the left of the page, which is +x."""
    tip_half = tip_stop_mm(outline.tip_width_mm) / 2
    gap_y = mould.grip.centre_y_mm
    plate_y = (outline.tip_y_mm + gap_y) / 2
    wall = outline.half_width_at(gap_y) + mould.wall_gap_mm + mould.wall_mm / 2
    labels = [
        (("Tip line", "stop under the tip edge"), page.at(0.8 * tip_half, outline.tip_y_mm)),
        (("Plate", "dashed, its front down"), page.at(outline.half_width_at(plate_y), plate_y)),
        (("Gap", "in both walls, for two fingers"), page.at(wall, gap_y)),
        (("Pad", "two stops under the plate"), page.at(*max(mould.pads))),
    ]
    for box in (insert.box for insert in mould.inserts):
        film = page.at(box.x_max_mm, sum((box.centre_mm[1], plate_y)) / 2)
        labels.append((("Recess", "for the smooth film"), film))
    return labels


def _low_y(box: Box) -> float:
    """A quarter up a box, beside the rails' screws."""
    return box.y_min_mm + box.length_mm / 4


def _pour_at(outline: Outline) -> Point:
    """A corner of the tip, on the right of the page."""
    y = outline.tip_y_mm - _IN_MM
    return _IN_MM - outline.half_width_at(y), y
