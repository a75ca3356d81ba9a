"""Copper of a board: gaps, widths, nets, spokes of the pour, supplies, and where none may be."""

import math
from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise

import networkx as nx
import shapely
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard, lands, on_page
from lumitip_fab.checks.readers.kicad_board import Copper, Terminal
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design.board_rules import rules_of

HOT_LOOP_MM2 = 6.0
"""A loop of about 5 mm² is what a TSOT26 with an 0603 beside it can have."""
HOT_TRACK_MM = 3.0
GROUND_SHARE = 80.0  # of the loop, in percent
ANTENNA_EDGE_MM = 0.5
LEAST_SPOKES = 2
"""Default of `min_resolved_spokes` of KiCad 6 to 10."""
_BESIDE_MM = 0.1  # from the pad, inside its thermal gap
_SOLID = 0.6  # of a pad's area, which the pour covers where it joins the pad all round
_ROUND_MM = 0.0006  # what chords of round copper take away, and six digits in files
_RULED_MM = 0.001  # that a rule's area may be short of the design's


def measure_copper(read: ReadBoard) -> Iterator[Measurement]:
    """Gaps, widths and rings against the rules of the design."""
    rules = rules_of(read.design, read.name)
    yield _gap(read, rules.copper_gap_mm)
    yield _edge_gap(read, rules.edge_gap_mm)
    if read.holes:
        yield _hole_gap(read, rules.hole_gap_mm)
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
    joined = sorted(" and ".join(sorted(labels)) for labels in names.values() if len(labels) > 1)
    yield read.count("short", joined, "places")
    grounded = {label for label, labels in names.items() if "GND" in labels}
    adrift = [
        f"on {'/'.join(sorted(piece.layers))}"
        for piece in read.board.loose
        if piece.kind == "fill" and read.clusters.of(piece) not in grounded & groups["GND"]
    ]
    yield read.count("islands", adrift, "fills")


def measure_joined(read: ReadBoard) -> Iterator[Measurement]:
    """Pads that the design joins, followed along the copper, and pads that it does not."""
    if not read.components:
        return
    pads: dict[str, dict[int | None, list[str]]] = defaultdict(lambda: defaultdict(list))
    owners: dict[int, set[str]] = defaultdict(set)
    for device in read.components:
        for number, net in device.nets:
            group = read.group(device.ref, number)
            pads[net][group].append(f"{device.ref}.{number}")
            if group is not None:
                owners[group].add(net)
    apart = [
        f"{net}: {min(groups.values(), key=len)[0]} is apart"
        for net, groups in pads.items()
        if len(groups) > 1 or None in groups
    ]
    yield read.count("apart", apart, "nets")
    both = [" and ".join(sorted(nets)) for nets in owners.values() if len(nets) > 1]
    yield read.count("joined", both, "places")


def measure_supplies(read: ReadBoard) -> Iterator[Measurement]:
    """Width of the tracks of supplies, which are wide but where ground's pour does the work."""
    if read.auxiliary is None:
        return
    wide = {net for net in read.auxiliary.supplies if net != "GND"}
    widths = [c.width_mm for c in read.board.loose if c.kind == "track" and c.net in wide]
    least = rules_of(read.design, read.name).supply_track_mm
    yield read.figure("supply_width", min(widths, default=math.nan), least, math.inf)


def _gap(read: ReadBoard, least_mm: float) -> Measurement:
    """The narrowest gap between copper that is not connected."""
    gaps = read.clusters.gaps(2 * least_mm)
    worst = min(gaps, key=lambda gap: gap[0], default=None)
    if worst is None:
        return read.figure("clearance", 2 * least_mm, least_mm - _ROUND_MM, math.inf)
    note = " and ".join(sorted(f"{piece.kind} of {piece.net or 'no net'}" for piece in worst[1:]))
    return read.figure("clearance", worst[0], least_mm - _ROUND_MM, math.inf, note=note)


def _edge_gap(read: ReadBoard, least_mm: float) -> Measurement:
    """The narrowest gap from copper to the edge."""
    copper, edge = [piece.area for piece in read.clusters.pieces], read.outline.boundary
    shapely.prepare([read.outline, edge])
    inside = shapely.contains(read.outline, copper).all()
    gap = float(shapely.distance(edge, copper).min()) if inside else -math.inf
    return read.figure("edge_clearance", gap, least_mm - _ROUND_MM, math.inf)


def _hole_gap(read: ReadBoard, least_mm: float) -> Measurement:
    """The narrowest gap from copper to unplated holes."""
    copper = [piece.area for piece in read.clusters.pieces]
    shapely.prepare(copper)
    gaps = [
        float(shapely.distance(copper, shapely.Point(hole.at)).min()) - hole.drill_mm / 2
        for hole in read.holes
    ]
    return read.figure("hole_clearance", min(gaps), least_mm - _ROUND_MM, math.inf)


def _ring_mm(via: Copper) -> float:
    left, _, right, _ = via.area.bounds
    return float(right - left - via.drill_mm) / 2


def measure_spokes(read: ReadBoard) -> Iterator[Measurement]:
    """Pads that the pour joins with too few spokes; those to a piece that leads nowhere do not
    count."""
    found = [fault for layer in read.board.layers for fault in _starved(read, layer)]
    yield read.count("spokes", found, "pads")


