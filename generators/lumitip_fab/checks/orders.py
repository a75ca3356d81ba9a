"""Order files against the board files: layers, parts, positions, note."""

import math
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely

from lumitip_fab.checks.board_read import ReadBoard, names_of, path_of, read_any
from lumitip_fab.checks.order_layers import Painted, measure_layers, measure_stiffener
from lumitip_fab.checks.panel_read import read_panel
from lumitip_fab.checks.readers.kicad_board import Part
from lumitip_fab.checks.readers.tables import table, unpacked
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Design, Fab, Finger, Flexible
from lumitip_fab.errors import OutputError

READS = ("boards/*.kicad_pcb", "boards/*.zip", "boards/*.csv")
STOP_FILE = "STOP_READ_FIRST.txt"
PLACE_MM = 0.001
SIZE_MM = 0.006
TURN_DEG = 0.1
_Files = dict[str, bytes]
_TERMINALS = re.compile(
    r"^(?P<ref>[DQ]\d+(?:_\d+)?)  (?P<one>[a-z]+) (?P<x1>\S+) (?P<y1>\S+)  "
    r"(?P<other>[a-z]+) (?P<x2>\S+) (?P<y2>\S+)$",
    re.MULTILINE,
)
"""A row of the assembly note: a part, the terminal at pad 1 and the other, each with its place."""
_FIRST_PADS = re.compile(r"^(?P<ref>[A-Z]+\d+(?:_\d+)?)  (?P<x>\S+) (?P<y>\S+)$", re.MULTILINE)
"""A row of an auxiliary board's note: a part and the place of its first pad."""


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Every zip of every board and panel."""
    for name in (*names_of(design), *(panel.name for panel in design.panels)):
        yield from measure_board(outputs, design, name)


def measure_board(outputs: Path, design: Design, name: str) -> Iterator[Measurement]:
    """Every zip of one board or panel; all are to have the same layers."""
    try:
        panels = [panel for panel in design.panels if panel.name == name]
        read = read_panel(outputs, design, *panels) if panels else read_any(outputs, design, name)
    except OutputError as error:
        yield unreadable("orders.board", path_of(name), str(error))
        return
    folder = (outputs / path_of(name)).parent
    flexible = read.flexible
    painted: Painted = {}
    first: _Files = {}
    found: tuple[Measurement, ...] = ()
    for fab in design.fabs:
        package = f"{fab.name}_{name}.zip"
        path = f"boards/{name}/order/{package}"
        try:
            files = unpacked(folder / "order" / package)
            ordered = _ordered(read, fab)
            layers = {key: files[name + end] for key, end in ordered.items()}
            yield count("orders.files", path, _unasked(name, ordered, files), "files")
            yield _tables_twice(path, folder / "order", fab, name, files)
            same = layers == first  # whose bytes would only be measured again
            measured = found if same else tuple(measure_layers("", read, layers, painted))
            yield from (replace(m, subject=f"{path}{m.subject}") for m in measured)
            if flexible:
                yield measure_stiffener(path, layers, flexible.stiffener)
            if not first:
                first, found = layers, measured
            other = [key for key in first if first[key] != layers[key]]
            yield count("orders.same", path, other, "layers that differ")
            yield from _parts(path, read, fab, files)
            note, made = (files[f"{name}_{n}.txt"].decode() for n in ("assembly", "fabrication"))
            wrong = _misled(read, read.finger, note) if read.finger else _misplaced(read, note)
            yield count("orders.note", path, list(wrong), "parts")
            yield count("orders.fabrication", path, list(_misordered(read, made)), "figures")
            if read.finger:
                stops = list(_unstopped(read, read.finger, files))
                yield count("orders.stop", path, stops, "files")
            if flexible:
                drawn = name + ordered["stiffener"]
                untold = _untold(note, flexible, design.stack.pcb_mm, drawn)
                yield count("orders.flexible", path, list(untold), "figures")
        except (OSError, KeyError, ValueError, SyntaxError) as error:
            yield unreadable("orders.readable", path, f"cannot be read: {error!r:.200}")


def _parts(path: str, read: ReadBoard, fab: Fab, files: _Files) -> Iterator[Measurement]:
    """Bill of materials and placement list against the parts on the board."""
    name = read.name
    bom = _rows(files[f"{name}_bom.csv"], fab.bom)
    mounted = {p.ref for p in read.board.parts if "exclude_from_bom" not in p.attributes}
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
    yield count("orders.bom", path, wrong, "parts")
    rows = _rows(files[f"{name}_positions.csv"], fab.positions)
    placed = Counter(row["ref"] for row in rows)
    lost = sorted(mounted ^ placed.keys()) + [ref for ref, times in placed.items() if times > 1]
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


def _turned_by(read: ReadBoard, row: dict[str, str], part: Part, fab: Fab) -> float:
    """How far a part would be turned from its pads: from lead 1 along its row to the right; of a
    module, as its land pattern lies."""
    pads = {t.number: t.at for t in part.terminals}
    last = str(max(2, len(pads) // 2))
    dx, dy = np.subtract(pads[last], pads["1"])
    seen = math.degrees(math.atan2(-dy, dx))  # counter-clockwise, from the front
    seen -= _lying_deg(read, part.ref, last)
    if not part.front:
        seen = 180 - seen if fab.back_from_behind else seen
    fits = [(start, turn) for start, turn in fab.rotations if part.footprint.startswith(start)]
    seen += max(fits, key=lambda fit: len(fit[0]))[1] if fits else 0.0
    return abs((float(row["angle_deg"]) - seen + 180) % 360 - 180)


def _lying_deg(read: ReadBoard, ref: str, last: str) -> float:
    """Angle of the line from pad 1 to another one of a module that is not turned; 0 of the rest."""
    modules = (d for d in read.components if d.ref == ref and d.kind == "module")
    for device in modules:
        at = {land.number: (land.x_mm, land.y_mm) for land in device.footprint.pads}
        dx, dy = np.subtract(at[last], at["1"])
        return math.degrees(math.atan2(dy, dx))
    return 0.0


def _misled(read: ReadBoard, finger: Finger, note: str) -> Iterator[str]:
    """Parts with polarity for which the assembly note has another place of a terminal than the
    board has, or another terminal at the mark than the catalogue."""
    chip = read.design.packages.at_cells(finger)
    terminals = {m["ref"]: m for m in _TERMINALS.finditer(note)}
    if f"pad 1 is the {chip.marked}" not in note or (
        not chip.mark_is_known and f"{chip.marked} is {chip.mark_confidence}" not in note
    ):
        yield "the mark"
    of_cell = re.compile(rf"{finger.cells_hold.letter}\d+(_\d+)?")
    for part in (p for p in read.board.parts if of_cell.fullmatch(p.ref)):
        row, pads = terminals.get(part.ref), {t.number: t.at for t in part.terminals}
        wanted = read.sensor([pads["1"], pads["2"]])
        if row is None or row["one"] != chip.marked or row["other"] == chip.marked:
            yield part.ref
            continue
        ends = [[float(row["x1"]), float(row["y1"])], [float(row["x2"]), float(row["y2"])]]
        if not np.abs(wanted - ends).max() <= PLACE_MM:
            yield part.ref


def _misordered(read: ReadBoard, note: str) -> Iterator[str]:
    """Figures of the fabrication note that are not those of the board's file."""
    edges = shapely.union_all(list(read.board.edges)).bounds
    tracks = [copper.width_mm for copper in read.board.loose if copper.width_mm]
    drills = [copper.drill_mm for copper in read.board.copper() if copper.drill_mm]
    figures = {
        "Copper layers": (float(len(read.board.layers)),),
        "Size": (edges[2] - edges[0], edges[3] - edges[1]),
        "Thickness": (read.board.thickness_mm,),
    }
    if tracks:
        figures["Narrowest track"] = (min(tracks),)
    if drills:
        figures["Smallest drill"] = (min(drills),)
    finish, flexible = read.of.finish, read.flexible
    copper_um = 1000 * flexible.copper_mm if flexible else finish.copper_um
    figures["Copper"] = (copper_um,)
    lines: dict[str, str] = dict(re.findall(r"^(.+?): (.+)$", note, re.MULTILINE))
    for name, wanted in figures.items():
        stated = [float(figure) for figure in re.findall(r"[\d.]+", lines.get(name, ""))]
        if len(stated) != len(wanted) or not np.allclose(stated, wanted, atol=SIZE_MM):
            yield name
    if finish.mask not in lines.get("Solder mask", lines.get("Coverlay", "")):
        yield "colour of the mask"
    for name, word in (("Surface", finish.surface), ("Silkscreen", "white")):
        if not re.fullmatch(rf"{re.escape(word)}(,.*)?", lines.get(name, "")):
            yield name


