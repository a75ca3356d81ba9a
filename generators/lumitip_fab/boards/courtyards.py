"""Courtyards as KiCad's file draws them: as much room round each part as its neighbours leave.

Placement works with half the gap between parts. Drawn are the usual widths, less where a neighbour
is nearer; parts with the same footprint have the same courtyard, as in the library.
"""

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from shapely import Point as Dot
from shapely import Polygon, affinity, box

from lumitip_fab.boards.model import SIDES, PlacedComponent, Placement
from lumitip_fab.design import Box, Component, Footprint, Pad, Point, Side


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


def _area(pad: Pad, angle_deg: float, at: Point) -> Polygon:
    if pad.round:
        return Dot(at).buffer(pad.width_mm / 2, quad_segs=16)
    half = pad.width_mm / 2, pad.height_mm / 2
    flat = box(at[0] - half[0], at[1] - half[1], at[0] + half[0], at[1] + half[1])
    return affinity.rotate(flat, angle_deg, origin=at)


PART_MM = 0.25
CONTACTS_MM = 0.5
"""Round connectors; a quarter round other parts, both by IPC-7351."""
_APART_MM = 0.002  # between courtyards that would touch
_STEP_MM = 1e-4


def land(shape: Footprint) -> Box:
    """Pads and body, without the shroud of a box header."""
    boxes = [
        Box(
            pad.x_mm - pad.width_mm / 2,
            pad.x_mm + pad.width_mm / 2,
            pad.y_mm - pad.height_mm / 2,
            pad.y_mm + pad.height_mm / 2,
        )
        for pad in shape.pads
    ]
    boxes += [shape.body] if shape.height_mm else []
    return Box(
        min(box.x_min_mm for box in boxes),
        max(box.x_max_mm for box in boxes),
        min(box.y_min_mm for box in boxes),
        max(box.y_max_mm for box in boxes),
    )


def with_courtyards(board: Placement) -> Placement:
    """The board with the courtyards to draw, those of shrouds too."""
    parts = board.components
    if not parts:
        return board
    inner = {shape.library_name: land(shape) for shape in (part.footprint for part in parts)}
    least: dict[str, float] = {}
    for part, around in zip(parts, _around_mm(parts, inner).tolist(), strict=True):
        name = part.footprint.library_name
        least[name] = min(around, least.get(name, around))
    drawn = tuple(
        part
        if part.kind == "fiducial"
        else dataclasses.replace(
            part, courtyard=inner[name].grown(least[name]), shroud_yard=_shroud_yard(part)
        )
        for part in parts
        for name in (part.footprint.library_name,)
    )
    return dataclasses.replace(board, components=drawn)


def _shroud_yard(part: PlacedComponent) -> Box | None:
    shroud = part.footprint.shroud
    return shroud.box.grown(CONTACTS_MM) if shroud else None


def _around_mm(parts: tuple[PlacedComponent, ...], inner: dict[str, Box]) -> NDArray[np.float64]:
    """Room round each part: its usual width, or what its neighbours leave."""
    usual = np.array([_usual_mm(part) for part in parts])
    gaps = _gaps_mm(parts, inner) - _APART_MM
    room = np.minimum(usual[:, None], np.maximum(gaps - usual, gaps / 2)).min(axis=1)
    return np.asarray(np.floor(room / _STEP_MM) * _STEP_MM)


def _usual_mm(part: PlacedComponent) -> float:
    if part.kind == "fiducial":
        return 0.0
    return CONTACTS_MM if part.contacts and part.footprint.height_mm else PART_MM


def _gaps_mm(parts: tuple[PlacedComponent, ...], inner: dict[str, Box]) -> NDArray[np.float64]:
    """Gaps between all parts of a side; infinite between sides, and of a part to itself."""
    boxes = [
        placed_box(p, p.courtyard if p.kind == "fiducial" else inner[p.footprint.library_name])
        for p in parts
    ]
    left, right, low, high = np.array(
        [(b.x_min_mm, b.x_max_mm, b.y_min_mm, b.y_max_mm) for b in boxes]
    ).T
    beside = np.maximum(left[:, None] - right, left - right[:, None])
    above = np.maximum(low[:, None] - high, low - high[:, None])
    front = np.array([part.side == "front" for part in parts])
    gaps = np.where(front[:, None] == front, np.maximum(beside, above), np.inf)
    np.fill_diagonal(gaps, np.inf)
    return np.asarray(gaps)
