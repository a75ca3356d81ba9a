"""Where the parts of a board are."""

import dataclasses

from lumitip_fab.boards import spots
from lumitip_fab.boards.circuit import (
    cathodes_of,
    circuit,
    gap_at_cells_mm,
    supply_of,
    turn_strings,
)
from lumitip_fab.boards.model import (
    GROUND,
    MIN_WIDTH_MM,
    SIGNAL,
    SUPPLY,
    THERMAL_GAP_MM,
    Cells,
    Net,
    NetClass,
    PlacedComponent,
    Placement,
)
from lumitip_fab.boards.placed import courtyard, pad_at
from lumitip_fab.boards.silk.legend import with_legend
from lumitip_fab.boards.silk.outlines import with_outline, without_crowded_lines
from lumitip_fab.design import (
    AuxiliaryBoard,
    Box,
    Design,
    Finger,
    Part,
    Point,
    Rules,
    Side,
)
from lumitip_fab.design.board_rules import rules_of
from lumitip_fab.design.pull_ups import used_slots
from lumitip_fab.errors import BuildError

CORNER_MM = 0.5
_POUR_BETWEEN_MM = 2 * THERMAL_GAP_MM + MIN_WIDTH_MM
"""Wire pad to test point: the ground pour passes between them, so that both get bridges. Where
tracks are thinner than the pour, the board is crowded and the tracks need the room more."""
PASSIVE_GAP_MM = 0.6
"""Multiplexer to the capacitor and pull-up beside it, where there is room. With arrays of pull-ups
between them the capacitor is as near as it can be."""
_NOISE_MM = 1e-6


def place(design: Design, board: Finger | AuxiliaryBoard) -> Placement:
    """A board with every part in its place, and its silkscreen.

    Raises:
        BuildError: if a part or a label has no room, with the numbers.
    """
    if isinstance(board, AuxiliaryBoard):
        return _printed(design, board)
    entry = design.packages.at_cells(board)
    gap_mm = gap_at_cells_mm(board, entry)
    cells = Cells(board.cells, design.reading.pitch_mm, entry, gap_mm)
    return _printed(design, finger_board(design, board), cells)


def _printed(design: Design, board: AuxiliaryBoard, cells: Cells | None = None) -> Placement:
    """A board whose parts are in their places, with outlines and legend."""
    rules, title, stack = rules_of(design, board.name), design.title, design.stack
    outlined = [with_outline(part, rules, cells) for part in board.components]
    spots.refuse_misplaced(board.name, outlined, inside=board.box if cells else None)
    bare = Placement(
        name=board.name,
        title=title.on_boards().name,
        revision=title.revision,
        date=title.date,
        design_hash=design.reading.design_hash,
        outline=board.box,
        corner_mm=board.corner_mm,
        holes=board.holes,
        hole_mm=board.hole_mm,
        ties=tuple((at, tie.hole_mm) for tie in board.ties for at in tie.holes),
        keep_outs=board.keep_outs,
        edge_clearance_mm=rules.edge_gap_mm,
        hole_clearance_mm=rules.hole_gap_mm,
        components=without_crowded_lines(outlined, rules),
        nets=tuple(Net(name, SUPPLY if name in board.supplies else SIGNAL) for name in board.nets),
        classes=tuple(
            NetClass(name, track_mm, rules.copper_gap_mm, rules.via_mm, rules.via_drill_mm)
            for name, track_mm in ((SIGNAL, rules.track_mm), (SUPPLY, rules.supply_track_mm))
        ),
        ground=GROUND,
        silk=(),
        texts=(),
        flexible=design.board.flexible if cells else None,
        ground_only=_hot_loop(board),
        caption=board.title,
        cells=cells,
        finish=board.finish,
        thickness_mm=stack.pcb_mm if cells else stack.auxiliary_mm,
    )
    return with_legend(bare, board.title_at, board.notes, rules)


