"""The boards outside the fingers against the design: edge, holes, pads, connectors and contact
map."""

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping
from itertools import pairwise

import networkx as nx
import numpy as np
import shapely

from lumitip_fab.checks.board_read import ReadAuxiliary
from lumitip_fab.checks.readers.kicad_board import Part, Terminal
from lumitip_fab.checks.readers.kicad_silk import Word
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import Box, Component, Pad, Point, ToolContact
from lumitip_fab.design.frames import applied, auxiliary_to_flange, on_board_page

CONTACTS = "J1"
PLACE_MM = 0.02
_SUPPLY, _GROUND = ("F1", 1), ("C1", 2)
"""Pads that the board's supply enters by, at the fuse, and that are on its ground."""
Contacts = Mapping[str, ToolContact]


def measure_contact_map(read: ReadAuxiliary) -> Iterator[Measurement]:
    """Every pad on the contact of its number, and every net on contacts of its own signal alone."""
    for flange in (f for f in read.design.flanges if f.auxiliary == read.name):
        contacts = {contact.number: contact for contact in flange.contacts}
        part = read.parts.get(CONTACTS)
        pads = {t.number: t for t in (part.terminals if part else ()) if t.copper is not None}
        lost = sorted(contacts.keys() ^ pads.keys())
        yield read.count("contact_count", [f"{number} at one end only" for number in lost], "pads")
        both = contacts.keys() & pads.keys()
        numbers = [number for number in contacts if number in both]
        on_board = read.sensor([pads[number].at for number in numbers])
        places = applied(auxiliary_to_flange(flange), on_board)[:, :2]
        off = [math.dist(place, contacts[n].at) for n, place in zip(numbers, places, strict=True)]
        yield read.figure(
            "contact_places",
            max(off, default=math.nan),
            0,
            PLACE_MM,
            note="from the coupling's contact of the same number",
        )
        groups = {number: read.group(CONTACTS, number) for number in numbers}
        named = {number: pads[number].net for number in numbers}
        wrong = [*_joined(contacts, groups), *_joined(contacts, named)]
        yield read.count("contact_signals", sorted({*wrong, *_led(read, contacts, groups)}), "nets")


def _joined(contacts: Contacts, nets: Mapping[str, object]) -> Iterator[str]:
    """Contacts of different signals on one net."""
    on: dict[object, list[str]] = defaultdict(list)
    for number, net in nets.items():
        if net not in ("", None):
            on[net].append(number)
    for numbers in on.values():
        carried = sorted({contacts[number].carries for number in numbers})
        if len(carried) > 1:
            yield f"contacts {', '.join(numbers)} join {' and '.join(carried)}"


def _led(
    read: ReadAuxiliary, contacts: Contacts, groups: Mapping[str, int | None]
) -> Iterator[str]:
    """Contacts that lead to the board's supply or ground and must not, or must and do not, and
    open ones that lead anywhere."""
    ends = {"supply": read.group(*_SUPPLY), "ground": read.group(*_GROUND)}
    for number, group in groups.items():
        contact = contacts[number]
        for kind, end in ends.items():
            if (group == end) != (contact.kind == kind):
                leads = "leads" if group == end else "does not lead"
                yield f"contact {number} ({contact.carries}) {leads} to the board's {kind}"
        if contact.kind == "open" and (read.clusters.label == group).sum() != 1:
            yield f"contact {number} is joined to something; it is to be left open"


LAND_MM = 0.001
EDGE_MM = 0.002
HOLE_MM = 0.01
HOT_LOOP_MM2 = 6.0
"""A loop of about 5 mm² is what a TSOT26 with an 0603 beside it can have."""
HOT_TRACK_MM = 3.0
GROUND_SHARE = 80.0  # of the loop, in percent
ANTENNA_EDGE_MM = 0.5
NAME_MM = 3.0  # from a pad to the name beside it, at most
LETTER = 0.6  # width of a letter at least, of its height


