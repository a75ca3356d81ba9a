"""Figures of what is outside the fingers, beside the published ones."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from lumitip_fab.design import AuxiliaryBoard, Design, Finger, Flange, Holder, Panel
from lumitip_fab.design.electrical import Indicator, PlugIn, Regulated


@dataclass(frozen=True)
class Row:
    """One figure: published, computed, and the reason where they differ."""

    quantity: str
    published: str
    computed: str
    reason: str = ""


def outside(design: Design) -> Iterator[Row]:
    """Rows of the boards and printed parts that the design has."""
    for auxiliary in design.auxiliary_boards:
        if auxiliary.name == "breakout":
            yield from _breakout(auxiliary)
        else:
            yield from _flange(auxiliary)
    for finger in design.fingers:
        yield _held_at(finger, design)
    for supply in design.electrical.supplies:
        yield from _regulated(supply)
    for plug_in in design.electrical.plug_ins:
        yield from _plugged_in(plug_in)
    for lit in design.electrical.indicators:
        yield _lit(lit)
    if any(auxiliary.name == "breakout" for auxiliary in design.auxiliary_boards):
        yield from _held(design)
    for flange in design.flanges:
        yield from _stack(flange)
    for panel in design.panels:
        yield _panelled(panel)


def _panelled(panel: Panel) -> Row:
    return Row(
        f"panel of the {panel.board}",
        "not stated",
        f"{len(panel.copies)} boards, {panel.box.width_mm:.1f} x {panel.box.length_mm:.1f} mm",
        "the board is too small for some PCB fabs to mount its parts",
    )


def _breakout(auxiliary: AuxiliaryBoard) -> Iterator[Row]:
    box = auxiliary.box
    spacing = auxiliary.holes[1][0] - auxiliary.holes[0][0]
    yield Row(
        "controller breakout",
        "45.7 x 33.0 mm",
        f"{box.width_mm:.1f} x {box.length_mm:.1f} mm",
        "by breakout.board_mm",
    )
    yield Row(
        "its screw holes",
        "35.56 mm apart, in the holder 36.00",
        f"{spacing:.2f} mm apart",
        "one figure for board and holder, breakout.hole_spacing_mm",
    )
    yield from _tied(auxiliary)


def _tied(auxiliary: AuxiliaryBoard) -> Iterator[Row]:
    """Strain relief of the cables; none where no cable ends at wire pads."""
    for tie in auxiliary.ties[:1]:
        yield Row(
            "its strain relief",
            "not stated",
            f"2 holes of {tie.hole_mm:g} mm at each of {len(auxiliary.ties)} rows of wire pads",
            f"for a thread of 1 mm round the cable, {tie.web_mm:g} mm from the edge",
        )


def _held_at(finger: Finger, design: Design) -> Row:
    """Strain relief of a finger's cable, or the figures that leave no room for it."""
    quantity = f"strain relief of the {finger.name}'s cable"
    for tie in finger.ties:
        why = (
            f"for a thread of 1 mm, {tie.web_mm:g} mm from the edge, where plate and film are open"
        )
        return Row(quantity, "not stated", f"2 holes of {tie.hole_mm:g} mm", why)
    if design.board.flexible:
        return Row(quantity, "not stated", "none", "the board has a stiffener behind its wire pads")
    wires = finger.connector
    x, y = wires.pads[-1]
    edge_mm = y - wires.pad_mm / 2 - design.board.box.y_min_mm
    notch_mm = finger.notch.x_max_mm - x - wires.pad_mm / 2
    why = (
        f"its wire pads leave {edge_mm:.1f} mm to the edge and {notch_mm:.1f} mm to the side of "
        "the notch, in which the plate behind the board is open: too little for a hole"
    )
    return Row(quantity, "not stated", "none", why)


def _flange(auxiliary: AuxiliaryBoard) -> Iterator[Row]:
    box = auxiliary.box
    yield Row(
        "board of the flange",
        "32.8 x 63.5 mm",
        f"{box.width_mm:.1f} x {box.length_mm:.1f} mm",
        "a rectangle with round corners; published: one side is an arc",
    )
    values = {device.ref: device.value for device in auxiliary.components}
    yield _supply(auxiliary, values)
    yield Row(
        "its fuse and reversed supply",
        "not stated",
        f"{values['F1']}, {values['Q1']}",
        "a MOSFET costs the LEDs no voltage, as a diode would",
    )
    points = [part for part in auxiliary.components if part.kind == "test point"]
    yield Row(
        "its test points",
        "not stated",
        ", ".join(part.value for part in points),
        f"on the front, {points[0].footprint.pads[0].width_mm:g} mm wide, with their names; on the "
        "breakout the wire pads have names",
    )
    yield from _tied(auxiliary)
    if "U2" in values:
        yield Row(
            "controller on it",
            "none: an Arduino beside the gripper",
            f"{values['U2']}, {values['U3']}, {values['Y1']}",
            "what the publication names as future work; by controller.board",
        )


