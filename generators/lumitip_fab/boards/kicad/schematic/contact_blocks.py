"""Rows of contacts: headers, sockets with the pads beside them, and wire pads."""

from collections.abc import Mapping, Sequence
from itertools import groupby

from lumitip_fab.boards.kicad.schematic import shapes
from lumitip_fab.boards.kicad.schematic.draft import Draft
from lumitip_fab.boards.kicad.schematic.power_path import STEP_MM
from lumitip_fab.boards.kicad.schematic.sheet import GRID_MM, text_mm, up_to_grid
from lumitip_fab.boards.kicad.schematic.symbols import PITCH_MM
from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.design import Component, Point

_APART_MM = 7.62  # between rows of contacts
_ABOVE_MM = 5.08, 2.54  # reference and value above the first contact
_ENDS_MM = 5.08  # from a pin to the name of its net
_NAME_MM = 5.08  # what a label or the symbol of a supply needs beyond its letters


def draw_strips(draft: Draft, parts: Sequence[Component], x: float = 0.0) -> None:
    """Rows of contacts beside each other, from a place on."""
    for part in parts:
        x = _header(draft, part, x) if is_header(part) else _strip(draft, part, x)
        x += _APART_MM


def is_header(part: Component) -> bool:
    """Whether a part is a plug with two rows, whose contacts are counted across both."""
    whole = len(part.nets) == len(part.footprint.pads) and len(part.nets) % 2 == 0
    return part.kind == "header" and part.side == "front" and whole


def draw_sockets(draft: Draft, pairs: Sequence[tuple[Component, Component]]) -> None:
    """Sockets, each with the pads beside it that carry the same nets: a wire for each contact."""
    x = 0.0
    for i, (socket, pads) in enumerate(pairs):
        side = 1 if i % 2 else -1
        x = _socket(draft, socket, pads, side, x) + _APART_MM


def _socket(draft: Draft, socket: Component, pads: Component, side: int, x: float) -> float:
    numbers = [number for number, _ in socket.nets]
    shape = shapes.strip(socket, numbers, side)
    beside = abs(next(iter(shapes.pins_of(shape).values()))[0])
    wide = max(text_mm(net) for _, net in socket.nets) + _NAME_MM
    through = _pads_mm(pads)
    reach = up_to_grid(beside + 2 * through + wide)
    middle = x + (reach if side < 0 else beside)
    pins = _placed(draft, socket, f"Socket_{socket.ref}", shape, (middle, 0.0))
    column = middle + side * (beside + through)
    beads = shapes.passed(pads, numbers)
    dots = _placed(draft, pads, f"Pads_{pads.ref}", beads, (column, 0.0))
    for number, net in socket.nets:
        end = dots[number][0] + side * through, dots[number][1]
        draft.wire(pins[number], dots[number], end)
        draft.end(net, end, side)
    return x + reach + beside


def _pads_mm(pads: Component) -> float:
    """From a socket's pins to its pads, whose value stands above them."""
    return up_to_grid(max(2 * STEP_MM, text_mm(pads.value) / 2 + GRID_MM))


def _strip(draft: Draft, part: Component, x: float) -> float:
    numbers = [number for number, _ in part.nets]
    shape = shapes.strip(part, numbers, 1)
    beside = abs(next(iter(shapes.pins_of(shape).values()))[0])
    half = up_to_grid(max(beside, *(text_mm(words) / 2 for words in (part.ref, part.value))))
    pins = _placed(draft, part, f"Strip_{part.ref}", shape, (x + half, 0.0))
    _ends(draft, [(net, pins[number]) for number, net in part.nets], 1)
    _open(draft, part, x, len(numbers))
    return x + half + beside + _names_mm(dict(part.nets))


def _header(draft: Draft, part: Component, x: float) -> float:
    numbers = [number for number, _ in part.nets]
    shape = shapes.header(part, numbers)
    beside = max(place[0] for place in shapes.pins_of(shape).values())
    names = _names_mm(dict(part.nets))
    pins = _placed(draft, part, f"Header_{part.ref}", shape, (x + names + beside, 0.0))
    _ends(draft, [(net, pins[number]) for number, net in part.nets[::2]], -1)
    _ends(draft, [(net, pins[number]) for number, net in part.nets[1::2]], 1)
    _open(draft, part, x + names, len(numbers) // 2)
    return x + 2 * (names + beside)


def _names_mm(nets: Mapping[str, str]) -> float:
    """Room for the names of nets beside the pins."""
    return up_to_grid(_ENDS_MM + max(map(text_mm, nets.values())) + _NAME_MM)


def _placed(draft: Draft, part: Component, name: str, shape: Node, at: Point) -> dict[str, Point]:
    texts = [(0.0, -above - GRID_MM / 2) for above in _ABOVE_MM]
    return draft.place(part, name, shape, at, 0, *texts)


def _ends(draft: Draft, pins: Sequence[tuple[str, Point]], side: int) -> None:
    """The name of each pin's net; neighbours of one net are joined, and named once."""
    for net, group in groupby(pins, key=lambda pin: pin[0]):
        places = [place for _, place in group]
        joint = places[0][0] + side * STEP_MM
        for place in places:
            draft.wire(place, (joint, place[1]))
        draft.wire((joint, places[0][1]), (joint, places[-1][1]))
        end = places[0][0] + side * _ENDS_MM, places[0][1]
        draft.wire((joint, end[1]), end)
        draft.end(net, end, side)


def _open(draft: Draft, part: Component, x: float, rows: int) -> None:
    """Contacts without a net, by their numbers."""
    joined = {number for number, _ in part.nets}
    left_open = [pad.number for pad in part.footprint.pads if pad.number not in joined]
    if left_open:
        draft.text(f"open: {', '.join(left_open)}", (x, rows * PITCH_MM + 2 * STEP_MM))
