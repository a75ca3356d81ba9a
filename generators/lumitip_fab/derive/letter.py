"""Where the letter is sunk that tells one finger's printed parts from the other's."""

import math

from lumitip_fab.design import Box, Letter

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
