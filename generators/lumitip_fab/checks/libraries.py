"""A board's project: its libraries hold the parts that board and schematic show; its rules, classes
and nets agree with each other and with the board's nets, and the rules are those of the design."""

import json
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lumitip_fab.checks.board_read import names_of
from lumitip_fab.checks.board_settings import other_settings
from lumitip_fab.checks.project_rules import other_rules
from lumitip_fab.checks.readers import MALFORMED
from lumitip_fab.checks.readers.kicad_shapes import (
    Node,
    child,
    children,
    numbers,
    read_nodes,
    words,
)
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Design
from lumitip_fab.errors import OutputError

READS = (
    "boards/*-lib-table",
    "boards/*.kicad_sym",
    "boards/*.kicad_mod",
    "boards/*.kicad_pcb",
    "boards/*.kicad_sch",
    "boards/*.kicad_pro",
)
_LIBRARY = "lumitip"
_TABLES = {"fp": f"{_LIBRARY}.pretty", "sym": f"{_LIBRARY}.kicad_sym"}
_DRAWN = ("fp_line", "fp_rect", "fp_circle", "fp_arc", "fp_poly")
_OF_THE_PART = ("Fab", "CrtYd")
"""Layers of lines that no neighbour trims, as the silkscreen's are."""
_MOUNTED = {"smd", "through_hole"}
_FORM = ("roundrect_rratio", "solder_mask_margin", "solder_paste_margin")
_BACK = str.maketrans("FB", "BF")
_SAME_MM = 1e-4
_RULES = {
    "min_clearance": "clearance",
    "min_track_width": "track_width",
    "min_via_diameter": "via_diameter",
    "min_through_hole_diameter": "via_drill",
}
"""Rules of a project, each the least of a value of its net classes."""
_POSITIVE = (*_RULES, "min_hole_clearance", "min_hole_to_hole", "min_copper_edge_clearance")


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """The libraries and the project of every board."""
    for name in names_of(design):
        folder, subject = outputs / "boards" / name, f"boards/{name}"
        for check, unit, wrong in (
            ("tables", "tables lead to no library", _tables),
            ("footprints", "footprints are not the library's", _footprints),
            ("symbols", "symbols are not the library's", _symbols),
            ("project", "settings are missing or contradict others", _project),
        ):
            yield _count(check, subject, unit, wrong(folder))
    for name in (*names_of(design), *(panel.name for panel in design.panels)):
        folder, subject = outputs / "boards" / name, f"boards/{name}"
        rules = other_rules(folder, design)
        yield _count("rules", subject, "settings are not the design's", rules)
        settings = other_settings(folder, design)
        yield _count("board", subject, "settings of the board's file are others", settings)


def _count(check: str, subject: str, unit: str, wrong: Iterator[str]) -> Measurement:
    try:
        return count(f"libraries.{check}", subject, list(wrong), unit)
    except (OutputError, OSError, *MALFORMED) as error:
        return unreadable(f"libraries.{check}", subject, f"cannot be read: {error!s:.200}")


def _tables(folder: Path) -> Iterator[str]:
    """Tables through which KiCad does not find the library."""
    for kind, file in _TABLES.items():
        table = read_nodes(folder / f"{kind}-lib-table")
        rows = [
            {key: words(child(lib, key)) for key in ("name", "type", "uri")}
            for lib in children(table, "lib")
        ]
        uri = "${KIPRJMOD}/" + file
        wanted = [{"name": [_LIBRARY], "type": ["KiCad"], "uri": [uri]}]
        if table[0] != f"{kind}_lib_table" or rows != wanted or not (folder / file).exists():
            yield f"{kind}-lib-table"


def _footprints(folder: Path) -> Iterator[str]:
    """Parts of the board that are not as their footprint in the library."""
    board = read_nodes(folder / f"{folder.name}.kicad_pcb")
    known: dict[str, Counter[Any]] = {}
    for part in children(board, "footprint"):
        library, _, name = str(part[1]).partition(":")
        if name not in known:
            known[name] = _shape(read_nodes(folder / f"{library}.pretty" / f"{name}.kicad_mod"))
        if _shape(part) != known[name]:
            yield name
    files = {file.stem for file in (folder / _TABLES["fp"]).glob("*.kicad_mod")}
    yield from sorted(files - known.keys())


