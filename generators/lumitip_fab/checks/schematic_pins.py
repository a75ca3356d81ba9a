"""Pins of chips and transistors in a schematic: names by the catalogue, types by what they do, so
that KiCad's electrical rules see leads that are exchanged."""

import re
from collections.abc import Iterator

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.readers.kicad_sheet import Pin, Sheet
from lumitip_fab.design import Multiplexer

_TYPES = {
    "power_in": r"V?IN|VCC|VEE|VDDH?|VBUS|GND",
    "input": r"SET|FB|EN|G|S\d|~\{E\}|SWDCLK",
    "output": r"OUT|SW",
    "power_out": r"OUT",
}
"""Types of pins, each with the names of those that may have it; others are not compared."""
_CHIPS = re.compile(r"[UQ]\d+")


def other_pins(sheet: Sheet, read: ReadBoard) -> Iterator[str]:
    """Pins with another name than their lead has in the catalogue, or of a type that lets KiCad
    join them with anything. Of pins on top of each other, one has the type."""
    for symbol in sheet.symbols:
        leads = _leads(read, symbol.ref) if _CHIPS.fullmatch(symbol.ref) else {}
        for number, name in leads.items():
            pins = {pin.number: pin for pin in symbol.pins}
            if number in pins and pins[number].name != name:
                yield f"{symbol.ref}.{number} is {pins[number].name}, not {name}"
        for name in sorted(set(leads.values())):
            kinds = [kind for kind, names in _TYPES.items() if re.fullmatch(names, name)]
            pins_of = [pin for pin in symbol.pins if pin.name == name]
            if kinds and pins_of and not _typed(pins_of, kinds):
                yield f"{symbol.ref} {name} is {pins_of[0].kind}, not {' or '.join(kinds)}"


def _typed(pins: list[Pin], kinds: list[str]) -> bool:
    """Whether each place of pins has one of a type that fits, and none of another one but
    passive."""
    places = {pin.at for pin in pins}
    found = {pin.at for pin in pins if pin.kind in kinds}
    return found == places and all(pin.kind in (*kinds, "passive") for pin in pins)


def _leads(read: ReadBoard, ref: str) -> dict[str, str]:
    """Name of each lead of a part by its number; none of parts without names."""
    packages = read.design.packages
    if not read.finger:
        parts = (d for d in read.components if d.ref == ref and d.pins)
        for part in parts:
            return dict(zip((pad.number for pad in part.footprint.pads), part.pins, strict=False))
        return {}
    if ref.startswith("Q"):
        on_emitter = read.strings and packages.switch is not None and ref == "Q1"
        return _counted(packages.switch.names) if packages.switch and on_emitter else {}
    return _counted(packages.source.names) if read.strings else _of_mux(packages.multiplexer)


def _counted(names: tuple[str, ...]) -> dict[str, str]:
    return {str(number): name for number, name in enumerate(names, start=1)}


def _of_mux(mux: Multiplexer) -> dict[str, str]:
    """Names of a multiplexer's leads, as data sheets of its kind have them."""
    names = {mux.output: "Z", mux.supply: "VCC", mux.ground: "GND", mux.enable: "~{E}"}
    names |= {lead: f"Y{channel}" for channel, lead in enumerate(mux.input_leads)}
    names |= {lead: f"S{bit}" for bit, lead in enumerate(mux.select)}
    names |= {mux.negative: "VEE"} if mux.negative is not None else {}
    return {str(lead): name for lead, name in names.items()}
