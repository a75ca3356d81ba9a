"""The bill of materials and the placement list, as each board house wants them."""

import csv
import io
import re
from collections.abc import Iterable, Iterator

from lumitip_fab.boards.model import Component, Placement
from lumitip_fab.design import Fab

Row = dict[str, str]


def bill_of_materials(board: Placement, fab: Fab) -> bytes:
    """One row for each kind of part, with its references."""
    return _table(fab.bom, bom_rows(board))


def placement_list(board: Placement, fab: Fab) -> bytes:
    """One row for each part; places are in the frame of the Gerber files."""
    return _table(fab.positions, (_placed(part, fab) for part in bought(board)))


def bought(board: Placement) -> list[Component]:
    """The parts that somebody solders on: all but bare copper, in order of reference."""
    return sorted((p for p in board.components if p.part), key=lambda p: _natural(p.ref))


def bom_rows(board: Placement) -> Iterator[Row]:
    """The rows by field."""
    kinds: dict[tuple[str, ...], list[str]] = {}
    for part in bought(board):
        key = (part.manufacturer, part.part, part.value, part.footprint.name, part.lcsc)
        kinds.setdefault(key, []).append(part.ref)
    for item, ((manufacturer, number, value, footprint, lcsc), refs) in enumerate(kinds.items(), 1):
        yield {
            "item": str(item), "refs": ",".join(refs), "quantity": str(len(refs)),
            "manufacturer": manufacturer, "part": number, "value": value, "footprint": footprint,
            "lcsc": lcsc,
        }  # fmt: skip


def angle_at(part: Component, fab: Fab) -> float:
    """The angle (degrees, 0 up to 360) by which a board house turns a part."""
    name = part.footprint.name
    fitting = [(start, turn) for start, turn in fab.rotations if name.startswith(start)]
    turn = max(fitting, key=lambda each: len(each[0]))[1] if fitting else 0.0
    angle = part.angle_deg
    if part.side == "back":
        angle = -angle if fab.back_from_behind else angle + 180.0
    return (angle + turn) % 360.0


def _placed(part: Component, fab: Fab) -> Row:
    return {
        "ref": part.ref, "value": part.value, "part": part.part, "footprint": part.footprint.name,
        "x_mm": f"{part.x_mm:.4f}", "y_mm": f"{part.y_mm:.4f}",
        "angle_deg": f"{angle_at(part, fab):g}",
        "side": fab.sides[part.side == "back"],
    }  # fmt: skip


def _table(columns: Iterable[tuple[str, str]], rows: Iterable[Row]) -> bytes:
    told = tuple(columns)
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\r\n")
    writer.writerow(heading for heading, _ in told)
    writer.writerows([row[field] for _, field in told] for row in rows)
    return file.getvalue().encode()


def _natural(ref: str) -> tuple[str, int]:
    letters, number = re.fullmatch(r"(\D*)(\d*)", ref).groups()  # type: ignore[union-attr]
    return letters, int(number or 0)
