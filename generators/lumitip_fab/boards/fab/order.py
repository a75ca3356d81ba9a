"""Order files of a board: bill of materials, placement list, notes and one zip."""

import csv
import io
import re
import zipfile
from collections.abc import Iterable, Iterator

from lumitip_fab.boards.fab.gerber import gerber_layers, plated_drills, unplated_drills
from lumitip_fab.boards.model import BoardModel, Placement
from lumitip_fab.boards.placed import pad_at
from lumitip_fab.design import Component, Fab, Finger, Flexible, Led, Packages, Photodetector

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
            "item": str(item),
            "refs": ",".join(refs),
            "quantity": str(len(refs)),
            "manufacturer": manufacturer,
            "part": number,
            "value": value,
            "footprint": footprint,
            "lcsc": lcsc,
        }


def angle_at(part: Component, fab: Fab) -> float:
    """The angle (degrees, 0 up to 360) by which a PCB fab turns a part."""
    name = part.footprint.name
    fitting = [(start, turn) for start, turn in fab.rotations if name.startswith(start)]
    turn = max(fitting, key=lambda each: len(each[0]))[1] if fitting else 0.0
    angle = part.angle_deg
    if part.side == "back":
        angle = -angle if fab.back_from_behind else angle + 180.0
    return (angle + turn) % 360.0


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


def _natural(ref: str) -> tuple[str, int]:
    letters, number = re.fullmatch(r"(\D*)(\d*)", ref).groups()  # type: ignore[union-attr]
    return letters, int(number or 0)


_EPOCH = (1980, 1, 1, 0, 0, 0)
_MODE = 0o644 << 16


def layers_of(model: BoardModel) -> dict[str, bytes]:
    """Every layer and drill file by its key in the table of PCB fabs."""
    layers = {layer.key: layer.data for layer in gerber_layers(model)}
    return layers | {"plated": plated_drills(model), "unplated": unplated_drills(model)}


