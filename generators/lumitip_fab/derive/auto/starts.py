"""First values of automatic fields: formulas and catalogue choices."""

import math
from collections.abc import Callable, Iterator

from lumitip_fab.config.automatic import Value, automatic_fields
from lumitip_fab.config.load import Input
from lumitip_fab.derive.auto.load import flare, load_case
from lumitip_fab.derive.auto.strings import choose_resistors, choose_strings
from lumitip_fab.derive.boards.connectors import POWER_WIRES
from lumitip_fab.derive.boards.feed import leaves_enough
from lumitip_fab.derive.boards.module import MOST_WIRES
from lumitip_fab.derive.boards.packages import LEAST_RING_MM
from lumitip_fab.derive.boards.plug_in import least_inrush_ohm
from lumitip_fab.derive.boards.supply_input import FUSE_SHARE, fed_ma
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.cells import bending_lines, lane_mm
from lumitip_fab.derive.finger.stack import is_flex, least_standoff_mm, mask_mm
from lumitip_fab.derive.finger.tip import plate_mm
from lumitip_fab.derive.mount.base import propose_flange
from lumitip_fab.derive.once import lay_out
from lumitip_fab.derive.wiring.ratings import (
    SUPPLY_TOLERANCE,
    sold_from,
    sold_ohm,
)
from lumitip_fab.derive.wiring.section import most_lit_ma
from lumitip_fab.errors import InputError

Proposal = tuple[str, Value, str]

MOST_SMALL = 8  # of the published multiplexer, which has 8 inputs
MOST_OWN_INPUTS = 16  # of a multiplexer with a pull-up for each
LINES_PER_WALL = 1.2  # slicers print a wall from there on with lines of variable width
FINE_MM = {"track": 0.15, "gap": 0.15, "via": 0.45, "drill": 0.2}
"""Copper for dense boards, which common PCB fabs make without extra cost."""
LEAST_DRILL_MM = 0.15  # what `board.via_drill_mm` allows
ROOMY_CHANNEL_MM = 4.0
WIDE_CHANNEL_MM = 5.0
MOST_BENT_LINES = 64
"""Of a board that bends, in a roomy channel. Its lines cannot cross where it bends, so the channel
sorts them all: 72 lines were not routed in a roomy one, and were in a wide one. Where the limit is
between these is not known."""
LEAST_EDGE_GAP_MM = 0.25  # that common PCB fabs keep from copper to a routed edge
LANE_USE = 0.8  # share of the lane between two columns that tracks can fill


def proposals() -> tuple[Callable[[Input], Iterator[Proposal]], ...]:
    """The formulas, in the order of their dependencies."""
    return (
        _layers,
        _printer,
        _multiplexer,
        _copper,
        _load,
        choose_strings,
        _vias,
        _channel,
        _room_of_sources,
        propose_flange,
        _flange,
        _feed,
        _standoff,
        _interface,
        load_case,
        flare,
    )


def _layers(config: Input) -> Iterator[Proposal]:
    p, parts = config.parameters, config.catalogue
    thick_mm, what = mask_mm(config)
    yield "stack.film_mm", thick_mm, f"thickness of {what}"
    filament = parts.filaments[p.backing.material]
    yield "backing.density_g_ml", filament.density_g_ml, f"density of {p.backing.material}"


def _printer(config: Input) -> Iterator[Proposal]:
    p = config.parameters
    line = config.parts.printer.profile.line_mm
    wall = max(
        float(automatic_fields()["printer.min_wall_mm"].start), round(LINES_PER_WALL * line, 2)
    )
    yield "printer.min_wall_mm", wall, f"{LINES_PER_WALL:g} lines of {line:g} mm, at least 0.8 mm"
    edge = max(float(automatic_fields()["tip.edge_mm"].start), line)
    yield "tip.edge_mm", edge, f"one line of {line:g} mm, at least 0.45 mm"
    wall = p.printer.min_wall_mm
    plate = plate_mm(p)
    slant = math.ceil(10 * (plate - p.tip.edge_mm) - 1e-6) / 10
    if slant > float(automatic_fields()["tip.slant_start_mm"].start):
        yield "tip.slant_start_mm", slant, f"a plate of {plate:g} mm at 45°"
    floor = max(float(automatic_fields()["stack.floor_mm"].start), wall)
    yield "stack.floor_mm", floor, f"at least printer.min_wall_mm = {wall:g}"
    mould = max(float(automatic_fields()["mould.wall_mm"].start), round(2 * wall, 2))
    yield "mould.wall_mm", mould, f"at least twice printer.min_wall_mm = {wall:g}"


