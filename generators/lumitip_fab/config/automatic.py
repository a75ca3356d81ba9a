"""The fields that may be `"auto"`: their start values and dependencies.

A field that is left out of a file and of its base is `"auto"` too. `lumitip_fab.derive.auto` makes
the choices. The values here are those of the published sensor.
"""

from dataclasses import dataclass
from typing import Any

AUTO = "auto"

Value = float | int | str


@dataclass(frozen=True)
class Automatic:
    """Choice of the value of a field."""

    start: Value
    """First value; it is kept where every rule passes."""
    follows: str
    """Quantities that the value depends on, in a few words."""
    step: float = 0.0
    """Resolution of a numeric search; 0 for values that are computed or from a list."""
    names: str = ""
    """Catalogue file whose entries are tried, for a field that names a part."""


_BOARD = "room of holes, parts and connector"
_OUTLINE = "board, notch and mould round which the outline runs"

FIELDS: dict[str, Automatic] = {
    "stack.floor_mm": Automatic(0.8, "printer's thinnest wall", 0.05),
    "stack.film_mm": Automatic(0.1, "thickness of the mask"),
    "outline.tip_fraction": Automatic(0.486, _OUTLINE, 0.01),
    "outline.tip_margin_mm": Automatic(6.2, _OUTLINE, 0.1),
    "outline.shoulder_margin_mm": Automatic(7.5, _OUTLINE, 0.1),
    "outline.shoulder_at_mm": Automatic(10.1, _OUTLINE, 0.1),
    "outline.waist_margin_mm": Automatic(2.5, _OUTLINE, 0.1),
    "outline.waist_at": Automatic(0.65, _OUTLINE, 0.01),
    "outline.end_margin_mm": Automatic(5.4, _OUTLINE, 0.1),
    "outline.end_corner_mm": Automatic(7.0, _OUTLINE, 0.1),
    "backing.density_g_ml": Automatic(1.27, "density of backing.material"),
    "backing.tail_mm": Automatic(1.5, "coupling and plate", 0.1),
    "backing.relief_clearance_mm": Automatic(0.8, "room beside the coupling", 0.05),
    "flex.interface_mm": Automatic(26.0, "multiplexers, land and ramp of the gripper", 0.5),
    "flex.standoff_mm": Automatic(2.0, "plate and nose of the gripper", 0.1),
    "flex.groove_mm": Automatic(1.5, "printer's line", 0.05),
    "flex.groove_depth_mm": Automatic(0.75, "plate", 0.05),
    "flex.thread_hole_mm": Automatic(2.2, "board round the holes", 0.1),
    "tip.slant_start_mm": Automatic(6.0, "pocket and plate", 0.1),
    "tip.edge_mm": Automatic(0.45, "printer's line"),
    "board.side_margin_mm": Automatic(5.8, _BOARD, 0.1),
    "board.tip_margin_mm": Automatic(3.65, _BOARD, 0.05),
    "board.end_margin_mm": Automatic(1.9, _BOARD, 0.05),
    "board.hole_mm": Automatic(2.1, "room ahead of the first row", 0.1),
    "board.hole_edge_mm": Automatic(2.15, _BOARD, 0.05),
    "board.clearance_mm": Automatic(0.25, "pitch and parts", 0.05),
    "board.channel_mm": Automatic(2.2, "number of tracks", 0.1),
    "board.track_mm": Automatic(0.2, "room between the cells"),
    "board.supply_track_mm": Automatic(0.5, "track_mm"),
    "board.copper_gap_mm": Automatic(0.2, "room between the cells"),
    "board.via_mm": Automatic(0.6, "room between the cells"),
    "board.via_drill_mm": Automatic(0.3, "room between the cells"),
    "board.edge_gap_mm": Automatic(0.5, "number of tracks"),
    "emitter.led": Automatic("15406085BA300", "pitch", names="leds"),
    "emitter.current_ma": Automatic(19.2, "heat, supply and ratings", 0.1),
    "emitter.string_leds": Automatic(16, "supply and forward voltage", 1),
    "emitter.drive": Automatic("source", "supply, LEDs and room for the sources"),
    "emitter.source": Automatic("LT3092", "supply and current", names="current_sources"),
    "emitter.resistor": Automatic("1206", "worst-case load", names="resistors"),
    "emitter.resistor_side": Automatic("back", "emitter.drive and room beside the coupling"),
    "emitter.switch": Automatic("AO3400A", "supply, controller and room", names="transistors"),
    "receiver.photodetector": Automatic("SML-H10TBT86", "pitch", names="photodetectors"),
    "receiver.multiplexer": Automatic("74HC4051PW", "cells and analog pins", names="multiplexers"),
    "receiver.load": Automatic("each", "room beside the multiplexer"),
    "receiver.pull_up_ohm": Automatic(20000.0, "receiver.load and current of the LEDs"),
    "receiver.array": Automatic("4x0603", "room beside the multiplexer", names="resistor_arrays"),
    "receiver.resistor": Automatic("0603", "room beside the multiplexer", names="resistors"),
    "receiver.capacitor": Automatic("100nF 0603", "multiplexer and supply", names="capacitors"),
    "receiver.bulk_capacitor": Automatic(
        "10uF 0603 10V", "room beside the wires and current of the detectors", names="capacitors"
    ),
    "wiring.order": Automatic("apart", "no other value"),
    "mask.route": Automatic("film", "no other value"),
    "mask.filament": Automatic("TPU 95A", "no other value"),
    "mask.layers": Automatic(2, "no other value"),
    "mask.allowance_mm": Automatic(0.75, "page", 0.05),
    "mask.flap_mm": Automatic(13.0, "thickness of a finger and page", 0.5),
    "mould.taper_length_mm": Automatic(3.0, "outline.tip_margin_mm", 0.1),
    "mould.tip_silicone_mm": Automatic(0.2, "stack.silicone_mm", 0.05),
    "mould.draft_deg": Automatic(3.0, "silicone over the rim", 0.1),
    "mould.wall_mm": Automatic(2.4, "printer's thinnest wall and letter", 0.1),
    "breakout.hole_mm": Automatic(2.1, "holder.screw", 0.1),
    "breakout.hole_spacing_mm": Automatic(35.56, "socket and holder", 0.1),
    "holder.wall_mm": Automatic(3.0, "strain of the arms", 0.1),
    "holder.wrap_deg": Automatic(105.0, "size of the gripper", 0.5),
    "holder.standoff_mm": Automatic(3.0, "solder tails", 0.1),
    "holder.strap_hole_mm": Automatic(4.2, "room in the arms", 0.1),
    "holder.strap_spacing_mm": Automatic(12.0, "width of the arms", 0.5),
    "flange.input_capacitor": Automatic("10uF 0603", "supply", names="capacitors"),
    "flange.fuse": Automatic("500mA 1206", "current of LEDs and controller", names="fuses"),
    "flange.gate_ohm": Automatic(100000.0, "supply"),
    "flange.tvs": Automatic("SMBJ24A", "supply", names="tvs_diodes"),
    "flange.inrush_resistor": Automatic("1206 pulse", "inrush_ohm", names="pulse_resistors"),
    "flange.inrush_ohm": Automatic(4.7, "supply, input capacitor, fuse and MOSFET"),
    "flange.indicator": Automatic("APT2012LZGCK", "the flange's output", names="indicators"),
    "printer.min_wall_mm": Automatic(0.8, "two lines of the printer"),
}


def filled(table: dict[str, Any]) -> tuple[dict[str, Any], frozenset[str]]:
    """A merged parameter table with a start in place of every automatic value.

    Returns:
        The table, and the fields whose values are to be chosen.
    """
    full, chosen = dict(table), set()
    for field, automatic in FIELDS.items():
        section, key = field.split(".")
        values = full.get(section)
        if isinstance(values, dict) and values.get(key, AUTO) == AUTO:
            full[section] = {**values, key: automatic.start}
            chosen.add(field)
    return full, frozenset(chosen)