def _starved(read: ReadBoard, layer: str) -> Iterator[str]:
    here = [piece for piece in read.board.loose if layer in piece.layers and piece.net == "GND"]
    fills = [piece.area for piece in here if piece.kind == "fill"]
    others = [piece.area for piece in here if piece.kind != "fill"]
    pads = [
        (f"{part.ref}.{terminal.number}", copper)
        for part, terminal, copper in lands(read.board, layer)
        if terminal.net == "GND"
    ]
    through = [fill for fill in fills if _leads_on(fill, others, [pad for _, pad in pads])]
    for name, pad in pads:
        near = [fill for fill in fills if fill.intersects(pad.area)]
        if (
            not near
            or sum(fill.intersection(pad.area).area for fill in near) > _SOLID * pad.area.area
        ):
            continue
        spokes = sum(_spokes(fill, pad) for fill in near if fill in through)
        if spokes < LEAST_SPOKES:
            yield f"{name} has {spokes} on {layer}"


def _leads_on(fill: BaseGeometry, others: Sequence[BaseGeometry], pads: Sequence[Copper]) -> bool:
    """Whether a piece of pour joins more than a single pad."""
    if any(bool(fill.intersects(other)) for other in others):
        return True
    return sum(bool(fill.intersects(pad.area)) for pad in pads) > 1


def _spokes(fill: BaseGeometry, pad: Copper) -> int:
    ring = pad.area.buffer(_BESIDE_MM).boundary
    crossed = shapely.line_merge(shapely.intersection(ring, fill))
    pieces = [part for part in shapely.get_parts(crossed) if part.length > 0]
    if len(pieces) > 1:  # a ring begins somewhere, and a spoke may stand there
        start, end = ring.coords[0], ring.coords[-1]
        touching = [p for p in pieces if p.distance(shapely.Point(start)) < 1e-9]
        if start == end and len(touching) > 1:
            return len(pieces) - 1
    return len(pieces)


def measure_hot_loop(read: ReadBoard) -> Iterator[Measurement]:
    """The loop in which a regulator's current jumps: its area, and the ground under it."""
    if not (hot_loop := read.auxiliary.hot_loop if read.auxiliary else ()):
        return
    pads = [_terminal(read, ref, number) for ref, number in hot_loop]
    corners = [pad.at for pad in pads if pad is not None]
    if len(corners) < len(pads):
        yield read.figure("hot_loop", math.nan, 0, HOT_LOOP_MM2, "mm²")
        return
    loop = shapely.MultiPoint(corners).convex_hull
    yield read.figure("hot_loop", loop.area, 0, HOT_LOOP_MM2, "mm²", "between its pads' middles")
    back = read.board.layers[-1]
    ground = [
        c.area for c in read.board.loose if c.kind == "fill" and c.net == "GND" and back in c.layers
    ]
    share = shapely.union_all(ground).intersection(loop).area / loop.area
    yield read.figure("hot_loop_ground", 100 * share, GROUND_SHARE, 100, "%", "of it, on the back")
    reach = _copper_mm(read, *hot_loop[0], *hot_loop[1])
    yield read.figure("hot_loop_input", reach, 0, HOT_TRACK_MM, note="of track to the capacitor")


def measure_keep_outs(read: ReadBoard) -> Iterator[Measurement]:
    """Copper under an antenna, on whatever layer, and how far the antenna is from the edge."""
    if not (boxes := read.auxiliary.keep_outs if read.auxiliary else ()):
        return
    areas = [on_page(box) for box in boxes]
    whole = shapely.union_all(areas)
    pieces = [(piece, piece.area.intersection(whole).area) for piece in read.board.copper()]
    inside = [f"{piece.kind} of {piece.net or 'no net'}" for piece, mm2 in pieces if mm2 > 0]
    covered = sum(mm2 for _, mm2 in pieces)
    yield read.figure("keep_out", covered, 0, 0, "mm²", "; ".join(inside[:4]) or "of copper")
    ruled = shapely.union_all([area.buffer(_RULED_MM) for area in read.board.keep_outs])
    open_mm2 = whole.difference(ruled).area
    yield read.figure("keep_out_rule", open_mm2, 0, 0, "mm²", "that KiCad may fill again")
    gap = min(area.distance(read.outline.boundary) for area in areas)
    yield read.figure("antenna_edge", gap, 0, ANTENNA_EDGE_MM, note="to the board's edge")


def _terminal(read: ReadBoard, ref: str, number: str) -> Terminal | None:
    part = read.parts.get(ref)
    return next((t for t in part.terminals if t.number == number), None) if part else None


def _copper_mm(read: ReadBoard, ref: str, number: str, other: str, pad: str) -> float:
    """Length of the shortest way along tracks of one side from pad to pad; infinite if none."""
    ends = [_terminal(read, ref, number), _terminal(read, other, pad)]
    areas = [t.copper.area if t and t.copper else shapely.Point() for t in ends]
    net = ends[0].net if ends[0] else ""
    graph = nx.Graph()
    for track in (c for c in read.board.loose if c.kind == "track" and c.net == net):
        line = shapely.get_coordinates(track.area.minimum_rotated_rectangle)
        sides = [math.dist(a, b) for a, b in pairwise(line)]
        length = max(sides) - track.width_mm
        graph.add_node(id(track), area=track.area, length=max(length, 0.0), on=track.layers)
    nodes = list(graph.nodes(data=True))
    for i, (one, a) in enumerate(nodes):
        for other_, b in nodes[i + 1 :]:
            if a["on"] & b["on"] and a["area"].intersects(b["area"]):
                graph.add_edge(one, other_)
    starts = [n for n, d in nodes if d["area"].intersects(areas[0])]
    goals = {n for n, d in nodes if d["area"].intersects(areas[1])}
    best = math.inf
    for start in starts:
        for goal in goals:
            if nx.has_path(graph, start, goal):
                way = nx.shortest_path(graph, start, goal)
                best = min(best, sum(graph.nodes[n]["length"] for n in way))
    return best