def _unstopped(read: ReadBoard, finger: Finger, files: _Files) -> Iterator[str]:
    """A stop line that is missing, or stands where the polarity is known; the parts that it does
    not name."""
    chip, text = read.design.packages.at_cells(finger), files.get(STOP_FILE, b"").decode()
    if chip.mark_is_known == bool(text):
        yield STOP_FILE
    elif text:
        letter, last = finger.cells_hold.letter, len(finger.cells)
        ends = [
            f"{at}{copy}"
            for at, copy in zip((f"{letter}1", f"{letter}{last}"), read.copy_ends, strict=True)
        ]
        cells = " to ".join(dict.fromkeys(ends))
        named = text.startswith(f"STOP: do not place {cells} ") and f"\n{cells}: " in text
        if not named or chip.order_number not in text:
            yield f"{cells} in {STOP_FILE}"


def _ordered(read: ReadBoard, fab: Fab) -> dict[str, str]:
    """Layers that a board's zip is to have: a stiffener is drawn for flexible boards alone."""
    return {key: end for key, end in fab.layers if key != "stiffener" or read.flexible}


def _unasked(name: str, ordered: dict[str, str], files: _Files) -> list[str]:
    """Files that a zip has beside layers, tables and note: each would be taken for a layer."""
    asked = {*ordered.values(), "_bom.csv", "_positions.csv", "_assembly.txt", "_fabrication.txt"}
    return sorted(files.keys() - {name + end for end in asked} - {STOP_FILE})


