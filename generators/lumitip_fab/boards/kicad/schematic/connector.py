"""The wires of a board, each with its test point."""

from lumitip_fab.boards.circuit import GROUND
from lumitip_fab.boards.kicad.schematic.sheet import Drawn, Sheet
from lumitip_fab.boards.kicad.schematic.symbols import ROW_MM
from lumitip_fab.boards.model import Component
from lumitip_fab.design import Point

WIDTH_MM = 50.8


def height_mm(ways: int) -> float:
    """Height of the block."""
    return ways * ROW_MM + 25.4


def draw_wires(sheet: Sheet, at: Point, parts: dict[str, Component], supply: str) -> None:
    """The connector with a row for each wire, and what the parts at the cells are."""
    wires = parts["J1"]
    ways = len(wires.nets)
    x, first = at[0] + 10.16, at[1] + 17.78
    sheet.texts.append(("Wires", (at[0] + 2.54, at[1] + 5.08), 2.5))
    cells = [part for part in parts.values() if part.kind in ("led", "photodetector")]
    caption = f"{cells[0].ref} to {cells[-1].ref}: {cells[0].value}"
    below = first + ways * ROW_MM + 2.54
    sheet.texts.append((caption, (at[0] + 2.54, below), 1.5))
    middle = first + (ways - 1) / 2 * ROW_MM
    sheet.symbols.append(
        Drawn(
            "Wires",
            "J1",
            wires.value,
            x,
            middle,
            pins=tuple(pad for pad, _ in wires.nets),
            ref_at=(0, -ways / 2 * ROW_MM - 1.27),
        )
    )
    for i, (_, net) in enumerate(wires.nets):
        y = first + i * ROW_MM
        probe, end = x + 12.7, x + 25.4
        point = parts[f"TP{i + 1}"]
        sheet.symbols.append(
            Drawn("TestPoint", point.ref, net, probe, y, pins=("1",), ref_at=(3.048, -3.302))
        )
        if net == supply:
            end += ROW_MM  # or it would point into ground, which is the row above
        corners = [(x + 5.08, y), (probe, y), (end, y)]
        sheet.junctions.append((probe, y))
        if net in (GROUND, supply):
            corners.insert(2, (x + 19.05, y))
            sheet.junctions.append((x + 19.05, y))
            sheet.power("PWR_FLAG", (x + 19.05, y))
            sheet.power(net, (end, y))
        else:
            sheet.flag(net, (end, y), 0)
        sheet.wire(*corners)
