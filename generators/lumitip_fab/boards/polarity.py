"""Which way round each LED of a string lies, so that the links between neighbours are short."""

import dataclasses
import math
from collections.abc import Sequence

from lumitip_fab.boards.geometry import pad_at
from lumitip_fab.boards.model import Component
from lumitip_fab.design import Point


def string_angles(
    chain: Sequence[Component], start: Point, anode: str, choices: Sequence[float]
) -> tuple[float, ...]:
    """The angles with the shortest links in all, found place by place along the string.

    Args:
        chain: LEDs in the order in which the current passes them.
        start: pad that the first LED is linked to.
        anode: number of the pad that the current enters by.
        choices: angles that each LED may have (degrees).
    """
    cathode = "1" if anode == "2" else "2"
    best: dict[Point, tuple[float, tuple[float, ...]]] = {start: (0.0, ())}
    for led in chain:
        reached: dict[Point, tuple[float, tuple[float, ...]]] = {}
        for angle in choices:
            turned = dataclasses.replace(led, angle_deg=angle)
            into = pad_at(turned, anode)
            length, angles = min(
                (round(so_far + math.dist(left, into), 6), told)
                for left, (so_far, told) in best.items()
            )
            reached[pad_at(turned, cathode)] = length, (*angles, angle)
        best = reached
    return min(best.values())[1]
