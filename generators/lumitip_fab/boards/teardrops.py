"""Teardrops: tracks that widen towards pads and vias, where flexible boards else tear.

A track begins with short pieces, the first the widest. Ground has none: the pour, which comes
later, joins its pads.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise, product, takewhile

import numpy as np
import shapely
from shapely.ops import substring

from lumitip_fab.boards.model import SIDES, Placement, Routing, Track
from lumitip_fab.boards.placed import PlacedPad, placed_pads
from lumitip_fab.design import Point, Side

BEYOND_MM = (0.15, 0.3, 0.45)  # the edge of pad or via: where each piece ends
WIDER = (2.2, 1.8, 1.4)  # than the track, each piece; none is wider than the pad
SLIMMER = (1.0, 0.87, 0.76)  # what is tried where there is less room,
ASIDE = (0.0, 0.4, -0.4)  # first along the track, then to one side, by this share of its width
_MARGIN_MM = 0.002  # beyond clearances


@dataclass(frozen=True)
class _Land:
    """A pad or a via: where tracks end."""

    area: shapely.Geometry
    net: str
    sides: tuple[Side, ...]
    width_mm: float


def with_teardrops(placement: Placement, routing: Routing) -> Routing:
    """The routing with those teardrops that find room.

    Args:
        placement: the board.
        routing: before the pour.
    """
    lands = list(_lands(placement, routing))
    copper = _Copper(placement, routing, lands)
    tracks: list[Track] = []
    for run in _runs(routing.tracks):
        if run[0].net == placement.ground:
            tracks += run
            continue
        first, rest = _drop(run, lands, copper)
        last, rest = _drop(_reversed(rest), lands, copper)
        tracks += [*first, *_reversed(rest), *last]
    return replace(routing, tracks=tuple(tracks))


def _lands(placement: Placement, routing: Routing) -> Iterator[_Land]:
    for component in placement.components:
        for pad in placed_pads(component):
            yield _Land(pad.area, pad.net, pad.sides, _width_mm(pad))
    for via in routing.vias:
        area = shapely.Point(via.x_mm, via.y_mm).buffer(via.diameter_mm / 2)
        yield _Land(area, via.net, SIDES, via.diameter_mm)


def _width_mm(pad: PlacedPad) -> float:
    return min(pad.pad.width_mm, pad.pad.height_mm)


Run = list[Track]
"""Tracks of one width that follow each other, each from the end of the one before."""


def _runs(tracks: tuple[Track, ...]) -> list[Run]:
    runs: list[Run] = []
    for track in tracks:
        before = runs[-1][-1] if runs else None
        if before and before == replace(track, start=before.start, end=track.start):
            runs[-1].append(track)
        else:
            runs.append([track])
    return runs


def _reversed(run: Run) -> Run:
    return [replace(track, start=track.end, end=track.start) for track in reversed(run)]


def _drop(run: Run, lands: list[_Land], copper: "_Copper") -> tuple[Run, Run]:
    """The tracks by which a run leaves the land that it begins in, and the rest of it."""
    if not run:
        return [], []
    first, at = run[0], run[0].start
    for land in lands:
        if land.net == first.net and first.side in land.sides and _covers(land, at):
            within = list(takewhile(partial(_ends_in, land), run))
            pieces, rest = _widened(run[len(within) :], land, copper)
            return [*within, *pieces], rest
    return [], run


def _covers(land: _Land, at: Point) -> bool:
    return bool(land.area.covers(shapely.Point(at)))


def _ends_in(land: _Land, track: Track) -> bool:
    return _covers(land, track.end)


def _widened(run: Run, land: _Land, copper: "_Copper") -> tuple[Run, Run]:
    """The pieces by which a run leaves a land, each the widest that finds room, none wider than
    the one before; and the rest of the run."""
    if not run:
        return [], []
    first, line = run[0], shapely.LineString([run[0].start, *(t.end for t in run)])
    inside_mm, begin_mm, most_mm = _inside_mm(line, land.area), 0.0, land.width_mm
    pieces: Run = []
    for beyond_mm, wider in zip(BEYOND_MM, WIDER, strict=True):
        if (end_mm := inside_mm + beyond_mm) > line.length:
            break
        piece = _piece(first, substring(line, begin_mm, end_mm), wider, most_mm, copper)
        if not piece:
            break
        pieces += piece
        begin_mm, most_mm = end_mm, piece[0].width_mm
    copper.add(pieces)
    return pieces, _tracks(first, substring(line, begin_mm, line.length))


def _piece(
    track: Track, line: shapely.LineString, wider: float, most_mm: float, copper: "_Copper"
) -> Run:
    """The widest piece along a line that finds room, or beside it; none if there is none."""
    for aside, slimmer in product(ASIDE, SLIMMER):
        beside = _beside(line, aside * track.width_mm)
        width_mm = round(min(wider * slimmer * track.width_mm, most_mm), 3)
        piece = _tracks(replace(track, width_mm=width_mm), beside)
        if width_mm > track.width_mm and all(map(copper.free, piece)):
            return piece
    return []


def _beside(line: shapely.LineString, aside_mm: float) -> shapely.LineString:
    """A parallel of a line, which still begins and ends in the copper of a track along it."""
    return line.offset_curve(aside_mm, join_style="mitre") if aside_mm else line


def _inside_mm(line: shapely.LineString, land: shapely.Geometry) -> float:
    """Where a line that begins in a land leaves it; its whole length if it does not."""
    outside = line.difference(land)
    if outside.is_empty:
        return float(line.length)
    return float(line.project(shapely.Point(shapely.get_parts(outside)[0].coords[0])))


def _tracks(track: Track, line: shapely.LineString) -> Run:
    """A line as tracks like another one."""
    places = [(round(x, 3), round(y, 3)) for x, y in line.coords]
    return [replace(track, start=a, end=b) for a, b in pairwise(places) if a != b]


class _Copper:
    """Obstacles on the board."""

    def __init__(self, placement: Placement, routing: Routing, lands: list[_Land]) -> None:
        classes = {c.name: c.clearance_mm for c in placement.classes}
        self.gaps = {n.name: classes[n.net_class] for n in placement.nets}
        self.most = max(classes.values())
        self.placement = placement
        self.nets = [land.net for land in lands] + [t.net for t in routing.tracks]
        self.sides = [land.sides for land in lands] + [(t.side,) for t in routing.tracks]
        shapes = [land.area for land in lands] + [_area(t) for t in routing.tracks]
        self.shapes = list(shapes)
        self.edge = _board(placement)
        self.holes = shapely.union_all(
            [shapely.Point(at).buffer(size / 2) for at, size in placement.unplated]
        )

    def free(self, drop: Track) -> bool:
        """Whether a track keeps its distance from all of other nets, from edge and holes."""
        area = _area(drop)
        if area.distance(self.edge) < self.placement.edge_clearance_mm + _MARGIN_MM:
            return False
        if area.distance(self.holes) < self.placement.hole_clearance_mm + _MARGIN_MM:
            return False
        near = shapely.dwithin(np.array(self.shapes, dtype=object), area, self.most + _MARGIN_MM)
        own = self.gaps[drop.net]
        return not any(
            self.nets[i] != drop.net
            and drop.side in self.sides[i]
            and self.shapes[i].distance(area)
            < max(own, self.gaps.get(self.nets[i], self.most)) + _MARGIN_MM
            for i in np.flatnonzero(near)
        )

    def add(self, pieces: list[Track]) -> None:
        """Put pieces of track on the board."""
        for piece in pieces:
            self.shapes.append(_area(piece))
            self.nets.append(piece.net)
            self.sides.append((piece.side,))


def _area(track: Track) -> shapely.Geometry:
    line = shapely.LineString([track.start, track.end])
    return line.buffer(track.width_mm / 2, quad_segs=16)


def _board(placement: Placement) -> shapely.Geometry:
    box = placement.outline
    return shapely.box(*box.bounds_mm).exterior
