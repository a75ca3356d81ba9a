"""The boards' KiCad files against the design: one list of measures, each of which applies to the
boards that have what it measures."""

import math
import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import shapely

from lumitip_fab.checks import board_copper, board_noise
from lumitip_fab.checks.board_circuit import (
    measure_channels,
    measure_contact_map,
    measure_passed_on,
)
from lumitip_fab.checks.board_current import measure_warming
from lumitip_fab.checks.board_finger import measure_cell_prints, measure_cells, measure_flexible
from lumitip_fab.checks.board_headers import measure_shrouds, measure_sockets
from lumitip_fab.checks.board_indicator import measure_bulk, measure_indicator
from lumitip_fab.checks.board_order import measure_wire_order
from lumitip_fab.checks.board_probes import measure_probes
from lumitip_fab.checks.board_protection import measure_protection
from lumitip_fab.checks.board_read import ReadBoard, names_of, path_of, placed, read_any
from lumitip_fab.checks.board_silk import measure_labels, measure_prints, measure_targets
from lumitip_fab.checks.board_silk_bodies import measure_bodies
from lumitip_fab.checks.board_strings import measure_strings, measure_switch
from lumitip_fab.checks.board_ties import measure_ties
from lumitip_fab.checks.feed import measure_feed
from lumitip_fab.checks.plug_in import measure_plug_in
from lumitip_fab.checks.readers.kicad_board import Part, Terminal
from lumitip_fab.checks.result import Measure, Measurement, measured, unreadable
from lumitip_fab.checks.settling import measure_settling
from lumitip_fab.checks.title_blocks import measure_title_block
from lumitip_fab.design import Component, Design, Footprint, Pad, Relief, footprints
from lumitip_fab.design.shape import Side
from lumitip_fab.errors import OutputError