def _hot_loop(board: AuxiliaryBoard) -> tuple[Box, ...]:
    """The box round the middles of the hot loop's pads; none without a regulator."""
    parts = {part.ref: part for part in board.components}
    places = [pad_at(parts[ref], number) for ref, number in board.hot_loop]
    if not places:
        return ()
    xs, ys = zip(*places, strict=True)
    return (Box(min(xs), max(xs), min(ys), max(ys)),)


def finger_board(design: Design, finger: Finger) -> AuxiliaryBoard:
    """A finger's board with every part in its place.

    Raises:
        BuildError: if a part has no room, with the numbers.
    """
    board, rules = design.board, rules_of(design, finger.name)
    parts = {part.ref: with_outline(part, rules) for part in circuit(design, finger)}
    kinds = {part.kind for part in parts.values()}
    named = {part.name: part for part in finger.parts}
    for ref, part in named.items():
        parts[ref] = _at(parts[ref], (part.x_mm, part.y_mm), side=part.side)
    if "led" in kinds:
        turn_strings(parts, finger, design.wiring, design.packages)
    if "multiplexer" in kinds:
        _round_multiplexers(parts, named, finger, design)
    _connector(parts, finger, rules)
    obstacles = [courtyard(part) for ref, part in parts.items() if not ref.startswith("FID")]
    mark = parts["FID1"].courtyard
    corners = spots.fiducials(board, obstacles, mark, finger.holes, rules.hole_gap_mm)
    for ref, at in zip(("FID1", "FID2", "FID3"), corners, strict=True):
        parts[ref] = _at(parts[ref], at)
    zone = next(zone.box for zone in finger.zones if zone.name == "cells")
    return AuxiliaryBoard(
        name=finger.name,
        title=f"{finger.name} board",
        title_at=zone.centre_mm,
        box=board.box,
        corner_mm=CORNER_MM,
        holes=finger.holes,
        hole_mm=board.hole_mm,
        ties=finger.ties,
        components=tuple(parts.values()),
        notes=(),
        supplies=tuple(dict.fromkeys((GROUND, supply_of(finger), *_lit_nets(design, kinds)))),
        keep_outs=(),
        hot_loop=(),
        finish=finger.finish,
    )


def _lit_nets(design: Design, kinds: set[str]) -> tuple[str, ...]:
    """The net that carries the current of all strings, on the board of the LEDs."""
    return (cathodes_of(design),) if "led" in kinds else ()


def _round_multiplexers(
    parts: dict[str, PlacedComponent],
    named: dict[str, Part],
    finger: Finger,
    design: Design,
) -> None:
    """Turn detectors with their nets to the left or to the connector; passives by each mux."""
    wiring, packages, rules = design.wiring, design.packages, design.rules
    towards = 90.0 if finger.turned else 0.0
    if packages.photodetector.marked != "collector":
        towards += 180.0
    for ref in [ref for ref in parts if ref.startswith("Q")]:
        parts[ref] = dataclasses.replace(parts[ref], angle_deg=towards)
    bulk = f"C{wiring.muxes + 1}"
    if bulk in named:
        parts[bulk] = dataclasses.replace(parts[bulk], angle_deg=270.0)
    zone = next(zone.box for zone in finger.zones if zone.name == "parts")
    muxes = [named[f"U{i + 1}"] for i in range(wiring.muxes)]
    taken = {mux.name: mux.box for mux in muxes}  # with its arrays
    if wiring.own_pull_ups:
        _arrays(parts, muxes, taken, design)
    for mux in muxes:
        before = [taken[u.name].x_max_mm for u in muxes if u.y_mm == mux.y_mm and u.x_mm < mux.x_mm]
        left = max(before, default=zone.x_min_mm - rules.part_gap_mm)
        beside = ("C", packages.multiplexer.supply, "1"), ("R", packages.multiplexer.output, "2")
        for letter, lead, outward in beside[: 1 if wiring.own_pull_ups else 2]:
            part = parts[letter + mux.name[1:]]
            up = lead > packages.multiplexer.leads // 2
            angle = 270.0 if up == (outward == "1") else 90.0
            _beside(parts, part, mux, (left, taken[mux.name].x_min_mm), up, angle, rules)