def _multiplexer(config: Input) -> Iterator[Proposal]:
    """The published multiplexer where the controller has pins for it, and a module's board room
    for its wires, else one with more inputs; the one with most where there is room for none. Pins
    with pull-ups count when the others are too few for any. Without a limit of pins, the larger one
    is taken from `MOST_SMALL` on: half as many parts, and tracks between them."""
    p, parts = config.parameters, config.catalogue
    cells, controller = sum(p.grid.columns), parts.controllers[p.controller.board]
    start = str(automatic_fields()["receiver.multiplexer"].start)
    known = sorted(
        parts.multiplexers.items(), key=lambda item: (item[0] != start, item[1].channels)
    )
    every = len(controller.inputs)
    for pins in (every - len(controller.pulled_up_ohm), every):
        for name, mux in known:
            needed = math.ceil(cells / mux.channels)
            most = MOST_SMALL if name == start else math.inf
            read = needed <= (most if controller.unlimited_analog_pins else pins)
            wired = not controller.module or POWER_WIRES + len(mux.select) + needed <= MOST_WIRES
            if read and wired and len(mux.select) <= len(controller.select_pins):
                reason = (
                    f"{needed} of them read {cells} cells; {p.controller.board} has pins for them"
                )
                yield "receiver.multiplexer", name, reason
                return
    name, mux = known[-1]
    yield "receiver.multiplexer", name, f"its {mux.channels} inputs are the most"


def _copper(config: Input) -> Iterator[Proposal]:
    """Fine tracks where the signals of a column do not fit beside it with normal tracks."""
    p, parts = config.parameters, config.catalogue
    columns = p.grid.columns
    detector = parts.photodetectors[p.receiver.photodetector]
    lines = bending_lines(p) if is_flex(p) else max(columns)
    lane = lane_mm(p, detector)
    needed = lines * (p.board.track_mm + p.board.copper_gap_mm)
    if needed <= LANE_USE * lane or max(columns) <= 1:
        return
    reason = (
        f"{lines} lines leave a column through a lane of {lane:.2f} mm: "
        f"{needed:.2f} mm at tracks of {p.board.track_mm:g} and gaps of {p.board.copper_gap_mm:g} "
        f"mm, {100 * LANE_USE:g} % of it can be used"
    )
    yield "board.track_mm", FINE_MM["track"], reason
    yield "board.copper_gap_mm", FINE_MM["gap"], reason
    yield "board.via_mm", FINE_MM["via"], reason
    yield "board.via_drill_mm", FINE_MM["drill"], reason


def _load(config: Input) -> Iterator[Proposal]:
    """A pull-up for each photodetector where they have room beside the multiplexers."""
    p, parts = config.parameters, config.parts
    usual = float(automatic_fields()["board.track_mm"].start)
    if p.board.track_mm < usual:
        yield (
            "receiver.load",
            "shared",
            f"tracks of {p.board.track_mm:g} mm leave no room for the pull-ups of each "
            "photodetector. Readings in the dark settle slowly",
        )
    elif parts.receiver.multiplexer.channels > MOST_OWN_INPUTS:
        yield "receiver.load", "shared", f"more than {MOST_OWN_INPUTS} inputs of a multiplexer"
    else:
        yield "receiver.load", "each", "a reading settles in the dark as well"


def _vias(config: Input) -> Iterator[Proposal]:
    """Via diameter for the drill in the file, or drill for the diameter, and supply tracks at
    least as wide as signal tracks."""
    board = config.parameters.board
    ring = 2 * LEAST_RING_MM
    if board.via_mm < board.via_drill_mm + ring:
        reason = f"copper of {LEAST_RING_MM:g} mm all round a hole"
        yield "board.via_mm", round(board.via_drill_mm + ring, 3), reason
        if "board.via_mm" not in config.automatic and board.via_mm - ring >= LEAST_DRILL_MM:
            yield "board.via_drill_mm", round(board.via_mm - ring, 3), reason
    if board.supply_track_mm < board.track_mm:
        yield (
            "board.supply_track_mm",
            board.track_mm,
            f"at least board.track_mm = {board.track_mm:g}",
        )


