"""The copper of a board: widths, gaps, and that every net is whole and by itself."""

import math
from collections.abc import Iterator

import shapely

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.kicad_board import Copper
from lumitip_fab.checks.result import Measurement

_ROUND_MM = 0.0006  # what chords of round copper take away, and six digits in files


def measure_copper(read: ReadBoard) -> Iterator[Measurement]:
    """Gaps, widths and rings against the rules of the design."""
    rules = read.design.rules
    yield _gap(read, rules.copper_gap_mm)
    yield _edge_gap(read, rules.edge_gap_mm)
    tracks = [piece.width_mm for piece in read.board.loose if piece.kind == "track"]
    yield read.figure("track_width", min(tracks, default=math.nan), rules.track_mm, math.inf)
    rings = [_ring_mm(piece) for piece in read.board.loose if piece.kind == "via"]
    wanted = (rules.via_mm - rules.via_drill_mm) / 2 - _ROUND_MM
    if rings:
        yield read.figure("via_ring", min(rings), wanted, math.inf)


def measure_nets(read: ReadBoard) -> Iterator[Measurement]:
    """Nets that the copper leaves open, and those that it joins."""
    groups, names = read.clusters.groups(), read.clusters.nets()
    opened = sorted(net for net, found in groups.items() if len(found) > 1)
    yield read.count("open", [f"{net} in {len(groups[net])} pieces" for net in opened], "nets")
    joined = sorted(" and ".join(sorted(told)) for told in names.values() if len(told) > 1)
    yield read.count("short", joined, "places")
    grounded = {label for label, told in names.items() if "GND" in told}
    adrift = [
        f"on {'/'.join(sorted(piece.layers))}"
        for piece in read.board.loose
        if piece.kind == "fill" and read.clusters.of(piece) not in grounded & groups["GND"]
    ]
    yield read.count("islands", adrift, "fills")


def _gap(read: ReadBoard, least_mm: float) -> Measurement:
    """The narrowest gap between copper that is not connected."""
    gaps = read.clusters.gaps(2 * least_mm)
    worst = min(gaps, key=lambda gap: gap[0], default=None)
    if worst is None:
        return read.figure("clearance", 2 * least_mm, least_mm - _ROUND_MM, math.inf)
    note = " and ".join(sorted(f"{piece.kind} of {piece.net or 'no net'}" for piece in worst[1:]))
    return read.figure("clearance", worst[0], least_mm - _ROUND_MM, math.inf, note=note)


def _edge_gap(read: ReadBoard, least_mm: float) -> Measurement:
    """The narrowest gap from copper to the edge and to unplated holes."""
    holes = [shapely.Point(h.at).buffer(h.drill_mm / 2, quad_segs=32) for h in read.holes]
    borders = [read.outline.boundary, *holes]
    copper = [piece.area for piece in read.clusters.pieces]
    gaps = [float(shapely.distance(border, copper).min()) for border in borders]
    inside = all(read.outline.contains(area) for area in copper)
    worst = min(gaps) if inside else -math.inf
    return read.figure("edge_clearance", worst, least_mm - _ROUND_MM, math.inf)


def _ring_mm(via: Copper) -> float:
    left, _, right, _ = via.area.bounds
    return float(right - left - via.drill_mm) / 2
