"""The circuit of a board, followed along its copper: multiplexers, and contacts of a coupling."""

import math
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping

from lumitip_fab.checks.board_read import ReadBoard, ohm
from lumitip_fab.checks.connections import channels
from lumitip_fab.checks.readers.kicad_board import Part
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import ToolContact
from lumitip_fab.design.frames import applied, auxiliary_to_flange

BYPASS_MM = 4.0  # from a supply lead to its capacitor, at most
GROUND = "GND"


def measure_channels(read: ReadBoard) -> Iterator[Measurement]:
    """Which detector each input reads, against the layout; and what serves the multiplexers."""
    if not read.muxes:
        return
    found = channels(read.board, read.clusters)
    wanted: dict[str, dict[str, str]] = {f"U{m + 1}": {} for m in range(read.muxes)}
    for cell in read.design.cells:
        wanted[f"U{cell.mux + 1}"][str(cell.channel)] = f"Q{cell.index + 1}"
    wrong = [
        f"{mux} channel {channel}: {found.by_copper.get(mux, {}).get(channel, 'none')}, not {ref}"
        for mux, inputs in wanted.items()
        for channel, ref in inputs.items()
        if found.by_copper.get(mux, {}).get(channel) != ref
    ]
    spare = [
        f"{mux} reads more"
        for mux, inputs in found.by_copper.items()
        if set(inputs) - set(wanted.get(mux, ()))
    ]
    yield read.count("channels", wrong + spare, "channels")
    yield read.count("names", list(found.doubts), "channels")
    yield read.count("service", list(_unserved(read)), "leads")
    yield from _bypasses(read)
    yield read.count("polarity", _reversed_detectors(read), "detectors")


def _unserved(read: ReadBoard) -> Iterator[str]:
    """Leads of multiplexers without their line; outputs or photodetectors without exactly one
    pull-up."""
    design, leads = read.design, read.design.packages.multiplexer
    supply = read.supply
    shared = {leads.supply: supply, leads.ground: GROUND, leads.enable: GROUND}
    shared |= {} if leads.negative is None else {leads.negative: GROUND}
    shared |= {lead: f"S{i}" for i, lead in enumerate(leads.select)}
    for which, pin in enumerate(design.wiring.adc_pins, start=1):
        for lead, signal in (shared | {leads.output: pin}).items():
            if read.group(f"U{which}", lead) != read.wire(signal) or read.wire(signal) is None:
                yield f"U{which} lead {lead} is not at {signal}"
    wanted = {pin: read.wire(pin) for pin in design.wiring.adc_pins}
    if design.wiring.own_pull_ups:
        detectors = (design.receiver.cells_hold.ref(cell.index) for cell in design.cells)
        collector = "1" if design.packages.photodetector.marked == "collector" else "2"
        wanted |= {ref: read.group(ref, collector) for ref in detectors}
    pulled_up = Counter(
        (ends - {read.wire(supply)}).pop()
        for ends in _resistors(read, design.wiring.pull_up_ohm)
        if len(ends) == 2 and read.wire(supply) in ends
    )
    for name, group in wanted.items():
        due = int((name[0] == "Q") == design.wiring.own_pull_ups)
        if pulled_up[group] != due:
            yield (
                f"{name} has {pulled_up[group]} pull-ups of {design.wiring.pull_up_ohm:g} ohm, "
                f"not {due}"
            )


def _bypasses(read: ReadBoard) -> Iterator[Measurement]:
    """From each multiplexer's supply and ground leads to the pads of a capacitor of its own."""
    leads, supply = read.design.packages.multiplexer, read.supply
    rails = read.wire(supply), read.wire(GROUND)
    free = {
        ref: part
        for ref, part in read.parts.items()
        if ref.startswith("C") and ref != f"C{read.muxes + 1}" and _ends(read, ref) == set(rails)
    }
    far: list[tuple[float, float]] = []
    for which in range(1, read.muxes + 1):
        mux = read.parts.get(f"U{which}")
        own = min(free, key=lambda ref: _reach(read, mux, leads.supply, free[ref]), default=None)
        chip = free.pop(own) if own else None
        far.append((_reach(read, mux, leads.supply, chip), _reach(read, mux, leads.ground, chip)))
    across = math.hypot(leads.body_mm[0], leads.lead_tips_mm)  # the two are at opposite corners
    for name, worst, limit in (
        ("bypass_supply", max(d for d, _ in far), BYPASS_MM),
        ("bypass_ground", max(d for _, d in far), BYPASS_MM + across),
    ):
        yield read.figure(name, worst, 0, limit, note="from a multiplexer to its capacitor")


def _reach(read: ReadBoard, mux: Part | None, lead: int, chip: Part | None) -> float:
    """From a lead to the pad of a part that is on the same net; infinite without either."""
    if mux is None or chip is None:
        return math.inf
    net = read.group(mux.ref, lead)
    ends = [t.at for t in mux.terminals if t.number == str(lead)]
    pads = [t.at for t in chip.terminals if read.group(chip.ref, t.number) == net]
    return min((math.dist(a, b) for a in ends for b in pads), default=math.inf)


