"""Bridges between ground pads and the pour, thin so that the pads can be soldered."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from shapely import Geometry, Polygon

from lumitip_fab.boards.geometry import PlacedPad
from lumitip_fab.boards.pour.room import opened
from lumitip_fab.boards.pour_rules import MIN_WIDTH_MM, THERMAL_GAP_MM, THERMAL_SPOKE_MM
from lumitip_fab.design import Point

LEAST_AREA_MM2 = 0.04  # smaller pieces of pour are left out
_INTO_MM = 0.1  # how far a spoke reaches into pad and pour


@dataclass(frozen=True)
class Sheet:
    """The pour of one side: pieces, and the pads that each of them reaches."""

    pieces: tuple[Polygon, ...]
    reached: tuple[tuple[int, ...], ...]
    """Of each pad the pieces that it is bridged to."""

    def pieces_at(self, places: Sequence[Point]) -> list[int]:
        """The piece of pour at each place, or -1."""
        found = np.full(len(places), -1)
        x, y = np.array(places).reshape(-1, 2).T
        for i, piece in enumerate(self.pieces):
            shapely.prepare(piece)
            found[shapely.contains_xy(piece, x, y)] = i
        return [int(i) for i in found]


def sheet(room: Geometry, pads: list[PlacedPad]) -> Sheet:
    """Cut the pads out of the room for the pour, and bridge the gaps.

    Args:
        room: where the pour may be.
        pads: pads of the ground net on this side.
    """
    gaps = [pad.area.buffer(THERMAL_GAP_MM, join_style="round") for pad in pads]
    body = opened(shapely.difference(room, shapely.union_all(gaps)))
    pieces = [p for p in shapely.get_parts(body) if p.area >= LEAST_AREA_MM2]
    shapely.prepare(pieces)
    shapely.prepare(room)
    tree = shapely.STRtree(pieces)
    added: list[list[Geometry]] = [[] for _ in pieces]
    reached = []
    for pad in pads:
        found = [
            (int(piece), spoke)
            for spoke, end in _spokes(pad)
            if room.covers(spoke)
            for piece in tree.query(end)
            if pieces[piece].covers(end)
        ]
        for piece, spoke in found:
            added[piece].append(spoke)
        reached.append(tuple(sorted({piece for piece, _ in found})))
    whole = [shapely.union_all([p, *more]) for p, more in zip(pieces, added, strict=True)]
    return Sheet(tuple(whole), tuple(reached))


def _spokes(pad: PlacedPad) -> list[tuple[Polygon, Polygon]]:
    """The four spokes of a pad, each with its outer end: along its axes, of round pads between."""
    size = pad.pad
    start = 45.0 if size.shape == "circle" else 0.0
    half = THERMAL_SPOKE_MM / 2
    spokes = []
    for turn, reach in zip(
        (0.0, 90.0, 180.0, 270.0), (size.width_mm, size.height_mm) * 2, strict=True
    ):
        inner, outer = reach / 2 - _INTO_MM, reach / 2 + THERMAL_GAP_MM + _INTO_MM
        angle = np.radians(start + turn + pad.component.angle_deg)
        matrix = [np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle), pad.x_mm, pad.y_mm]
        spoke = shapely.box(inner, -half, outer, half)
        end = shapely.box(outer - _INTO_MM / 2, -MIN_WIDTH_MM / 2, outer, MIN_WIDTH_MM / 2)
        spokes.append(tuple(shapely.affinity.affine_transform(p, matrix) for p in (spoke, end)))
    return spokes
