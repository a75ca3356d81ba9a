"""`bom.csv`: everything that is bought, printed and cast, from the facts of the built files, with
prices."""

import csv
import io
from collections.abc import Iterator
from dataclasses import asdict, dataclass

from lumitip_fab.design import Design, Purchase
from lumitip_fab.pipeline.artefact import Artefact, Files

_GRAMS = 1000.0
_KINDS = {
    "C": "capacitor",
    "D": "LED",
    "F": "fuse",
    "J": "connector",
    "L": "inductor",
    "Q": "transistor",
    "R": "resistor",
    "U": "circuit",
    "Y": "crystal",
    "Z": "ESD diode",
}
"""Kind of a part by the first letter of its references."""
_ON_BOARD = {
    "receiver": {"Q": "photodetector"},
    "emitter": {"U": "current source"},
    "flange": {"D1": "TVS diode"},
}
"""The same where a board has another kind of this letter, or of this part alone."""


@dataclass(frozen=True)
class Line:
    """A line of the bill."""

    group: str
    item: str
    manufacturer: str
    part: str
    where: str
    quantity: float
    unit: str
    each: float | None

    @property
    def price(self) -> float | None:
        """Price of the whole quantity."""
        return None if self.each is None else round(self.quantity * self.each, 2)


def electronics(design: Design, files: Files) -> Iterator[Line]:
    """Parts of all boards, alike ones together, the controller, bare boards, and placing."""
    purchase = design.purchase
    found: dict[tuple[str, str, str], dict[str, int]] = {}
    for path in files.like("boards/*/*.kicad_pcb"):
        board = path.split("/")[1]
        if "parts" not in files.facts(path):
            continue  # a panel, whose parts are those of its board
        for row in files.facts(path)["parts"]:
            ref, letter = row["refs"].split(",")[0], row["refs"][0]
            own = _ON_BOARD.get(board, {})
            kind = own.get(ref) or own.get(letter) or _KINDS[letter]
            key = f"{kind} {row['value']}", row["manufacturer"], row["part"]
            found.setdefault(key, {})[board] = int(row["quantity"])
    for (item, maker, part), where in sorted(found.items()):
        each = purchase.part_each(part)
        boards = ", ".join(f"{count} on {name}" for name, count in where.items())
        yield Line("electronics", item, maker, part, boards, sum(where.values()), "piece", each)
    yield from _pieces(purchase, "electronics")
    boxes = {f.name: design.board.box for f in design.fingers}
    boxes |= {c.name: c.box for c in design.auxiliary_boards}
    for name, box in boxes.items():
        each = purchase.bare_board_each(box)
        size = f"{box.width_mm:g} x {box.length_mm:g} mm"
        yield Line("boards", f"{name} board", "", size, "bare", 1, "piece", each)
    placed = sum(sum(where.values()) for where in found.values())
    item, where_text = "placing and soldering", "parts on all boards"
    yield Line("boards", item, "", "", where_text, placed, "piece", purchase.placing_each)


PRINTED = ("backing", "interface", "mould", "holder", "flange", "fit")
"""Folders of printed parts, in the order of the bill; a printed mask is the last."""


def materials(design: Design, files: Files) -> Iterator[Line]:
    """Filament, silicone, film of the mask unless it is printed, and wire."""
    slicing, purchase = design.slicing, design.purchase
    printed = design.mask.route == "tpu"
    kinds = (*PRINTED, "mask") if printed else PRINTED
    for path in (path for kind in kinds for path in files.like(f"{kind}/*.stl")):
        filament = slicing.of(path)
        grams = round(files.facts(path)["volume_mm3"] / 1000 * filament.density_g_ml, 2)
        where, each = "solid, brim left out", purchase.filament_g(filament.name)
        yield Line("prints", path, "", filament.name, where, grams, "g", each)
    mixes = [files.facts(path) for path in files.like("mould/*_casting.md")]
    grams = round(sum(mix["part_a_g"] + mix["part_b_g"] for mix in mixes), 2)
    kg = purchase.silicone_kg
    where, each = "both fingers, with what stays in the cup", None if kg is None else kg / _GRAMS
    yield Line("casting", design.mould.silicone, "", "", where, grams, "g", each)
    if not printed:
        where = "a sheet for each finger"
        yield Line("mask", design.mask.film, "", "A4", where, 2, "sheet", purchase.film_sheet)
    metres: dict[float, float] = {}
    for cable in design.cabling.cables:
        length = cable.length_mm * len(cable.wires) / 1000
        metres[cable.section_mm2] = metres.get(cable.section_mm2, 0.0) + length
    where = "colours and lengths in wiring/cables.csv"
    for section, length in sorted(metres.items()):
        item = f"stranded wire, {section:g} mm²"
        yield Line("wiring", item, "", "", where, round(length, 2), "m", purchase.wire_m)


def _pieces(purchase: Purchase, group: str) -> Iterator[Line]:
    for piece in purchase.pieces:
        if piece.group == group:
            yield Line(
                group,
                piece.item,
                piece.manufacturer,
                piece.part,
                piece.where,
                piece.quantity,
                "piece",
                piece.each,
            )


COLUMNS = (
    "group",
    "item",
    "manufacturer",
    "part",
    "for",
    "quantity",
    "unit",
    "unit_price",
    "price",
)


def bill_of_materials(design: Design, files: Files) -> tuple[Artefact, ...]:
    """One line for each thing, and the sum of those whose price is known."""
    purchase = design.purchase
    lines = [
        *electronics(design, files),
        *materials(design, files),
        *_pieces(purchase, "fasteners"),
    ]
    priced = [line.price for line in lines if line.price is not None]
    note = f"{purchase.currency}, {purchase.dated}, {purchase.confidence}: {purchase.source}"
    note += "; what is used, not packs"
    if len(priced) < len(lines):
        note += f"; {len(lines) - len(priced)} without a price"
    facts = {
        "lines": [asdict(line) | {"price": line.price} for line in lines],
        "total": sum(priced),
        "prices": note,
    }
    return (Artefact("bom.csv", _table(lines, note, sum(priced)), frame="", facts=facts),)


def amount(quantity: float) -> str:
    """A quantity as the bill shows it."""
    return f"{quantity:g}"


def money(price: float | None) -> str:
    """A price as the bill shows it: empty where none is known."""
    return "" if price is None else f"{price:.2f}"


def _table(lines: list[Line], note: str, total: float) -> bytes:
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(COLUMNS)
    for line in lines:
        writer.writerow(
            (
                line.group,
                line.item,
                line.manufacturer,
                line.part,
                line.where,
                amount(line.quantity),
                line.unit,
                "" if line.each is None else f"{line.each:.4g}",
                money(line.price),
            )
        )
    writer.writerow(("total", "", "", "", note, "", "", "", money(total)))
    return file.getvalue().encode()
