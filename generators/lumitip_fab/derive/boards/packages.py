"""Packages of the parts, design rules of the copper, PCB fabs, and layers of a flexible board."""

from dataclasses import replace
from typing import TypeVar

from lumitip_fab.catalogue.ordering import Silk
from lumitip_fab.catalogue.record import Entry
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards import connectors, placing
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.stack import is_flex
from lumitip_fab.design import Box, Component, Fab, Flexible, Packages, Point, Rules
from lumitip_fab.design.components import chip

E = TypeVar("E", bound=Entry)
LEAST_RING_MM = 0.1  # copper round the hole of a via
COMMON_SILK = Silk(text_mm=0.8, line_mm=0.15, gap_mm=0.15)  # where the catalogue has no PCB fab


def derive_packages(config: Input) -> Packages:
    """The parts of the fingers' boards, by their names in the parameter file."""
    p, parts = config.parameters, config.catalogue
    return Packages(
        led=_without_texts(parts.leds[p.emitter.led]),
        led_name=p.emitter.led,
        source=_without_texts(parts.current_sources[p.emitter.source]),
        source_name=p.emitter.source,
        string_resistor=_without_texts(parts.resistors[p.emitter.resistor]),
        photodetector=_without_texts(parts.photodetectors[p.receiver.photodetector]),
        photodetector_name=p.receiver.photodetector,
        pull_up=_without_texts(parts.resistors[p.receiver.resistor]),
        array=_without_texts(parts.resistor_arrays[p.receiver.array]),
        capacitor=_without_texts(parts.capacitors[p.receiver.capacitor]),
        bulk=_without_texts(config.parts.receiver.bulk_capacitor)
        if config.parts.receiver.bulk_capacitor
        else None,
        bulk_name=p.receiver.bulk_capacitor,
        multiplexer=_without_texts(parts.multiplexers[p.receiver.multiplexer]),
        switch=_without_texts(config.parts.emitter.switch) if config.parts.emitter.switch else None,
        switch_name=p.emitter.switch,
    )


def capacitor(
    config: Input, ref: str, name: str, nets: tuple[str, str], at: Point, angle_deg: float
) -> Component:
    """A capacitor by its name in the catalogue."""
    entry, value = config.catalogue.capacitors[name], name.split(maxsplit=1)[0]
    return chip(ref, "capacitor", value, entry, nets, at, angle_deg)


def _without_texts(entry: E) -> E:
    """The entry without its texts: an edit of its source must not route the boards again."""
    return entry.model_copy(update={"source": "-", "title": ""})


def derive_rules(config: Input, faults: Diagnostics) -> Rules:
    """Rules of the copper; refused where a via has no ring or a track does not leave a lead."""
    p = config.parameters
    board, mux = p.board, config.parts.receiver.multiplexer
    least = board.via_drill_mm + 2 * LEAST_RING_MM
    faults.unless(board.via_mm >= least - 1e-9, "via_ring", board=board, least=least)
    between = mux.lead_pitch_mm - mux.lead_pad_mm[1]
    faults.unless(
        board.copper_gap_mm <= between + 1e-9, "gap_between_leads", board=board, between=between
    )
    faults.unless(board.track_mm <= board.supply_track_mm, "supply_track_narrow", board=board)
    silks = [fab.silk for fab in config.catalogue.fabs.values()] or [COMMON_SILK]
    return Rules(
        part_gap_mm=board.clearance_mm,
        track_mm=board.track_mm,
        supply_track_mm=board.supply_track_mm,
        copper_gap_mm=board.copper_gap_mm,
        via_mm=board.via_mm,
        via_drill_mm=board.via_drill_mm,
        edge_gap_mm=board.edge_gap_mm,
        hole_gap_mm=placing.HOLE_CLEARANCE_MM,
        silk_text_mm=max(silk.text_mm for silk in silks),
        silk_line_mm=max(silk.line_mm for silk in silks),
        silk_gap_mm=max(silk.gap_mm for silk in silks),
    )


def derive_fabs(config: Input) -> tuple[Fab, ...]:
    """Every PCB fab of the catalogue."""
    led = config.parts.emitter.led
    return tuple(
        Fab(
            name=name,
            layers=tuple((layer.replace("_", " "), end) for layer, end in fab.layers.items()),
            bom=fab.bom,
            positions=fab.positions,
            sides=fab.sides,
            back_from_behind=fab.back_angle == "from behind",
            rotations=tuple(fab.rotations.items()),
            rotations_assumed=fab.rotations_assumed,
            part_rotations=tuple(fab.part_rotations.items()),
            anode_first=(led.order_number,) if led.marked == "anode" else (),
            remark=fab.remark,
            least_mm=fab.panel.least_mm if fab.panel else None,
        )
        for name, fab in config.catalogue.fabs.items()
    )


COVERLAY_MM = 0.0275  # 12.5 um of polyimide on 15 um of adhesive
STIFFENER_MM = 0.2
STIFFENER_GAP_MM = 0.3  # to the sides of the wire notch
OVER_PADS_MM = 0.1


def flexible_board(config: Input, box: Box, notch: Box, connector_y_mm: float) -> Flexible | None:
    """Layers and zones of a flexible board; none for a rigid one.

    The coverlay has the common thickness of PCB fabs (assumed: each has its own); the core is the
    rest. The board bends beyond the rigid interface. The stiffener is behind
    the wires' pads, where the plate is open, so that it does not lift the board; it ends before
    the test points.
    """
    p, copper_mm = config.parameters, config.catalogue.laminates.flexible.copper_mm
    if not is_flex(p):
        return None
    held_to = min(notch.y_min_mm + p.flex.interface_mm, box.y_max_mm)
    x = notch.x_max_mm - STIFFENER_GAP_MM
    top = connector_y_mm + connectors.WIDE[1] / 2 + OVER_PADS_MM
    return Flexible(
        bend=replace(box, y_min_mm=held_to),
        stiffener=Box(-x, x, box.y_min_mm, top),
        stiffener_mm=STIFFENER_MM,
        core_mm=p.stack.pcb_mm - 2 * (copper_mm + COVERLAY_MM),
        copper_mm=copper_mm,
        coverlay_mm=COVERLAY_MM,
    )