READS = ("boards/*.kicad_pcb",)
EDGE_MM = 0.002
HOLE_MM = 0.01
LAND_MM = 0.001
WIRE_MM = 0.001
_HEIGHT = re.compile(r"X(\d+)(?:-\d+)?N$")  # of an IPC-7351 name, in hundredths
_FLAT = ("TestPoint", "Fiducial", "WirePads", "MountingHole")


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every figure of every board."""
    for name in names_of(design):
        yield from measure_board(outputs, design, name)


def measure_board(outputs: Path, design: Design, name: str) -> Iterator[Measurement]:
    """Every figure of one board."""
    try:
        read = read_any(outputs, design, name)
    except OutputError as error:
        yield unreadable("board.readable", path_of(name), str(error))
        return
    yield read.figure("readable", len(read.board.parts), 1, float("inf"), "parts")
    yield from measured(MEASURES, read)


def measure_outline(read: ReadBoard) -> Iterator[Measurement]:
    """The edge against the board's box; of a finger's board also the gap to the pocket."""
    box = read.box
    left, low, right, high = read.outline.bounds
    (x_min, y_max), (x_max, y_min) = read.sensor([(left, low), (right, high)])
    off = [x_min - box.x_min_mm, x_max - box.x_max_mm, y_min - box.y_min_mm, y_max - box.y_max_mm]
    yield read.figure("outline", np.abs(off).max(), 0, EDGE_MM)
    if read.finger is None:
        return
    pocket, clearance = read.design.board.pocket, read.design.board.pocket_clearance_mm
    gaps = [
        x_min - pocket.x_min_mm,
        pocket.x_max_mm - x_max,
        y_min - pocket.y_min_mm,
        pocket.y_max_mm - y_max,
    ]
    worst = max(gaps, key=lambda gap: abs(gap - clearance))
    yield read.figure("pocket_gap", worst, clearance - EDGE_MM, clearance + EDGE_MM)


def measure_holes(read: ReadBoard) -> Iterator[Measurement]:
    """The unplated holes for pins or screws: how many, where, how wide; and room round pins."""
    wanted, found = read.of.holes, read.sensor([hole.at for hole in read.screws])
    yield read.figure("hole_count", len(found), len(wanted), len(wanted), "holes")
    if not wanted:
        return
    apart = np.hypot(*(np.array(wanted)[:, None] - found[None]).transpose(2, 0, 1))
    off = apart.min(axis=1).max() if found.size else math.nan
    yield read.figure("holes", off, 0, HOLE_MM, note="from the design's pins or screws")
    wide = [abs(hole.drill_mm - read.hole_mm) for hole in read.screws]
    yield read.figure("hole_width", max(wide, default=math.nan), 0, HOLE_MM, note="from the design")
    if read.finger is None:
        return
    pin_mm = read.design.board.pin_mm
    room, least = (
        [(hole.drill_mm - pin_mm) / 2 for hole in read.screws],
        (read.hole_mm - pin_mm) / 2,
    )
    worst = max(room, key=lambda gap: abs(gap - least), default=math.nan)
    yield read.figure("pin_clearance", worst, least - EDGE_MM, least + EDGE_MM)


def measure_lands(read: ReadBoard) -> Iterator[Measurement]:
    """Every pad of every part: its place, its size and its hole. Where the design has no places of
    parts, they are where the file has them, and their pads as the footprint has them."""
    if read.components:
        refs = {device.ref for device in read.components}
        others = [p.ref for p in read.board.parts if p.ref not in refs and _has_copper(p)]
        yield read.count("other_parts", others, "parts")
        wanted: dict[str, Component | None] = {device.ref: device for device in read.components}
    else:
        shapes = footprints_of(read)
        wanted = {p.ref: as_it_lies(read, p, shapes) for p in read.board.parts if _has_copper(p)}
    off = {ref: _off_mm(read, device, read.parts.get(ref)) for ref, device in wanted.items()}
    worst = max(off, key=lambda ref: math.inf if math.isnan(off[ref]) else off[ref])
    yield read.figure("lands", off[worst], 0, LAND_MM, note=f"worst at {worst}")


def footprints_of(read: ReadBoard) -> dict[str, Footprint]:
    """Footprints of a board's parts, by name."""
    shapes = [shape for _, shape in footprints.of_design(read.design)]
    shapes += [footprints.dot("TestPoint"), footprints.dot("Fiducial")]
    if read.finger:
        row = read.finger.connector
        ways = len(row.signals)
        shapes.append(footprints.row("WirePads", ways, row.pitch_mm, row.pad_mm, row.drill_mm))
    return {shape.name: shape for shape in shapes}


def as_it_lies(read: ReadBoard, part: Part, shapes: dict[str, Footprint]) -> Component | None:
    """A part where the file has it, with the footprint of its name; none if there is no such."""
    if part.footprint not in shapes:
        return None
    x_mm, y_mm = read.sensor([part.at])[0].tolist()
    side: Side = "front" if part.front else "back"
    angle_deg = part.angle_deg - (0.0 if part.front else 180.0)  # KiCad turns what it mirrors in y
    shape = shapes[part.footprint]
    return Component(part.ref, part.value, "", "", shape, x_mm, y_mm, angle_deg, side, ())


def _has_copper(part: Part) -> bool:
    return any(t.copper is not None for t in part.terminals)


def _off_mm(read: ReadBoard, device: Component | None, part: Part | None) -> float:
    """Worst place, size or hole of a part's pads; NaN if one is missing or there are more."""
    if device is None:
        return math.nan
    lands = device.footprint.pads
    there = part is not None and part.front == (device.side == "front")
    found = {t.number: t for t in part.terminals} if part and there else {}
    if set(found) != {land.number for land in lands} or part is None:
        return math.nan
    if len(part.terminals) != len(lands):
        return math.nan
    return float(np.max([_pad_off_mm(read, device, land, found[land.number]) for land in lands]))


def _pad_off_mm(read: ReadBoard, device: Component, land: Pad, pad: Terminal) -> float:
    if pad.copper is None:
        return math.nan
    x, y = read.sensor([pad.at])[0]
    turned = round(device.angle_deg / 90) % 2
    size = (land.height_mm, land.width_mm) if turned else (land.width_mm, land.height_mm)
    left, low, right, high = pad.copper.area.bounds
    off: float = max(
        math.dist((x, y), placed(device, land)),
        abs(pad.drill_mm - land.drill_mm),
        abs(right - left - size[0]),
        abs(high - low - size[1]),
    )
    return off