def _shape(part: Node) -> Counter[Any]:
    """Pads and lines of a footprint as seen from its own side."""
    back = words(child(part, "layer")) == ["B.Cu"]
    at = numbers(child(part, "at"))
    turn = at[2] if len(at) > 2 else 0.0
    kinds = frozenset(words(child(part, "attr"))) & _MOUNTED
    found = Counter[Any]([kinds, *(str(model[1]) for model in children(part, "model"))])
    for pad in children(part, "pad"):
        x, y, *angle = numbers(child(pad, "at"))
        own = (angle[0] if angle else 0.0) - turn
        layers = {_side(layer, back) for layer in words(child(pad, "layers"))}
        drill = tuple(words(child(pad, "drill")))
        kind, size = tuple(words(pad)[:3]), numbers(child(pad, "size"))
        place = _rounded(x, -y if back else y), round((-own if back else own) % 180, 3) % 180
        form = tuple(numbers(child(pad, key)) for key in _FORM)
        found[kind, place, size, drill, frozenset(layers), form] += 1
    for line in children(part, *_DRAWN):
        (layer,) = words(child(line, "layer"))
        if layer.partition(".")[2] in _OF_THE_PART:
            found[line[0], _side(layer, back), frozenset(_places(line, back))] += 1
    return found


def _places(line: Node, back: bool) -> Iterator[tuple[float, ...]]:
    for name in ("start", "mid", "end", "center"):
        if point := child(line, name):
            x, y = numbers(point)[:2]
            yield _rounded(x, -y if back else y)
    for point in children(child(line, "pts") or [], "xy"):
        x, y = numbers(point)
        yield _rounded(x, -y if back else y)


def _side(layer: str, back: bool) -> str:
    return layer[0].translate(_BACK) + layer[1:] if back else layer


def _rounded(*values: float) -> tuple[float, ...]:
    return tuple(round(value / _SAME_MM) * _SAME_MM + 0.0 for value in values)


def _symbols(folder: Path) -> Iterator[str]:
    """Symbols that the schematic carries and the library has otherwise, or not."""
    sheet = read_nodes(folder / f"{folder.name}.kicad_sch")
    library = read_nodes(folder / _TABLES["sym"])
    ours = {str(symbol[1]): symbol for symbol in children(library, "symbol")}
    theirs = {
        str(symbol[1]).removeprefix(f"{_LIBRARY}:"): symbol
        for symbol in children(child(sheet, "lib_symbols") or [], "symbol")
    }
    for name in sorted(ours.keys() | theirs.keys()):
        if name not in ours or name not in theirs or ours[name][2:] != theirs[name][2:]:
            yield name


def _project(folder: Path) -> Iterator[str]:
    """Settings of the project that contradict each other, the schematic or the board."""
    record = json.loads((folder / f"{folder.name}.kicad_pro").read_text(encoding="utf-8"))
    rules, nets = record["board"]["design_settings"]["rules"], record["net_settings"]
    if record["meta"]["filename"] != f"{folder.name}.kicad_pro":
        yield "filename"
    yield from (rule for rule, s in record["erc"]["rule_severities"].items() if s != "error")
    classes = {c["name"]: c for c in nets["classes"]}
    for rule, value in _RULES.items():
        if rules[rule] != min(c[value] for c in classes.values()):
            yield rule
    yield from (rule for rule in _POSITIVE if rules[rule] <= 0)
    board = read_nodes(folder / f"{folder.name}.kicad_pcb")
    named = {str(net[2]) for net in children(board, "net") if net[2]}
    patterns = {entry["pattern"]: entry["netclass"] for entry in nets["netclass_patterns"]}
    if patterns.keys() != named or not set(patterns.values()) <= classes.keys():
        yield "netclass_patterns"
    for name, each in classes.items():
        if name != "Default" and {n for n, c in patterns.items() if c == name} != set(each["nets"]):
            yield f"nets of {name}"
