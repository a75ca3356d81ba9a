"""Teardrops: tracks that widen towards pads and vias, where flexible boards else tear.

A track begins with short pieces, the first the widest. Ground has none: the pour, which comes
later, joins its pads.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import shapely
from shapely.ops import substring

from lumitip_fab.boards.model import SIDES, Placement, Routing, Track
from lumitip_fab.boards.placed import PlacedPad, placed_pads
from lumitip_fab.design import Side

BEYOND_MM = (0.15, 0.3, 0.45)  # the edge of pad or via: where each piece ends
WIDER = (2.2, 1.8, 1.4)  # than the track, each piece; none is wider than the pad
SLIMMER = (1.0, 0.87, 0.76)  # what is tried where there is less room
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
    """The pieces by which a run leaves the land that it begins in, and the rest of it; without
    room there are none."""
    if not run:
        return [], []
    first = run[0]
    at, line = shapely.Point(first.start), shapely.LineString([first.start, *(t.end for t in run)])
    for land in lands:
        if land.net != first.net or first.side not in land.sides or not land.area.covers(at):
            continue
        inside_mm = _inside_mm(line, land.area)
        for slimmer in SLIMMER:
            pieces, used_mm = _pieces(first, line, inside_mm, land.width_mm, slimmer)
            if pieces and all(map(copper.free, pieces)):
                copper.add(pieces)
                return pieces, _along(first, line, used_mm, line.length)
        break
    return [], run


def _inside_mm(line: shapely.LineString, land: shapely.Geometry) -> float:
    """Where a line that begins in a land leaves it; its whole length if it does not."""
    outside = line.difference(land)
    if outside.is_empty:
        return float(line.length)
    return float(line.project(shapely.Point(shapely.get_parts(outside)[0].coords[0])))


def _pieces(
    track: Track, line: shapely.LineString, inside_mm: float, most_mm: float, slimmer: float
) -> tuple[Run, float]:
    """The beginning of a run in pieces, each less wide than the one before, and where they end."""
    pieces: Run = []
    begin_mm = 0.0
    for beyond_mm, wider in zip(BEYOND_MM, WIDER, strict=True):
        width = round(min(wider * slimmer * track.width_mm, most_mm), 3)
        end_mm = inside_mm + beyond_mm
        if end_mm > line.length or width <= track.width_mm:
            break
        pieces += _along(replace(track, width_mm=width), line, begin_mm, end_mm)
        begin_mm = end_mm
    return pieces, begin_mm


def _along(track: Track, line: shapely.LineString, begin_mm: float, end_mm: float) -> Run:
    """A part of a line as tracks like another one."""
    part = substring(line, begin_mm, end_mm)
    places = [(round(x, 3), round(y, 3)) for x, y in part.coords]
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
    return shapely.box(box.x_min_mm, box.y_min_mm, box.x_max_mm, box.y_max_mm).exterior
