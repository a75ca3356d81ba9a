"""The letters E and R as cutters: straight strokes, because fonts differ from machine to machine.

┌─────┐  1        ┌────╮    1
├──┐              ├────╯
└─────┘  0        │   ╲     0
0    0.7          0    0.7
"""

import numpy as np
from build123d import Face, Solid, Vector, Wire

from lumitip_fab.design import Letter, Point
from lumitip_fab.frames import Matrix
from lumitip_fab.mechanical.shapes import placed

BEYOND_MM = 0.5  # how far the cutter stands out of the wall
_E = (
    (0.0, 0.0), (0.7, 0.0), (0.7, 0.17), (0.17, 0.17), (0.17, 0.415), (0.6, 0.415),
    (0.6, 0.585), (0.17, 0.585), (0.17, 0.83), (0.7, 0.83), (0.7, 1.0), (0.0, 1.0),
)  # fmt: skip
_R = (
    (0.0, 0.0), (0.17, 0.0), (0.17, 0.415), (0.42, 0.415), (0.53, 0.0), (0.7, 0.0),
    (0.58, 0.44), (0.7, 0.56), (0.7, 0.88), (0.6, 1.0), (0.0, 1.0),
)  # fmt: skip
_R_BOWL = ((0.17, 0.585), (0.53, 0.585), (0.53, 0.83), (0.17, 0.83))
_STROKES = {"E": (_E,), "R": (_R, _R_BOWL)}


def letter_cutter(finger: str, letter: Letter, to_sensor: Matrix) -> Solid:
    """What the first letter of a finger's name takes from a wall, in the sensor frame.

    Args:
        finger: `"emitter"` or `"receiver"`.
        letter: place and size, in the frame in which the part is printed.
        to_sensor: from that frame.
    """
    outer, *inner = (_ring(corners, letter) for corners in _STROKES[finger[0].upper()])
    cutter = Solid.extrude(Face(outer, inner), Vector(0, letter.depth_mm + BEYOND_MM, 0))
    return placed(cutter, np.asarray(to_sensor, dtype=np.float64))


def _ring(corners: tuple[Point, ...], letter: Letter) -> Wire:
    box, bottom = letter.box, letter.wall_mm - letter.depth_mm
    points = [
        (box.x_max_mm - u * box.length_mm, bottom, box.y_min_mm + v * box.length_mm)
        for u, v in corners
    ]
    return Wire.make_polygon(points, close=True)
