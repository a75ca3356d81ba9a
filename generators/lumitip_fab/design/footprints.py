"""Footprints of parts, from their dimensions in the catalogue."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Literal

from lumitip_fab.catalogue import controllers as catalogue
from lumitip_fab.catalogue.controllers import Leaded, Module, Strip
from lumitip_fab.catalogue.current_sources import CurrentSource
from lumitip_fab.catalogue.electronics import Chip, Multiplexer, ResistorArray
from lumitip_fab.design import Design
from lumitip_fab.design.pcb import Footprint, Form, Pad, Shroud
from lumitip_fab.design.shape import Box

DOT_MM = 1.0
"""Diameter of a mark for cameras, and of a test point behind a wire pad."""
_TOE_MM = 0.4  # pad beyond the tip of a lead
_CHIPS = {
    "resistor": "RESC",
    "capacitor": "CAPC",
    "led": "LEDC",
    "indicator": "LEDC",
    "photodetector": "PTRC",
    "fuse": "FUSC",
    "inductor": "INDC",
    "crystal": "XTAL",
    "tvs diode": "DIOM",
    "esd diode": "DIOM",
    "schottky diode": "DIOM",
}
"""First letters of a chip's name by its kind; of phototransistors the standard has none."""


def of_design(design: Design) -> Iterator[tuple[str, Footprint]]:
    """Every footprint of every board, with the kind of its part; some more than once."""
    packages, own = design.packages, design.wiring.own_pull_ups
    unused = "pull_up" if own and packages.switch is None else "" if own else "array"
    for name, entry in vars(packages).items():
        if name == unused:
            continue
        if isinstance(entry, Multiplexer):
            yield "multiplexer", multiplexer(entry)
        elif isinstance(entry, CurrentSource):
            if design.wiring.set_ohm:
                yield "current source", leaded(entry)
        elif isinstance(entry, ResistorArray):
            yield "resistor array", array(entry)
        elif isinstance(entry, Leaded):
            yield "switch", leaded(entry)
        elif isinstance(entry, Chip):
            kind = type(entry).__name__.lower()
            yield kind, chip(kind, entry)
    for board in design.auxiliary_boards:
        yield from ((part.kind, part.footprint) for part in board.components)


def chip(kind: str, entry: Chip) -> Footprint:
    """A two-terminal part along x, pad 1 to the left."""
    length, width, height = entry.body_mm
    at = entry.pad_pitch_mm / 2
    pads = tuple(Pad(number, x, 0.0, *entry.pad_mm) for number, x in (("1", -at), ("2", at)))
    size = "".join(f"{int(side * 10 + 1e-9):02d}" for side in (length, width))
    name = f"{_CHIPS[kind]}{size}X{_hundredths(height)}N"
    return Footprint(name, pads, _body(length, width), height, "chip")


def multiplexer(entry: Multiplexer) -> Footprint:
    """Leads in two rows, lead 1 at the lower left."""
    row = entry.leads // 2
    pads = _two_rows(row, entry.leads - row, entry)
    length, width, height = entry.body_mm
    pitch, span, high = map(_hundredths, (entry.lead_pitch_mm, entry.lead_tips_mm, height))
    name = f"SOP{pitch}P{span}X{high}-{entry.leads}N"
    return Footprint(name, pads, _body(length, width), height, "leaded", entry.lead_tips_mm)


def array(entry: ResistorArray) -> Footprint:
    """Resistors side by side along x: pads 1, 2 … in the lower row from the left, the other ends
    above them, counted counter-clockwise."""
    pads = []
    for i in range(2 * entry.resistors):
        place, side = (i, -1) if i < entry.resistors else (2 * entry.resistors - 1 - i, 1)
        x = (place - (entry.resistors - 1) / 2) * entry.pad_pitch_mm
        pads.append(Pad(str(i + 1), x, side * entry.row_pitch_mm / 2, *entry.pad_mm))
    length, width, height = entry.body_mm
    size = "".join(f"{round(side * 100)}" for side in (length, width))
    name = f"RESCAV{_hundredths(entry.pad_pitch_mm)}P{size}X{_hundredths(height)}-{len(pads)}N"
    return Footprint(name, tuple(pads), _body(length, width), height, "array")


def leaded(entry: Leaded) -> Footprint:
    """Leads in two rows, lead 1 at the lower left; a row with fewer leads is centred."""
    leads = len(entry.names)
    low = (leads + 1) // 2
    pads = _two_rows(low, leads - low, entry)
    length, width, height = entry.body_mm
    pitch, span, high = map(_hundredths, (entry.lead_pitch_mm, entry.lead_span_mm, height))
    name = f"SOT{pitch}P{span}X{high}-{leads}N"
    tips = entry.lead_tips_mm or entry.lead_span_mm - 2 * _TOE_MM
    return Footprint(name, pads, _body(length, width), height, "leaded", tips)


