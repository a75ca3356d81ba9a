"""Where the letter is sunk that tells one finger's printed parts from the other's."""

from lumitip_fab.design import Box, Letter

WIDTH = 0.7  # of its height
MOST_MM = 4.0
LEAST_MM = 1.85  # below that a printed line is wider than what stands between two strokes
DEPTH_MM = 0.5
LEAST_DEPTH_MM = 0.4


def letter_on(low_mm: float, high_mm: float, depth_mm: float, wall_mm: float) -> Letter:
    """A letter in the middle of a wall, as high as there is room.

    Args:
        low_mm: lower end of the room over the bed.
        high_mm: its upper end.
        depth_mm: how deep it is sunk.
        wall_mm: where the wall stands on its axis.
    """
    height, middle = min(high_mm - low_mm, MOST_MM), (low_mm + high_mm) / 2
    half = WIDTH * height / 2
    box = Box(-half, half, middle - height / 2, middle + height / 2)
    return Letter(box, wall_mm, depth_mm)