def _untold(note: str, flexible: Flexible, thickness_mm: float, drawn: str) -> Iterator[str]:
    """Figures of a flexible board that the order note has wrong, or not at all."""
    stiff = flexible.stiffener
    edges = (stiff.x_min_mm, stiff.x_max_mm, stiff.y_min_mm, stiff.y_max_mm)
    wanted = {
        "thickness": (r"FLEXIBLE BOARD, (\S+) mm thick", (thickness_mm,)),
        "stiffener": (r"x (\S+) to (\S+), y (\S+) to (\S+);", edges),
        "its thickness": (r"Stiffener of polyimide, (\S+) mm,", (flexible.stiffener_mm,)),
        "bend": (r"where y is above (\S+):", (flexible.bend.y_min_mm,)),
    }
    for name, (row, values) in wanted.items():
        match = re.search(row, note)
        if match is None or not np.allclose([float(v) for v in match.groups()], values, atol=1e-3):
            yield name
    if f"Its outline is the drawing {drawn}," not in note:
        yield "its drawing"


def _misplaced(read: ReadBoard, note: str) -> Iterator[str]:
    """Parts of an auxiliary board whose first pad or side differs in the assembly note."""
    behind = re.search(r"^ON THE BACK: (.+?)\. ", note, re.MULTILINE)
    told_behind = set(behind[1].split(", ")) if behind else set()
    first_pads = {m["ref"]: (float(m["x"]), float(m["y"])) for m in _FIRST_PADS.finditer(note)}
    for part in read.board.parts:
        if "exclude_from_bom" in part.attributes:
            continue
        first = next(t.at for t in part.terminals if t.number == "1")
        place = first_pads.get(part.ref, (math.nan, math.nan))
        there = np.abs(read.sensor([first])[0] - place).max() <= PLACE_MM
        if not there or (part.ref in told_behind) == part.front:
            yield part.ref


def _tables_twice(path: str, folder: Path, fab: Fab, name: str, files: _Files) -> Measurement:
    """The tables beside a zip are those inside it."""
    tables = (f"{name}_bom.csv", f"{name}_positions.csv")
    differ = [t for t in tables if (folder / f"{fab.name}_{t}").read_bytes() != files[t]]
    return count("orders.tables", path, differ, "tables that differ")


def _rows(data: bytes, columns: tuple[tuple[str, str], ...]) -> list[dict[str, str]]:
    """The rows of a table by field."""
    return [{field: row[heading] for heading, field in columns} for row in table(data.decode())]
