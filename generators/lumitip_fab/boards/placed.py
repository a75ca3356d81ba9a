"""Pads and courtyards of components in their places on a board."""

import math
from dataclasses import dataclass

from shapely import Point as Dot
from shapely import Polygon, affinity, box

from lumitip_fab.boards.model import SIDES, PlacedComponent, Placement
from lumitip_fab.design import Box, Component, Pad, Point, Side


@dataclass(frozen=True)
class PlacedPad:
    """A pad on the board, in the finger's sensor frame."""

    component: Component
    pad: Pad
    net: str
    """Empty where it is connected to nothing."""
    x_mm: float
    y_mm: float
    sides: tuple[Side, ...]
    """Both for a plated hole."""
    area: Polygon


def placed(component: Component, x_mm: float, y_mm: float) -> Point:
    """A point of a footprint's frame on the board; a part on the back is mirrored in x first."""
    x = -x_mm if component.side == "back" else x_mm
    turn = math.radians(component.angle_deg)
    c, s = math.cos(turn), math.sin(turn)
    return component.x_mm + x * c - y_mm * s, component.y_mm + x * s + y_mm * c


def pad_at(component: Component, number: str) -> Point:
    """Centre of a pad on the board."""
    pad = next(pad for pad in component.footprint.pads if pad.number == number)
    return placed(component, pad.x_mm, pad.y_mm)


def courtyard(component: PlacedComponent) -> Box:
    """The courtyard of a part in its place."""
    return placed_box(component, component.courtyard)


def placed_box(component: Component, shape: Box) -> Box:
    """A rectangle of a footprint's frame on the board, or the upright one round it."""
    corners = [
        placed(component, x, y)
        for x in (shape.x_min_mm, shape.x_max_mm)
        for y in (shape.y_min_mm, shape.y_max_mm)
    ]
    xs, ys = zip(*corners, strict=True)
    return Box(min(xs), max(xs), min(ys), max(ys))


def placed_pads(component: Component) -> tuple[PlacedPad, ...]:
    """All pads of a part, with their copper as polygons."""
    nets = dict(component.nets)
    return tuple(
        PlacedPad(
            component,
            pad,
            nets.get(pad.number, ""),
            *(at := placed(component, pad.x_mm, pad.y_mm)),
            SIDES if pad.drill_mm else (component.side,),
            _area(pad, component.angle_deg, at),
        )
        for pad in component.footprint.pads
    )


BYPASS_MM = 1.0  # from the edge of a capacitor's ground pad to the middle of a via, at most


def bypass_pads(placement: Placement) -> tuple[PlacedPad, ...]:
    """Ground pads of capacitors that are soldered on one side: each has a ground via beside it."""
    return tuple(
        pad
        for component in placement.components
        if component.ref.startswith("C")
        for pad in placed_pads(component)
        if pad.net == placement.ground and not pad.pad.drill_mm
    )


def _area(pad: Pad, angle_deg: float, at: Point) -> Polygon:
    if pad.round:
        return Dot(at).buffer(pad.width_mm / 2, quad_segs=16)
    half = pad.width_mm / 2, pad.height_mm / 2
    flat = box(at[0] - half[0], at[1] - half[1], at[0] + half[0], at[1] + half[1])
    return affinity.rotate(flat, angle_deg, origin=at)
