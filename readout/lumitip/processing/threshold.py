"""The threshold λ between dark and light cells, and the weight of a dark cell.

λ is the mean of the means of two clusters.

The values are sorted and cut in two at the largest step between neighbours in this order; of equal
steps the lowest counts. λ lies half-way between the means of both parts, so a value between the
step and λ is dark or light by λ alone.
"""

import numpy as np
from numpy.typing import NDArray

from lumitip.grid import Floats

FULL_LIGHT = 255.0
"""Value of a cell in full light; 0 is dark. Raw ADC codes run the other way: dark is high."""
MOST = 1e9
"""Values further from zero are of no sensor, and their sums might be of no float."""


def usable(values: Floats) -> NDArray[np.bool_]:
    """Which values count: neither NaN nor beyond `MOST`."""
    return np.asarray(np.abs(values) <= MOST)


def threshold(values: Floats) -> tuple[float, float]:
    """λ and the contrast, which is the difference of the two means, of one frame.

    Args:
        values: finite, shape `(cells,)`, at least two.
    """
    ordered = values.copy()
    ordered.sort()
    first = int((ordered[1:] - ordered[:-1]).argmax()) + 1
    low = float(np.add.reduce(ordered[:first])) / first
    high = float(np.add.reduce(ordered[first:])) / (ordered.size - first)
    return (low + high) / 2.0, high - low


def darkness(values: Floats) -> Floats:
    """The weight of dark cells in the dark centre, 255 − value: a fully dark cell weighs most.

    This is the published definition, on values (255 is full light) and never on raw codes. A value
    beyond the scale weighs as much as the end of the scale.

    Args:
        values: finite or NaN, any shape; NaN stays NaN.
    """
    weights: Floats = FULL_LIGHT - np.minimum(np.maximum(values, 0.0), FULL_LIGHT)
    return weights