def _channel(config: Input) -> Iterator[Proposal]:
    p = config.parameters
    channels = config.parts.receiver.multiplexer.channels
    muxes = math.ceil(sum(p.grid.columns) / channels)
    fine = p.board.track_mm < float(automatic_fields()["board.track_mm"].start)
    lines = sum(p.grid.columns)
    reason = f"room to sort {lines} lines before {muxes} multiplexers"
    if is_flex(p) and lines > MOST_BENT_LINES:
        yield "board.channel_mm", WIDE_CHANNEL_MM, reason
    elif muxes > 4 or fine:
        yield "board.channel_mm", ROOMY_CHANNEL_MM, reason
    if fine and p.board.panel == "none":  # mouse bites reach into a board of a panel
        yield "board.edge_gap_mm", LEAST_EDGE_GAP_MM, reason


def _room_of_sources(config: Input) -> Iterator[Proposal]:
    """Resistors instead of current sources where these have no room on a first layout."""
    if "emitter.drive" not in config.automatic or config.parameters.emitter.drive != "source":
        return
    faults = Diagnostics(config)
    try:
        lay_out(config, faults)
    except InputError:
        return
    crowded = [p.message for p in faults.problems if p.field == "emitter.source"]
    if crowded:
        yield from choose_resistors(
            config, f"otherwise emitter.source {crowded[0].partition('. ')[0]}"
        )


def _standoff(config: Input) -> Iterator[Proposal]:
    """The interface's pad before the gripper's nose; its ramp, and so its length, follow."""
    if not is_flex(config.parameters):
        return
    usual = automatic_fields()["flex.standoff_mm"]
    least = round(math.ceil(least_standoff_mm(config) / usual.step - 1e-6) * usual.step, 3)
    if least > float(usual.start):
        reason = f"board, plate and pad end before the nose of {config.parameters.coupling.gripper}"
        yield "flex.standoff_mm", least, reason


def _interface(config: Input) -> Iterator[Proposal]:
    """Length of the interface that holds the multiplexers of a first layout, if there is one."""
    if not is_flex(config.parameters):
        return
    try:
        finger = lay_out(config, Diagnostics(config)).plan.receiver
    except InputError:
        return
    at_cells = next(zone.box for zone in finger.zones if zone.name == "cells")
    held = at_cells.y_min_mm - finger.notch.y_min_mm
    start = float(automatic_fields()["flex.interface_mm"].start)
    if held > start:
        yield (
            "flex.interface_mm",
            math.ceil(held * 10 - 1e-6) / 10,
            "as far as the cells: it holds the multiplexers and the tracks before them",
        )


def _fuse(config: Input) -> Iterator[Proposal]:
    """The smallest fuse for LEDs and controller at the worst case, or the largest that there is."""
    drawn_ma = most_lit_ma(config) + fed_ma(config)
    by_rating = sorted(config.catalogue.fuses.items(), key=lambda item: item[1].rated_a)
    fitting = (name for name, fuse in by_rating if 1000 * FUSE_SHARE * fuse.rated_a >= drawn_ma)
    reason = f"LEDs and controller draw up to {drawn_ma:.0f} mA"
    yield "flange.fuse", next(fitting, by_rating[-1][0]), reason


def _flange(config: Input) -> Iterator[Proposal]:
    """Parts of the flange's board that follow from supply and current."""
    p, parts = config.parameters, config.catalogue
    start = parts.capacitors[str(automatic_fields()["flange.input_capacitor"].start)]
    needed_v = p.supply.voltage_v * (1 + SUPPLY_TOLERANCE)
    for name, capacitor in parts.capacitors.items():
        same = capacitor.capacitance_nf >= start.capacitance_nf
        if start.rated_v < needed_v <= capacitor.rated_v and same:
            yield "flange.input_capacitor", name, f"rated for {needed_v:g} V"
            break
    fitting = [n for n, tvs in parts.tvs_diodes.items() if tvs.standoff_v >= p.supply.voltage_v]
    if fitting:
        name = min(fitting, key=lambda each: parts.tvs_diodes[each].standoff_v)
        yield "flange.tvs", name, f"the lowest stand-off voltage for {p.supply.voltage_v:g} V"
    yield from _fuse(config)
    ohm = max(
        float(automatic_fields()["flange.inrush_ohm"].start), sold_from(least_inrush_ohm(config))
    )
    yield "flange.inrush_ohm", ohm, "no ringing, and a small current, as it is plugged in"
    ohm = sold_ohm(float(automatic_fields()["flange.gate_ohm"].start))
    yield "flange.gate_ohm", ohm, "as small a current as a gate needs"


def _feed(config: Input) -> Iterator[Proposal]:
    """No diode before the controller where that would have too little."""
    name = str(automatic_fields()["breakout.feed_diode"].start)
    if not leaves_enough(config, name):
        yield "breakout.feed_diode", "none", f"behind {name} the controller would have too little"
