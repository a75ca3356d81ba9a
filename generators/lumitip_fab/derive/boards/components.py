"""Components of auxiliary boards: catalogue entries in their places, with nets at their pads."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

from lumitip_fab.catalogue import electronics
from lumitip_fab.catalogue.controllers import OPEN, Leaded, Strip
from lumitip_fab.config.load import Input
from lumitip_fab.derive.boards import connectors
from lumitip_fab.design import Component, Point, footprints

Nets = tuple[tuple[str, str], ...]


def strip(
    ref: str, value: str, entry: Strip, at: Point, nets: tuple[str, ...], pins: tuple[str, ...]
) -> Component:
    """Two rows of contacts, counter-clockwise from the lower left; a plug goes into a box header
    from the nearer end of the board."""
    return Component(
        ref=ref,
        kind="header",
        value=value,
        part=entry.order_number,
        manufacturer=entry.manufacturer,
        lcsc=entry.lcsc,
        footprint=footprints.rows("Header", entry, "north" if at[1] > 0 else "south"),
        x_mm=at[0],
        y_mm=at[1],
        angle_deg=0.0,
        side="front",
        nets=numbered(nets),
        pins=pins,
    )


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


def wires(ref: str, signals: tuple[str, ...], at: Point, wide: bool) -> Component:
    """Wire pads of a cable in a row, each called by its signal."""
    pitch, pad, drill = connectors.WIDE if wide else connectors.NARROW
    return Component(
        ref=ref,
        kind="wires",
        value=f"{len(signals)} wires",
        part="",
        footprint=footprints.row("WirePads", len(signals), pitch, pad, drill),
        x_mm=at[0],
        y_mm=at[1],
        angle_deg=0.0,
        side="front",
        nets=numbered(signals),
        pins=signals,
    )


def chip(
    ref: str,
    kind: str,
    value: str,
    entry: electronics.Chip,
    at: Point,
    angle_deg: float,
    nets: tuple[str, str],
) -> Component:
    """A part with two terminals."""
    return Component(
        ref=ref,
        kind=kind,
        value=value,
        part=entry.order_number,
        manufacturer=entry.manufacturer,
        lcsc=entry.lcsc,
        footprint=footprints.chip(kind, entry),
        x_mm=at[0],
        y_mm=at[1],
        angle_deg=angle_deg,
        side="front",
        nets=numbered(nets),
    )


def resistor(
    ref: str,
    code: str,
    entry: electronics.Resistor,
    at: Point,
    angle_deg: float,
    nets: tuple[str, str],
) -> Component:
    """A resistor by the code of its value."""
    device = chip(ref, "resistor", code, entry, at, angle_deg, nets)
    return replace(device, part=entry.part(code), lcsc=entry.lcsc_of(code))


def capacitor(
    config: Input, ref: str, name: str, at: Point, angle_deg: float, nets: tuple[str, str]
) -> Component:
    """A capacitor by its name in the catalogue."""
    entry = config.catalogue.capacitors[name]
    return chip(ref, "capacitor", name.split(maxsplit=1)[0], entry, at, angle_deg, nets)


def leaded(
    ref: str,
    kind: str,
    value: str,
    entry: Leaded,
    at: Point,
    angle_deg: float,
    nets: dict[str, str],
) -> Component:
    """A part with leads; `nets` has the net of each lead by its name."""
    return Component(
        ref=ref,
        kind=kind,
        value=value,
        part=entry.order_number,
        manufacturer=entry.manufacturer,
        lcsc=entry.lcsc,
        footprint=footprints.leaded(entry),
        x_mm=at[0],
        y_mm=at[1],
        angle_deg=angle_deg,
        side="front",
        nets=numbered(tuple(nets[name] for name in entry.names)),
        pins=entry.names,
    )


def fiducials(places: Iterable[Point]) -> tuple[Component, ...]:
    """Marks for the placing machine's camera."""
    shape = footprints.dot("Fiducial")
    return tuple(
        Component(
            ref=f"FID{i}",
            kind="fiducial",
            value="Fiducial",
            part="",
            footprint=shape,
            x_mm=x,
            y_mm=y,
            angle_deg=0.0,
            side="front",
            nets=(),
        )
        for i, (x, y) in enumerate(places, start=1)
    )


def numbered(nets: tuple[str, ...]) -> Nets:
    """Nets of pads that are numbered from 1; one that is left open has none."""
    return tuple((str(i), net) for i, net in enumerate(nets, start=1) if net != OPEN)
