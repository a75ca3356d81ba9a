"""The sheet of an auxiliary board: every part with the names of its nets at its pins."""

import math

from lumitip_fab.boards.kicad.schematic import auxiliary_symbols, symbols
from lumitip_fab.boards.kicad.schematic.files import sheet_files
from lumitip_fab.boards.kicad.schematic.sheet import MARGIN_MM, Drawn, Sheet, paper_for
from lumitip_fab.boards.kicad.sexpr import Node
from lumitip_fab.boards.model import Placement
from lumitip_fab.design import AuxiliaryBoard, Component, Point

_PITCH_MM = 2.54  # from pin to pin
_COLUMN_MM = 50.8
_ABOVE_MM = 12.7  # of a part, for its reference
_TALL_MM = 150.0  # of a column of parts
_UPRIGHT_MM = 25.4  # a part whose terminals are above and below
_ROW_MM = {True: 2.54, False: 12.7}  # from a column's left: contacts, the box of a chip
_LETTER_MM = 1.2
_LABEL_MM = 5.08  # wire from a pin to its label


def auxiliary_sheet(board: Placement, auxiliary: AuxiliaryBoard) -> dict[str, bytes]:
    """Sheet, symbol library and its table, by their path beside the board.

    Args:
        board: its parts, with their nets.
        auxiliary board: for what their contacts are called.
    """
    parts = {part.ref: part for part in board.components}
    shapes: dict[str, Node] = {}
    sheet = Sheet()
    x = y = MARGIN_MM
    sheet.texts.append((auxiliary.title, (x, y), 2.5))
    for device in (d for d in auxiliary.components if d.nets):
        part, two = parts[device.ref], auxiliary_symbols.upright(device.kind)
        upright = two is not None or device.kind == "transistor"
        tall = _UPRIGHT_MM if upright else len(device.nets) * _PITCH_MM + _ABOVE_MM
        if y + tall > MARGIN_MM + _TALL_MM:
            x, y = x + _COLUMN_MM, MARGIN_MM
        name, shape = two or _shape(device)
        shapes.setdefault(name, shape)
        if two:
            _two(sheet, _middle(x, y), name, part)
        elif upright:
            _transistor(sheet, _middle(x, y), name, part, device)
        else:
            _row(sheet, (x + _ROW_MM[device.contacts], y + _ABOVE_MM), part, name)
        if open_ := _left_open(device):
            sheet.texts.append((f"open: {', '.join(open_)}", (x, y + tall + _PITCH_MM), 1.27))
        y += tall
    paper, _ = paper_for(x + _COLUMN_MM - MARGIN_MM, _TALL_MM)
    return sheet_files(board, paper, sheet, shapes, parts)


def _left_open(device: Component) -> list[str]:
    """Contacts that are joined to nothing."""
    joined = {number for number, _ in device.nets}
    return [n.number for n in device.footprint.pads if device.contacts and n.number not in joined]


def _shape(device: Component) -> tuple[str, Node]:
    """Name and symbol of contacts in a row, or of a part whose pins have names."""
    if device.contacts:
        numbers = tuple(number for number, _ in device.nets)
        whole = len(numbers) == len(device.footprint.pads)
        name = f"Strip{len(numbers)}" if whole else f"Strip_{device.ref}"
        return name, symbols.contacts(numbers, _PITCH_MM)
    name = f"{device.kind.capitalize()}_{device.ref}"
    if device.kind == "transistor":
        return name, auxiliary_symbols.transistor(device)
    return name, auxiliary_symbols.chip(device, _PITCH_MM)


def _middle(x: float, y: float) -> Point:
    """Middle of an upright part below a place, on the grid."""
    return (x + 4 * _PITCH_MM) // 1.27 * 1.27, (y + _UPRIGHT_MM / 2) // 1.27 * 1.27


def _beside(words: str, edge_mm: float, y_mm: float) -> Point:
    """Middle of a text that begins at an edge, or ends there on the left."""
    return edge_mm + math.copysign(len(words) * _LETTER_MM / 2, edge_mm), y_mm


def _transistor(sheet: Sheet, at: Point, symbol: str, part: Component, device: Component) -> None:
    """Its source above, its drain below, its gate to the left."""
    x, y = at
    sheet.symbols.append(
        Drawn(
            symbol,
            part.ref,
            part.value,
            x,
            y,
            pins=tuple(pad for pad, _ in part.nets),
            ref_at=_beside(part.ref, 5.08, -1.27),
            value_at=_beside(part.value, 5.08, 1.27),
        )
    )
    nets = dict(zip(device.pins, (net for _, net in part.nets), strict=True))
    sheet.wire((x - _LABEL_MM, y), (x - 1.5 * _LABEL_MM, y))
    sheet.flag(nets["G"], (x - 1.5 * _LABEL_MM, y), 180)
    for name, way in (("S", -1), ("D", 1)):
        beside = x + 2 * _LABEL_MM, y + way * 7.62
        sheet.wire((x + 2.54, y + way * 5.08), (x + 2.54, beside[1]), beside)
        sheet.flag(nets[name], beside, 0)


def _two(sheet: Sheet, at: Point, symbol: str, part: Component) -> None:
    """A part with two terminals, upright, each with the name of its net."""
    x, y = at
    sheet.symbols.append(
        Drawn(
            symbol,
            part.ref,
            part.value,
            x,
            y,
            ref_at=_beside(part.ref, -2.54, -1.27),
            value_at=_beside(part.value, -2.54, 1.27),
        )
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
        Drawn(
            symbol,
            part.ref,
            part.value,
            x,
            middle,
            pins=tuple(pad for pad, _ in part.nets),
            ref_at=(0, -ways / 2 * _PITCH_MM - 1.27),
            value_at=(0, ways / 2 * _PITCH_MM + 1.27),
        )
    )
    for i, (_, net) in enumerate(part.nets):
        y = first + i * _PITCH_MM
        sheet.wire((x + _LABEL_MM, y), (x + 2 * _LABEL_MM, y))
        sheet.flag(net, (x + 2 * _LABEL_MM, y), 0)
