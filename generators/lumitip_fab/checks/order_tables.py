"""The tables of a zip, bill of materials and placement list, against the parts on the board."""

import math
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lumitip_fab.checks.board_read import ReadBoard
from lumitip_fab.checks.order_layers import PLACE_MM
from lumitip_fab.checks.order_ways import TEXTS, at_cell
from lumitip_fab.checks.readers.kicad_board import Part
from lumitip_fab.checks.readers.tables import table
from lumitip_fab.checks.result import Measurement, count
from lumitip_fab.design import Fab
from lumitip_fab.text import passage

TURN_DEG = 0.1
Files = dict[str, bytes]
"""Contents of a zip, by name."""


def measure_tables(path: str, read: ReadBoard, fab: Fab, files: Files) -> Iterator[Measurement]:
    """Bill of materials and placement list of a zip against the parts on the board."""
    name = read.name
    bom = _rows(files[f"{name}_bom.csv"], fab.bom)
    mounted = read.assembled()
    refs = [ref for row in bom for ref in row["refs"].split(",")]
    wrong = sorted(mounted ^ set(refs)) + [ref for ref in set(refs) if refs.count(ref) > 1]
    wrong += [
        row["part"]
        for row in bom
        if "quantity" in row and int(row["quantity"]) != len(row["refs"].split(","))
    ]
    wrong += [
        f"{row['refs']:.20} is {row['part'] or 'without a number'}"
        for row in bom
        if {row["part"]} != {read.ordered(ref)[0] for ref in row["refs"].split(",")}
    ]
    wrong += [
        f"{row['refs']:.20} has {row['lcsc'] or 'no number'} at LCSC"
        for row in bom
        if "lcsc" in row
        and {row["lcsc"]} != {read.ordered(ref)[1] for ref in row["refs"].split(",")}
    ]
    wrong += [text for row in bom for text in _other_texts(read, row, row["refs"].split(","))]
    yield count("orders.bom", path, wrong, "parts")
    other = [p.ref for p in read.board.parts if p.ref and _excluded(p) != (p.ref not in mounted)]
    yield count("orders.excluded", path, other, "parts")
    rows = _rows(files[f"{name}_positions.csv"], fab.positions)
    placed = Counter(row["ref"] for row in rows)
    lost = sorted(mounted ^ placed.keys()) + [ref for ref, times in placed.items() if times > 1]
    lost += [text for row in rows for text in _other_texts(read, row, [row["ref"]])]
    yield count("orders.placed", path, lost, "parts")
    known = [(row, read.parts[row["ref"]]) for row in rows if row["ref"] in read.parts]
    off = 0.0  # a board may have wire pads alone
    if known:
        places = np.array([(float(row["x_mm"]), float(row["y_mm"])) for row, _ in known])
        off = float(np.abs(places - read.sensor([part.at for _, part in known])).max())
    yield Measurement("orders.positions", path, off, 0, PLACE_MM, "mm")
    sides = [row["ref"] for row, part in known if row["side"] != fab.sides[not part.front]]
    yield count("orders.sides", path, sides, "parts")
    turns = [_turned_by(read, row, part, fab) for row, part in known]
    yield Measurement("orders.turns", path, float(np.max(turns, initial=0.0)), 0, TURN_DEG, "°")


def _excluded(part: Part) -> bool | None:
    """Whether KiCad leaves a part out of its own bill of materials and placement list; none if out
    of one of them alone."""
    both = {"exclude_from_bom", "exclude_from_pos_files"}
    found = both & part.attributes
    return bool(found) if found in (set(), both) else None


def _other_texts(read: ReadBoard, row: dict[str, str], refs: list[str]) -> Iterator[str]:
    """What a row has of its parts, and the board's file has not."""
    for part in (read.parts[ref] for ref in refs if ref in read.parts):
        maker = dict(part.fields).get("Manufacturer", "")
        own = {"value": _value(read, part), "footprint": part.footprint, "manufacturer": maker}
        for field in sorted(own.keys() & row.keys()):
            if row[field] != own[field]:
                yield f"{part.ref}: {field} {row[field]:.20}"


def _value(read: ReadBoard, part: Part) -> str:
    """The value of a part, and a stop line after that of parts at the cells whose polarity is not
    known."""
    if read.finger is None or read.design.packages.at_cells(read.finger).mark_is_known:
        return part.value
    if not at_cell(read, part):
        return part.value
    return f"{part.value} ({passage(TEXTS, 'stop_row')})"


def _turned_by(read: ReadBoard, row: dict[str, str], part: Part, fab: Fab) -> float:
    """How far a part would be turned from its pads: from lead 1 along its row to the right; of an
    LED, from its cathode; of a module, as its land pattern lies."""
    pads = {t.number: t.at for t in part.terminals}
    last = str(max(2, len(pads) // 2))
    dx, dy = np.subtract(pads[last], pads["1"])
    if _begins_with_its_anode(read, part.ref):
        dx, dy = -dx, -dy
    seen = math.degrees(math.atan2(-dy, dx))  # counter-clockwise, from the front
    seen -= _lying_deg(read, part.ref, last)
    if not part.front:
        seen = 180 - seen if fab.back_from_behind else seen
    fits = [(start, turn) for start, turn in fab.rotations if part.footprint.startswith(start)]
    of_prefix = max(fits, key=lambda fit: len(fit[0]))[1] if fits else 0.0
    seen += dict(fab.part_rotations).get(read.ordered(part.ref)[0], of_prefix)
    return abs((float(row["angle_deg"]) - seen + 180) % 360 - 180)


def _begins_with_its_anode(read: ReadBoard, ref: str) -> bool:
    """Whether pad 1 of a part, the marked one, is the anode of an LED of the cells."""
    led, cells = read.design.packages.led, read.cells_hold
    is_led = cells is not None and cells.kind == "led" and ref.rstrip("_0123456789") == cells.letter
    return is_led and led.marked == "anode"


def _lying_deg(read: ReadBoard, ref: str, last: str) -> float:
    """Angle of the line from pad 1 to another one of a module that is not turned; 0 of the rest."""
    modules = (d for d in read.components if d.ref == ref and d.kind == "module")
    for device in modules:
        at = {land.number: (land.x_mm, land.y_mm) for land in device.footprint.pads}
        dx, dy = np.subtract(at[last], at["1"])
        return math.degrees(math.atan2(dy, dx))
    return 0.0


def tables_twice(path: str, folder: Path, fab: Fab, name: str, files: Files) -> Measurement:
    """The tables beside a zip are those inside it."""
    tables = (f"{name}_bom.csv", f"{name}_positions.csv")
    differ = [t for t in tables if (folder / f"{fab.name}_{t}").read_bytes() != files[t]]
    return count("orders.tables", path, differ, "tables that differ")


def _rows(data: bytes, columns: tuple[tuple[str, str], ...]) -> list[dict[str, str]]:
    """The rows of a table by field."""
    return [{field: row[heading] for heading, field in columns} for row in table(data.decode())]