def _arrays(
    parts: dict[str, PlacedComponent], muxes: list[Part], taken: dict[str, Box], design: Design
) -> None:
    """Arrays of pull-ups to the right and left of their multiplexer, their inputs towards it."""
    gap_mm = design.rules.part_gap_mm
    packages = design.packages
    along, across = packages.array.over_pads_mm
    slots = used_slots(design.reading.cells, packages.multiplexer, packages.array)
    for number, (which, slot) in enumerate(slots, start=1):
        mux, ref = muxes[which], f"RN{number}"
        box = mux.box
        x = (box.x_max_mm if slot.side > 0 else box.x_min_mm) + slot.side * (gap_mm + across / 2)
        y = mux.y_mm + slot.end * (mux.size_y_mm - along) / 2
        parts[ref] = _at(parts[ref], (x, y), angle_deg=270.0 if slot.side > 0 else 90.0)
        wide = taken[mux.name]
        taken[mux.name] = dataclasses.replace(
            wide,
            x_min_mm=min(wide.x_min_mm, x - across / 2),
            x_max_mm=max(wide.x_max_mm, x + across / 2),
        )


def _beside(
    parts: dict[str, PlacedComponent],
    part: PlacedComponent,
    mux: Part,
    between: tuple[float, float],
    up: bool,
    angle_deg: float,
    rules: Rules,
) -> None:
    """Capacitor or pull-up to the left of a multiplexer, at the lead that it serves."""
    yard = part.courtyard.grown(-rules.part_gap_mm / 2)
    room_mm = between[1] - between[0]
    spare = room_mm - yard.length_mm
    if spare < 2 * rules.part_gap_mm - _NOISE_MM:
        raise BuildError(
            f"{part.ref} needs {yard.length_mm + 2 * rules.part_gap_mm:.2f} mm beside "
            f"{mux.name}, {room_mm:.2f} mm is there: widen the board (board.side_margin_mm) "
            "or choose a smaller package"
        )
    arrays_between = between[1] < mux.box.x_min_mm - _NOISE_MM
    gap = rules.part_gap_mm if arrays_between else min(PASSIVE_GAP_MM, spare / 2)
    reach = (mux.size_y_mm - yard.width_mm) / 2
    at = (between[1] - gap - yard.length_mm / 2, mux.y_mm + (reach if up else -reach))
    parts[part.ref] = _at(part, at, angle_deg=angle_deg)


def _connector(parts: dict[str, PlacedComponent], finger: Finger, rules: Rules) -> None:
    """The wire pads where the design has them, and a test point on the back behind each."""
    pads = finger.connector.pads
    parts["J1"] = _at(parts["J1"], ((pads[0][0] + pads[-1][0]) / 2, pads[0][1]))
    crowded = rules.track_mm < MIN_WIDTH_MM
    gap_mm = rules.part_gap_mm if crowded else max(rules.part_gap_mm, _POUR_BETWEEN_MM)
    for i, (x, y) in enumerate(pads, start=1):
        point = parts[f"TP{i}"]
        apart = (finger.connector.pad_mm + point.footprint.body.length_mm) / 2 + gap_mm
        parts[point.ref] = _at(point, (x, y + apart))


def _at(
    part: PlacedComponent, at: Point, angle_deg: float | None = None, side: Side | None = None
) -> PlacedComponent:
    return dataclasses.replace(
        part,
        x_mm=round(at[0], 6) + 0.0,
        y_mm=round(at[1], 6) + 0.0,
        angle_deg=part.angle_deg if angle_deg is None else angle_deg,
        side=side or part.side,
    )
