"""Strain relief: two unplated holes beside each row of wire pads, for a thread round the cable.

The thread runs over the cable from one hole to the other. The holes are between the row and the
board's edge where there is room, so that they hold the insulation; else at the ends of the row,
else beside it.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.design import Board, Box, Component, Finger, Point, Tie

HOLE_MM = 1.6
"""For a waxed thread, or a bare wire, that passes twice."""
GAP_MM = 0.35
"""Hole to pads and bodies: more than `Rules.hole_gap_mm` of any design."""
OPEN_MM = GAP_MM + HOLE_MM + 0.01
"""Plate open beyond the pads of a finger's row, so that holes at its ends have room."""
WEB_MM = 1.0
"""Board between a hole and the edge, or another hole: as thick as it is wide."""
NEAR_EDGE_MM = 6.0
"""Row to the edge, at most, for holes between the two."""
BEYOND_MM = 3.0
"""A hole from the place nearest to its row, at most."""
STEP_MM = 0.25
APART_MM = tuple(5.0 - STEP_MM * i for i in range(10))
"""Distances between the holes of a pair beside a row, the best first: a cable of nine wires is some
4 mm thick."""
SHIFTS_MM = tuple(sign * STEP_MM * i for i in range(21) for sign in ((1, -1) if i else (1,)))
_FIDUCIAL_MM = 1.0  # clear ring round a mark for cameras

Pair = tuple[Point, Point]


@dataclass(frozen=True)
class _Room:
    """Where the middle of a hole may be."""

    box: Box
    corner_mm: float
    taken: tuple[Box, ...]
    """Pads and bodies."""
    holes: tuple[tuple[Point, float], ...]
    """Other holes, with their diameters."""

    def has(self, at: Point) -> bool:
        """Whether a hole has room here."""
        inner = self.box.grown(-self.corner_mm)
        reach = HOLE_MM / 2
        least = GAP_MM + reach - 1e-9
        return (
            _apart_mm(at, inner) <= self.corner_mm - WEB_MM - reach
            and all(_apart_mm(at, box) >= least for box in self.taken if _near(at, box, least))
            and all(
                math.dist(at, other) >= WEB_MM + reach + diameter_mm / 2 - 1e-9
                for other, diameter_mm in self.holes
            )
        )

    def pair(self, row: "_Row") -> Pair | None:
        """The best places for a row's two holes; none without room."""
        return next((pair for pair in _pairs(row, self.box) if all(map(self.has, pair))), None)


@dataclass(frozen=True)
class _Row:
    """A row of wire pads along x."""

    x_mm: float
    y_mm: float
    width_mm: float
    """Over its pads."""
    pad_mm: float

    @classmethod
    def of(cls, row: Component) -> "_Row":
        """The row of a part that is not turned."""
        first, last = row.footprint.pads[0], row.footprint.pads[-1]
        width_mm = last.x_mm - first.x_mm + first.width_mm
        return cls(row.x_mm, row.y_mm, width_mm, first.width_mm)


def finger_ties(finger: Finger, board: Board) -> tuple[Tie, ...]:
    """Holes beside a finger's wire pads, where the plate behind them and the film before them are
    open; none where these leave no room, or where the board is flexible and has a stiffener there.
    """
    wires, reach = finger.connector, HOLE_MM / 2
    (left, y), (right, _) = wires.pads[0], wires.pads[-1]
    row = _Row((left + right) / 2, y, right - left + wires.pad_mm, wires.pad_mm)
    pads = Box(left, right, y, y).grown(wires.pad_mm / 2)
    taken = (pads, *(part.box for part in finger.parts))
    room = _Room(
        board.box, WEB_MM + reach, taken, tuple((at, board.hole_mm) for at in finger.holes)
    )
    pair = None if board.flexible else room.pair(row)
    openings = finger.notch.grown(-reach), finger.window.grown(-reach)
    if pair is None or any(_apart_mm(at, box) > 0 for box in openings for at in pair):
        return ()
    return (Tie("J1", pair, HOLE_MM, WEB_MM),)


