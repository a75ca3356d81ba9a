"""The spring contacts of the flange's board against the map of the robot's coupling."""

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping

from lumitip_fab.checks.board_read import ReadCarrier
from lumitip_fab.checks.result import Measurement
from lumitip_fab.design import ToolContact
from lumitip_fab.frames import applied, carrier_to_flange

CONTACTS = "J1"
PLACE_MM = 0.02
_SUPPLY, _GROUND = ("F1", 1), ("C1", 2)
"""Pads that the board's supply enters by, at the fuse, and that are on its ground."""
Contacts = Mapping[str, ToolContact]


def measure_contact_map(read: ReadCarrier) -> Iterator[Measurement]:
    """Every pad on the contact of its number, and every net on contacts of its own signal alone."""
    for flange in (f for f in read.design.flanges if f.carrier == read.name):
        contacts = {contact.number: contact for contact in flange.contacts}
        part = read.parts.get(CONTACTS)
        pads = {t.number: t for t in (part.terminals if part else ()) if t.copper is not None}
        lost = sorted(contacts.keys() ^ pads.keys())
        yield read.count("contact_count", [f"{number} at one end only" for number in lost], "pads")
        both = contacts.keys() & pads.keys()
        numbers = [number for number in contacts if number in both]
        on_board = read.sensor([pads[number].at for number in numbers])
        places = applied(carrier_to_flange(flange), on_board)[:, :2]
        off = [math.dist(place, contacts[n].at) for n, place in zip(numbers, places, strict=True)]
        yield read.figure(
            "contact_places",
            max(off, default=math.nan),
            0,
            PLACE_MM,
            note="from the coupling's contact of the same number",
        )
        groups = {number: read.group(CONTACTS, number) for number in numbers}
        named = {number: pads[number].net for number in numbers}
        wrong = [*_joined(contacts, groups), *_joined(contacts, named)]
        yield read.count("contact_signals", sorted({*wrong, *_led(read, contacts, groups)}), "nets")


def _joined(contacts: Contacts, nets: Mapping[str, object]) -> Iterator[str]:
    """Contacts of different signals on one net."""
    on: dict[object, list[str]] = defaultdict(list)
    for number, net in nets.items():
        if net not in ("", None):
            on[net].append(number)
    for numbers in on.values():
        carried = sorted({contacts[number].carries for number in numbers})
        if len(carried) > 1:
            yield f"contacts {', '.join(numbers)} join {' and '.join(carried)}"


def _led(read: ReadCarrier, contacts: Contacts, groups: Mapping[str, int | None]) -> Iterator[str]:
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