def _supply(auxiliary: AuxiliaryBoard, values: Mapping[str, str]) -> Row:
    """The regulator's parts; without one, what the robot's contact must carry."""
    published = "AP63205, 4.7 uH, 10 uF, 2 x 22 uF"
    if auxiliary.hot_loop:
        parts = f"{values['U1']}, {values['L1']}, {values['C1']}, 2 x {values['C2']}"
        return Row("its supply", published, parts, "parts of [flange]")
    return Row(
        "its supply",
        published,
        "no regulator",
        "the supply contact itself must carry this voltage: set the robot's tool output before you "
        f"plug the flange in. With more, {values['D1']} conducts and {values['F1']} melts",
    )


def _regulated(supply: Regulated) -> Iterator[Row]:
    volts, least_a = f"{supply.output_v:g} V", supply.ripple_a / 2
    yield Row(
        f"ripple of the {volts}",
        "not stated",
        f"{supply.ripple_mv:.1f} mV",
        f"at {supply.load_a:g} A: {supply.ripple_a:.2f} A of ripple through "
        f"{supply.inductance_uh:g} µH, {supply.capacitor_uf:g} µF left of each capacitor; "
        f"below {least_a:.2f} A the regulator skips pulses, and it is more",
    )
    yield Row(
        f"start-up of the {volts}",
        "not stated",
        f"{supply.soft_start_ms:g} ms",
        f"soft start; the capacitors then take {1000 * supply.charging_a:.0f} mA; ngspice: "
        "boards/flange/flange.cir",
    )


def _plugged_in(plug_in: PlugIn) -> Iterator[Row]:
    low, high = plug_in.cable_uh
    if not plug_in.capacitor_uf:
        return
    rated = "" if plug_in.pulse_a is None else f"; its MOSFET bears {plug_in.pulse_a:g} A"
    melts = ""
    if plug_in.melting_a2s is not None:
        share = 100 * plug_in.surge_a2s / plug_in.melting_a2s
        melts = f"; {share:.0f} % of the fuse's melting I²t"
    yield Row(
        "plugged into a live supply",
        "not stated",
        f"{plug_in.peak_a:.1f} A",
        f"at most{rated}{melts}; {plug_in.inrush_ohm:g} Ω damp {low:g} to {high:g} µH of cable and "
        f"take {1000 * plug_in.pulse_j:.1f} mJ; ngspice: boards/flange/flange_plug_in.cir",
    )


def _lit(lit: Indicator) -> Row:
    return Row(
        "power LED of the flange",
        "not stated",
        f"{lit.led}, {lit.colour}, through {lit.ohm:g} Ω",
        f"at its {lit.output_v:g} V; {lit.low_ma:.1f} to {lit.high_ma:.1f} mA over tolerances, "
        f"{lit.visible_ma:g} mA are seen in a lit room; its resistor takes up to "
        f"{1000 * lit.resistor_w:.0f} mW of {1000 * lit.rated_w:g} mW rated",
    )


def _held(design: Design) -> Iterator[Row]:
    if not design.holders:
        yield Row(
            "holder of the breakout",
            "round the gripper's body",
            "none",
            f"the body of {design.mount.title} is not round: fix the board beside it, or "
            "give holder.body_mm",
        )
    for holder in design.holders:
        yield from _holder(holder)


def _holder(holder: Holder) -> Iterator[Row]:
    yield Row(
        "cradle of the holder",
        "37.8 mm radius",
        f"{holder.cradle_mm:.1f} mm radius, body {holder.body_mm:g} mm",
        f"that body's diameter: {holder.body_from}",
    )
    yield Row(
        "arms of the holder",
        "bolted with M4",
        f"clip round, to {holder.wrap_deg:g}° from the middle",
        "holder.wrap_deg beyond 90° holds without screws",
    )


def _stack(flange: Flange) -> Iterator[Row]:
    yield Row(
        "height that the flange adds",
        "7.5 mm",
        f"{flange.top_z_mm:.1f} mm",
        "the highest part on its board, board, floor and lid; the published one has its "
        "headers outside and a floor of 0.4 mm",
    )
    yield Row(
        "its bolts and locating pin",
        "4 x M5 on 62.8 mm, 3.8 mm",
        f"{len(flange.bolts)} x {flange.bolt} on {_circle_mm(flange):.1f} mm, {flange.pin_mm:g} mm",
        f"of {flange.coupling} in parts/couplings.toml, which stands on ISO "
        f"9409-1-{flange.iso}; the pin is bought, not printed",
    )
    pressed = flange.contacts_mm - (flange.board_z_mm - flange.contacts_z_mm)
    yield Row(
        "its spring contacts",
        "not stated",
        f"pressed by {pressed:.1f} of {flange.stroke_mm:g} mm",
        "against contacts whose depth is inferred: measure your coupling",
    )


def _circle_mm(flange: Flange) -> float:
    """Diameter of the circle that the bolts lie on."""
    return 2 * max(math.hypot(*at) for at in flange.bolts)
