"""Compiled shadows of the second optical model: which stored rays a specimen takes."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from second_optics import Floats, Integers, kernel

Singles = NDArray[np.float32]


class Pairs(NamedTuple):
    """Pairs of an LED and a detector near it; arrays of shape `(pairs,)`."""

    cell: Integers
    """Of the detector."""
    detector: Integers
    """Number of its displacement from the LED."""
    x: Floats
    """Place of the LED (mm)."""
    y: Floats


class Shape(NamedTuple):
    """A specimen in the gap."""

    borders: Floats
    """Cosine, sine and offset (mm) of each line, shape `(n, 3)`."""
    cable: bool
    middle: float
    """Height above the receiver (mm)."""
    size: float
    """Thickness or diameter (mm)."""


@kernel
def blocked(of: Shape, x: float, y: float, slant_x: float, slant_y: float) -> bool:
    """Whether a specimen takes a ray: x, y at the receiver, and its slopes.

    A cable is a cylinder. A sheet is a slab with an upright cut.
    """
    if of.cable:
        cos, sin, offset = of.borders[0, 0], of.borders[0, 1], of.borders[0, 2]
        slant = slant_y * cos - slant_x * sin
        left = y * cos - x * sin - offset + slant * of.middle
        return bool(abs(left) < of.size / 2.0 * math.sqrt(1.0 + slant * slant))
    # Heights between both faces at which the ray is within all half-planes.
    begin, end = of.middle - of.size / 2.0, of.middle + of.size / 2.0
    for border in range(len(of.borders)):
        cos, sin, offset = of.borders[border, 0], of.borders[border, 1], of.borders[border, 2]
        slant = slant_y * cos - slant_x * sin
        left = y * cos - x * sin - offset
        if abs(slant) < 1e-9:
            if left >= 0.0:
                return False
        elif slant > 0.0:
            end = min(end, -left / slant)
        else:
            begin = max(begin, -left / slant)
    return begin < end


@kernel
def shade(
    pairs: Pairs,
    begin: Integers,
    weight: Singles,
    passes: Singles,
    of: Shape,
    clear: float,
    found: Floats,
) -> None:
    """Add the light that passes a specimen to each cell.

    Args:
        pairs: LEDs and detectors.
        begin, weight, passes: see `second_light.Rays`.
        of: the specimen.
        clear: share of light that passes straight.
        found: light of each cell, changed in place.
    """
    for pair in range(pairs.cell.size):
        px, py, light = pairs.x[pair], pairs.y[pair], 0.0
        kind = pairs.detector[pair]
        for ray in range(begin[kind], begin[kind + 1]):
            left = weight[ray]
            for _ in range(_times_blocked(passes, ray, 0, of, px, py)):
                left *= clear
            light += left
        found[pairs.cell[pair]] += light


@kernel
def _times_blocked(passes: Singles, ray: int, first: int, of: Shape, px: float, py: float) -> int:
    """How often a ray is blocked where it passes the specimen's height.

    Args:
        passes: x, y and both slants of each pass of a ray, ended by NaN.
        ray: its row.
        first: column of its first pass.
        of: the specimen.
        px, py: what is added to x and y.
    """
    times = 0
    for at in range(first, passes.shape[1], 4):
        x = passes[ray, at]
        if math.isnan(x):
            break
        y, slant_x, slant_y = passes[ray, at + 1], passes[ray, at + 2], passes[ray, at + 3]
        if blocked(of, x + px, y + py, slant_x, slant_y):
            times += 1
    return times


@kernel
def cover(
    pairs: Pairs,
    begin: Integers,
    weight: Singles,
    places: Singles,
    of: Shape,
    share: float,
    found: Floats,
) -> None:
    """Add light that comes from the specimen to each cell.

    Args:
        pairs: LEDs and detectors.
        begin, weight, places: see `second_light.Rays`.
        of: the specimen.
        share: of the light that the specimen sends on.
        found: light of each cell, changed in place.
    """
    for pair in range(pairs.cell.size):
        px, py, light = pairs.x[pair], pairs.y[pair], 0.0
        kind = pairs.detector[pair]
        for ray in range(begin[kind], begin[kind + 1]):
            if not blocked(of, places[ray, 0] + px, places[ray, 1] + py, 0.0, 0.0):
                continue
            if not _times_blocked(places, ray, 2, of, px, py):
                light += share * weight[ray]
        found[pairs.cell[pair]] += light