def measure_edge(read: ReadAuxiliary) -> Iterator[Measurement]:
    """The edge against the auxiliary board's box."""
    box = read.auxiliary.box
    left, low, right, high = read.outline.bounds
    (x_min, y_max), (x_max, y_min) = read.sensor([(left, low), (right, high)])
    off = [x_min - box.x_min_mm, x_max - box.x_max_mm, y_min - box.y_min_mm, y_max - box.y_max_mm]
    yield read.figure("outline", np.abs(off).max(), 0, EDGE_MM)


def measure_screws(read: ReadAuxiliary) -> Iterator[Measurement]:
    """Screw holes: how many, where, how wide."""
    wanted, found = read.auxiliary.holes, read.sensor([hole.at for hole in read.screws])
    yield read.figure("hole_count", len(found), len(wanted), len(wanted), "holes")
    if not wanted:
        return
    apart = np.hypot(*(np.array(wanted)[:, None] - found[None]).transpose(2, 0, 1))
    yield read.figure("holes", apart.min(axis=1).max() if found.size else math.nan, 0, HOLE_MM)
    off = [abs(hole.drill_mm - read.auxiliary.hole_mm) for hole in read.screws]
    yield read.figure("hole_width", max(off, default=math.nan), 0, HOLE_MM, note="from the design")


def measure_lands(read: ReadAuxiliary) -> Iterator[Measurement]:
    """Every pad of every part: its place, its size and its hole."""
    devices = {device.ref: device for device in read.auxiliary.components}
    others = [p.ref for p in read.board.parts if p.ref not in devices and _has_copper(p)]
    yield read.count("other_parts", others, "parts")
    off = {ref: _off_mm(read, device, read.parts.get(ref)) for ref, device in devices.items()}
    worst = max(off, key=lambda ref: math.inf if math.isnan(off[ref]) else off[ref])
    yield read.figure("lands", off[worst], 0, LAND_MM, note=f"worst at {worst}")


def measure_joined(read: ReadAuxiliary) -> Iterator[Measurement]:
    """Pads that the design joins, followed along the copper, and pads that it does not."""
    pads: dict[str, dict[int | None, list[str]]] = defaultdict(lambda: defaultdict(list))
    owners: dict[int, set[str]] = defaultdict(set)
    for device in read.auxiliary.components:
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


def measure_supplies(read: ReadAuxiliary) -> Iterator[Measurement]:
    """Width of the tracks of supplies, which are wide but where ground's pour does the work."""
    wide = {net for net in read.auxiliary.supplies if net != "GND"}
    widths = [c.width_mm for c in read.board.loose if c.kind == "track" and c.net in wide]
    least = read.design.rules.supply_track_mm
    yield read.figure("supply_width", min(widths, default=math.nan), least, math.inf)


def measure_hot_loop(read: ReadAuxiliary) -> Iterator[Measurement]:
    """The loop in which a regulator's current jumps: its area, and the ground under it."""
    if not read.auxiliary.hot_loop:
        return
    pads = [_terminal(read, ref, number) for ref, number in read.auxiliary.hot_loop]
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
    reach = _copper_mm(read, *read.auxiliary.hot_loop[0], *read.auxiliary.hot_loop[1])
    yield read.figure("hot_loop_input", reach, 0, HOT_TRACK_MM, note="of track to the capacitor")


def measure_keep_outs(read: ReadAuxiliary) -> Iterator[Measurement]:
    """Copper under an antenna, on whatever layer, and how far the antenna is from the edge."""
    boxes = read.auxiliary.keep_outs
    if not boxes:
        return
    areas = [_on_page(box) for box in boxes]
    whole = shapely.union_all(areas)
    pieces = [(piece, piece.area.intersection(whole).area) for piece in read.board.copper()]
    inside = [f"{piece.kind} of {piece.net or 'no net'}" for piece, mm2 in pieces if mm2 > 0]
    covered = sum(mm2 for _, mm2 in pieces)
    yield read.figure("keep_out", covered, 0, 0, "mm²", "; ".join(inside[:4]) or "of copper")
    ruled = shapely.union_all([area.buffer(LAND_MM) for area in read.board.keep_outs])
    open_mm2 = whole.difference(ruled).area
    yield read.figure("keep_out_rule", open_mm2, 0, 0, "mm²", "that KiCad may fill again")
    gap = min(area.distance(read.outline.boundary) for area in areas)
    yield read.figure("antenna_edge", gap, 0, ANTENNA_EDGE_MM, note="to the board's edge")


