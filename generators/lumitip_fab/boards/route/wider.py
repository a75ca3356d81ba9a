"""Narrow tracks made wider where there is room: they are etched with less risk."""

import dataclasses
import itertools
import math
from collections.abc import Iterator

import numpy as np
import shapely
from shapely import Geometry

from lumitip_fab.boards.model import BoardModel, Placement, Routing, Track, fiducial_margin_mm
from lumitip_fab.boards.placed import placed_pads
from lumitip_fab.boards.pour.room import free_board
from lumitip_fab.boards.route.rules import MARGIN_MM
from lumitip_fab.boards.route.spread import WIDE_MM
from lumitip_fab.boards.verify import copper_of
from lumitip_fab.design import Side

LEAST_MM = 1.0  # part of a straight piece that gets it by itself
_STEP_MM = 0.01  # such parts end at whole multiples of this along x or y
_HALF_MM = WIDE_MM / 2 + MARGIN_MM
_ARC = 16  # chords of a quarter circle


def with_wider_tracks(placement: Placement, routing: Routing) -> Routing:
    """The routing with straight pieces of track, or parts of them, at `WIDE_MM` where they may be.

    The longest pieces come first, those of ground last. Tracks stay narrow in narrower pads, and
    beside other copper, edges and holes that they would come too near to.

    Args:
        placement: the board.
        routing: tracks and vias of all nets, before the pour.
    """
    room = _Room(placement, routing)
    pieces = [[track] for track in routing.tracks]
    narrow = [p for p in pieces if p[0].width_mm < WIDE_MM and p[0].start != p[0].end]
    for parts in sorted(narrow, key=lambda p: (p[0].net == placement.ground, -_length_mm(p[0]))):
        parts[:] = _cut(parts[0], room.free(parts[0]))
        for piece in parts:
            if piece.width_mm == WIDE_MM:
                room.add(piece)
    return dataclasses.replace(routing, tracks=tuple(itertools.chain(*pieces)))


def _length_mm(track: Track) -> float:
    return round(math.dist(track.start, track.end), 6)


def _cut(track: Track, free: Geometry) -> list[Track]:
    """A track in pieces, those wide that lie in an area and are long enough, or all of it."""
    run = [b - a for a, b in zip(track.start, track.end, strict=True)]
    reach = max(map(abs, run))
    stretch = _length_mm(track) / reach
    ends: list[tuple[float, float]] = []
    for part in (p for p in shapely.get_parts(free) if p.length):
        along = np.abs(shapely.get_coordinates(part) - track.start).max(axis=1)
        first = math.ceil(along.min() / _STEP_MM - 1e-6) * _STEP_MM
        last = math.floor(along.max() / _STEP_MM + 1e-6) * _STEP_MM
        last = reach if along.max() > reach - 1e-6 else last
        if (last - first) * stretch >= LEAST_MM or (first == 0.0 and last == reach):
            ends.append((first, last))
    pieces, at = [], 0.0
    for first, last in sorted(ends):
        pieces += [(at, first, track.width_mm), (first, last, WIDE_MM)]
        at = last
    pieces.append((at, reach, track.width_mm))
    return [
        dataclasses.replace(
            track,
            start=_along(track, run, a / reach),
            end=_along(track, run, b / reach),
            width_mm=width_mm,
        )
        for a, b, width_mm in pieces
        if b > a
    ]


def _along(track: Track, run: list[float], share: float) -> tuple[float, float]:
    return round(track.start[0] + share * run[0], 3), round(track.start[1] + share * run[1], 3)


@dataclasses.dataclass(frozen=True)
class _Zone:
    """Where the middle of a wide track must not be."""

    net: str
    """Tracks of this net may; none where it is empty."""
    sides: tuple[Side, ...]
    area: Geometry


class _Room:
    """The room that the tracks leave each other as they are."""

    def __init__(self, placement: Placement, routing: Routing) -> None:
        self.gap_mm = max(c.clearance_mm for c in placement.classes)
        self.board = free_board(placement, _HALF_MM)
        self.zones = list(self._zones(placement, routing))
        self.tree = shapely.STRtree([zone.area for zone in self.zones])
        self.wide: list[_Zone] = []

    def _zones(self, placement: Placement, routing: Routing) -> Iterator[_Zone]:
        pads = [pad for component in placement.components for pad in placed_pads(component)]
        copper = copper_of(BoardModel(placement, routing, ()))
        margins = [fiducial_margin_mm(pad.component) for pad in pads]
        margins += [0.0] * (len(copper) - len(pads))
        for piece, margin_mm in zip(copper, margins, strict=True):
            gap_mm = piece.radius_mm + max(self.gap_mm, margin_mm)
            yield _Zone(
                piece.net, piece.sides, piece.core.buffer(_HALF_MM + gap_mm, quad_segs=_ARC)
            )
        for pad in pads:
            if min(pad.pad.width_mm, pad.pad.height_mm) < WIDE_MM - 1e-9:
                yield _Zone("", pad.sides, pad.area.buffer(_HALF_MM))
        for box in placement.ground_only:
            area = shapely.box(*box.bounds_mm).buffer(_HALF_MM + self.gap_mm)
            yield _Zone(placement.ground, ("back",), area)

    def add(self, track: Track) -> None:
        """Keep others away from a track that is wide now."""
        line = shapely.LineString([track.start, track.end])
        area = line.buffer(_HALF_MM + WIDE_MM / 2 + self.gap_mm, quad_segs=_ARC)
        self.wide.append(_Zone(track.net, (track.side,), area))

    def free(self, track: Track) -> Geometry:
        """The parts of a track that may be wide."""
        line = shapely.LineString([track.start, track.end])
        near = [self.zones[i] for i in self.tree.query(line, predicate="intersects")]
        taken = [
            zone.area
            for zone in (*near, *self.wide)
            if zone.net != track.net and track.side in zone.sides and zone.area.intersects(line)
        ]
        return shapely.difference(shapely.intersection(line, self.board), shapely.union_all(taken))
