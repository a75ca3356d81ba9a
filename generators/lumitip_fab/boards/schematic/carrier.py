"""The sheet of a carrier: every part with the names of its nets at its pins."""

from lumitip_fab.boards.model import Component, Placement
from lumitip_fab.boards.pcb.sexpr import Node
from lumitip_fab.boards.schematic import symbols
from lumitip_fab.boards.schematic.files import sheet_files
from lumitip_fab.boards.schematic.paper import MARGIN_MM, paper_for
from lumitip_fab.boards.schematic.sheet import Drawn, Sheet
from lumitip_fab.design import Carrier, Device, Point

_PITCH_MM = 2.54  # from pin to pin
_COLUMN_MM = 50.8
_ABOVE_MM = 12.7  # of a part, for its reference
_TALL_MM = 150.0  # of a column of parts
_PLAIN = {"resistor": "R", "capacitor": "C"}  # symbols of parts with two like terminals
_PLAIN_MM = 25.4
_LABEL_MM = 5.08  # wire from a pin to its label


def carrier_sheet(board: Placement, carrier: Carrier) -> dict[str, bytes]:
    """Sheet, symbol library and its table, by their path beside the board.

    Args:
        board: its parts, with their nets.
        carrier: for what their contacts are called.
    """
    parts = {part.ref: part for part in board.components}
    shapes: dict[str, Node] = {}
    sheet = Sheet()
    x = y = MARGIN_MM
    sheet.texts.append((carrier.title, (x, y), 2.5))
    hand = symbols.hand_drawn()
    for device in (d for d in carrier.devices if d.nets):
        plain = _PLAIN.get(device.kind)
        tall = _PLAIN_MM if plain else len(device.nets) * _PITCH_MM + _ABOVE_MM
        if y + tall > MARGIN_MM + _TALL_MM:
            x, y = x + _COLUMN_MM, MARGIN_MM
        part = parts[device.ref]
        if plain:
            shapes.setdefault(plain, hand[plain])
            _two(sheet, (x + 4 * _PITCH_MM, y + _PLAIN_MM / 2), plain, part)
        else:
            name, shape = _contacts(device)
            shapes.setdefault(name, shape)
            _row(sheet, (x + _PITCH_MM, y + _ABOVE_MM), part, name)
        y += tall
    paper, _ = paper_for(x + _COLUMN_MM - MARGIN_MM, _TALL_MM)
    return sheet_files(board, paper, sheet, shapes, parts)


def _contacts(device: Device) -> tuple[str, Node]:
    """Name and symbol of a row of contacts; of a module only the pads that are joined."""
    numbers = [number for number, _ in device.nets]
    if device.kind == "module":
        return "Module", symbols.contacts(numbers, _PITCH_MM, "U")
    return f"Strip{len(numbers)}", symbols.wires(len(numbers), _PITCH_MM)


def _two(sheet: Sheet, at: Point, symbol: str, part: Component) -> None:
    """A part with two terminals, upright, each with the name of its net."""
    x, y = at[0] // 1.27 * 1.27, at[1] // 1.27 * 1.27
    sheet.symbols.append(
        Drawn(symbol, part.ref, part.value, x, y, ref_at=(-5.08, -1.27), value_at=(-5.08, 1.27))
    )
    for (_, net), way in zip(part.nets, (-1, 1), strict=True):
        sheet.wire((x, y + way * 3.81), (x, y + way * 7.62), (x + _LABEL_MM, y + way * 7.62))
        sheet.flag(net, (x + _LABEL_MM, y + way * 7.62), 0)


def _row(sheet: Sheet, at: Point, part: Component, symbol: str) -> None:
    """A row of contacts, first at the top, each with the name of its net."""
    ways = len(part.nets)
    x, first = at
    middle = first + (ways - 1) / 2 * _PITCH_MM
    sheet.symbols.append(
        Drawn(symbol, part.ref, part.value, x, middle,
              pins=tuple(pad for pad, _ in part.nets),
              ref_at=(0, -ways / 2 * _PITCH_MM - 1.27),
              value_at=(0, ways / 2 * _PITCH_MM + 1.27))
    )  # fmt: skip
    for i, (_, net) in enumerate(part.nets):
        y = first + i * _PITCH_MM
        sheet.wire((x + _LABEL_MM, y), (x + 2 * _LABEL_MM, y))
        sheet.flag(net, (x + 2 * _LABEL_MM, y), 0)