def order_files(
    model: BoardModel, layers: dict[str, bytes], note: bytes, fab: Fab, stem: str
) -> dict[str, bytes]:
    """The zip for a PCB fab, and its two tables once more by themselves.

    Args:
        model: the finished board.
        layers: from `layers_of`.
        note: for who places the parts.
        fab: the PCB fab.
        stem: what the files' names begin with.
    """
    board = model.placement
    tables = {
        f"{stem}_bom.csv": bill_of_materials(board, fab),
        f"{stem}_positions.csv": placement_list(board, fab),
    }
    files = {stem + ending: layers[layer] for layer, ending in fab.layers if layer in layers}
    files[f"{stem}_assembly.txt"] = note
    named = {f"{fab.name}_{name}": data for name, data in tables.items()}
    return {
        f"{fab.name}_{stem}.zip": _zipped(files | tables),
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


_OTHER = {"anode": "cathode", "cathode": "anode", "collector": "emitter", "emitter": "collector"}
_POLAR = {"led": "LED", "photodetector": "photodetector"}


def assembly_note(board: Placement, finger: Finger, packages: Packages, fab: Fab) -> bytes:
    """Plain text: what marks mean, how far to trust that, and where each terminal goes.

    Args:
        board: parts in their places.
        finger: whose board it is.
        packages: for the terminal that a part's mark shows, and its confidence.
        fab: the PCB fab, whose remark is added.
    """
    chip = packages.at_cells(finger)
    lines = [
        f"{board.title}: {board.name} board, revision {board.revision}, "
        f"design {board.design_hash[:8]}",
        "",
        *(
            _flexible(board.flexible, board.name + dict(fab.layers)["stiffener"])
            if board.flexible
            else ()
        ),
        *_polarity(board, chip, finger.cells_hold.kind),
        *_others(board),
        *_ordering(board, fab),
        "Places of the terminals, in mm as in the Gerber files, seen from the front:",
        *_places(board, chip),
    ]
    return "".join(f"{line}\n" for line in lines).encode()


def _polarity(board: Placement, chip: Led | Photodetector, kind: str) -> Iterator[str]:
    parts = [part for part in bought(board) if part.kind == kind]
    yield (
        f"{_refs(board, kind)}, {parts[0].part} by {chip.manufacturer}: pad 1 is the "
        f"{chip.marked}, pad 2 the {_OTHER[chip.marked]}. On the silkscreen a bracket stands round "
        "pad 1, or a bar beside it."
    )
    if chip.confidence == "datasheet":
        yield f"The mark on the part itself shows its {chip.marked}, by its datasheet."
    else:
        yield (
            f"CHECK BEFORE PLACING: that the mark on the part itself shows its {chip.marked} is "
            f"{chip.confidence}, not read from a datasheet. Hold a part against its leaflet; if "
            f"its mark shows the {_OTHER[chip.marked]}, all {_POLAR[kind]}s are turned by 180 "
            "degrees against the placement list."
        )
    yield ""


def _flexible(flexible: Flexible, outline: str) -> Iterator[str]:
    """Order note of a flexible board, and the file with the stiffener's outline."""
    bend, stiff = flexible.bend, flexible.stiffener
    total = flexible.core_mm + 2 * (flexible.copper_mm + flexible.coverlay_mm)
    yield (
        f"FLEXIBLE BOARD, {total:.3g} mm thick in all: polyimide {flexible.core_mm:.3g} mm, copper "
        f"{flexible.copper_mm:g} mm on both sides, each under a coverlay of "
        f"{flexible.coverlay_mm:g} mm. The layers of solder mask are the coverlays' openings."
    )
    yield (
        f"Stiffener of polyimide, {flexible.stiffener_mm:g} mm, on the back, in mm as in the "
        f"Gerber files: x {stiff.x_min_mm:.3f} to {stiff.x_max_mm:.3f}, y {stiff.y_min_mm:.3f} to "
        f"{stiff.y_max_mm:.3f}; with the board's plated holes in it, 0.3 mm wider. "
        f"Its outline is the drawing {outline}, of no copper."
    )
    yield (
        f"It bends where y is above {bend.y_min_mm:.3f}: there are no vias, and nothing stiff may "
        "be added."
    )
    yield ""


def _others(board: Placement) -> Iterator[str]:
    kinds = {part.kind for part in bought(board)}
    if "multiplexer" in kinds:
        yield f"{_refs(board, 'multiplexer')}: lead 1 is at the dot, on the notch's side."
    plain = [_refs(board, kind) for kind in ("resistor", "capacitor") if kind in kinds]
    yield f"{' and '.join(plain)}: either way round."
    yield ""


def auxiliary_note(board: Placement, title: str, fab: Fab) -> bytes:
    """The same of an auxiliary board: which pad is the first of each part.

    Args:
        board: parts in their places.
        title: what the board says of itself.
        fab: the PCB fab, whose remark is added.
    """
    lines = [
        f"{board.title}: {title}, revision {board.revision}, design {board.design_hash[:8]}",
        "",
        *_behind(board),
        *_ordering(board, fab),
        "Pad 1 of each part, in mm as in the Gerber files, seen from the front:",
        *(f"{part.ref}  {x:.3f} {y:.3f}" for part in bought(board) for x, y in [pad_at(part, "1")]),
    ]
    return "".join(f"{line}\n" for line in lines).encode()


def _behind(board: Placement) -> Iterator[str]:
    behind = [part.ref for part in bought(board) if part.side == "back"]
    if behind:
        yield f"ON THE BACK: {', '.join(behind)}. Everything else is on the front."
        yield ""


def _ordering(board: Placement, fab: Fab) -> Iterator[str]:
    if fab.remark:
        yield fab.remark
        yield ""
    if "lcsc" in (field for _, field in fab.bom):
        unknown = [row["part"] for row in bom_rows(board) if not row["lcsc"]]
        if unknown:
            yield (
                f"Without a number of the distributor in the bill of materials: "
                f"{', '.join(unknown)}. Choose them by hand."
            )
            yield ""


def _places(board: Placement, chip: Led | Photodetector) -> Iterator[str]:
    for part in bought(board):
        if part.kind in _POLAR:
            one, other = (pad_at(part, number) for number in ("1", "2"))
            yield (
                f"{part.ref}  {chip.marked} {one[0]:.3f} {one[1]:.3f}  "
                f"{_OTHER[chip.marked]} {other[0]:.3f} {other[1]:.3f}"
            )


def _refs(board: Placement, kind: str) -> str:
    refs = [part.ref for part in bought(board) if part.kind == kind]
    return refs[0] if len(refs) == 1 else f"{refs[0]} to {refs[-1]}"
