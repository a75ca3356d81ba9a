"""Order files against the board files: layers, parts, positions, note."""

import math
import re
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

from lumitip_fab.checks.board_read import ReadBoard, names_of, path_of, read_any
from lumitip_fab.checks.order_layers import (
    PLACE_MM,
    Painted,
    measure_layers,
    measure_stiffener,
)
from lumitip_fab.checks.order_notes import other_figures, other_lines
from lumitip_fab.checks.order_tables import Files, measure_tables, tables_twice
from lumitip_fab.checks.panel_read import read_panel
from lumitip_fab.checks.readers.tables import unpacked
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Design, Fab, Finger, Flexible
from lumitip_fab.errors import OutputError

READS = ("boards/*.kicad_pcb", "boards/*.zip", "boards/*.csv")
STOP_FILE = "STOP_READ_FIRST.txt"
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
    if read.outline.is_empty:
        yield unreadable("orders.board", path_of(name), "its edge is not drawn, or is open")
        return
    folder = (outputs / path_of(name)).parent
    flexible = read.flexible
    painted: Painted = {}
    first: Files = {}
    found: tuple[Measurement, ...] = ()
    for fab in design.fabs:
        package = f"{fab.name}_{name}.zip"
        path = f"boards/{name}/order/{package}"
        try:
            files = unpacked(folder / "order" / package)
            ordered = _ordered(read, fab)
            layers = {key: files[name + end] for key, end in ordered.items()}
            yield count("orders.files", path, _unasked(name, ordered, files), "files")
            yield tables_twice(path, folder / "order", fab, name, files)
            same = layers == first  # whose bytes would only be measured again
            measured = found if same else tuple(measure_layers("", read, layers, painted))
            yield from (replace(m, subject=f"{path}{m.subject}") for m in measured)
            if flexible:
                yield measure_stiffener(path, layers, flexible.stiffener)
            if not first:
                first, found = layers, measured
            other = [key for key in first if first[key] != layers[key]]
            yield count("orders.same", path, other, "layers that differ")
            yield from measure_tables(path, read, fab, files)
            note, made = (files[f"{name}_{n}.txt"].decode() for n in ("assembly", "fabrication"))
            drawn = name + ordered.get("stiffener", "")
            wrong = list(
                _misled(read, read.finger, note) if read.finger else _misplaced(read, note)
            )
            wrong += other_lines(read, fab, note, drawn)
            yield count("orders.note", path, wrong, "parts and lines")
            yield count("orders.assumed", path, _unsure(read, fab, note), "parts")
            yield count("orders.fabrication", path, list(other_figures(read, made)), "figures")
            if read.finger:
                stops = list(_unstopped(read, read.finger, files))
                yield count("orders.stop", path, stops, "files")
            if flexible:
                untold = _untold(note, flexible, design.stack.pcb_mm, drawn)
                yield count("orders.flexible", path, list(untold), "figures")
        except (OSError, KeyError, ValueError, SyntaxError) as error:
            yield unreadable("orders.readable", path, f"cannot be read: {error!r:.200}")


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


def _unsure(read: ReadBoard, fab: Fab, note: str) -> list[str]:
    """Parts that are turned by an assumed angle, or by none that is known, and that the note does
    not name as such, or the other way round."""
    row = re.search(r"^ROTATION ASSUMED: (.+?)\.", note, re.MULTILINE)
    named = set(row[1].split(", ")) if row else set()
    unsure = set()
    for ref in read.assembled():
        footprint = read.parts[ref].footprint
        fits = [start for start, _ in fab.rotations if footprint.startswith(start)]
        of_its_own = read.ordered(ref)[0] in dict(fab.part_rotations)
        if not of_its_own and max(fits, key=len, default="") in ("", *fab.rotations_assumed):
            unsure.add(ref)
    return sorted(named ^ unsure)


def _unstopped(read: ReadBoard, finger: Finger, files: Files) -> Iterator[str]:
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


def _unasked(name: str, ordered: dict[str, str], files: Files) -> list[str]:
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
    mounted = read.assembled()
    row = re.search(r"^NOT MOUNTED BY YOU: (.+?)\. The customer", note, re.MULTILINE)
    named = set(re.findall(r"([A-Z]+\d+(?:_\d+)?) \(", row[1])) if row else set()
    yield from sorted(named ^ {p.ref for p in read.board.parts if p.bought} ^ mounted)
    for part in (part for part in read.board.parts if part.ref in mounted):
        first = next(t.at for t in part.terminals if t.number == "1")
        place = first_pads.get(part.ref, (math.nan, math.nan))
        there = np.abs(read.sensor([first])[0] - place).max() <= PLACE_MM
        if not there or (part.ref in told_behind) == part.front:
            yield part.ref
