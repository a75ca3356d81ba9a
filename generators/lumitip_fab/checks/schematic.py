"""The schematics: every part and net of a sheet, followed along its wires, against the board."""

from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path

from lumitip_fab.checks.board_read import ReadBoard, names_of, read_any
from lumitip_fab.checks.readers.kicad_board import KicadBoard
from lumitip_fab.checks.readers.kicad_sheet import Sheet, read_sheet
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.checks.schematic_pins import other_pins
from lumitip_fab.checks.title_blocks import other_texts
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

READS = ("boards/*.kicad_sch", "boards/*.kicad_pcb")


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every schematic against its board."""
    for name in names_of(design):
        subject = f"boards/{name}/{name}.kicad_sch"
        try:
            sheet = read_sheet(outputs / subject)
            read = read_any(outputs, design, name)
        except (OutputError, LookupError, ValueError) as error:
            yield unreadable("schematic.readable", subject, str(error))
            continue
        yield count("schematic.parts", subject, list(_other_parts(sheet, read.board)), "parts")
        yield count("schematic.fields", subject, list(_other_fields(sheet, read)), "fields")
        yield count("schematic.pins", subject, list(other_pins(sheet, read)), "pins")
        yield count("schematic.nets", subject, list(_other_nets(sheet, read.board)), "nets")
        title = f"{design.title.on_boards().name}: {name}"
        texts = list(other_texts(sheet.title_block, design, title))
        yield count("schematic.title_block", subject, texts, "texts of the title block")


def _other_parts(sheet: Sheet, board: KicadBoard) -> Iterator[str]:
    """Parts that are in one of the two only, or of another value or footprint."""
    drawn = {s.ref: (s.value, s.footprint) for s in sheet.symbols}
    placed = {
        part.ref: (part.value, part.footprint)
        for part in board.parts
        if "board_only" not in part.attributes
    }
    for ref in sorted(drawn.keys() | placed.keys()):
        if drawn.get(ref) != placed.get(ref):
            yield f"{ref}: {drawn.get(ref)} in the schematic, {placed.get(ref)} on the board"


def _other_fields(sheet: Sheet, read: ReadBoard) -> Iterator[str]:
    """Fields by which a part is ordered that board or catalogue have otherwise, and parts that are
    left out; parts that are in KiCad's bill of materials and not in the orders, or the other way
    round."""
    assembled = read.assembled()
    for symbol in sheet.symbols:
        drawn, part = dict(symbol.fields), read.parts.get(symbol.ref)
        placed = {} if part is None else dict(part.fields)
        number, lcsc = read.ordered(symbol.ref)
        wanted = {
            "Manufacturer": placed.get("Manufacturer", ""),
            "MPN": placed.get("MPN", ""),
            "LCSC": lcsc,
        }
        yield from (
            f"{symbol.ref}: {field} {drawn.get(field, 'missing')}"
            for field, value in wanted.items()
            if drawn.get(field, "") != value
        )
        if number and wanted["MPN"] != number:
            yield f"{symbol.ref}: MPN {wanted['MPN']} on the board"
        if not symbol.placed:
            yield f"{symbol.ref}: left out"
        if symbol.in_bom != (symbol.ref in assembled):
            yield f"{symbol.ref}: {'in' if symbol.in_bom else 'not in'} KiCad's bill of materials"


def _other_nets(sheet: Sheet, board: KicadBoard) -> Iterator[str]:
    """Nets that join other pads in the schematic than on the board."""
    placed = defaultdict(set)
    for part in board.parts:
        for terminal in part.terminals:
            if terminal.net:
                placed[terminal.net].add(f"{part.ref}.{terminal.number}")
    for net in sorted(sheet.nets.keys() | placed.keys()):
        drawn, there = sheet.nets.get(net, set()), placed.get(net, set())
        if drawn != there:
            yield f"{net}: {', '.join(sorted(drawn ^ there)[:4])} in one of the two only"
