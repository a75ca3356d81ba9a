"""Where no track and no via can be, and where the tracks of a net end."""

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from lumitip_fab.boards.model import SIDES, Placement, fiducial_margin_mm
from lumitip_fab.boards.placed import PlacedPad
from lumitip_fab.boards.route.kernels import BLOCKED, Bytes, Ints
from lumitip_fab.boards.route.rules import MARGIN_MM, PAD_TO_VIA_MM, Grid, Rules, round_via_mm
from lumitip_fab.design import Box
from lumitip_fab.errors import BuildError

Reals = NDArray[np.float64]


@dataclass(frozen=True)
class Obstacles:
    """The map of what is fixed."""

    grid: Grid
    rules: Rules
    number: dict[str, int]
    """Number of each net, from 1."""

    def owners(self, placement: Placement, pads: tuple[PlacedPad, ...]) -> NDArray[np.int16]:
        """Who may be where: `(classes, 3, H, W)`, see `kernels.search`."""
        grid, rules = self.grid, self.rules
        owner = np.zeros((len(rules.classes), 3, grid.height, grid.width), dtype=np.int16)
        for c, kind in enumerate(rules.classes):
            for p, size in ((0, kind.track_mm), (1, kind.track_mm), (2, round_via_mm(kind))):
                self._edge(placement, owner[c, p], size / 2)
                self._keep_outs(placement, owner[c, p], size / 2)
            self._ground_only(placement, c, owner[c])
            for pad in pads:
                self._pad(pad, c, owner[c])
            if placement.flexible:
                bend = placement.flexible.bend.grown(kind.via_mm / 2 + MARGIN_MM)
                self._bend(bend, owner[c, 2])
        return owner

    def _bend(self, bend: Box, owner: NDArray[np.int16]) -> None:
        everywhere = slice(0, self.grid.height), slice(0, self.grid.width)
        x, y = self.grid.offsets(everywhere, *bend.centre_mm)
        owner[(np.abs(x) < bend.width_mm / 2) & (np.abs(y) < bend.length_mm / 2)] = BLOCKED

    def _edge(self, placement: Placement, owner: NDArray[np.int16], half_mm: float) -> None:
        keep = placement.edge_clearance_mm + half_mm + MARGIN_MM
        from_hole = placement.hole_clearance_mm + half_mm + MARGIN_MM
        everywhere = slice(0, self.grid.height), slice(0, self.grid.width)
        x, y = self.grid.offsets(everywhere, *placement.outline.centre_mm)
        half = placement.outline.width_mm / 2, placement.outline.length_mm / 2
        corner = placement.corner_mm
        dx, dy = np.abs(x) - half[0] + corner, np.abs(y) - half[1] + corner
        outside = np.hypot(np.maximum(dx, 0), np.maximum(dy, 0))
        inside = np.minimum(np.maximum(dx, dy), 0)
        owner[outside + inside - corner > -keep] = BLOCKED
        for hole, diameter_mm in placement.unplated:
            reach = self._rounded(diameter_mm / 2 + from_hole)
            where = self.grid.near(*hole, reach)
            x, y = self.grid.offsets(where, *hole)
            owner[where][np.hypot(x, y) < reach] = BLOCKED

    def _keep_outs(self, placement: Placement, owner: NDArray[np.int16], half_mm: float) -> None:
        keep = half_mm + MARGIN_MM
        for box in placement.keep_outs:
            reach = max(box.width_mm, box.length_mm) / 2 + keep
            where = self.grid.near(*box.centre_mm, reach)
            x, y = self.grid.offsets(where, *box.centre_mm)
            dx, dy = np.abs(x) - box.width_mm / 2, np.abs(y) - box.length_mm / 2
            owner[where][(dx < keep) & (dy < keep)] = BLOCKED

    def _ground_only(self, placement: Placement, c: int, owner: NDArray[np.int16]) -> None:
        kind, ground = self.rules.classes[c], self.number.get(placement.ground, BLOCKED)
        for box in placement.ground_only:
            for p, size in ((SIDES.index("back"), kind.track_mm), (2, round_via_mm(kind))):
                keep = size / 2 + kind.clearance_mm + MARGIN_MM
                where = self.grid.near(*box.centre_mm, max(box.width_mm, box.length_mm) / 2 + keep)
                x, y = self.grid.offsets(where, *box.centre_mm)
                wide, long = box.width_mm / 2 + keep, box.length_mm / 2 + keep
                inside = (np.abs(x) < wide) & (np.abs(y) < long)
                view = owner[p][where]
                view[inside & (view == 0)] = ground

    def _pad(self, pad: PlacedPad, c: int, owner: NDArray[np.int16]) -> None:
        own = self.number.get(pad.net, BLOCKED)
        kind = self.rules.classes[c]
        clearance = self.rules.clearance_mm(c, self.rules.of_net.get(pad.net, c))
        clearance = max(clearance, fiducial_margin_mm(pad.component)) + MARGIN_MM
        layers = [SIDES.index(side) for side in pad.sides]
        for p in (*layers, 2):
            size = (round_via_mm(kind) if p == 2 else kind.track_mm) / 2
            self._claim(owner[p], pad, size + clearance, own)
        self._claim(owner[2], pad, kind.via_mm / 2 + PAD_TO_VIA_MM, BLOCKED)

    def _claim(self, owner: NDArray[np.int16], pad: PlacedPad, keep: float, own: int) -> None:
        round_mm = self._rounded(keep)
        x, y, where = self.from_pad(pad, round_mm)
        if pad.pad.round:
            near = np.hypot(x, y) < self._rounded(pad.pad.width_mm / 2 + keep)
        else:
            dx, dy = np.abs(x) - pad.pad.width_mm / 2, np.abs(y) - pad.pad.height_mm / 2
            beside = np.minimum(dx, dy) <= 0
            near = np.where(
                beside,
                np.maximum(dx, dy) < keep,
                np.hypot(np.maximum(dx, 0), np.maximum(dy, 0)) < round_mm,
            )
        view = owner[where]
        view[near] = np.where((view[near] == 0) | (view[near] == own), own, BLOCKED)

    def from_pad(
        self, pad: PlacedPad, beyond_mm: float
    ) -> tuple[Reals, Reals, tuple[slice, slice]]:
        """Nodes round a pad, as x and y (mm) in the pad's own axes, and which they are."""
        size = pad.pad
        where = self.grid.near(
            pad.x_mm, pad.y_mm, np.hypot(size.width_mm, size.height_mm) / 2 + beyond_mm
        )
        x, y = self.grid.offsets(where, pad.x_mm, pad.y_mm)
        turn = np.radians(pad.component.angle_deg)
        c, s = np.cos(turn), np.sin(turn)
        return c * x + s * y, c * y - s * x, where

    def _rounded(self, radius_mm: float) -> float:
        """Radius round a place off the grid that keeps whole diagonal steps outside."""
        return float(np.sqrt(radius_mm**2 + self.grid.pitch_mm**2 / 2))


