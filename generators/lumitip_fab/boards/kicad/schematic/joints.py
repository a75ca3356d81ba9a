"""Wires that end where they meet, with a dot at each joint."""

import itertools
from collections import Counter
from collections.abc import Iterable

from lumitip_fab.design import Point

Wire = tuple[Point, Point]


def jointed(wires: Iterable[Wire], pins: Iterable[Point]) -> tuple[list[Wire], list[Point]]:
    """Wires cut at each end and pin that they pass, and the places where three or more meet.

    Args:
        wires: along x or y.
        pins: places of all pins.
    """
    whole = [(_rounded(start), _rounded(end)) for start, end in wires]
    ends = [_rounded(pin) for pin in pins]
    cuts = {end for wire in whole for end in wire} | set(ends)
    pieces: dict[Wire, None] = {}
    for start, end in whole:
        passed = sorted(at for at in cuts if _between(start, at, end))
        for one, other in itertools.pairwise(passed):
            pieces[one, other] = None
    met = Counter([*(end for piece in pieces for end in piece), *ends])
    return list(pieces), [at for at, count in met.items() if count > 2]


def _between(start: Point, at: Point, end: Point) -> bool:
    """Whether a place is on a wire, its ends among it."""
    (x0, x1), (y0, y1) = (sorted((start[i], end[i])) for i in (0, 1))
    return x0 <= at[0] <= x1 and y0 <= at[1] <= y1


def _rounded(at: Point) -> Point:
    return round(at[0], 3), round(at[1], 3)
