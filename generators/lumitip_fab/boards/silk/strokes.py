"""Silkscreen as strokes: text in KiCad's font, set as KiCad sets it."""

import math
from collections.abc import Iterator
from functools import lru_cache
from importlib.resources import files
from itertools import islice

from lumitip_fab.boards.model import Placement, Stroke, Text
from lumitip_fab.boards.placed import placed
from lumitip_fab.design import Component, Point, Side

Glyph = tuple[float, tuple[tuple[Point, ...], ...]]
_GLYPHS = 0x2200 - 0x20  # from space: Latin, Greek and arrows, of the font's 65 000
# Baseline below the middle of a text, in heights, less a share of the stroke's width; measured
# in plots of KiCad 9.
_BASELINE, _LIFT = 0.510238, 0.052


def upright(angle_deg: float, side: Side) -> float:
    """An angle of a text turned by half turns until it is read from below or from the right.

    Args:
        angle_deg: counter-clockwise, seen from the front.
        side: from which the text is read.
    """
    seen = angle_deg if side == "front" else -angle_deg
    turned = seen % 180.0
    turned = turned - 180.0 if turned > 90.0 else turned
    return turned if side == "front" else -turned + 0.0


def angle_on_board_deg(component: Component, text: Text) -> float:
    """Angle of a footprint's text on the board, counter-clockwise seen from the front."""
    turn = text.angle_deg if component.side == "front" else -text.angle_deg
    return upright(component.angle_deg + turn, component.side)


def text_strokes(
    words: str, text: Text, at: Point, angle_deg: float, side: Side
) -> Iterator[Stroke]:
    """The strokes of a centred line of text, in the sensor frame.

    Args:
        words: what it says.
        text: its size.
        at: its middle.
        angle_deg: counter-clockwise, seen from the front.
        side: of the board; on the back it is mirrored, to be read from there.
    """
    glyphs = _font()
    letters = [glyphs.get(letter, glyphs["?"]) for letter in words]
    turn, sign = math.radians(angle_deg), 1 if side == "front" else -1
    cos, sin = math.cos(turn), math.sin(turn)
    left = -sum(width for width, _ in letters) / 2
    for width, strokes in letters:
        for stroke in strokes:
            points = []
            for px, py in stroke:
                x = sign * (left + px) * text.height_mm
                y = -(py + _BASELINE) * text.height_mm + _LIFT * text.width_mm
                points.append((at[0] + x * cos - y * sin, at[1] + x * sin + y * cos))
            if points:
                yield Stroke(tuple(points), text.width_mm)
        left += width


@lru_cache
def _font() -> dict[str, Glyph]:
    """Width and strokes of each letter, in heights: x to the right, y down, baseline at 0."""
    from gerbonara import data
    from gerbonara.newstroke import Newstroke

    source = files(data).joinpath("newstroke_font.cpp").read_bytes()
    return dict(islice(Newstroke.load_glyphs(source), _GLYPHS))


def silkscreen(board: Placement) -> Iterator[tuple[Side, Stroke]]:
    """Every stroke with its side, in the sensor frame: footprints, references, lines, texts."""
    for part in board.components:
        for stroke in part.outline:
            points = tuple(placed(part, *point) for point in stroke.points)
            yield part.side, Stroke(points, stroke.width_mm)
        if (text := part.ref_text) is not None:
            at, angle = placed(part, text.x_mm, text.y_mm), angle_on_board_deg(part, text)
            for stroke in text_strokes(part.ref, text, at, angle, part.side):
                yield part.side, stroke
    yield from board.silk
    for side, text in board.texts:
        at, angle = (text.x_mm, text.y_mm), upright(text.angle_deg, side)
        for stroke in text_strokes(text.text, text, at, angle, side):
            yield side, stroke
