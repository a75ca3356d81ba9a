"""Pads to hold a probe to, on the boards outside the fingers: test points and named wire pads."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import shapely
from shapely import affinity
from shapely.geometry.base import BaseGeometry

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.board_ties import bodies_of
from lumitip_fab.checks.readers.kicad_board import Terminal
from lumitip_fab.checks.result import Measurement

GROUND = "GND"
PROBE_MM, WIRE_PAD_MM = 1.5, 1.0
"""Least width of a test point, and of a wire pad, which the wire's solder makes higher."""
ROOM_MM = 0.25
"""From such a pad to the body of any part, at least: the tip of a probe is round."""
NAME_MM = 3.0
"""From its middle to its name, at most."""
LETTER = 0.6
"""Width of a letter at least, of its height."""
_NOISE_MM = 1e-3


@dataclass(frozen=True)
class _Probe:
    """A pad where the design has it, as the file has it."""

    ref: str
    net: str
    name: str
    """Beside a wire pad the wire's name, which a supply has before and behind the board's fuse."""
    least_mm: float
    pad: Terminal | None


def measure_probes(read: ReadBoard) -> Iterator[Measurement]:
    """A pad for each supply that leaves the board, for ground and for each data line of a tool's
    coupling: on the open face, wide enough, clear of bodies, and with its name beside it."""
    if read.auxiliary is None:
        return
    wanted, bodies = _wanted(read), list(bodies_of(read))
    found = [probe for net in wanted for probe in _probes(read, net)]
    good = [probe for probe in found if _reached(read, probe)]
    missing = [net for net in wanted if not any(probe.net == net for probe in good)]
    yield read.count("probes", missing, "nets without a pad for a probe")
    taken = shapely.union_all(bodies)
    best = [_best(taken, [probe for probe in good if probe.net == net]) for net in wanted]
    note = "beyond the least width of a test point or a wire pad"
    wide = min((beyond for beyond, _ in best), default=math.nan)
    yield read.figure("probe_width", wide, -_NOISE_MM, math.inf, note=note)
    if bodies:
        room = min((room for _, room in best), default=math.nan)
        yield read.figure("probe_room", room, ROOM_MM, math.inf, note="to the nearest body")
    unnamed = [f"{p.ref} has no {p.name} beside it" for p in found if not _named(read, p)]
    yield read.count("probe_names", unnamed, "pads")


def _wanted(read: ReadBoard) -> list[str]:
    """Nets that need a pad: supplies on contacts of cables and couplings, those that a regulator
    makes, ground, and the data lines of a coupling that are not left open."""
    board = read.auxiliary
    assert board is not None
    cables = (part for part in board.components if part.contacts and part.kind != "socket")
    leaving = {net for part in cables if part.pins for _, net in part.nets}
    nets = [net for net in board.supplies if net in leaving]
    for part in board.components:
        named = dict(zip((pad.number for pad in part.footprint.pads), part.pins, strict=False))
        nets += [net for pad, net in part.nets if part.kind == "regulator" and named[pad] == "OUT"]
    for flange in (f for f in read.design.flanges if f.auxiliary == read.name):
        contacts = next(dict(part.nets) for part in board.components if part.ref == "J1")
        nets += [
            contacts[contact.number]
            for contact in flange.contacts
            if contact.kind == "data" and contact.number in contacts
        ]
    return list(dict.fromkeys([GROUND, *nets]))


def _probes(read: ReadBoard, net: str) -> Iterator[_Probe]:
    """Test points and named wire pads of a net by the design."""
    for part in read.components:
        if part.kind == "test point" or (part.kind == "wires" and part.pins):
            least = PROBE_MM if part.kind == "test point" else WIRE_PAD_MM
            terminals = read.parts[part.ref].terminals if part.ref in read.parts else ()
            pads = {t.number: t for t in terminals if t.copper is not None}
            names = part.pins or tuple(on for _, on in part.nets)
            for (number, on), name in zip(part.nets, names, strict=True):
                if on == net:
                    yield _Probe(part.ref, net, name, least, pads.get(number))


def _reached(read: ReadBoard, probe: _Probe) -> bool:
    """Whether its copper is on the open face, joined to its net, and not under a controller."""
    pad = probe.pad
    if pad is None or pad.copper is None or read.board.layers[0] not in pad.copper.layers:
        return False
    joined = read.clusters.of(pad.copper) in _groups(read, probe)
    return joined and not _covered(read).contains(shapely.Point(pad.at))


def _best(bodies: BaseGeometry, probes: list[_Probe]) -> tuple[float, float]:
    """Of the pad of a net with most room: its width beyond the least, and its room to bodies."""
    areas = [(p, p.pad.copper.area) for p in probes if p.pad is not None and p.pad.copper]
    rooms = [(_width_mm(area) - p.least_mm, float(bodies.distance(area))) for p, area in areas]
    return max(rooms, key=lambda each: each[1], default=(math.nan, math.nan))


def _groups(read: ReadBoard, probe: _Probe) -> set[int | None]:
    """The copper of its net, by the pads of other parts."""
    return {
        read.group(part.ref, number)
        for part in read.components
        if part.ref != probe.ref
        for number, on in part.nets
        if on == probe.net
    } - {None}


def _covered(read: ReadBoard) -> BaseGeometry:
    """Where a controller lies in its sockets."""
    places = [
        terminal.at
        for part in read.components
        if part.kind == "socket" and part.ref in read.parts
        for terminal in read.parts[part.ref].terminals
    ]
    return shapely.MultiPoint(places).envelope


def _width_mm(area: BaseGeometry) -> float:
    left, low, right, high = area.bounds
    return float(min(right - left, high - low))


def _named(read: ReadBoard, probe: _Probe) -> bool:
    """Whether its name is printed beside it, on its side."""
    if probe.pad is None:
        return False
    at = shapely.Point(probe.pad.at)
    for word in read.board.silk.words:
        if word.text == probe.name and word.front:
            half = LETTER * word.height_mm * len(word.text) / 2
            flat = shapely.LineString([(-half, 0), (half, 0)])
            turned = affinity.rotate(flat, -word.angle_deg, origin=(0, 0))
            if affinity.translate(turned, *word.at).distance(at) <= NAME_MM:
                return True
    return False