def _two_rows(low: int, high: int, entry: Multiplexer | Leaded) -> tuple[Pad, ...]:
    """Pads of leads along x, counted counter-clockwise from the lower left."""
    along, across = entry.lead_pad_mm
    y = (entry.lead_span_mm - along) / 2
    pads = []
    for i in range(low + high):
        count, place, side = (low, i, -1) if i < low else (high, low + high - 1 - i, 1)
        x = (place - (count - 1) / 2) * entry.lead_pitch_mm
        pads.append(Pad(str(i + 1), x, side * y, across, along))
    return tuple(pads)


def module(entry: Module) -> Footprint:
    """A module with its antenna at the top."""
    pads = tuple(
        Pad(str(i), x, y, width, height)
        for i, (x, y, width, height) in enumerate(entry.pads_mm, start=1)
    )
    width, length, height = entry.body_mm
    return Footprint(f"Module_{entry.order_number}", pads, _body(width, length), height, "module")


def row(name: str, ways: int, pitch_mm: float, pad_mm: float, drill_mm: float) -> Footprint:
    """A row of plated holes along x about its middle; the first is square.

    Args:
        name: first part of the footprint's name.
        ways: number of holes.
        pitch_mm: from hole to hole.
        pad_mm: diameter of the copper.
        drill_mm: diameter of the hole.
    """
    middle = (ways - 1) / 2
    pads = tuple(
        Pad(str(i + 1), (i - middle) * pitch_mm, 0.0, pad_mm, pad_mm, i > 0, drill_mm, False)
        for i in range(ways)
    )
    full_name = f"{name}_1x{ways:02d}_P{pitch_mm:.2f}mm_D{drill_mm:.1f}mm"
    return Footprint(full_name, pads, _body(ways * pitch_mm, pitch_mm), 0.0)


def bare(footprint: Footprint) -> Footprint:
    """A row whose body is its copper, and no more."""
    first, last = footprint.pads[0], footprint.pads[-1]
    half = first.width_mm / 2
    return replace(footprint, body=Box(first.x_mm - half, last.x_mm + half, -half, half))


def socket(strip: Strip) -> Footprint:
    """A row of plated holes under a socket."""
    bare = row("PinSocket", strip.ways, strip.pitch_mm, strip.pad_mm, strip.drill_mm)
    return replace(bare, height_mm=strip.height_mm, form="socket")


def rows(name: str, strip: Strip) -> Footprint:
    """Two rows of plated holes along x, counted as the contacts of a ribbon cable's socket are:
    across both rows from the left, 1 in the row away from the plug, which goes in from +y.

    Args:
        name: first part of the footprint's name.
        strip: the part on it.

    Source: IDC-Header_2x07_P2.54mm_Horizontal of KiCad's libraries.
    """
    ways, pitch = strip.ways, strip.pitch_mm
    size = strip.pad_mm, strip.pad_mm
    pads = []
    for i in range(2 * ways):
        column, row = divmod(i, 2)
        x, y = pitch * (column - (ways - 1) / 2), pitch * (row - 0.5)
        pads.append(Pad(str(i + 1), x, y, *size, i > 0, strip.drill_mm, False))
    full_name = f"{name}_2x{ways:02d}_P{pitch:.2f}mm_D{strip.drill_mm:.2f}mm"
    shroud = _shroud(strip.shroud, pitch) if strip.shroud else None
    form: Form = "springs" if strip.stroke_mm else "box header" if shroud else "header"
    body = _body(ways * pitch, 2 * pitch)
    return Footprint(full_name, tuple(pads), body, strip.height_mm, form, shroud=shroud)


def _shroud(entry: catalogue.Shroud, pitch_mm: float) -> Shroud:
    length, depth = entry.body_mm
    back = pitch_mm / 2 + entry.beyond_mm
    return Shroud(Box(-length / 2, length / 2, back, back + depth), entry.notch_mm)


def dot(name: Literal["TestPoint", "Fiducial"], pad_mm: float = DOT_MM) -> Footprint:
    """A bare round pad: to hold a probe to, or a mark for the placing machine's camera."""
    pad = Pad("1", 0.0, 0.0, pad_mm, pad_mm, round=True, paste=False)
    return Footprint(f"{name}_D{pad_mm:.1f}mm", (pad,), _body(pad_mm, pad_mm), 0.0)


def _body(length_mm: float, width_mm: float) -> Box:
    return Box(-length_mm / 2, length_mm / 2, -width_mm / 2, width_mm / 2)


def _hundredths(length_mm: float) -> str:
    return str(round(length_mm * 100))