def measure_wires(read: ReadBoard) -> Iterator[Measurement]:
    """The pads for a cable's wires, in the design's order."""
    if read.finger is None:
        return
    wanted = np.array(read.finger.connector.pads)
    part = read.parts.get("J1")
    found = {t.number: t.at for t in part.terminals} if part else {}
    pads = [found.get(str(i + 1), (math.nan, math.nan)) for i in range(len(wanted))]
    off = np.hypot(*(read.sensor(pads) - wanted).T)
    yield read.figure("wires", off.max() if len(found) == len(wanted) else math.nan, 0, WIRE_MM)


def measure_heights(read: ReadBoard) -> Iterator[Measurement]:
    """Heights of the parts by their footprints' names: those on the front at most the silicone's
    thickness, those on the back with room to the walls and the floor of their relief."""
    if (finger := read.finger) is None:
        return
    tall = {part.ref: _height_mm(part) for part in read.board.parts if part.terminals}
    front = [tall[p.ref] for p in read.board.parts if p.terminals and p.front]
    highest = max(front, key=lambda h: math.inf if math.isnan(h) else h, default=math.nan)
    yield read.figure("height_front", highest, 0, read.design.stack.silicone_mm)
    spare = [
        _spare_mm(read, finger.reliefs, part, tall[part.ref])
        for part in read.board.parts
        if part.terminals and not part.front and tall[part.ref] != 0
    ]
    if spare or finger.reliefs:
        least = min(spare, key=lambda s: -math.inf if math.isnan(s) else s, default=math.nan)
        yield read.figure("room_behind", least, 0, math.inf, note="left round parts on the back")


def _height_mm(part: Part) -> float:
    """By the footprint's name; bare copper has none, NaN if the name does not give it."""
    if part.footprint.startswith(_FLAT):
        return 0.0
    height = _HEIGHT.search(part.footprint)
    return int(height[1]) / 100 if height else math.nan


def _spare_mm(read: ReadBoard, reliefs: tuple[Relief, ...], part: Part, height_mm: float) -> float:
    """Least room between a part on the back and the walls and floor of its relief."""
    copper = [t.copper.area for t in part.terminals if t.copper is not None]
    left, low, right, high = shapely.union_all(copper).bounds
    (x_min, y_max), (x_max, y_min) = read.sensor([(left, low), (right, high)])
    spares = [
        min(
            x_min - r.box.x_min_mm,
            r.box.x_max_mm - x_max,
            y_min - r.box.y_min_mm,
            r.box.y_max_mm - y_max,
            r.depth_mm - height_mm,
        )
        for r in reliefs
    ]
    return float(max(spares, default=math.nan))


MEASURES: tuple[Measure[ReadBoard], ...] = (
    measure_outline,
    measure_holes,
    measure_ties,
    measure_cells,
    measure_lands,
    measure_wires,
    measure_wire_order,
    measure_heights,
    board_copper.measure_copper,
    board_copper.measure_nets,
    board_copper.measure_joined,
    board_copper.measure_spokes,
    board_noise.measure_bypass_vias,
    board_copper.measure_supplies,
    measure_warming,
    board_copper.measure_hot_loop,
    board_noise.measure_crystal,
    board_copper.measure_keep_outs,
    measure_prints,
    measure_labels,
    measure_bodies,
    measure_cell_prints,
    measure_targets,
    measure_flexible,
    measure_strings,
    measure_switch,
    measure_channels,
    measure_bulk,
    measure_settling,
    measure_contact_map,
    measure_passed_on,
    measure_plug_in,
    measure_feed,
    measure_indicator,
    measure_probes,
    measure_protection,
    measure_shrouds,
    measure_sockets,
    measure_title_block,
)
"""Each applies to the boards that have what it measures: a finger's cells, the contacts of a
coupling, a regulator's hot loop, an antenna's keep-out, flexible layers …"""
