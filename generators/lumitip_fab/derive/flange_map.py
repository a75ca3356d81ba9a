"""What stands on the coupling's contacts, against the coupling's own map of them."""

import json
import math

from lumitip_fab.carrier_entry import OPEN, Strip
from lumitip_fab.coupling_entry import Contact, ToolCoupling
from lumitip_fab.derive.faults import Faults
from lumitip_fab.load import Input

PLACE_MM = 0.05
_FOR = {"supply": "SUPPLY", "ground": "GND"}
"""Signal that belongs on a contact of a kind, and on no other."""


def refuse_map(given: Input, faults: Faults) -> None:
    """Refuse contacts where the coupling has none, and nets that join what must stay apart."""
    p = given.parameters.flange
    coupling = given.catalogue.couplings[p.coupling]
    strip = given.catalogue.strips[p.contacts]
    if not _meets(strip, coupling):
        faults.refuse(
            "flange.contacts",
            f"{p.contacts!r} given, {strip.rows} x {strip.ways} contacts {strip.pitch_mm:g} mm "
            f"apart, which do not meet the {len(coupling.contacts)} contacts of {p.coupling!r}. "
            "Take another strip or flange.coupling",
        )
        return
    if len(p.signals) != len(coupling.contacts):
        faults.refuse(
            "flange.signals",
            f"{len(p.signals)} signals given, {p.coupling!r} has {len(coupling.contacts)} "
            f"contacts: one for each is needed. Take {_own(coupling)}",
        )
        return
    for signal in dict.fromkeys(p.signals):
        on = [
            (number, contact)
            for number, contact in enumerate(coupling.contacts, start=1)
            if p.signals[number - 1] == signal
        ]
        if signal != OPEN and (wrong := _wrong(signal, on)):
            faults.refuse(
                "flange.signals",
                f"{wrong}, by the map of {p.coupling!r} in parts/couplings.toml. Take "
                f"{_own(coupling)}, or an entry with the map that you have measured",
            )


def _meets(strip: Strip, coupling: ToolCoupling) -> bool:
    """Whether every contact of a strip stands on one of the coupling, and none is left."""
    x, y = coupling.contacts_at_mm
    wanted = [(contact.at_mm[0] - x, contact.at_mm[1] - y) for contact in coupling.contacts]
    offsets = [place - (strip.ways - 1) / 2 for place in range(strip.ways)]
    rows = [place - (strip.rows - 1) / 2 for place in range(strip.rows)]
    there = [(place * strip.pitch_mm, row * strip.pitch_mm) for row in rows for place in offsets]
    near = [min(math.dist(one, other) for other in there) <= PLACE_MM for one in wanted]
    return all(near) and len(wanted) == len(there)


def _wrong(signal: str, on: list[tuple[int, Contact]]) -> str:
    """What is wrong with a net on these contacts; empty if nothing is."""
    where = " and ".join(f"{number} ({contact.carries})" for number, contact in on)
    if len({contact.carries for _, contact in on}) > 1:
        return f"{signal} stands on contacts {where}, which carry different signals"
    where = f"contact{'s' if len(on) > 1 else ''} {where}"
    _, contact = on[0]
    belongs = _FOR.get(contact.kind)
    if contact.kind == "open":
        return f"{signal} stands on {where}: {OPEN} is needed there"
    if belongs and signal != belongs:
        return f"{signal} stands on {where}, of kind {contact.kind}: {belongs} is needed there"
    if not belongs and signal in (*_FOR.values(), "REGULATED"):
        return (
            f"{signal} stands on {where}, of kind {contact.kind}: a line of its own is needed there"
        )
    return ""


def _own(coupling: ToolCoupling) -> str:
    """The signals that the coupling's map asks for, as TOML."""
    return json.dumps([_FOR.get(contact.kind, contact.carries) for contact in coupling.contacts])
