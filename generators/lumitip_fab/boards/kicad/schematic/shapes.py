"""Symbols that are drawn for one part, chips and rows of contacts, and the types of their pins."""

import re
from collections.abc import Iterator, Sequence

from lumitip_fab.boards.kicad.schematic.sheet import text_mm, up_to_grid
from lumitip_fab.boards.kicad.schematic.symbols import (
    GRID_MM,
    PIN_MM,
    PITCH_MM,
    box,
    circle,
    drawn,
    pin,
    symbol,
)
from lumitip_fab.boards.kicad.sexpr import Node, Value
from lumitip_fab.design import Component, Point
from lumitip_fab.text import table_of

Rows = Sequence[tuple[str, int]]
"""Pads with their rows from the top."""
_LEAD_MM = 3.81  # of contacts and pins below, with room for a number of two digits above it
_INSIDE_MM = 2.54  # between names of the two sides


def chip(part: Component, left: Rows, right: Rows, below: Sequence[str] = ()) -> Node:
    """A box with named pins on its sides, and pins below it; its place is row 0, in its middle."""
    names = pin_names(part)
    rows = max((row for _, row in (*left, *right)), default=0) + 1
    wide = sum(max((text_mm(names[pad]) for pad, _ in side), default=0.0) for side in (left, right))
    half = up_to_grid(max(wide + _INSIDE_MM + 2 * GRID_MM, len(below) * PITCH_MM) / 2)
    under = max((text_mm(names[pad]) for pad in below), default=0.0)
    foot = rows * PITCH_MM + up_to_grid(under)
    pins = [
        pin(pad, side * (half + PIN_MM), -row * PITCH_MM, angle, PIN_MM, *_typed(part, pad))
        for of_side, side, angle in ((left, -1, 0), (right, 1, 180))
        for pad, row in of_side
    ]
    first = -(len(below) // 2) * PITCH_MM
    pins += [
        pin(pad, first + i * PITCH_MM, -foot - _LEAD_MM, 90, _LEAD_MM, *_typed(part, pad))
        for i, pad in enumerate(below)
    ]
    return symbol(
        _letter(part), [box(-half, PITCH_MM, half, -foot, fill="background")], pins, shown=True
    )


def strip(part: Component, pads: Sequence[str], side: int) -> Node:
    """A column of contacts, first at the top, with their pins to the left (-1) or right (1)."""
    names = pin_names(part)
    wide = max((text_mm(names[pad]) for pad in pads if pad in names), default=0.0)
    half = up_to_grid((wide + 2 * GRID_MM) / 2)
    pins = [
        pin(
            *(pad, side * (half + _LEAD_MM), -row * PITCH_MM, 90 + 90 * side, _LEAD_MM),
            *_typed(part, pad),
        )
        for row, pad in enumerate(pads)
    ]
    foot = (len(pads) - 0.5) * PITCH_MM
    body = box(-half, PITCH_MM / 2, half, -foot, fill="background")
    return symbol(_letter(part), [body], pins, shown=True)


def header(part: Component, pads: Sequence[str]) -> Node:
    """Two columns of contacts, counted across both, from the upper left."""
    ways = len(pads) // 2
    half = up_to_grid(2 * PITCH_MM)
    pins = [
        pin(pad, side * (half + _LEAD_MM), -row * PITCH_MM, angle_deg, _LEAD_MM)
        for side, angle_deg, column in ((-1, 0, pads[::2]), (1, 180, pads[1::2]))
        for row, pad in enumerate(column)
    ]
    foot = (ways - 0.5) * PITCH_MM
    dots = [
        circle(side * PITCH_MM, -row * PITCH_MM, 0.762) for row in range(ways) for side in (-1, 1)
    ]
    body = box(-half, PITCH_MM / 2, half, -foot, fill="background")
    return symbol(_letter(part), [body, *dots], pins, shown=True)


def passed(part: Component, pads: Sequence[str]) -> Node:
    """A column of pads that wires pass through."""
    dots = [circle(0, -row * PITCH_MM, 0.762) for row in range(len(pads))]
    pins = [pin(pad, 0, -row * PITCH_MM, 0, 0) for row, pad in enumerate(pads)]
    foot = (len(pads) - 0.5) * PITCH_MM
    frame = box(-GRID_MM, PITCH_MM / 2, GRID_MM, -foot)
    return symbol(_letter(part), [frame, *dots], pins)


def lying(shape: Value) -> Value:
    """A symbol with x and y exchanged: what was above is to the right, what was left is below."""
    if not isinstance(shape, tuple) or shape[0] == "property":
        return shape
    key, *values = shape
    if key in ("xy", "start", "end", "center", "at") and len(values) in (2, 3):
        x, y, *angle = values
        turned = [(90 - a) % 360 for a in angle if isinstance(a, int | float)]
        return (key, y, x, *turned)
    return (key, *map(lying, values))


def _typed(part: Component, pad: str) -> tuple[str, str]:
    """Name and type of a pin."""
    name = pin_names(part).get(pad, "~")
    return name, pin_type(part, name)


def _letter(part: Component) -> str:
    """The letters of a part's reference."""
    return part.ref.rstrip("0123456789")


def pins_of(shape: Node) -> dict[str, Point]:
    """Outer end of each pin of a symbol, y up, by its number."""
    found = {}
    for node in _nodes(shape, "pin"):
        (at,) = _nodes(node, "at")
        (number,) = _nodes(node, "number")
        x, y = (float(value) for value in at[1:3] if isinstance(value, int | float))
        found[str(number[1])] = x, y
    return found


def _nodes(node: Node, key: str) -> Iterator[Node]:
    """The nodes of a kind inside another, at any depth."""
    for value in node[1:]:
        if isinstance(value, tuple):
            if value[0] == key:
                yield value
            else:
                yield from _nodes(value, key)


def mosfet(part: Component, channel: str) -> Node:
    """A MOSFET with a `"P"` channel, its source above its drain, or an `"N"` channel, its drain
    above its source: gate to the left, its diode to the right."""
    lands = {name: land for (land, _), name in zip(part.nets, part.pins, strict=True)}
    return drawn(f"{channel}_MOSFET", **lands)


_PORT = re.compile(r"[AD]\d+|P\d_\d+")
"""Pins of a controller that its firmware makes inputs or outputs."""


def pin_type(part: Component, name: str) -> str:
    """Type of a part's pin, such as `"power_in"`; passive where its name says nothing."""
    known = table_of("boards/kicad/tables.toml")["pins"].get(part.kind, {})
    port = part.kind in ("module", "socket") and _PORT.fullmatch(name)
    return str(known.get(name, "bidirectional" if port else "passive"))


def pin_names(part: Component) -> dict[str, str]:
    """Name of each pad; none where a part has no names."""
    return dict(zip((pad.number for pad in part.footprint.pads), part.pins, strict=False))
