"""The outline of the gripping face, and the letter sunk into a finger's printed parts."""

import math

import numpy as np

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import foot_half_mm, is_flex
from lumitip_fab.design import Board, Box, Cubic, Letter, Outline, Point

_ROUND = 4 / 3 * (math.sqrt(2) - 1)  # handle of a cubic that follows a quarter ellipse


LEAST_LEG_MM = 2.0  # plate beside the wire notch at the gripper end, without a groove
LEAST_CORNER_MM = 0.5


def derive_outline(config: Input, board: Board, notch: Box, faults: Diagnostics) -> Outline:
    """The outline, refused where it is no smooth curve round the board.

    Args:
        config: the parameters.
        board: the board, with its pocket.
        notch: the wire notch, which leaves two legs at the gripper end.
        faults: where to refuse.
    """
    p = config.parameters
    tip_y = board.box.y_max_mm + p.outline.tip_margin_mm
    end_y = board.box.y_min_mm - p.outline.end_margin_mm
    length, half_board = tip_y - end_y, board.box.x_max_mm
    shoulder = (half_board + p.outline.shoulder_margin_mm, tip_y - p.outline.shoulder_at_mm)
    waist = (half_board + p.outline.waist_margin_mm, tip_y - p.outline.waist_at * length)
    tip_half = p.outline.tip_fraction * shoulder[0]
    leg_mm = _leg_mm(config, notch)
    room = waist[0] - notch.x_max_mm - leg_mm
    corner = min(p.outline.end_corner_mm, max(room, LEAST_CORNER_MM))
    end_half = waist[0] - corner
    faults.unless(shoulder[0] >= waist[0], "shoulder_narrow")
    least = (p.outline.shoulder_at_mm + 1) / length
    faults.unless(shoulder[1] > waist[1] + 1, "waist_before_shoulder", least=least)
    most = 1 - corner / length
    faults.unless(waist[1] > end_y + corner, "waist_behind_corner", most=most, corner=corner)
    faults.unless(
        room >= LEAST_CORNER_MM,
        "legs_narrow",
        legs_mm=room + leg_mm,
        width=notch.width_mm,
        least_mm=leg_mm + LEAST_CORNER_MM,
    )
    right = [
        _line((-end_half, end_y), (end_half, end_y)),
        _quarter((end_half, end_y), (waist[0], end_y + corner), level_first=True),
        _line((waist[0], end_y + corner), waist),
        _sweep(waist, shoulder, shoulder[0] - tip_half, tip_y - shoulder[1]),
        _quarter(shoulder, (tip_half, tip_y), level_first=False),
        _line((tip_half, tip_y), (-tip_half, tip_y)),
    ]
    left = [_mirrored(piece) for piece in reversed(right[1:-1])]
    outline = Outline((*right, *left), tip_y, end_y, 2 * tip_half, 2 * end_half)
    rim, where = _least_rim(outline, board)
    faults.unless(
        rim >= p.printer.min_wall_mm,
        "rim_narrow",
        board=board,
        rim=rim,
        x_mm=where[0],
        y_mm=where[1],
    )
    return outline


def _leg_mm(config: Input, notch: Box) -> float:
    """Least plate beside the notch: a groove for an interface takes some of it."""
    if not is_flex(config.parameters):
        return LEAST_LEG_MM
    groove_mm = foot_half_mm(config, notch.x_max_mm) - notch.x_max_mm
    return max(LEAST_LEG_MM, groove_mm + config.parameters.printer.min_wall_mm)


def _line(a: Point, b: Point) -> Cubic:
    dx, dy = (b[0] - a[0]) / 3, (b[1] - a[1]) / 3
    return a, (a[0] + dx, a[1] + dy), (b[0] - dx, b[1] - dy), b


def _quarter(a: Point, b: Point, level_first: bool) -> Cubic:
    """A quarter ellipse that starts level (along x) or upright (along y)."""
    dx, dy = (b[0] - a[0]) * _ROUND, (b[1] - a[1]) * _ROUND
    if level_first:
        return a, (a[0] + dx, a[1]), (b[0], b[1] - dy), b
    return a, (a[0], a[1] + dy), (b[0] - dx, b[1]), b


def _sweep(waist: Point, shoulder: Point, ellipse_a: float, ellipse_b: float) -> Cubic:
    """From waist to shoulder, upright at both; at the shoulder with the ellipse's curvature.

    A cubic with end handle c and the other handle's point d aside has curvature 2d / (3c²)
    there; the ellipse has a / b².
    """
    length, aside = shoulder[1] - waist[1], shoulder[0] - waist[0]
    handle = ellipse_b * math.sqrt(max(2 * aside / (3 * max(ellipse_a, 1e-6)), 0))
    handle = min(max(handle, 0.1 * length), 0.5 * length)
    return (
        waist,
        (waist[0], waist[1] + 0.5 * length),
        (shoulder[0], shoulder[1] - handle),
        shoulder,
    )


def _mirrored(piece: Cubic) -> Cubic:
    a, b, c, d = ((-x, y) for x, y in reversed(piece))
    return a, b, c, d


def _least_rim(outline: Outline, board: Board) -> tuple[float, Point]:
    """Least distance from the pocket to the outline, below zero where it crosses it."""
    from shapely import Polygon, box, make_valid

    pocket = board.pocket
    high_mm = pocket.y_max_mm + board.roof_mm
    hole = box(pocket.x_min_mm, pocket.y_min_mm, pocket.x_max_mm, high_mm)
    skin = Polygon(outline.polygon())
    corners = np.array(skin.exterior.coords)
    dx = np.maximum(np.abs(corners[:, 0]) - pocket.x_max_mm, 0)
    above, below = corners[:, 1] - high_mm, pocket.y_min_mm - corners[:, 1]
    distance = np.hypot(dx, np.maximum(np.maximum(above, below), 0))
    nearest = int(distance.argmin())
    where = (float(corners[nearest, 0]), float(corners[nearest, 1]))
    if not skin.is_valid:  # it crosses itself
        return -float(hole.difference(make_valid(skin)).area / hole.length), where
    if not skin.contains(hole):
        return -float(hole.difference(skin).area / hole.length), where
    return float(skin.exterior.distance(hole)), where


WIDTH = 0.7  # of its height
MOST_MM = 4.0
LEAST_MM = 1.85
BETWEEN = 0.245  # of its height: the least wall between two strokes
DEPTH_MM = 0.5
LEAST_DEPTH_MM = 0.4


def least_letter_mm(line_mm: float) -> float:
    """The least height of a letter: one printed line stands between two strokes."""
    return max(LEAST_MM, math.ceil(100 * line_mm / BETWEEN) / 100)


def most_letter_mm(line_mm: float) -> float:
    """The greatest height of a letter, where there is room."""
    return max(MOST_MM, least_letter_mm(line_mm))


def letter_on(
    low_mm: float, high_mm: float, depth_mm: float, wall_mm: float, line_mm: float
) -> Letter:
    """A letter in the middle of a wall, as high as there is room.

    Args:
        low_mm: lower end of the room over the bed.
        high_mm: its upper end.
        depth_mm: how deep it is sunk.
        wall_mm: where the wall stands on its axis.
        line_mm: width of a printed line.
    """
    height, middle = min(high_mm - low_mm, most_letter_mm(line_mm)), (low_mm + high_mm) / 2
    half = WIDTH * height / 2
    box = Box(-half, half, middle - height / 2, middle + height / 2)
    return Letter(box, wall_mm, depth_mm)
