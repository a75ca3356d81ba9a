"""Sizes of texts on a sheet, from above, and steps of its grid."""

import math

GRID_MM = 1.27
_LETTER = 0.95
"""Width of a letter by its height, with the gap to the next: the mean of capitals and digits."""


def text_mm(words: str, height_mm: float = GRID_MM) -> float:
    """Width of a text."""
    return len(words) * _LETTER * height_mm


def up_to_grid(length_mm: float) -> float:
    """The next length of the grid."""
    return math.ceil(round(length_mm / GRID_MM, 6)) * GRID_MM
