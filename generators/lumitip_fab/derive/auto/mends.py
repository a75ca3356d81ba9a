"""Which fields can mend a broken rule, the least intrusive first; by the rule's field.

The rule's own field comes first. The program itself changes automatic fields only; the others are
named to the user.
"""

_ROOM = ("board.channel_mm", "board.side_margin_mm")
_FINGER = ("outline.waist_margin_mm", "outline.end_margin_mm", "board.channel_mm",
           "board.tip_margin_mm", "outline.tip_margin_mm", "tip.slant_start_mm")  # fmt: skip
_CURRENT = ("emitter.current_ma", "emitter.string_leds", "emitter.resistor")

MENDS: dict[str, tuple[str, ...]] = {
    "grid.columns": ("receiver.multiplexer",),
    "stack.silicone_mm": ("emitter.resistor_side",),
    "stack.floor_mm": ("backing.tail_mm",),
    "outline.tip_fraction": ("outline.shoulder_margin_mm",),
    "outline.waist_margin_mm": ("outline.shoulder_margin_mm", "outline.end_corner_mm",
                                "outline.shoulder_at_mm", "outline.tip_margin_mm"),
    "outline.waist_at": ("outline.end_corner_mm", "outline.shoulder_at_mm"),
    "outline.shoulder_margin_mm": ("outline.waist_margin_mm",),
    "backing.tail_mm": ("stack.floor_mm",),
    "tip.slant_start_mm": ("outline.tip_margin_mm",),
    "coupling.gripper": (*_FINGER, "mould.taper_length_mm"),
    "board.side_margin_mm": (),
    "board.tip_margin_mm": ("board.hole_edge_mm", "board.hole_mm"),
    "board.hole_mm": ("board.tip_margin_mm", "board.side_margin_mm"),
    "board.end_margin_mm": ("board.hole_mm",),
    "board.channel_mm": ("board.hole_mm",),
    "board.copper_gap_mm": ("receiver.multiplexer",),
    "board.supply_track_mm": ("board.track_mm",),
    "board.via_mm": ("board.via_drill_mm",),
    "emitter.led": ("board.clearance_mm", "emitter.current_ma"),
    "emitter.current_ma": _CURRENT,
    "emitter.max_heat_w": _CURRENT,
    "emitter.resistor": ("emitter.resistor_side", "board.channel_mm", *_CURRENT,
                         "board.side_margin_mm", "backing.relief_clearance_mm"),
    "supply.max_ma": _CURRENT,
    "supply.voltage_v": ("emitter.string_leds", "flange.gate_ohm", "flange.enabled"),
    "controller.board": ("receiver.multiplexer", "flange.enabled"),
    "receiver.photodetector": ("board.clearance_mm",),
    "receiver.resistor": ("receiver.capacitor", "board.clearance_mm"),
    "receiver.multiplexer": _ROOM,
    "mask.hole_mm": ("board.channel_mm",),
    "mask.flap_mm": ("mask.allowance_mm",),
    "mould.draft_deg": ("mould.tip_silicone_mm",),
    "mould.wall_mm": (),
    "mould.taper_length_mm": ("outline.tip_margin_mm",),
    "mould.tip_silicone_mm": (),
    "flex.groove_depth_mm": ("stack.floor_mm",),
    "flex.standoff_mm": ("flex.groove_depth_mm",),
    "flex.interface_mm": ("flex.standoff_mm", "board.channel_mm", "tip.slant_start_mm",
                          "outline.end_margin_mm", "board.tip_margin_mm",
                          "outline.tip_margin_mm"),
    "flex.thread_hole_mm": ("board.hole_edge_mm", "board.end_margin_mm", "board.side_margin_mm"),
    "breakout.board_mm": ("breakout.hole_spacing_mm",),
    "breakout.hole_mm": ("breakout.hole_spacing_mm",),
    "breakout.hole_spacing_mm": ("breakout.hole_mm",),
    "holder.body_mm": ("holder.wall_mm", "breakout.enabled"),
    "holder.wrap_deg": ("holder.wall_mm", "holder.strap_hole_mm"),
    "holder.standoff_mm": ("breakout.hole_spacing_mm",),
    "holder.screw": ("breakout.hole_spacing_mm", "holder.wall_mm"),
    "holder.strap_hole_mm": ("holder.wrap_deg",),
    "holder.strap_spacing_mm": ("holder.strap_hole_mm",),
    "printer.profile": (),
    "flange.fuse": ("emitter.current_ma", "flange.enabled"),
    "flange.input_capacitor": ("supply.voltage_v", "flange.enabled"),
    "flange.coupling": ("flange.enabled",),
    "flange.web_mm": ("flange.enabled",),
    "flange.contacts": ("flange.tail_mm", "flange.enabled"),
    "flange.gate_ohm": (),
}  # fmt: skip


def menders(field: str) -> tuple[str, ...]:
    """Fields to try for a rule about a field, in order, each once."""
    return tuple(dict.fromkeys((field, *MENDS.get(field, ()))))
