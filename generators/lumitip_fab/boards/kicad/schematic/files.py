"""The files of a schematic: the sheet, its symbols, and the table that finds them."""

from collections.abc import Iterable

from lumitip_fab.boards.circuit import cathodes_of
from lumitip_fab.boards.kicad.nodes import library_table
from lumitip_fab.boards.kicad.schematic import symbols
from lumitip_fab.boards.kicad.schematic.auxiliary import auxiliary_blocks
from lumitip_fab.boards.kicad.schematic.blocks import string_blocks, switch_block, wires_block
from lumitip_fab.boards.kicad.schematic.frames import framed
from lumitip_fab.boards.kicad.schematic.multiplexers import multiplexer_blocks
from lumitip_fab.boards.kicad.schematic.sheet import Block, Sheet, beside, columns, grid
from lumitip_fab.boards.kicad.schematic.writer import sheet_text
from lumitip_fab.boards.kicad.sexpr import FORMAT, Node, written
from lumitip_fab.boards.model import SUPPLY, Placement
from lumitip_fab.design import Design


def schematic_files(board: Placement, design: Design) -> dict[str, bytes]:
    """Sheet, symbol library and its table, by their path beside the board.

    Args:
        board: its parts, with their nets.
        design: its wiring and its parts.
    """
    shapes, paper, sheet = _drawn(board, design)
    parts = {part.ref: part for part in board.components}
    library: Node = (
        "kicad_symbol_lib",
        ("version", FORMAT),
        ("generator", "lumitip"),
        *(symbols.named(name, shape, True) for name, shape in shapes.items()),
    )
    return {
        f"{board.name}.kicad_sch": sheet_text(board, paper, sheet, shapes, parts).encode(),
        f"{symbols.LIBRARY}.kicad_sym": written(library).encode(),
        "sym-lib-table": library_table(
            "sym", symbols.LIBRARY, f"{symbols.LIBRARY}.kicad_sym", "Symbols of this board"
        ).encode(),
    }


def _drawn(board: Placement, design: Design) -> tuple[dict[str, Node], str, Sheet]:
    """Symbols by name, name of the paper, and the drawing: strings or multiplexers with the wires
    that lead to them; on any other board, blocks in frames."""
    parts = {part.ref: part for part in board.components}
    kinds = {part.kind for part in board.components}
    if kinds.isdisjoint(("led", "multiplexer")):
        drafts = auxiliary_blocks(board)
        shapes = {name: shape for _, draft in drafts for name, shape in draft.shapes.items()}
        return shapes, *framed(drafts)
    others = (board.ground, cathodes_of(design))
    supply = next(n.name for n in board.nets if n.net_class == SUPPLY and n.name not in others)
    shapes = symbols.hand_drawn() | {supply: symbols.supply(supply)}
    wires, packages = wires_block(parts, supply), design.packages
    if "multiplexer" in kinds:
        blocks = list(multiplexer_blocks(parts, supply, packages))
        paper, sheet = grid(wires, blocks)
    else:
        blocks = list(
            string_blocks(parts, supply, cathodes_of(design), design.wiring, packages.led.marked)
        )
        if design.packages.switch is not None:
            pull_down = parts[design.wiring.pull_down_ref]
            wires = beside(wires, switch_block(parts["Q1"], pull_down))
        paper, sheet = columns([*blocks, wires])
    return shapes | _shapes([wires, *blocks]), paper, sheet


def _shapes(blocks: Iterable[Block]) -> dict[str, Node]:
    """The symbols of blocks by name, in the order in which they come up."""
    return {name: shape for block in blocks for name, shape in block.shapes.items()}
