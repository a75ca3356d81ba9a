"""Figures of a gripper from one way to read its maker's fingertip, and what that leaves open."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lumitip_fab.catalogue.materials import Fastener
from lumitip_fab.grippers.features import NEAR_MM, PARALLEL, Features, Vector, parallel
from lumitip_fab.grippers.ways import ON_ROW_MM, SQUARE, STEP_MM, Way

CUT_MM = 2.0  # of the mount face's edges by chamfers, at most
WIDE = 1.5  # width of a fingertip in its lengths, at most; else its bolts may run across it
UPRIGHT: Vector = np.array([0.0, 0.0, 1.0])
_TAPPED_MM = {
    **{"M2": 1.6, "M2.5": 2.05, "M3": 2.5, "M4": 3.3, "M5": 4.2, "M6": 5.0, "M8": 6.8},
    **{"M10": 8.5, "M12": 10.2},
}
"""Tap drills by thread, by ISO 2306: a hole of this size may have a thread."""
_DRILL_MM = 0.05  # from a tap drill's diameter
_SLOT_DEG = (150.0, 210.0)  # of the full circle, at the ends of a slot
_LEAN_DEG = 0.05
_SPACING, _HOLE, _BOLT = "bolt_spacing_mm", "bolt_hole_mm", "bolt"
_PAD = ("pad_w_mm", "bolt_w_mm", "block_back_w_mm")
_BLOCK = ("block_width_mm", "block_corner_mm", *_PAD)
_PINS = ("pins.hole_mm", "pins.spacing_mm", "pins.depth_mm")


@dataclass(frozen=True)
class Proposed:
    """A figure as the fingertip has it."""

    value: float | str
    where: str
    """What it was read from."""


@dataclass
class Measured:
    """The figures that a fingertip shows when it is read in one way."""

    figures: dict[str, Proposed] = field(default_factory=dict)
    open: set[str] = field(default_factory=set)
    """Those that it does not show beyond doubt."""
    notes: dict[str, dict[str, Any]] = field(default_factory=dict)
    """Why, and what the user has to know: names of texts with their values."""

    def note(self, name: str, *figures: str, **values: Any) -> None:
        """Note something, and leave figures open that it makes doubtful."""
        self.notes[name] = values
        self.open |= set(figures)

    def take(self, name: str, value: float, where: str) -> None:
        """Take a length from somewhere, in mm."""
        self.figures[name] = Proposed(round(float(value), 2) + 0.0, where)


def measured(way: Way, seen: Features, fasteners: Mapping[str, Fastener]) -> Measured:
    """The figures of one way.

    Args:
        way: how the fingertip is read.
        seen: what it has, in the mount frame of that way.
        fasteners: threads with their clearance holes.
    """
    found = Measured()
    _of_bolts(found, way, seen, fasteners)
    _of_pins(found, way, seen)
    _of_block(found, way, seen)
    _of_pad(found, way, seen)
    for name in found.open & set(found.figures):
        del found.figures[name]
    if "block_width_mm" in found.open:
        found.notes.pop("aside", None)
    return found


def _of_bolts(found: Measured, way: Way, seen: Features, fasteners: Mapping[str, Fastener]) -> None:
    where, bolt = in_full(way.bolts), seen.holes[way.bolts[0]]
    hole = round(bolt.narrow_mm, 2)
    found.take(_HOLE, hole, where)
    fits = [n for n, f in fasteners.items() if f.hole_mm[0] <= hole <= f.hole_mm[1]]
    if len(fits) == 1:
        found.figures[_BOLT] = Proposed(fits[0], f"{where}, clearance hole by ISO 273")
    tapped = [n for n, drill in _TAPPED_MM.items() if abs(drill - hole) <= _DRILL_MM]
    if tapped:
        found.note("tapped", _HOLE, _BOLT, diameter=hole, thread=tapped[0])
    sizes = [piece.diameter_mm for piece in bolt.pieces]
    heads = [p for p in bolt.pieces[sizes.index(min(sizes)) :] if _wider(p.diameter_mm, sizes)]
    if heads:
        found.take("counterbore_mm", heads[0].diameter_mm, where)
        found.take("land_mm", heads[0].low_mm, f"{where}: mount face to counterbore")
    if len(way.bolts) == 2:
        found.take(_SPACING, _apart(seen, way.bolts), where)
    if len(way.bolts) > 2:
        found.note("many", _SPACING, *_BLOCK, *_PINS, count=len(way.bolts))
    slots = _slots(seen)
    if slots:
        found.note("slots", _SPACING, *_BLOCK, *_PINS, diameters=slots)


def _wider(diameter_mm: float, sizes: Sequence[float]) -> bool:
    return diameter_mm - min(sizes) >= STEP_MM


def _slots(seen: Features) -> str:
    """Diameters of two equal half-cylinders along the bolts that begin in the mount face."""
    ends = [
        round(c.diameter_mm, 2)
        for c in seen.cylinders
        if c.hollow and parallel(c.axis, UPRIGHT) and abs(c.low_mm) < CUT_MM
        if _SLOT_DEG[0] < c.turn_deg < _SLOT_DEG[1]
    ]
    return ", ".join(f"{size:g}" for size in sorted({s for s in ends if ends.count(s) > 1}))


def _of_pins(found: Measured, way: Way, seen: Features) -> None:
    """Locating pins beside the bolts, or sleeves round them."""
    bolt, where = seen.holes[way.bolts[0]], in_full(way.bolts)
    sizes = [piece.diameter_mm for piece in bolt.pieces]
    sleeves = [p for p in bolt.pieces[: sizes.index(min(sizes))] if _wider(p.diameter_mm, sizes)]
    sure = not way.beside if sleeves else bool(way.pins) or not way.beside
    if not sure or (sleeves and len(way.bolts) != 2):
        found.note("pins", *_PINS, holes=in_full(way.beside) or where, off=f"{ON_ROW_MM:g}")
    elif sleeves:
        _take_pins(found, way.bolts, sleeves[-1].diameter_mm, sleeves[-1].high_mm, seen)
    elif way.pins:
        hole = seen.holes[way.pins[0]]
        _take_pins(found, way.pins, hole.narrow_mm, hole.pieces[-1].high_mm, seen)
        if hole.through:
            found.note("pins_through", _PINS[-1], holes=in_full(way.pins))


def _take_pins(
    found: Measured, pair: Sequence[int], hole: float, deep: float, seen: Features
) -> None:
    for name, size in zip(_PINS, (hole, _apart(seen, pair), deep), strict=True):
        found.take(name, size, in_full(pair))


def _of_block(found: Measured, way: Way, seen: Features) -> None:
    right, left = (_reach(found, way, seen, 0, side) for side in (1, -1))
    where = "width of the block at the mount face"
    if abs(right - left) > ON_ROW_MM:
        where = "twice the distance from the middle of the bolts to the nearer side of the block"
        found.note("aside", right=round(right, 2), left=round(left, 2))
    found.take("block_width_mm", 2 * min(right, left), where)
    radii = {
        round(c.diameter_mm / 2, 2)
        for c in seen.cylinders
        if not c.hollow and abs(c.axis[2]) > PARALLEL and 60 < c.turn_deg < 120 and c.foot[1] > 0
    }
    if len(radii) == 1:
        found.take("block_corner_mm", radii.pop(), "round corners behind the bolts")
    wide, deep, long = (np.ptp(seen.reach(axis)) for axis in np.eye(3))
    if wide > WIDE * long or deep > long:
        found.note("across", *_BLOCK)


def _of_pad(found: Measured, way: Way, seen: Features) -> None:
    """Figures behind the pad: the board is taken to stand there."""
    if way.pad is None:
        found.note("no_pad", *_PAD)
        return
    pad = seen.faces[way.pad]
    if abs(pad.normal[0]) > SQUARE:
        found.note("row", *_BLOCK)
        return
    before = -pad.offset_mm / float(pad.normal[1])
    found.take("pad_w_mm", before, "pad to the bolts' axes")
    found.take("bolt_w_mm", before, "the board stands where the pad is")
    found.take(
        "block_back_w_mm", before + _reach(found, way, seen, 1, 1), "pad to the back of the block"
    )
    lean = -math.degrees(math.asin(pad.normal[2]))
    if abs(lean) > _LEAN_DEG:
        found.note("lean", lean=lean)


def _reach(found: Measured, way: Way, seen: Features, axis: int, side: int) -> float:
    """How far the block reaches from the origin: to the side that a chamfer or flank cuts from
    the edge of the mount face round the bolts, else to that edge. In doubt if the mount face
    reaches farther elsewhere, or if there are sides, but only farther out."""
    mount = seen.faces[way.mount]
    feet = np.array([(*seen.holes[k].foot[:2], 0.0) for k in way.bolts])
    sides = [face.offset_mm for face in seen.faces if side * face.normal[axis] > PARALLEL]
    near, whole = (
        float((side * face.corners[:, axis]).max()) for face in (mount.around(feet), mount)
    )
    beyond = [far for far in sides if far > near - NEAR_MM]
    reach = min(beyond, default=near)
    if reach > near + CUT_MM:
        reach = near
    elif whole <= reach + ON_ROW_MM:
        return reach
    found.note("pieces", ("block_width_mm", "block_back_w_mm")[axis])
    return reach


def in_full(numbers: Sequence[int]) -> str:
    """Names of holes."""
    return " and ".join(f"hole {k + 1}" for k in numbers)


def _apart(seen: Features, pair: Sequence[int]) -> float:
    a, b = (seen.holes[k].foot for k in pair)
    return float(np.linalg.norm(b - a))