def _resistors(read: ReadBoard, value: float) -> Iterator[set[int | None]]:
    """The groups that each resistor of this value joins; an array has one between each pad of its
    first row and the pad opposite."""
    for ref, part in read.parts.items():
        if ref.startswith("R") and math.isclose(ohm(part.value), value, rel_tol=1e-6):
            pads = len(part.terminals)
            for pad in range(1, pads // 2 + 1):
                yield {read.group(ref, pad), read.group(ref, pads + 1 - pad)}


def _ends(read: ReadBoard, ref: str) -> set[int | None]:
    return {read.group(ref, 1), read.group(ref, 2)}


def _reversed_detectors(read: ReadBoard) -> list[str]:
    """Detectors whose emitter is not at ground."""
    emitter = "2" if read.design.packages.photodetector.marked == "collector" else "1"
    refs = [f"Q{i + 1}" for i in range(len(read.design.cells))]
    return [ref for ref in refs if read.group(ref, emitter) != read.wire(GROUND)]


CONTACTS = "J1"
CONTACT_MM = 0.02
_SUPPLY, _GROUND = ("F1", 1), ("D1", 2)
"""Pads that the board's supply enters by, at the fuse, and that are on its ground."""
Contacts = Mapping[str, ToolContact]


def measure_contact_map(read: ReadBoard) -> Iterator[Measurement]:
    """Every pad on the contact of its number, and every net on contacts of its own signal alone."""
    for flange in (f for f in read.design.flanges if f.auxiliary == read.name):
        contacts = {contact.number: contact for contact in flange.contacts}
        part = read.parts.get(CONTACTS)
        pads = {t.number: t for t in (part.terminals if part else ()) if t.copper is not None}
        lost = sorted(contacts.keys() ^ pads.keys())
        yield read.count("contact_count", [f"{number} at one end only" for number in lost], "pads")
        both = contacts.keys() & pads.keys()
        numbers = [number for number in contacts if number in both]
        on_board = read.sensor([pads[number].at for number in numbers])
        places = applied(auxiliary_to_flange(flange), on_board)[:, :2]
        off = [math.dist(place, contacts[n].at) for n, place in zip(numbers, places, strict=True)]
        note = "from the coupling's contact of the same number"
        yield read.figure("contact_places", max(off, default=math.nan), 0, CONTACT_MM, note=note)
        groups = {number: read.group(CONTACTS, number) for number in numbers}
        named = {number: pads[number].net for number in numbers}
        wrong = [*_mixed(contacts, groups), *_mixed(contacts, named)]
        yield read.count(
            "contact_signals", sorted({*wrong, *_misled(read, contacts, groups)}), "nets"
        )


def measure_passed_on(read: ReadBoard) -> Iterator[Measurement]:
    """Contacts of the robot that lead to no header: a gripper on the flange touches no contact, and
    needs its cable from there. Contacts that the design leaves open are not counted, nor is a
    supply that its headers have only behind the fuse."""
    for flange in (f for f in read.design.flanges if f.auxiliary == read.name):
        headers = [d for d in read.components if d.kind == "header" and d.ref != CONTACTS]
        pads = [(header.ref, number) for header in headers for number, _ in header.nets]
        reached = {read.group(*pad) for pad in pads if pad[0] in read.parts} - {None}
        nets = dict(next(d for d in read.components if d.ref == CONTACTS).nets)
        named = {net for header in headers for _, net in header.nets}
        used = [c for c in flange.contacts if c.number in nets]
        lost = [
            f"{c.number} ({c.carries})"
            for c in used
            if c.kind != "supply" or nets[c.number] in named
            if read.group(CONTACTS, c.number) not in reached
        ]
        yield read.count("passed_on", lost, "contacts")


def _mixed(contacts: Contacts, nets: Mapping[str, object]) -> Iterator[str]:
    """Contacts of different signals on one net."""
    on: dict[object, list[str]] = defaultdict(list)
    for number, net in nets.items():
        if net not in ("", None):
            on[net].append(number)
    for numbers in on.values():
        carried = sorted({contacts[number].carries for number in numbers})
        if len(carried) > 1:
            yield f"contacts {', '.join(numbers)} join {' and '.join(carried)}"


def _misled(read: ReadBoard, contacts: Contacts, groups: Mapping[str, int | None]) -> Iterator[str]:
    """Contacts that lead to the board's supply or ground and must not, or must and do not, and
    open ones that lead anywhere."""
    ends = {"supply": read.group(*_SUPPLY), "ground": read.group(*_GROUND)}
    for number, group in groups.items():
        contact = contacts[number]
        for kind, end in ends.items():
            if (group == end) != (contact.kind == kind):
                leads = "leads" if group == end else "does not lead"
                yield f"contact {number} ({contact.carries}) {leads} to the board's {kind}"
        if contact.kind == "open" and (read.clusters.label == group).sum() != 1:
            yield f"contact {number} is joined to something; it is to be left open"
