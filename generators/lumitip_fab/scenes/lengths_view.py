"""The wires as they are cut: how their ends are stripped, and each cable in its colours."""

from lumitip_fab.design import Cable, Cabling
from lumitip_fab.design.cabling import STRIP_MM
from lumitip_fab.scenes.casting_page import inks
from lumitip_fab.scenes.dimensions import dimension_rows, line, rectangle
from lumitip_fab.scenes.drawing import Sheet

WIDTH_MM = 120.0
"""Of the longest cable on the page."""
_END_SCALE = 3.0  # of a stripped end
_WIRE_MM, _BREAK_MM = 1.3, 3.0  # from wire to wire; half the gap of the wire that is cut short
_ROW_MM, _LEAST_MM = 4.0, 6.5  # between cables; from the middle of one to the next
_NAME_MM, _WORDS_MM, _WORDS, _MARGIN_MM = 6.0, 60.0, 1.3, 4.0
_DOWN_MM = 4.5  # from what is measured to its dimension
_COPPER, _INSULATION = "#d9893b", "#8d949b"


def lengths_view(cabling: Cabling) -> str:
    """One wire with its ends, then the cables, which are to scale."""
    sheet = Sheet(_MARGIN_MM, _WORDS)
    _stripped(sheet)
    scale = WIDTH_MM / max(cable.length_mm for cable in cabling.cables)
    top = -14.0
    for cable in cabling.cables:
        with sheet.group(cable.name):
            top = _cable(sheet, cable, scale, top)
    sheet.cover(WIDTH_MM + _NAME_MM + _WORDS_MM, 0.0)
    return sheet.svg({"data-scale": scale})


def _stripped(sheet: Sheet) -> None:
    """A wire of any length, cut short in the middle."""
    bare, middle = _END_SCALE * STRIP_MM, WIDTH_MM / 2
    for low, high in ((0.0, bare), (WIDTH_MM - bare, WIDTH_MM)):
        sheet.lines([line((low, y), (high, y)) for y in (-0.5, 0.0, 0.5)], "line")
        sheet.area([rectangle((low, high), (-0.7, 0.7))], "part", _COPPER)
    for low, high in ((bare, middle - _BREAK_MM), (middle + _BREAK_MM, WIDTH_MM - bare)):
        sheet.area([rectangle((low, high), (-1.5, 1.5))], "body", _INSULATION)
    sheet.lines([line((middle - _BREAK_MM, 0.0), (middle + _BREAK_MM, 0.0))], "axis")
    ends = [(f"{STRIP_MM:g} mm", (low, 0.7), (low + bare, 0.7)) for low in (0.0, WIDTH_MM - bare)]
    for end in ends:
        dimension_rows(sheet, [end], _DOWN_MM, 1)
    dimension_rows(
        sheet, [("length by its table", (0.0, -1.5), (WIDTH_MM, -1.5))], -_DOWN_MM - 3.0, -1
    )
    sheet.words(WIDTH_MM + _NAME_MM, -1.7, "Each wire", "name", "start")


def _cable(sheet: Sheet, cable: Cable, scale: float, top: float) -> float:
    """The wires of a cable side by side; returns where the next one begins."""
    end = scale * cable.length_mm
    for row, wire in enumerate(cable.wires):
        y = top - _WIRE_MM * row
        sheet.wire(line((0.0, y), (end, y)), inks(wire.colour))
    low = top - _WIRE_MM * (len(cable.wires) - 1)
    middle, right = (top + low) / 2, WIDTH_MM + _NAME_MM
    count = len(cable.wires)
    cut = f"{cable.name}: {count} wire{'s' * (count > 1)} of {cable.length_mm:g} mm"
    sheet.words(right, middle - 1.7, cut, "name", "start")
    return min(low - _ROW_MM, middle - _LEAST_MM)