def derive_ties(
    components: Sequence[Component],
    box: Box,
    corner_mm: float,
    screws: Sequence[tuple[Point, float]],
    field: str,
    faults: Diagnostics,
) -> tuple[Tie, ...]:
    """Holes beside every row of wire pads that a cable ends at.

    Args:
        components: all parts of the board in their places.
        box: the board's outline.
        corner_mm: radius of its corners.
        screws: its other unplated holes, with their diameters.
        field: parameter to name where a row has no room.
        faults: where rows without room are refused.
    """
    taken = tuple(shape for part in components for shape in boxes_of(part))
    holes, ties = tuple(screws), list[Tie]()
    for row in (part for part in components if part.kind == "wires" and part.pins):
        # The corners of the rim are rounder by what a hole keeps to the edge.
        room = _Room(box, max(corner_mm, WEB_MM + HOLE_MM / 2), taken, holes)
        pair = room.pair(_Row.of(row))
        if pair is None:
            faults.add(
                "tie_no_room", field=field, hole_mm=HOLE_MM, row=row, web_mm=WEB_MM, gap_mm=GAP_MM
            )
            continue
        ties.append(Tie(row.ref, pair, HOLE_MM, WEB_MM))
        holes += tuple((at, HOLE_MM) for at in pair)
    return tuple(ties)


def _pairs(row: _Row, box: Box) -> Iterator[Pair]:
    """Places for a row's two holes, the best first."""
    half = row.pad_mm / 2
    left, right = row.x_mm - row.width_mm / 2, row.x_mm + row.width_mm / 2
    out = -1 if row.y_mm - box.y_min_mm < box.y_max_mm - row.y_mm else 1
    edge = box.y_min_mm if out < 0 else box.y_max_mm
    if abs(edge - row.y_mm) - half <= NEAR_EDGE_MM:
        yield from _beside(row.x_mm, edge - out * (WEB_MM + HOLE_MM / 2), row.width_mm)
    reach = GAP_MM + HOLE_MM / 2
    steps = [STEP_MM * i for i in range(round(BEYOND_MM / STEP_MM) + 1)]
    for total in sorted(a + b for a in steps for b in steps):
        for more in (step for step in steps if 0 <= total - step <= BEYOND_MM):
            yield (left - reach - more, row.y_mm), (right + reach + total - more, row.y_mm)
    for more in steps:
        for side in (out, -out):
            y = row.y_mm + side * (half + reach + more)
            yield from _beside(row.x_mm, y, row.width_mm)


def _beside(x_mm: float, y_mm: float, width_mm: float) -> Iterator[Pair]:
    """Pairs along a row, over it: wide apart and in its middle first."""
    for apart in APART_MM:
        for shift in SHIFTS_MM:
            if abs(shift) <= width_mm / 2:
                middle = x_mm + shift
                yield (middle - apart / 2, y_mm), (middle + apart / 2, y_mm)


def boxes_of(part: Component) -> Iterator[Box]:
    """Pads of a part, its body and its shroud on the board, as upright rectangles."""
    shape = part.footprint
    ring = _FIDUCIAL_MM if part.kind == "fiducial" else 0.0
    boxes = [
        Box(
            pad.x_mm - pad.width_mm / 2,
            pad.x_mm + pad.width_mm / 2,
            pad.y_mm - pad.height_mm / 2,
            pad.y_mm + pad.height_mm / 2,
        ).grown(ring)
        for pad in shape.pads
    ]
    boxes += [shape.body] if shape.height_mm else []
    boxes += [shape.shroud.box] if shape.shroud else []
    mirror = -1.0 if part.side == "back" else 1.0
    turn = math.radians(part.angle_deg)
    c, s = math.cos(turn), math.sin(turn)
    for box in boxes:
        places = [
            (part.x_mm + mirror * x * c - y * s, part.y_mm + mirror * x * s + y * c)
            for x in (box.x_min_mm, box.x_max_mm)
            for y in (box.y_min_mm, box.y_max_mm)
        ]
        xs, ys = zip(*places, strict=True)
        yield Box(min(xs), max(xs), min(ys), max(ys))


def _near(at: Point, box: Box, mm: float) -> bool:
    """Whether a point is within a rectangle grown by some distance, to its square corners."""
    return (
        box.x_min_mm - mm < at[0] < box.x_max_mm + mm
        and box.y_min_mm - mm < at[1] < box.y_max_mm + mm
    )


def _apart_mm(at: Point, box: Box) -> float:
    """Distance of a point to a rectangle; 0 inside."""
    x = max(box.x_min_mm - at[0], at[0] - box.x_max_mm, 0.0)
    y = max(box.y_min_mm - at[1], at[1] - box.y_max_mm, 0.0)
    return math.hypot(x, y)
