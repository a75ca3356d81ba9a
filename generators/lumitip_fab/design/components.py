"""Components of boards: catalogue entries with the nets of their pads, in their places."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

from lumitip_fab.catalogue.controllers import OPEN, Leaded, Strip
from lumitip_fab.catalogue.electronics import Capacitor, Chip, Resistor, ResistorArray
from lumitip_fab.catalogue.record import Ordered
from lumitip_fab.design import footprints
from lumitip_fab.design.pcb import Component, Footprint
from lumitip_fab.design.shape import Point, Side
from lumitip_fab.text import resistor_code

Nets = tuple[tuple[str, str], ...]
MIDDLE: Point = (0.0, 0.0)
"""Place of a component that placement moves."""


def mounted(
    ref: str,
    kind: str,
    value: str,
    entry: Ordered,
    shape: Footprint,
    nets: Nets,
    at: Point = MIDDLE,
    angle_deg: float = 0.0,
    pins: tuple[str, ...] = (),
) -> Component:
    """A part that is bought and soldered to the board's front."""
    return Component(
        ref=ref,
        kind=kind,
        value=value,
        part=entry.order_number,
        manufacturer=entry.manufacturer,
        lcsc=entry.lcsc,
        datasheet=entry.datasheet,
        footprint=shape,
        x_mm=at[0],
        y_mm=at[1],
        angle_deg=angle_deg,
        side="front",
        nets=nets,
        pins=pins,
        hand_soldered=isinstance(entry, Strip) and entry.hand_soldered,
    )


def copper(
    ref: str,
    kind: str,
    value: str,
    shape: Footprint,
    nets: Nets,
    at: Point = MIDDLE,
    side: Side = "front",
    pins: tuple[str, ...] = (),
) -> Component:
    """Bare copper, for which no part is bought."""
    return Component(ref, value, "", kind, shape, *at, 0.0, side, nets, pins=pins)


def chip(
    ref: str,
    kind: str,
    value: str,
    entry: Chip,
    nets: Sequence[str],
    at: Point = MIDDLE,
    angle_deg: float = 0.0,
) -> Component:
    """A part with two terminals, each with its net."""
    shape = footprints.chip(kind, entry)
    made = mounted(ref, kind, value, entry, shape, numbered(nets), at, angle_deg)
    return replace(made, rating=f"{entry.rated_v:g} V") if isinstance(entry, Capacitor) else made


def resistor(
    ref: str,
    ohm: float,
    entry: Resistor | ResistorArray,
    nets: Sequence[str],
    at: Point = MIDDLE,
    angle_deg: float = 0.0,
) -> Component:
    """A resistor, or an array of them; the order number of its package has the resistance."""
    code = resistor_code(ohm)
    if isinstance(entry, Resistor):
        made = chip(ref, "resistor", code, entry, nets, at, angle_deg)
    else:
        shape = footprints.array(entry)
        made = mounted(ref, "resistor array", code, entry, shape, numbered(nets), at, angle_deg)
    return replace(made, part=entry.part(code), lcsc=entry.lcsc_of(code))


def leaded(
    ref: str,
    kind: str,
    value: str,
    entry: Leaded,
    nets: dict[str, str],
    at: Point,
    angle_deg: float,
) -> Component:
    """A part with leads; `nets` has the net of each lead by its name, but for open ones."""
    leads = numbered(name if name == OPEN else nets[name] for name in entry.names)
    shape = footprints.leaded(entry)
    return mounted(ref, kind, value, entry, shape, leads, at, angle_deg, entry.names)


def strip(
    ref: str, value: str, entry: Strip, nets: tuple[str, ...], at: Point, pins: tuple[str, ...]
) -> Component:
    """Two rows of contacts, counted across both; a plug goes into a box header from the nearer
    end of the board."""
    shape = footprints.rows("Header", entry)
    angle_deg = 180.0 if shape.shroud and at[1] < 0 else 0.0
    return mounted(ref, "header", value, entry, shape, numbered(nets), at, angle_deg, pins)


def from_behind(device: Component, places: Sequence[Point]) -> Component:
    """The same rows of contacts with the body on the board's back, each contact in its place.

    Args:
        device: the rows, its pads in any order.
        places: of contact 1, 2 ..., from the middle of the device, seen from the board's front.
    """
    size = device.footprint.pads[0]
    pads = tuple(
        replace(size, number=str(number), x_mm=x, y_mm=-y, round=number > 1)
        for number, (x, y) in enumerate(places, start=1)
    )
    name = device.footprint.name.replace("Header", "SpringContacts")
    # Mirrored in x and turned by half: contact 1 is at the lower left in the device's own frame.
    return replace(
        device,
        side="back",
        angle_deg=180.0,
        footprint=replace(device.footprint, name=name, pads=pads),
    )


def wires(
    ref: str,
    signals: Sequence[str],
    size_mm: tuple[float, float, float],
    at: Point = MIDDLE,
    named: bool = True,
) -> Component:
    """Wire pads in a row, one for each signal.

    Args:
        ref: reference.
        signals: net of each pad, from the left.
        size_mm: pitch, diameter of the pads, diameter of their holes.
        at: middle of the row.
        named: whether the signals are printed beside the pads.
    """
    shape = footprints.row("WirePads", len(signals), *size_mm)
    pins = tuple(signals) if named else ()
    value = f"{len(signals)} wires"
    return copper(ref, "wires", value, shape, numbered(signals), at, pins=pins)


def probe(
    ref: str,
    signal: str,
    at: Point = MIDDLE,
    side: Side = "back",
    pad_mm: float = footprints.DOT_MM,
) -> Component:
    """A pad to hold a probe to, `pad_mm` wide."""
    shape = footprints.dot("TestPoint", pad_mm)
    return copper(ref, "test point", signal, shape, numbered([signal]), at, side)


def fiducials(
    places: Sequence[Point], diameter_mm: float = 1.0, side: Side = "front", first: int = 1
) -> tuple[Component, ...]:
    """Marks for the placing machine's camera; their numbers begin at `first`."""
    shape = footprints.dot("Fiducial", diameter_mm)
    return tuple(
        copper(f"FID{i}", "fiducial", "Fiducial", shape, (), at, side=side)
        for i, at in enumerate(places, start=first)
    )


def numbered(nets: Iterable[str]) -> Nets:
    """Nets of pads that are numbered from 1; one that is left open has none."""
    return tuple((str(i), net) for i, net in enumerate(nets, start=1) if net != OPEN)