NECK_MM = 0.6  # beyond a narrow pad, where tracks take its width
CROWD_MM = 4.0  # how far beside and above a pad others crowd it


class TightError(BuildError):
    """Fixed copper blocks every path; a finer grid may find one."""


@dataclass(frozen=True)
class Terminal:
    """A pad as the search sees it."""

    pad: PlacedPad
    nodes: Ints
    """Nodes in its middle, on its layers."""


@dataclass(frozen=True)
class Wanted:
    """A net to route, the terminal in the thickest crowd of pads first.

    A search that starts in the crowd has paid for its detours when it reaches open ground, and
    then heads for the other end; one that ends there floods the open ground before.
    """

    name: str
    number: int
    wide: int
    """Its class."""
    terminals: tuple[Terminal, ...]
    neck: Bytes
    """`(H, W)`: 1 where its tracks are narrow."""
    places: Ints = field(default_factory=lambda: np.empty(0, dtype=np.int32))
    """Of a net that is one via and no track: the nodes of the front where it may be,"""
    costs: Reals = field(default_factory=lambda: np.empty(0))
    """and the cost of each."""

    @cached_property
    def apart_mm(self) -> list[list[float]]:
        """Distances of its pads."""
        at = [(t.pad.x_mm, t.pad.y_mm) for t in self.terminals]
        return [[round(math.hypot(u - x, v - y), 6) for u, v in at] for x, y in at]


