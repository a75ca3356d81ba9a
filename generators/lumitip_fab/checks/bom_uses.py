"""Uses and quantities of the bill's lines: parts of each board, fasteners, bare boards, and what
the design buys besides."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from lumitip_fab.checks.board_read import names_of, read_any
from lumitip_fab.checks.cables import Row as Wire
from lumitip_fab.checks.result import Measurement, count
from lumitip_fab.design import Design
from lumitip_fab.design.mould import MOULDS, printed_times

_FILE = "bom.csv"
_ON_BOARD = re.compile(r"(\d+) on (\w+)(?:, soldered on by hand)?")
_TIMES = re.compile(r"(\d+) times, each some ")
_COLOURS = re.compile(r"(\d+) colours: ")
_SECTION = re.compile(r"([\d.]+) mm² ")
_LONGER = re.compile(r"flange bolts, (-?[\d.]+) mm (longer|shorter) than ")
_ROUND_MM = 0.051
_LOOSE = 2  # of each kind whose marked terminal is to be tested
Part = tuple[str, str]
"""Manufacturer, and order number."""


@dataclass(frozen=True)
class Row:
    """A line of the bill."""

    group: str
    item: str
    maker: str
    part: str
    where: str
    quantity: float
    unit: str
    each: float | None
    price: float | None


def measure_uses(
    outputs: Path,
    rows: tuple[Row, ...],
    parts: Mapping[str, Counter[Part]],
    wires: tuple[Wire, ...],
    design: Design,
) -> Iterator[Measurement]:
    """Count again what each line is for.

    Args:
        outputs: the output folder.
        rows: of the bill.
        parts: quantity of each part on each board's file.
        wires: of the list of cables.
        design: what is built.

    Raises:
        OutputError: if a board cannot be read.
    """
    wrong = [*_misplaced(rows, parts), *_misprinted(rows, wires, design)]
    yield count("bom.uses", _FILE, wrong, "lines for something else")
    wrong = list(_wrong_boards(outputs, rows, design))
    yield count("bom.boards", _FILE, wrong, "wrong boards")
    yield count("bom.fasteners", _FILE, list(_wrong_fasteners(rows, design)), "wrong fasteners")
    yield count("bom.pieces", _FILE, list(_wrong_pieces(rows, design)), "lines unlike the design's")


def _misplaced(rows: tuple[Row, ...], parts: Mapping[str, Counter[Part]]) -> Iterator[str]:
    """Parts that the bill has on other boards, or in other numbers there."""
    stated: Counter[tuple[Part, str]] = Counter()
    for row in (row for row in rows if row.group == "electronics"):
        uses = _ON_BOARD.findall(row.where)
        for number, board in uses:
            stated[(row.maker, row.part), board] += int(number)
        if uses and sum(int(number) for number, _ in uses) != row.quantity:
            yield f"{row.item}: {row.where}, not {row.quantity:g}"
    there = Counter({(part, board): n for board, of in parts.items() for part, n in of.items()})
    for part, board in sorted({*stated, *there}):
        if stated[part, board] != there[part, board]:
            yield f"{' '.join(part)}: {stated[part, board]} on {board}, not {there[part, board]}"


def _misprinted(rows: tuple[Row, ...], wires: tuple[Wire, ...], design: Design) -> Iterator[str]:
    """Printed parts that are needed more or less often, and wires of more or fewer colours."""
    for row in rows:
        if row.group == "prints":
            found = _TIMES.match(row.where)
            times = int(found[1]) if found else 1
            if times != printed_times(design.mould_accessories, row.item):
                yield f"{row.item}: {times} times"
        if row.group == "wiring":
            colours, section = _COLOURS.match(row.where), _SECTION.search(row.item)
            mm2 = float(section[1]) if section else 0.0
            drawn = {wire.colour for wire in wires if wire.section_mm2 == mm2}
            if colours is None or int(colours[1]) != len(drawn):
                yield f"{row.item}: {row.where}"


def _wrong_boards(outputs: Path, rows: tuple[Row, ...], design: Design) -> Iterator[str]:
    """Bare boards that are listed not once, or in another size; placing of more or fewer parts."""
    boxes = {c.name: c.box for c in design.auxiliary_boards}
    names = list(names_of(design))
    wanted: dict[str, tuple[str, float]] = {}
    for name in names:
        box = boxes.get(name, design.board.box)
        wanted[f"{name} board"] = (f"{box.width_mm:g} x {box.length_mm:g} mm", 1.0)
    placed = sum(len(read_any(outputs, design, name).assembled()) for name in names)
    wanted["placing and soldering"] = ("", float(placed))
    listed = [row for row in rows if row.group == "boards"]
    yield from sorted(wanted.keys() ^ {row.item for row in listed})
    yield from (f"{item} twice" for item, n in Counter(r.item for r in listed).items() if n > 1)
    for row in listed:
        if (row.part, row.quantity) != wanted.get(row.item, (row.part, row.quantity)):
            yield f"{row.item}: {row.quantity:g} {row.part}"


def _wrong_fasteners(rows: tuple[Row, ...], design: Design) -> Iterator[str]:
    """Screws, nuts and pins of clamps, holder and flange that are more or fewer than their holes
    in the parts, and bolts of another length."""
    wanted: Counter[str] = Counter()
    for clamp in design.clamps:
        wanted[f"{clamp.screw.name} screw"] += MOULDS * len(clamp.screws)
        wanted[f"{clamp.screw.name} nut"] += 2 * MOULDS * len(clamp.screws)
    for thread, holes in (
        *((holder.screw, holder.holes) for holder in design.holders),
        *((flange.screw, flange.screws) for flange in design.flanges),
    ):
        wanted[f"{thread} screw"] += len(holes)
        wanted[f"{thread} nut"] += len(holes)
    for flange in design.flanges:
        wanted[f"{flange.pin_mm:g} x {flange.pin_length_mm:g} parallel pin"] += 1
    listed: Counter[str] = Counter()
    for row in (r for r in rows if r.group == "fasteners" and "socket head" not in r.item):
        name = re.sub(r"^(M[\d.]+) (?:x [\d.]+ )?(?:countersunk )?(screw|nut)$", r"\1 \2", row.item)
        listed[name] += round(row.quantity)
    for name in sorted({*wanted, *listed}):
        if wanted[name] != listed[name]:
            yield f"{listed[name]} {name}, not {wanted[name]}"
    longer = [
        float(mm) * (1 if way == "longer" else -1)
        for row in rows
        for mm, way in _LONGER.findall(row.where)
    ]
    heights = [flange.top_z_mm for flange in design.flanges]
    if len(longer) != len(heights) or any(
        abs(mm - high) > _ROUND_MM for mm, high in zip(longer, heights, strict=True)
    ):
        yield f"bolts of the flange {longer} mm longer"


def _wrong_pieces(rows: tuple[Row, ...], design: Design) -> Iterator[str]:
    """What the design buys beside parts, prints and materials: lines that differ in item, product,
    use or quantity, and lines that it does not buy."""
    wanted = Counter(
        (p.group, p.item, p.manufacturer, p.part, p.where, float(f"{p.quantity:g}"))
        for p in design.purchase.pieces
    )
    for kind, package in design.packages.unmarked.items():
        number = package.order_number
        where = "test of the marked terminals, before the boards"
        loose = ("supplies", f"{kind} {number}, loose", package.manufacturer, number, where)
        wanted[*loose, float(_LOOSE)] += 1
    groups = ("supplies", "fasteners")
    listed = Counter(
        (r.group, r.item, r.maker, r.part, r.where, r.quantity)
        for r in rows
        if r.group in groups or (not _ON_BOARD.findall(r.where) and r.group == "electronics")
    )
    for line in sorted((wanted - listed) + (listed - wanted)):
        yield f"{line[1]}: {line[5]:g} for {line[4]}"
