"""The circuit of a finger's board: its parts, the net of each of their pads, and how its LEDs turn.

supply ── R1 ──►|── … ──►|── GND            one string of LEDs; more beside it, all at GND or
                                            at the drain of Q1, whose source is at GND

supply ── IN U1 OUT ── R1 ─┬─►|── … ── GND  the same with a current source
               SET ── R3 ──┘

3V3 ── RN1 ──┬── Q1 ──▷ GND                 one multiplexer with its detectors
    ── RN1 ──│─┬── …
             U1 ── A0                       (S0, S1, S2 choose)

3V3 ── R1 ──┬── A0                          the same with a shared pull-up
           U1 ──┬── Q1 ──▷ GND
                └── …
"""

import dataclasses
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from lumitip_fab.boards.model import GROUND, PlacedComponent
from lumitip_fab.boards.placed import pad_at
from lumitip_fab.design import (
    Chip,
    Component,
    Design,
    Finger,
    Led,
    Packages,
    Photodetector,
    Point,
    Wiring,
    footprints,
)
from lumitip_fab.design.components import (
    MIDDLE,
    chip,
    fiducials,
    leaded,
    mounted,
    probe,
    resistor,
    wires,
)
from lumitip_fab.design.pull_ups import used_slots


def circuit(design: Design, finger: Finger) -> tuple[Component, ...]:
    """The parts of a finger's board, without a place yet, with the net of each pad."""
    at_cells = {"led": _strings, "photodetector": _channels}[finger.cells_hold.kind]
    row = finger.connector
    pads = wires("J1", row.signals, (row.pitch_mm, row.pad_mm, row.drill_mm))
    return (
        *at_cells(design, finger),
        replace(pads, footprint=footprints.bare(pads.footprint)),
        *(probe(f"TP{i}", signal) for i, signal in enumerate(row.signals, start=1)),
        *fiducials(3 * [MIDDLE]),
    )


def supply_of(finger: Finger) -> str:
    """Net that feeds a finger's board, beside ground."""
    return finger.connector.supply


def _strings(design: Design, finger: Finger) -> Iterator[Component]:
    """LEDs in series, each string with its resistor or its current source."""
    wiring, packages, held = design.wiring, design.packages, finger.cells_hold
    nets_of = {}
    for number, string in enumerate(wiring.strings, start=1):
        links = [f"S{number}_{k}" for k in range(len(string))] + [cathodes_of(design)]
        for place, cell in enumerate(string):
            nets_of[cell] = _polar(packages.led, anode=links[place], cathode=links[place + 1])
    for cell in sorted(nets_of):
        yield chip(held.ref(cell), held.kind, packages.led_name, packages.led, nets_of[cell])
    yield from (_sources if wiring.set_ohm else _string_resistors)(design, finger)
    yield from _switch(design)


def _string_resistors(design: Design, finger: Finger) -> Iterator[Component]:
    for number, ohm in enumerate(design.wiring.resistor_ohm, start=1):
        nets = supply_of(finger), f"S{number}_0"
        yield resistor(f"R{number}", ohm, design.packages.string_resistor, nets)


def _sources(design: Design, finger: Finger) -> Iterator[Component]:
    """A current source for each string, with a resistor at its OUT and one at its SET."""
    wiring, packages = design.wiring, design.packages
    strings = len(wiring.set_ohm)
    for number in range(1, strings + 1):
        leads = {"IN": supply_of(finger), "OUT": f"S{number}_OUT", "SET": f"S{number}_SET"}
        name, entry = packages.source_name, packages.source
        yield leaded(f"U{number}", "current source", name, entry, leads, MIDDLE, 0.0)
    for first, ohms, lead in (
        (1, wiring.resistor_ohm, "OUT"),
        (strings + 1, wiring.set_ohm, "SET"),
    ):
        for number, ohm in enumerate(ohms, start=1):
            nets = f"S{number}_{lead}", f"S{number}_0"
            yield resistor(f"R{first + number - 1}", ohm, packages.string_resistor, nets)