def measure_names(read: ReadAuxiliary) -> Iterator[Measurement]:
    """The name beside each contact: of all that is printed but references, the nearest, by where
    the word ends and not by its middle."""
    refs = {device.ref for device in read.auxiliary.components}
    printed = [w for w in read.board.silk.words if w.front and w.text not in refs]
    lines = [_line(read, word) for word in printed]
    wrong = []
    for device in (d for d in read.auxiliary.components if d.contacts):
        for land, name in zip(device.footprint.pads, device.pins, strict=False):
            apart = shapely.distance(lines, shapely.Point(_placed(device, land)))
            nearest = int(apart.argmin()) if apart.size else -1
            if nearest < 0 or printed[nearest].text != name or apart[nearest] > NAME_MM:
                wrong.append(f"{device.ref}.{land.number} is not called {name}")
    yield read.count("names", wrong, "contacts")


def _line(read: ReadAuxiliary, word: Word) -> shapely.LineString:
    """Along the middle of a word, from its first letter to its last."""
    turn, half = math.radians(word.angle_deg), LETTER * word.height_mm * len(word.text) / 2
    along = half * np.array([math.cos(turn), -math.sin(turn)])  # the page's y points down
    return shapely.LineString(read.sensor([word.at - along, word.at + along]))


def _terminal(read: ReadAuxiliary, ref: str, number: str) -> Terminal | None:
    part = read.parts.get(ref)
    return next((t for t in part.terminals if t.number == number), None) if part else None


def _copper_mm(read: ReadAuxiliary, ref: str, number: str, other: str, pad: str) -> float:
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


def _on_page(box: Box) -> shapely.Polygon:
    left, low = on_board_page((box.x_min_mm, box.y_max_mm))
    right, high = on_board_page((box.x_max_mm, box.y_min_mm))
    return shapely.box(left, low, right, high)


def _has_copper(part: Part) -> bool:
    return any(t.copper is not None for t in part.terminals)


def _off_mm(read: ReadAuxiliary, device: Component, part: Part | None) -> float:
    """Worst place, size or hole of a part's pads; NaN if one is missing or there are more."""
    lands = device.footprint.pads
    there = part is not None and part.front == (device.side == "front")
    found = {t.number: t for t in part.terminals} if part and there else {}
    if set(found) != {land.number for land in lands} or part is None:
        return math.nan
    if len(part.terminals) != len(lands):
        return math.nan
    return float(np.max([_pad_off_mm(read, device, land, found[land.number]) for land in lands]))


def _pad_off_mm(read: ReadAuxiliary, device: Component, land: Pad, pad: Terminal) -> float:
    if pad.copper is None:
        return math.nan
    x, y = read.sensor([pad.at])[0]
    turned = round(device.angle_deg / 90) % 2
    size = (land.height_mm, land.width_mm) if turned else (land.width_mm, land.height_mm)
    left, low, right, high = pad.copper.area.bounds
    off: float = max(
        math.dist((x, y), _placed(device, land)),
        abs(pad.drill_mm - land.drill_mm),
        abs(right - left - size[0]),
        abs(high - low - size[1]),
    )
    return off


def _placed(device: Component, land: Pad) -> Point:
    turn = math.radians(device.angle_deg)
    c, s = math.cos(turn), math.sin(turn)
    x = -land.x_mm if device.side == "back" else land.x_mm
    return (device.x_mm + x * c - land.y_mm * s, device.y_mm + x * s + land.y_mm * c)
