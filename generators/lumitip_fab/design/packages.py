"""`Packages`: the parts of the fingers' boards, as the catalogue has them."""

from dataclasses import dataclass

from lumitip_fab.catalogue.controllers import Transistor
from lumitip_fab.catalogue.current_sources import CurrentSource
from lumitip_fab.catalogue.electronics import (
    Capacitor,
    Led,
    Multiplexer,
    Photodetector,
    Resistor,
    ResistorArray,
)
from lumitip_fab.catalogue.record import TRUSTED
from lumitip_fab.design.boards import Finger

Marked = Led | Photodetector
"""A part with a mark at one of its ends."""

OTHER = {"anode": "cathode", "cathode": "anode", "collector": "emitter", "emitter": "collector"}
"""The other terminal of a part with two."""
KNOWN = TRUSTED
"""Levels of confidence with which a mark needs no look at the part."""


@dataclass(frozen=True)
class Packages:
    """The parts of both boards, as the catalogue has them."""

    led: Led
    led_name: str
    """In the catalogue, which is the value on drawings; likewise below."""
    source: CurrentSource
    """Of each string of LEDs, if they have one."""
    source_name: str
    string_resistor: Resistor
    photodetector: Photodetector
    photodetector_name: str
    pull_up: Resistor
    """Shared by the photodetectors of a multiplexer; the same package pulls the gate of the LEDs'
    switch down."""
    array: ResistorArray
    """Of the photodetectors' own pull-ups."""
    capacitor: Capacitor
    bulk: Capacitor | None
    """Beside the wire of the receiver's supply; none where it has no room or is not wanted."""
    bulk_name: str
    multiplexer: Multiplexer
    switch: Transistor | None
    """Between the strings of LEDs and ground; none where they are always on."""
    switch_name: str

    @property
    def unmarked(self) -> dict[str, Marked]:
        """By its kind, each part whose marked terminal is neither measured nor read from a
        datasheet: one of them is tried before boards are ordered."""
        parts: dict[str, Marked] = {
            "LED": self.led,
            "photodetector": self.photodetector,
        }
        return {kind: part for kind, part in parts.items() if not part.mark_is_known}

    def at_cells(self, finger: Finger) -> Marked:
        """What emits or detects light on a finger."""
        return self.led if finger.cells_hold.kind == "led" else self.photodetector