def cathodes_of(design: Design) -> str:
    """Net of the last cathode of every string: ground, or the drain of their switch."""
    return GROUND if design.packages.switch is None else "LEDK"


def _switch(design: Design) -> Iterator[Component]:
    """The transistor between the strings and ground, with the pull-down at its gate."""
    packages, wiring = design.packages, design.wiring
    if packages.switch is None:
        return
    gate = design.emitter.connector.signals[2]
    leads = {"G": gate, "S": GROUND, "D": cathodes_of(design)}
    yield leaded("Q1", "switch", packages.switch_name, packages.switch, leads, MIDDLE, 0.0)
    ref = wiring.pull_down_ref
    yield resistor(ref, wiring.pull_down_ohm, packages.pull_up, (gate, GROUND))


def _channels(design: Design, finger: Finger) -> Iterator[Component]:
    """Photodetectors at their multiplexers, with pull-ups and capacitors."""
    reading, wiring, packages = design.reading, design.wiring, design.packages
    mux, held, supply = packages.multiplexer, finger.cells_hold, supply_of(finger)
    for cell in reading.cells:
        ref = held.ref(cell.index)
        nets = _polar(packages.photodetector, collector=ref, emitter=GROUND)
        yield chip(ref, held.kind, packages.photodetector_name, packages.photodetector, nets)
    shape = footprints.multiplexer(mux)
    shared = {lead: f"S{i}" for i, lead in enumerate(mux.select)}
    shared |= {mux.supply: supply, mux.ground: GROUND, mux.enable: GROUND}
    shared |= {} if mux.negative is None else {mux.negative: GROUND}
    for which, pin in enumerate(wiring.adc_pins):
        # An input without a detector is tied to ground, so that nothing floats.
        leads = dict.fromkeys(mux.input_leads, GROUND) | shared | {mux.output: pin}
        leads |= _detectors(design, finger, which)
        named = tuple((str(lead), leads[lead]) for lead in sorted(leads))
        yield mounted(f"U{which + 1}", "multiplexer", wiring.multiplexer, mux, shape, named)
    if wiring.own_pull_ups:
        yield from _own_pull_ups(design, finger)
    else:
        for which, pin in enumerate(wiring.adc_pins, start=1):
            yield resistor(f"R{which}", wiring.pull_up_ohm, packages.pull_up, (supply, pin))
    if packages.bulk is not None:
        ref, value = f"C{wiring.muxes + 1}", packages.bulk_name.split()[0]
        yield chip(ref, "capacitor", value, packages.bulk, (supply, GROUND))
    bypass = packages.capacitor
    for which in range(1, wiring.muxes + 1):
        value = f"{bypass.capacitance_nf:g}nF"
        yield chip(f"C{which}", "capacitor", value, bypass, (supply, GROUND))


def _detectors(design: Design, finger: Finger, which: int) -> dict[int, str]:
    """Net of each input lead of a multiplexer that has a detector."""
    inputs = design.packages.multiplexer.inputs
    return {
        inputs[str(cell.channel)]: finger.cells_hold.ref(cell.index)
        for cell in design.reading.cells
        if cell.mux == which
    }


def _own_pull_ups(design: Design, finger: Finger) -> Iterator[Component]:
    """One for each photodetector, in arrays; both ends of a spare one are at the supply."""
    array, mux = design.packages.array, design.packages.multiplexer
    supply = supply_of(finger)
    for number, (which, slot) in enumerate(used_slots(design.reading.cells, mux, array), start=1):
        detector_at = _detectors(design, finger, which)
        # Turned so that pad 1 is at the cells' end to the right of the multiplexer.
        near = [detector_at.get(lead, supply) for lead in slot.leads[:: slot.side]]
        nets = near + [supply] * (2 * array.resistors - len(near))
        yield resistor(f"RN{number}", design.wiring.pull_up_ohm, array, nets)


