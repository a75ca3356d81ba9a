"""Dimensions on a drawing sheet: rows of dimension lines that keep apart, with names."""

from collections.abc import Sequence
from operator import itemgetter
from xml.sax.saxutils import escape

import numpy as np

from lumitip_fab.design import Point
from lumitip_fab.scenes.drawing import Points, Sheet

Span = tuple[str, Point, Point]
"""Name of a dimension, and the two points on the page between which it is measured."""
WORDS_MM = 4.0
LETTER_MM = 0.56 * WORDS_MM  # mean width of a letter
STEP_MM = 6.5  # from row to row
_ARROW_MM, _BEYOND_MM, _GAP_MM = 2.2, 1.2, 0.8
_INK, _NAMES = "#1a1a1a", "#1f4e79"


def dimension_rows(
    sheet: Sheet, spans: Sequence[Span], first_mm: float, outward: int, upright: bool = False
) -> None:
    """Draw dimensions in rows away from a view, the shortest nearest to it.

    Args:
        sheet: the page.
        spans: what to draw; points in mm on the page.
        first_mm: y of the first row; x of the first column of upright ones.
        outward: 1 or -1: the side on which the next row lies.
        upright: whether they are measured up the page.
    """
    axis = 1 if upright else 0
    ordered = sorted(spans, key=lambda span: abs(span[1][axis] - span[2][axis]))
    rows = [first_mm + outward * STEP_MM * row for row in range(len(ordered))]
    crossing = [
        sorted(end[axis] for _, *ends in ordered[row + 1 :] for end in ends)
        for row in range(len(ordered))
    ]
    names = [
        _draw(sheet, span, row, outward, upright, lines)
        for span, row, lines in zip(ordered, rows, crossing, strict=True)
    ]
    for name, place, anchor in filter(itemgetter(0), names):  # over the lines of all
        write(sheet, place, name, anchor, upright)


def _draw(
    sheet: Sheet, span: Span, row_mm: float, outward: int, upright: bool, crossing: list[float]
) -> tuple[str, Point, str]:
    """Draw the lines of a dimension; returns its name with place and anchor.

    Beside it, the name begins beyond lines of longer dimensions that would cross it, which are
    sorted, and the dimension's line is drawn on to it.
    """
    axis = 1 if upright else 0

    def point(along: float, across: float) -> Point:
        return (across, along) if upright else (along, across)

    name, *ends = span
    for end in ends:
        feature = point(end[axis], end[1 - axis] + outward * _GAP_MM)
        sheet.lines(
            [np.array([feature, point(end[axis], row_mm + outward * _BEYOND_MM)])], "leader"
        )
    low, high = sorted(end[axis] for end in ends)
    inside = high - low >= 3 * _ARROW_MM
    reach = 0.0 if inside else 2 * _ARROW_MM
    for along, turn in ((low, 1.0), (high, -1.0)):
        foot = along + (turn if inside else -turn) * _ARROW_MM
        arrow = [point(along, row_mm), point(foot, row_mm + 0.45), point(foot, row_mm - 0.45)]
        sheet.area([np.array(arrow)], "part", _INK)
    wide, line_end = LETTER_MM * len(name), high + reach
    if wide + 2 * _GAP_MM <= high - low:
        place, anchor, lift = (low + high) / 2, "middle", 1.3
    else:
        for across in crossing:
            if line_end < across < line_end + 2 * _GAP_MM + wide:
                line_end = across + _GAP_MM
        place, anchor, lift = line_end + _GAP_MM, "start", -1.1
    sheet.lines([np.array([point(low - reach, row_mm), point(line_end, row_mm)])], "leader")
    return name, point(place, row_mm - lift if upright else row_mm + lift), anchor


def write(sheet: Sheet, at: Point, text: str, anchor: str = "start", upright: bool = False) -> None:
    """A name on the page, anchored at its `"start"` or `"middle"`; an upright one reads upwards."""
    x, y = at
    halo = 'stroke="#fff" stroke-width="1.2" paint-order="stroke"'
    turn = f' transform="rotate(-90 {x:.2f} {-y:.2f})"' if upright else ""
    sheet.drawn.append(
        f'<text font-size="{WORDS_MM}" fill="{_NAMES}" {halo} x="{x:.2f}" y="{-y:.2f}" '
        f'text-anchor="{anchor}"{turn}>{escape(text)}</text>'
    )
    wide = LETTER_MM * len(text)
    start = 0.0 if anchor == "start" else -wide / 2
    for along in (start, start + wide):
        sheet.cover(x if upright else x + along, y + along if upright else y)


def pointers(sheet: Sheet, labels: Sequence[tuple[str, Point]], x_mm: float, top_mm: float) -> None:
    """A column of names with a line from each to its feature.

    Args:
        sheet: the page.
        labels: each name, and the place of its feature.
        x_mm: where the names begin, to the right of all features.
        top_mm: greatest height of a name.
    """
    next_mm = top_mm
    for name, (x, y) in sorted(labels, key=lambda label: -label[1][1]):
        height = min(y, next_mm)
        next_mm = height - 0.8 * STEP_MM
        sheet.lines([np.array([(x, y), (x_mm - 5.0, height), (x_mm - 1.0, height)])], "leader")
        sheet.dot(x, y)
        write(sheet, (x_mm, height - 1.1), name)


def line(*points: Point) -> Points:
    """An open line."""
    return np.array(points)


def rectangle(x: tuple[float, float], y: tuple[float, float]) -> Points:
    """A closed line round a rectangle."""
    return np.array([(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1]), (x[0], y[0])])


def circle(centre: Point, radius_mm: float) -> Points:
    """A closed line round a circle, with chords."""
    angles = np.linspace(0.0, 2 * np.pi, 73)
    return np.array(centre) + radius_mm * np.stack([np.cos(angles), np.sin(angles)], axis=1)
