"""Letters and values as cutters: straight strokes, because fonts differ from machine to machine."""

import numpy as np
from build123d import Face, Solid, Vector, Wire

from lumitip_fab.design import Box, Letter, Point
from lumitip_fab.design.frames import Matrix
from lumitip_fab.parts.shapes import box_solid, placed
from lumitip_fab.text import table_of

BEYOND_MM = 0.5  # how far the cutter stands out of the wall
_TABLE = "parts/letters.toml"


def letter_cutter(finger: str, letter: Letter, to_sensor: Matrix) -> Solid:
    """Cutter that engraves the first letter of a finger's name into a wall, in the sensor frame.

    Args:
        finger: `"emitter"` or `"receiver"`.
        letter: place and size, in the frame in which the part is printed.
        to_sensor: from that frame.
    """
    outer, *inner = (_ring(corners, letter) for corners in table_of(_TABLE)[finger[0].upper()])
    cutter = Solid.extrude(Face(outer, inner), Vector(0, letter.depth_mm + BEYOND_MM, 0))
    return placed(cutter, np.asarray(to_sensor, dtype=np.float64))


def letter_rings(finger: str, box: Box) -> list[list[Point]]:
    """Outline of the first letter of a finger's name, and of what it leaves out: it reads right
    along x and y, from the left of the box.

    Args:
        finger: `"emitter"` or `"receiver"`, in any case.
        box: place, and height of the letter.
    """
    high = box.length_mm
    return [
        [(box.x_min_mm + u * high, box.y_min_mm + v * high) for u, v in corners]
        for corners in table_of(_TABLE)[finger[0].upper()]
    ]


def _ring(corners: list[Point], letter: Letter) -> Wire:
    box, bottom = letter.box, letter.wall_mm - letter.depth_mm
    points = [
        (box.x_max_mm - u * box.length_mm, bottom, box.y_min_mm + v * box.length_mm)
        for u, v in corners
    ]
    return Wire.make_polygon(points, close=True)


STROKE = 0.17  # of the height
WIDTH, PITCH = 0.6, 0.85


def value_cutters(text: str, label: Box, face_mm: float, depth_mm: float) -> list[Solid]:
    """Cutters that engrave a value into a face that looks up, from the left.

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
        for stroke in table_of(_TABLE)["strokes"][character]:
            x_min, x_max, y_min, y_max = _place(stroke)
            box = Box(
                left + x_min * high,
                left + x_max * high,
                label.y_min_mm + y_min * high,
                label.y_min_mm + y_max * high,
            )
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
