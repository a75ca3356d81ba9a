"""Courtyards as KiCad's file draws them: as much room round each part as its neighbours leave.

Placement works with half the gap between parts. Drawn are the usual widths, less where a neighbour
is nearer; parts with the same footprint have the same courtyard, as in the library.
"""

import dataclasses

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.boards.model import PlacedComponent, Placement
from lumitip_fab.boards.placed import placed_box
from lumitip_fab.design import Box, Footprint

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
    inner = {shape.name: land(shape) for shape in (part.footprint for part in parts)}
    least: dict[str, float] = {}
    for part, around in zip(parts, _around_mm(parts, inner).tolist(), strict=True):
        name = part.footprint.name
        least[name] = min(around, least.get(name, around))
    drawn = tuple(
        part
        if part.kind == "fiducial"
        else dataclasses.replace(
            part, courtyard=inner[name].grown(least[name]), shroud_yard=_shroud_yard(part)
        )
        for part in parts
        for name in (part.footprint.name,)
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
        placed_box(p, p.courtyard if p.kind == "fiducial" else inner[p.footprint.name])
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
