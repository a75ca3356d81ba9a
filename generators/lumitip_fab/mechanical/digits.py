"""Values as cutters: seven straight strokes for each digit, because fonts differ from machine to
machine.

     ─a─
    f   b
     ─g─
    e   c
     ─d─

A one is a stroke in the middle, and a plus is g with a short one.
"""

from build123d import Solid

from lumitip_fab.design import Box
from lumitip_fab.mechanical.shapes import box_solid

STROKE = 0.17  # of the height
WIDTH, PITCH = 0.6, 0.85
BEYOND_MM = 0.5
_STROKES = {
    "0": "abcdef", "1": "!", "2": "abged", "3": "abgcd", "4": "fgbc", "5": "afgcd",
    "6": "afgecd", "7": "abc", "8": "abcdefg", "9": "abcdfg", "-": "g", "+": "g|",
}  # fmt: skip


def value_cutters(text: str, label: Box, face_mm: float, depth_mm: float) -> list[Solid]:
    """What a value takes from a face that looks up, set from the left.

    Args:
        text: digits and a sign.
        label: the room for it; its height is that of the digits.
        face_mm: height of the face.
        depth_mm: how deep it is sunk.
    """
    high = label.length_mm
    solids = []
    for place, character in enumerate(text):
        left = label.x_min_mm + place * PITCH * high
        for stroke in _STROKES[character]:
            x_min, x_max, y_min, y_max = _place(stroke)
            box = Box(
                left + x_min * high, left + x_max * high,
                label.y_min_mm + y_min * high, label.y_min_mm + y_max * high,
            )  # fmt: skip
            solids.append(box_solid(box, face_mm - depth_mm, face_mm + BEYOND_MM))
    return solids


def _place(stroke: str) -> tuple[float, float, float, float]:
    """A stroke in parts of the height: from and to along x, from and to along y."""
    middle = (1 - STROKE) / 2
    level = {"a": 1 - STROKE, "g": middle, "d": 0.0}
    if stroke in level:
        return 0.0, WIDTH, level[stroke], level[stroke] + STROKE
    if stroke in "|!":
        ends = (middle - 0.2, middle + STROKE + 0.2) if stroke == "|" else (0.0, 1.0)
        return (WIDTH - STROKE) / 2, (WIDTH + STROKE) / 2, *ends
    left = 0.0 if stroke in "fe" else WIDTH - STROKE
    low = middle if stroke in "fb" else 0.0
    return left, left + STROKE, low, low + middle + STROKE
