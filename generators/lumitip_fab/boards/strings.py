"""Which way round the LEDs of a string lie, and what sets their current."""

import dataclasses
import math
from collections.abc import Sequence

from lumitip_fab.boards.model import PlacedComponent
from lumitip_fab.boards.placed import pad_at
from lumitip_fab.design import Finger, Packages, Point, Wiring


def turn_strings(
    parts: dict[str, PlacedComponent], finger: Finger, wiring: Wiring, packages: Packages
) -> None:
    """Turn sources or resistors, and LEDs so that neighbours of a string face each other."""
    anode = "1" if packages.led.marked == "anode" else "2"
    (_turn_sources if wiring.set_ohm else _turn_resistors)(parts, wiring)
    _turn_pull_down(parts, wiring)
    for number, string in enumerate(wiring.strings, start=1):
        chain = [parts[f"D{cell + 1}"] for cell in string]
        start = pad_at(parts[f"R{number}"], "2")
        choices = (90.0, 270.0) if finger.turned else (0.0, 180.0)
        angles = string_angles(chain, start, anode, choices)
        for part, angle in zip(chain, angles, strict=True):
            parts[part.ref] = dataclasses.replace(part, angle_deg=angle)


def _turn_resistors(parts: dict[str, PlacedComponent], wiring: Wiring) -> None:
    """Turn the string resistors with their supply ends to the connector."""
    for number in range(1, len(wiring.strings) + 1):
        ref = f"R{number}"
        turns = [dataclasses.replace(parts[ref], angle_deg=angle) for angle in (90.0, 270.0)]
        parts[ref] = min(turns, key=lambda part: pad_at(part, "1")[1])


def _turn_sources(parts: dict[str, PlacedComponent], wiring: Wiring) -> None:
    """Turn the sources with IN to the connector, and their resistors so that the string begins
    between the two."""
    strings = len(wiring.strings)
    for number in range(1, strings + 1):
        at_out, at_set = f"R{number}", f"R{strings + number}"
        for ref, angle_deg in ((f"U{number}", 180.0), (at_out, 270.0), (at_set, 90.0)):
            parts[ref] = dataclasses.replace(parts[ref], angle_deg=angle_deg)


def _turn_pull_down(parts: dict[str, PlacedComponent], wiring: Wiring) -> None:
    """Turn the gate's pull-down with its gate end to the connector, if there is one."""
    if wiring.emitter_pin is not None:
        down = parts[wiring.pull_down_ref]
        parts[down.ref] = dataclasses.replace(down, angle_deg=90.0)


def string_angles(
    chain: Sequence[PlacedComponent], start: Point, anode: str, choices: Sequence[float]
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
                (round(so_far + math.dist(left, into), 6), angles_so_far)
                for left, (so_far, angles_so_far) in best.items()
            )
            reached[pad_at(turned, cathode)] = length, (*angles, angle)
        best = reached
    return min(best.values())[1]
