"""Order files of a board: bill of materials, placement list and one zip."""

import csv
import io
import re
import zipfile
from collections.abc import Iterable, Iterator
from dataclasses import replace

from lumitip_fab.boards.fab.gerber import gerber_layers, plated_drills, unplated_drills
from lumitip_fab.boards.model import AT_CELLS, BoardModel, Placement
from lumitip_fab.design import Component, Fab
from lumitip_fab.text import passage

Row = dict[str, str]
TEXTS = "boards/fab/notes.txt"
"""Texts of an order."""


def bill_of_materials(board: Placement, fab: Fab) -> bytes:
    """One row for each kind of part, with its references."""
    return _table(fab.bom, bom_rows(_listed(board)))


def placement_list(board: Placement, fab: Fab) -> bytes:
    """One row for each part that is mounted; places are in the frame of the Gerber files."""
    return _table(fab.positions, [_placed(part, fab) for part in _listed(board)])


def bought(board: Placement) -> list[Component]:
    """The parts that somebody solders on: all but bare copper, in order of reference."""
    return sorted((p for p in board.components if p.part), key=lambda p: natural(p.ref))


def assembled(board: Placement) -> list[Component]:
    """The parts that the PCB fab mounts, in order of reference: those that are soldered on by hand
    are not ordered from it."""
    return [part for part in bought(board) if part.assembled]


def polarity_unknown(board: Placement) -> bool:
    """Whether the marked terminal of the parts at the cells is neither measured nor read from a
    datasheet."""
    return board.cells is not None and not board.cells.part.mark_is_known


def _listed(board: Placement) -> Iterator[Component]:
    """The mounted parts as the tables list them: where the polarity of those at the cells is not
    known, their value ends with a stop line, since an operator may see no more than a table."""
    stop = passage(TEXTS, "stop_row") if polarity_unknown(board) else ""
    for part in assembled(board):
        at_cell = stop and part.kind in AT_CELLS
        yield replace(part, value=f"{part.value} ({stop})") if at_cell else part


def by_hand(board: Placement) -> list[Component]:
    """The parts that are soldered on by hand, in order of reference."""
    return [part for part in bought(board) if part.hand_soldered]


def bom_rows(parts: Iterable[Component]) -> Iterator[Row]:
    """The rows by field."""
    kinds: dict[tuple[str, ...], list[str]] = {}
    for part in parts:
        shape = part.footprint.name
        key = (part.manufacturer, part.part, part.value, shape, part.lcsc, part.rating)
        kinds.setdefault(key, []).append(part.ref)
    for item, (kind, refs) in enumerate(kinds.items(), 1):
        manufacturer, number, value, footprint, lcsc, rating = kind
        yield {
            "item": str(item),
            "refs": ",".join(refs),
            "quantity": str(len(refs)),
            "manufacturer": manufacturer,
            "part": number,
            "value": value,
            "footprint": footprint,
            "lcsc": lcsc,
            "rating": rating,
        }


def angle_at(part: Component, fab: Fab) -> float:
    """The angle (degrees, 0 up to 360) by which a PCB fab turns a part."""
    _, turn = _rotation(part, fab)
    angle = part.angle_deg
    if part.side == "back":
        angle = -angle if fab.back_from_behind else angle + 180.0
    return (angle + turn) % 360.0


def turned_by_assumption(part: Component, fab: Fab) -> bool:
    """Whether the offset of a part's angle is assumed, or no offset is known for its footprint."""
    start, _ = _rotation(part, fab)
    return start in ("", *fab.rotations_assumed)


def _rotation(part: Component, fab: Fab) -> tuple[str, float]:
    """A part's order number or the longest beginning of its footprint's name in a fab's tables, and
    its offset (degrees)."""
    fitting = [each for each in fab.rotations if part.footprint.name.startswith(each[0])]
    known = max(fitting, key=lambda each: len(each[0]), default=("", 0.0))
    start, turn = next((each for each in fab.part_rotations if each[0] == part.part), known)
    return start, turn + 180.0 * (part.part in fab.anode_first)


def _placed(part: Component, fab: Fab) -> Row:
    return {
        "ref": part.ref,
        "value": part.value,
        "part": part.part,
        "footprint": part.footprint.name,
        "x_mm": f"{part.x_mm:.4f}",
        "y_mm": f"{part.y_mm:.4f}",
        "angle_deg": f"{angle_at(part, fab):g}",
        "side": fab.sides[part.side == "back"],
    }


def _table(columns: Iterable[tuple[str, str]], rows: Iterable[Row]) -> bytes:
    headings = tuple(columns)
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\r\n")
    writer.writerow(heading for heading, _ in headings)
    writer.writerows([row[field] for _, field in headings] for row in rows)
    return file.getvalue().encode()


def natural(ref: str) -> tuple[str, int, int]:
    """Letters and number of a reference and, in a panel, its copy."""
    found = re.fullmatch(r"(\D*)(\d*)(?:_(\d+))?", ref)
    letters, number, copy = found.groups()  # type: ignore[union-attr]
    return letters, int(number or 0), int(copy or 0)


_EPOCH = (1980, 1, 1, 0, 0, 0)
_MODE = 0o644 << 16


def layers_of(model: BoardModel) -> dict[str, bytes]:
    """Every layer and drill file by its key in the table of PCB fabs."""
    layers = {layer.key: layer.data for layer in gerber_layers(model)}
    return layers | {"plated": plated_drills(model), "unplated": unplated_drills(model)}


def order_files(
    model: BoardModel, layers: dict[str, bytes], notes: dict[str, bytes], fab: Fab, stem: str
) -> dict[str, bytes]:
    """The zip for a PCB fab, and its two tables once more by themselves.

    Args:
        model: the finished board.
        layers: from `layers_of`.
        notes: text files, by name.
        fab: the PCB fab.
        stem: what the files' names begin with.
    """
    board = model.placement
    tables = {
        f"{stem}_bom.csv": bill_of_materials(board, fab),
        f"{stem}_positions.csv": placement_list(board, fab),
    }
    files = {stem + ending: layers[layer] for layer, ending in fab.layers if layer in layers}
    named = {f"{fab.name}_{name}": data for name, data in tables.items()}
    return {
        f"{fab.name}_{stem}.zip": _zipped(files | tables | notes),
        **named,
    }


def _zipped(files: dict[str, bytes]) -> bytes:
    """A zip that is the same whenever and wherever it is made."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as package:
        for name in sorted(files):
            entry = zipfile.ZipInfo(name, _EPOCH)
            entry.compress_type, entry.external_attr, entry.create_system = (
                zipfile.ZIP_DEFLATED,
                _MODE,
                3,
            )
            package.writestr(entry, files[name])
    return packed.getvalue()
