"""The circuit of a board: its parts, and the net of each of their pads.

supply ── R1 ──►|── … ──►|── GND            one string of LEDs; more beside it

3V3 ── RN1 ──┬── Q1 ──▷ GND                 one multiplexer with its detectors
    ── RN1 ──│─┬── …
             U1 ── A0                       (S0, S1, S2 choose)

3V3 ── R1 ──┬── A0                          the same with a shared pull-up
           U1 ──┬── Q1 ──▷ GND
                └── …
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from lumitip_fab.boards.model import Net, NetClass
from lumitip_fab.design import (
    Chip,
    Component,
    Connector,
    Design,
    Finger,
    Footprint,
    Led,
    Photodetector,
    Resistor,
    ResistorArray,
    Rules,
    Side,
    footprints,
)
from lumitip_fab.design.pull_ups import used_slots
from lumitip_fab.text import resistor_code

GROUND = "GND"
SIGNAL, SUPPLY = "signal", "supply"
"""Gap between parts at cells from which there is room for lines along their sides."""


@dataclass(frozen=True)
class Circuit:
    """Parts without a place yet, and nets."""

    components: tuple[Component, ...]
    nets: tuple[Net, ...]
    classes: tuple[NetClass, NetClass]


def circuit(design: Design, finger: Finger) -> Circuit:
    """The circuit of one board."""
    rules = design.rules
    of_finger = _emitter if finger.cells_hold.kind == "led" else _receiver
    supply = finger.connector.signals[1]
    parts = (
        *of_finger(design, supply),
        *_bare_copper(finger.connector),
    )
    names = dict.fromkeys((GROUND, supply, *(net for part in parts for _, net in part.nets)))
    return Circuit(
        components=parts,
        nets=tuple(Net(n, SUPPLY if n in (GROUND, supply) else SIGNAL) for n in names),
        classes=(
            net_class(SIGNAL, rules.track_mm, rules),
            net_class(SUPPLY, rules.supply_track_mm, rules),
        ),
    )


def _emitter(design: Design, supply: str) -> Iterator[Component]:
    wiring, packages = design.wiring, design.packages
    led, resistor = packages.led, packages.string_resistor
    held = design.emitter.cells_hold
    shape = footprints.chip("led", led)
    nets_of = {}
    for number, string in enumerate(wiring.strings, start=1):
        links = [f"S{number}_{k}" for k in range(len(string))] + [GROUND]
        for place, cell in enumerate(string):
            nets_of[cell] = _polar(led, anode=links[place], cathode=links[place + 1])
    for cell in sorted(nets_of):
        yield _part(held.ref(cell), packages.led_name, led, held.kind, shape, nets_of[cell])
    shape = footprints.chip("resistor", resistor)
    for number, ohm in enumerate(wiring.resistor_ohm, start=1):
        nets = ("1", supply), ("2", f"S{number}_0")
        yield _resistor(f"R{number}", ohm, resistor, shape, nets)


def _receiver(design: Design, supply: str) -> Iterator[Component]:
    reading, wiring, packages = design.reading, design.wiring, design.packages
    detector, mux = packages.photodetector, packages.multiplexer
    held = design.receiver.cells_hold
    shape = footprints.chip("photodetector", detector)
    for cell in reading.cells:
        ref = held.ref(cell.index)
        nets = _polar(detector, collector=ref, emitter=GROUND)
        yield _part(ref, packages.photodetector_name, detector, held.kind, shape, nets)
    shape = footprints.multiplexer(mux)
    shared = {str(lead): f"S{i}" for i, lead in enumerate(mux.select)}
    shared |= {str(mux.supply): supply, str(mux.ground): GROUND, str(mux.enable): GROUND}
    shared |= {} if mux.negative is None else {str(mux.negative): GROUND}
    for which, pin in enumerate(wiring.adc_pins):
        leads = shared | {str(mux.output): pin}
        leads |= {
            str(mux.inputs[str(cell.channel)]): held.ref(cell.index)
            for cell in reading.cells
            if cell.mux == which
        }
        # An input without a detector is tied to ground, so that nothing floats.
        leads |= {str(lead): GROUND for lead in mux.input_leads if str(lead) not in leads}
        pins = tuple(sorted(leads.items(), key=lambda item: int(item[0])))
        yield Component(
            f"U{which + 1}",
            wiring.multiplexer,
            mux.order_number,
            "multiplexer",
            shape,
            0.0,
            0.0,
            0.0,
            "front",
            pins,
            manufacturer=mux.manufacturer,
            lcsc=mux.lcsc,
        )
    yield from _own_pull_ups(design, supply) if wiring.own_pull_ups else _pull_ups(design, supply)
    bypass = footprints.chip("capacitor", packages.capacitor)
    for which in range(1, wiring.muxes + 1):
        nets = ("1", supply), ("2", GROUND)
        chip = packages.capacitor
        value = f"{chip.capacitance_nf:g}nF"
        yield _part(f"C{which}", value, chip, "capacitor", bypass, nets)


def _pull_ups(design: Design, supply: str) -> Iterator[Component]:
    """One at the output of each multiplexer."""
    wiring, chip = design.wiring, design.packages.pull_up
    shape = footprints.chip("resistor", chip)
    for which, pin in enumerate(wiring.adc_pins, start=1):
        nets = ("1", supply), ("2", pin)
        yield _resistor(f"R{which}", wiring.pull_up_ohm, chip, shape, nets)


def _own_pull_ups(design: Design, supply: str) -> Iterator[Component]:
    """One for each photodetector, in arrays; both ends of a spare one are at the supply."""
    array, mux = design.packages.array, design.packages.multiplexer
    shape = footprints.array(array)
    for number, (which, slot) in enumerate(used_slots(design.reading.cells, mux, array), start=1):
        detector_at = {
            mux.inputs[str(cell.channel)]: design.receiver.cells_hold.ref(cell.index)
            for cell in design.reading.cells
            if cell.mux == which
        }
        # Turned so that pad 1 is at the cells' end to the right of the multiplexer.
        leads = slot.leads[:: slot.side]
        near = [detector_at.get(lead, supply) for lead in leads]
        near += [supply] * (2 * array.resistors - len(near))
        nets = tuple((str(i), net) for i, net in enumerate(near, start=1))
        yield _resistor(f"RN{number}", design.wiring.pull_up_ohm, array, shape, nets)


def _bare_copper(wires: Connector) -> Iterator[Component]:
    """Connector, test points and fiducials: no part is bought for them."""
    signals = wires.signals
    shape = footprints.row("WirePads", len(signals), wires.pitch_mm, wires.pad_mm, wires.drill_mm)
    nets = tuple((str(i), signal) for i, signal in enumerate(signals, start=1))
    yield _copper("J1", f"{len(signals)} wires", "wires", footprints.bare(shape), nets)
    shape = footprints.dot("TestPoint")
    for i, signal in enumerate(signals, start=1):
        yield _copper(f"TP{i}", signal, "test point", shape, (("1", signal),), "back")
    for i in range(1, 4):
        yield _copper(f"FID{i}", "Fiducial", "fiducial", footprints.dot("Fiducial"), ())


def _resistor(
    ref: str,
    ohm: float,
    chip: Resistor | ResistorArray,
    shape: Footprint,
    nets: tuple[tuple[str, str], ...],
) -> Component:
    code = resistor_code(ohm)
    return Component(
        ref,
        code,
        chip.part(code),
        "resistor" if isinstance(chip, Resistor) else "resistor array",
        shape,
        0.0,
        0.0,
        0.0,
        "front",
        nets,
        manufacturer=chip.manufacturer,
        lcsc=chip.lcsc_of(code),
    )


def _part(
    ref: str,
    value: str,
    chip: Chip,
    kind: str,
    shape: Footprint,
    nets: tuple[tuple[str, str], ...],
) -> Component:
    return Component(
        ref,
        value,
        chip.order_number,
        kind,
        shape,
        0.0,
        0.0,
        0.0,
        "front",
        nets,
        manufacturer=chip.manufacturer,
        lcsc=chip.lcsc,
    )


def _copper(
    ref: str,
    value: str,
    kind: str,
    shape: Footprint,
    nets: tuple[tuple[str, str], ...],
    side: Side = "front",
) -> Component:
    return Component(ref, value, "", kind, shape, 0.0, 0.0, 0.0, side, nets)


def _polar(chip: Led | Photodetector, **terminals: str) -> tuple[tuple[str, str], ...]:
    """Nets of a part with polarity: pad 1 is the terminal that its mark shows."""
    (other,) = (name for name in terminals if name != chip.marked)
    return ("1", terminals[chip.marked]), ("2", terminals[other])


def gap_at_cells_mm(finger: Finger, chip: Chip) -> float:
    """Least gap between parts at neighbouring cells; infinite for a single cell."""
    along, across = chip.over_pads_mm
    size = (across, along) if finger.turned else (along, across)
    first = finger.cells[0]
    gaps = (
        max(abs(x - first[0]) - size[0], abs(y - first[1]) - size[1]) for x, y in finger.cells[1:]
    )
    return min(gaps, default=math.inf)


def net_class(name: str, track_mm: float, rules: Rules) -> NetClass:
    """Rules of a kind of net."""
    return NetClass(name, track_mm, rules.copper_gap_mm, rules.via_mm, rules.via_drill_mm)