def wanted(
    name: str,
    pads: list[PlacedPad],
    all_pads: tuple[PlacedPad, ...],
    fixed: Obstacles,
    owner: NDArray[np.int16],
    *,
    thin: bool,
) -> Wanted:
    """The pads to connect.

    Args:
        name: of the net.
        pads: its pads.
        all_pads: those of the whole board.
        fixed: what is in the way, and the rules.
        owner: its map.
        thin: whether all its tracks are thin, whatever its class.

    Raises:
        TightError: no track can end in a pad.
    """
    narrow = fixed.rules.narrow
    wide = narrow if thin else fixed.rules.of_net[name]
    width = fixed.rules.classes[wide].track_mm
    neck = np.zeros((fixed.grid.height, fixed.grid.width), dtype=np.uint8)
    terminals = []
    for pad in pads:
        slim = min(pad.pad.width_mm, pad.pad.height_mm) < width + 1e-9
        nodes = _middle(pad, fixed, owner[narrow if slim else wide])
        if slim or not nodes.size:
            reach = max(pad.pad.width_mm, pad.pad.height_mm) / 2 + NECK_MM
            where = fixed.grid.near(pad.x_mm, pad.y_mm, reach)
            x, y = fixed.grid.offsets(where, pad.x_mm, pad.y_mm)
            neck[where][np.hypot(x, y) < reach] = 1
            nodes = _middle(pad, fixed, owner[narrow])
        if not nodes.size:
            raise TightError(
                f"net {name}: no track can end in pad {pad.component.ref}.{pad.pad.number} at "
                f"({pad.x_mm:.2f}, {pad.y_mm:.2f}) mm, so near is it to other pads, a hole or "
                "the edge; give the parts more room"
            )
        terminals.append(Terminal(pad, nodes))
    places = np.array([(pad.x_mm, pad.y_mm) for pad in all_pads])
    terminals.sort(key=lambda end: -_crowd(end.pad, places))
    return Wanted(name, fixed.number[name], wide, tuple(terminals), neck)


def _crowd(pad: PlacedPad, places: NDArray[np.float64]) -> int:
    """How many pads there are round one, itself included."""
    off = np.abs(places - (pad.x_mm, pad.y_mm)).max(axis=1)
    return int(np.count_nonzero(np.round(off, 6) < CROWD_MM))


def _middle(pad: PlacedPad, fixed: Obstacles, owner: NDArray[np.int16]) -> Ints:
    """Nodes along the middle of a pad that its net may use, by index."""
    grid, size = fixed.grid, pad.pad
    x, y, where = fixed.from_pad(pad, 0.0)
    long = max(size.width_mm - size.height_mm, 0) / 2, max(size.height_mm - size.width_mm, 0) / 2
    off = np.maximum(np.abs(x) - long[0], 0) + np.maximum(np.abs(y) - long[1], 0)
    middle = off <= np.round(off.min(), 6) + 1e-6
    found = []
    for side in pad.sides:
        layer = SIDES.index(side)
        free = middle & np.isin(owner[layer][where], (0, fixed.number[pad.net]))
        rows, columns = np.nonzero(free)
        found.append(
            layer * grid.plane + (rows + where[0].start) * grid.width + columns + where[1].start
        )
    return np.concatenate(found).astype(np.int32)
