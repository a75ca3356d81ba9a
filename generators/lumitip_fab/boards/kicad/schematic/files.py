"""The files of a schematic: the sheet, its symbols, and the table that finds them."""

from collections.abc import Iterator, Mapping

from lumitip_fab.boards.kicad.schematic import fingers, symbols
from lumitip_fab.boards.kicad.schematic.sheet import MARGIN_MM, Sheet, paper_for
from lumitip_fab.boards.kicad.schematic.writer import sheet_text
from lumitip_fab.boards.kicad.sexpr import FORMAT, Node, Quoted, written
from lumitip_fab.boards.model import Placement
from lumitip_fab.design import Component, Design, Finger, Packages, Point, Wiring


def schematic_files(board: Placement, finger: Finger, design: Design) -> dict[str, bytes]:
    """Sheet, symbol library and its table, by their path beside the board.

    Args:
        board: its parts, with their nets.
        finger: whose board it is.
        design: its wiring and its parts.
    """
    wiring, packages = design.wiring, design.packages
    parts = {part.ref: part for part in board.components}
    supply = next(net for _, net in parts["J1"].nets if net != board.ground)
    shapes = _symbols(board, finger, packages, supply)
    paper, sheet = _drawn(finger, wiring, packages, parts, supply)
    return sheet_files(board, paper, sheet, shapes, parts)


def sheet_files(
    board: Placement,
    paper: str,
    sheet: Sheet,
    shapes: dict[str, Node],
    parts: Mapping[str, Component],
) -> dict[str, bytes]:
    """A drawn sheet with the library of its symbols, and the table that finds it.

    Args:
        board: whose schematic it is.
        paper: name of the paper.
        sheet: the drawing.
        shapes: symbols by name.
        parts: the board's parts by reference.
    """
    library: Node = (
        "kicad_symbol_lib",
        ("version", FORMAT),
        ("generator", "lumitip"),
        *(symbols.named(name, shape, True) for name, shape in shapes.items()),
    )
    return {
        f"{board.name}.kicad_sch": sheet_text(board, paper, sheet, shapes, parts).encode(),
        f"{symbols.LIBRARY}.kicad_sym": written(library).encode(),
        "sym-lib-table": written(_table()).encode(),
    }


def _symbols(board: Placement, finger: Finger, packages: Packages, supply: str) -> dict[str, Node]:
    drawn = symbols.hand_drawn()
    wires = next(part for part in board.components if part.kind == "wires")
    drawn |= {supply: symbols.supply(supply), "Wires": symbols.wires(len(wires.nets))}
    if finger.cells_hold.kind == "led":
        return drawn | {"LED": symbols.led(packages.led.marked)}
    return drawn | {
        "Phototransistor": symbols.phototransistor(packages.photodetector.marked),
        "Multiplexer": symbols.multiplexer(packages.multiplexer),
        "R_Array": symbols.resistor_array(packages.array.resistors),
    }


def _drawn(
    finger: Finger,
    wiring: Wiring,
    packages: Packages,
    parts: Mapping[str, Component],
    supply: str,
) -> tuple[str, Sheet]:
    """Name of the paper, and the drawing on it."""
    sheet = Sheet()
    ways = len(parts["J1"].nets)
    if finger.cells_hold.kind == "led":
        width, height = fingers.strings_size_mm(wiring)
        paper, _ = paper_for(width, height + fingers.wires_height_mm(ways))
        fingers.draw_strings(sheet, (MARGIN_MM, MARGIN_MM), wiring, parts, supply)
        below = MARGIN_MM, MARGIN_MM + height
        fingers.draw_wires(sheet, below, parts, supply)
        return paper, sheet
    mux = packages.multiplexer
    tall = max(fingers.block_height_mm(mux), fingers.wires_height_mm(ways))
    paper, places = _places(wiring.muxes, tall)
    fingers.draw_wires(sheet, next(places), parts, supply)
    for number, at in enumerate(places, start=1):
        fingers.draw_block(sheet, at, number, mux, parts, supply)
    return paper, sheet


def _places(blocks: int, tall_mm: float) -> tuple[str, Iterator[Point]]:
    """The smallest paper that takes some blocks after the wires, and where each goes."""
    wide = fingers.BLOCK_WIDTH_MM
    shapes = [(across, -(-blocks // across)) for across in range(1, blocks + 1)]
    choices = [
        (paper_for(fingers.WIRES_WIDTH_MM + across * wide, down * tall_mm), across)
        for across, down in shapes
    ]
    (paper, _), across = min(
        choices, key=lambda choice: (choice[0][1], -blocks % choice[1], -choice[1])
    )

    def places() -> Iterator[Point]:
        yield MARGIN_MM, MARGIN_MM
        for i in range(blocks):
            down, right = divmod(i, across)
            yield MARGIN_MM + fingers.WIRES_WIDTH_MM + right * wide, MARGIN_MM + down * tall_mm

    return paper, places()


def _table() -> Node:
    entry = (
        "lib",
        ("name", Quoted(symbols.LIBRARY)),
        ("type", Quoted("KiCad")),
        ("uri", Quoted("${KIPRJMOD}/" + f"{symbols.LIBRARY}.kicad_sym")),
        ("options", Quoted("")),
        ("descr", Quoted("Symbols of this board")),
    )
    return ("sym_lib_table", entry)
