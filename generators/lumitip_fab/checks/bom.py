"""`bom.csv` against the boards, the printed parts, the casting notes, the cables, and its
own sums; and how many lines of the boards' lists have numbers to order by."""

import math
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from lumitip_fab.checks.board_read import names_of
from lumitip_fab.checks.bom_numbers import measure_numbers
from lumitip_fab.checks.bom_uses import Part, Row, measure_uses
from lumitip_fab.checks.cables import read_list
from lumitip_fab.checks.readers.kicad_board import read_board
from lumitip_fab.checks.readers.tables import table
from lumitip_fab.checks.readers.vertices import corners_mm
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Design
from lumitip_fab.design.mould import printed_times
from lumitip_fab.errors import OutputError

READS = (
    "bom.csv",
    "boards/*/*.kicad_pcb",
    "boards/*/order/*_bom.csv",
    "backing/*.stl",
    "interface/*.stl",
    "mould/*.stl",
    "holder/*.stl",
    "flange/*.stl",
    "fit/*.stl",
    "gauge/*.stl",
    "mask/*.stl",
    "mould/*_casting.md",
    "wiring/cables.csv",
)
_FILE = "bom.csv"
_PART_G = re.compile(r"^\| .*, part [AB] \| \*\*([\d.]+) g\*\* \|$", re.MULTILINE)
_GROUPS = frozenset(
    ("electronics", "boards", "prints", "casting", "mask", "wiring", "supplies", "fasteners")
)
_CENT = 0.0051
_FRACTION = 0.01
_LENGTH = re.compile(r"M[\d.]+ x ([\d.]+) socket head screw$")
_THREADS = (1.5, 2.5)  # of a bolt in the gripper, its length an even one


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read the bill as whoever orders by it, and count again."""
    try:
        rows, total, note = _read(outputs / _FILE)
        parts = _parts(outputs, design)
        grams = _grams(outputs, design)
        wires = read_list(outputs / "wiring/cables.csv")
        metres = sum(row.length_mm for row in wires) / 1000
        cast = sum(_casting(outputs, design))
        uses = list(measure_uses(outputs, rows, parts, wires, design))
    except OutputError as error:
        yield unreadable("bom.readable", _FILE, str(error))
        return
    every = sum(parts.values(), start=Counter[Part]())
    yield count("bom.parts", _FILE, _wrong_parts(rows, every, design), "wrong parts")
    yield from uses
    yield _prints(rows, grams)
    cast += sum(design.mould.trial_g)
    yield _near("silicone", rows, "casting", cast, "g", "both casting notes, and the trial")
    sheets = 0.0 if design.mask.route == "tpu" else 2.0
    yield _near("film", rows, "mask", sheets, "sheets", "one for each finger, unless it is printed")
    yield _near("wire", rows, "wiring", metres, "m", "of every wire in the list of cables")
    yield from _bolts(rows, design)
    yield count("bom.prices", _FILE, _wrong_prices(rows, design), "wrong lines")
    units = [f"{row.item}: {row.unit}" for row in rows if row.unit != _unit(row, design)]
    yield count("bom.units", _FILE, units, "other units")
    yield _sum(rows, total, note, design)
    yield from measure_numbers(outputs, design)


def _bolts(rows: tuple[Row, ...], design: Design) -> Iterator[Measurement]:
    """Bolts of the fingers and of the flange, by thread; how far the former go into the gripper."""
    wanted = Counter({design.mount.bolt: 2 * len(design.mount.bolt_u_mm)})
    for flange in design.flanges:
        wanted[flange.bolt] += len(flange.bolts)
    for thread, number in wanted.items():
        of_thread = re.compile(rf"{re.escape(thread)}(?: x [\d.]+)? socket")
        listed = sum(r.quantity for r in rows if of_thread.match(r.item))
        yield Measurement(
            "bom.bolts", _FILE, listed, number, number, "bolts", f"{thread}, of fingers and flange"
        )
    lengths = [found[1] for r in rows if (found := _LENGTH.match(r.item))]
    length = float(lengths[0]) if len(lengths) == 1 else math.nan
    threads = (length - design.mount.land_mm) / float(design.mount.bolt.removeprefix("M"))
    note = "threads into the gripper"
    yield Measurement("bom.bolt_length", _FILE, threads, *_THREADS, "", note)


def _read(path: Path) -> tuple[tuple[Row, ...], float, str]:
    try:
        lines = table(path.read_text(encoding="utf-8"))
        rows = tuple(
            Row(
                r["group"],
                r["item"],
                r["manufacturer"],
                r["part"],
                r["for"],
                _figure(r["quantity"]),
                r["unit"],
                _price(r["unit_price"]),
                _price(r["price"]),
            )
            for r in lines[:-1]
        )
        if lines[-1]["group"] != "total":
            raise ValueError("its last line is no total")
        if unknown := {row.group for row in rows} - _GROUPS:
            raise ValueError(f"unknown groups: {', '.join(sorted(unknown))}")
        return rows, _figure(lines[-1]["price"]), lines[-1]["for"]
    except (OSError, ValueError, KeyError, IndexError) as error:
        raise OutputError(f"{path}: cannot be read as a bill: {error!r:.120}") from error


def _figure(text: str) -> float:
    if not math.isfinite(figure := float(text)):
        raise ValueError(f"{text} is no figure")
    return figure


def _price(text: str) -> float | None:
    return _figure(text) if text else None


def _parts(outputs: Path, design: Design) -> dict[str, Counter[Part]]:
    """Quantity of each part in each board's file, those that are soldered on by hand too.

    Raises:
        OutputError: if one cannot be read.
    """
    found: dict[str, Counter[Part]] = {}
    for name in names_of(design):
        board = read_board(outputs / f"boards/{name}/{name}.kicad_pcb")
        fields = [dict(part.fields) for part in board.parts if part.bought]
        found[name] = Counter((f.get("Manufacturer", ""), f.get("MPN", "")) for f in fields)
    return found


def _grams(outputs: Path, design: Design) -> dict[str, float]:
    """Mass of each printed part, solid."""
    found = {}
    printed = [pattern for pattern in READS if pattern.endswith(".stl")]
    if design.mask.route != "tpu":
        printed.remove("mask/*.stl")
    for path in sorted(path for pattern in printed for path in outputs.glob(pattern)):
        corners = corners_mm(path).reshape(-1, 3, 3)
        mm3 = float(np.linalg.det(corners).sum() / 6)
        name = path.relative_to(outputs).as_posix()
        times = printed_times(design.mould_accessories, name)
        found[name] = times * mm3 / 1000 * design.slicing.of(name).density_g_ml
    return found


def _casting(outputs: Path, design: Design) -> Iterator[float]:
    for finger in design.fingers:
        path = outputs / f"mould/{finger.name}_casting.md"
        try:
            yield from map(float, _PART_G.findall(path.read_text(encoding="utf-8")))
        except (OSError, ValueError) as error:
            raise OutputError(f"{path}: {error}") from error


def _wrong_parts(rows: tuple[Row, ...], parts: Counter[Part], design: Design) -> list[str]:
    counts: Counter[Part] = Counter()
    for row in rows:
        if row.group == "electronics":
            counts[row.maker, row.part] += round(row.quantity)
    soldered = any(board.module for board in design.auxiliary_boards)
    wanted = parts + Counter({} if soldered else {("", design.controller.title): 1})
    return [
        f"{' '.join(part)}: {counts[part]}, not {wanted[part]}"
        for part in sorted({*counts, *wanted})
        if counts[part] != wanted[part]
    ]


def _prints(rows: tuple[Row, ...], grams: dict[str, float]) -> Measurement:
    listed = {row.item: row.quantity for row in rows if row.group == "prints"}
    if listed.keys() != grams.keys():
        wrong = sorted(listed.keys() ^ grams.keys())
        return unreadable("bom.prints", _FILE, f"lists other parts: {', '.join(wrong[:3])}")
    off = {name: abs(listed[name] / grams[name] - 1) for name in grams}
    worst = max(off, key=lambda name: off[name])
    note = f"mass against volume and density, worst at {worst}"
    return Measurement("bom.prints", _FILE, 100 * off[worst], 0, 100 * _FRACTION, "%", note)


def _near(
    check: str, rows: tuple[Row, ...], group: str, wanted: float, unit: str, note: str
) -> Measurement:
    listed = sum(row.quantity for row in rows if row.group == group)
    room = _FRACTION * wanted
    return Measurement(f"bom.{check}", _FILE, listed, wanted - room, wanted + room, unit, note)


def _wrong_prices(rows: tuple[Row, ...], design: Design) -> list[str]:
    """Lines whose price is not quantity times unit price, or whose unit price is not the one of
    the design."""
    wrong = []
    for row in rows:
        each = _each(row, design)
        price = None if each is None else row.quantity * each
        if not _same(row.each, each, 5e-4 * (each or 0)) or not _same(row.price, price, _CENT):
            wrong.append(f"{row.item}: {row.each} each, {row.price} in all")
    return wrong


def _each(row: Row, design: Design) -> float | None:
    """Unit price of a line."""
    purchase = design.purchase
    if row.group in ("electronics", "fasteners", "supplies"):
        known = {piece.item: piece.each for piece in purchase.pieces}
        priced = next((p.each for p in purchase.parts if p.of(row.part)), None)
        return known.get(row.item, priced)
    if row.group == "boards":
        boxes = {c.name: c.box for c in design.auxiliary_boards}
        box = boxes.get(row.item.removesuffix(" board"), design.board.box)
        bare = purchase.board_each + box.width_mm * box.length_mm / 100 * purchase.board_per_cm2
        return round(bare, 2) if row.item.endswith(" board") else purchase.placing_each
    if row.group == "prints":
        return purchase.unit_price(design.slicing.of(row.item).name)
    packs = {"casting": purchase.silicone, "mask": purchase.film, "wiring": "stranded wire"}
    return purchase.unit_price(packs[row.group])


def _unit(row: Row, design: Design) -> str:
    """Unit of a line's quantity."""
    by_group = {"prints": "g", "casting": "g", "mask": "sheet", "wiring": "m"}
    by_item = {piece.item: piece.unit for piece in design.purchase.pieces}
    return by_group.get(row.group) or by_item.get(row.item, "piece")


def _same(figure: float | None, wanted: float | None, room: float) -> bool:
    if figure is None or wanted is None:
        return figure is wanted
    return abs(figure - wanted) <= room


def _sum(rows: tuple[Row, ...], total: float, note: str, design: Design) -> Measurement:
    """The total against its lines; it must say of when the prices are, and what they are worth."""
    purchase = design.purchase
    sources = (purchase.currency, purchase.dated, purchase.confidence)
    lines = sum(row.price or 0.0 for row in rows)
    off = abs(lines - total) if all(word in note for word in sources) else math.nan
    return Measurement("bom.total", _FILE, off, 0, _CENT, purchase.currency, f"of {lines:.2f}")