def _polar(entry: Led | Photodetector, **terminals: str) -> tuple[str, str]:
    """Nets of a part with polarity: pad 1 is the terminal that its mark shows."""
    (other,) = (name for name in terminals if name != entry.marked)
    return terminals[entry.marked], terminals[other]


def gap_at_cells_mm(finger: Finger, entry: Chip) -> float:
    """Least gap between parts at neighbouring cells; infinite for a single cell."""
    along, across = entry.over_pads_mm
    size = (across, along) if finger.turned else (along, across)
    first = finger.cells[0]
    gaps = (
        max(abs(x - first[0]) - size[0], abs(y - first[1]) - size[1]) for x, y in finger.cells[1:]
    )
    return min(gaps, default=math.inf)


def turn_strings(
    parts: dict[str, PlacedComponent], finger: Finger, wiring: Wiring, packages: Packages
) -> None:
    """Turn sources or resistors, and LEDs so that neighbours of a string face each other."""
    anode = "1" if packages.led.marked == "anode" else "2"
    (_turn_sources if wiring.set_ohm else _turn_resistors)(parts, wiring)
    _turn_pull_down(parts, wiring)
    for number, string in enumerate(wiring.strings, start=1):
        chain = [parts[f"D{cell + 1}"] for cell in string]
        start = pad_at(parts[f"R{number}"], "2")
        choices = (90.0, 270.0) if finger.turned else (0.0, 180.0)
        angles = string_angles(chain, start, anode, choices)
        for part, angle in zip(chain, angles, strict=True):
            parts[part.ref] = dataclasses.replace(part, angle_deg=angle)


def _turn_resistors(parts: dict[str, PlacedComponent], wiring: Wiring) -> None:
    """Turn the string resistors with their supply ends to the connector."""
    for number in range(1, len(wiring.strings) + 1):
        ref = f"R{number}"
        turns = [dataclasses.replace(parts[ref], angle_deg=angle) for angle in (90.0, 270.0)]
        parts[ref] = min(turns, key=lambda part: pad_at(part, "1")[1])


def _turn_sources(parts: dict[str, PlacedComponent], wiring: Wiring) -> None:
    """Turn the sources with IN to the connector, and their resistors so that the string begins
    between the two."""
    strings = len(wiring.strings)
    for number in range(1, strings + 1):
        at_out, at_set = f"R{number}", f"R{strings + number}"
        for ref, angle_deg in ((f"U{number}", 180.0), (at_out, 270.0), (at_set, 90.0)):
            parts[ref] = dataclasses.replace(parts[ref], angle_deg=angle_deg)


def _turn_pull_down(parts: dict[str, PlacedComponent], wiring: Wiring) -> None:
    """Turn the gate's pull-down with its gate end to the connector, if there is one."""
    if wiring.emitter_pin is not None:
        down = parts[wiring.pull_down_ref]
        parts[down.ref] = dataclasses.replace(down, angle_deg=90.0)


def string_angles(
    chain: Sequence[PlacedComponent], start: Point, anode: str, choices: Sequence[float]
) -> tuple[float, ...]:
    """The angles with the shortest links in all, found place by place along the string.

    Args:
        chain: LEDs in the order in which the current passes them.
        start: pad that the first LED is linked to.
        anode: number of the pad that the current enters by.
        choices: angles that each LED may have (degrees).
    """
    cathode = "1" if anode == "2" else "2"
    best: dict[Point, tuple[float, tuple[float, ...]]] = {start: (0.0, ())}
    for led in chain:
        reached: dict[Point, tuple[float, tuple[float, ...]]] = {}
        for angle in choices:
            turned = dataclasses.replace(led, angle_deg=angle)
            into = pad_at(turned, anode)
            length, angles = min(
                (round(so_far + math.dist(left, into), 6), angles_so_far)
                for left, (so_far, angles_so_far) in best.items()
            )
            reached[pad_at(turned, cathode)] = length, (*angles, angle)
        best = reached
    return min(best.values())[1]
