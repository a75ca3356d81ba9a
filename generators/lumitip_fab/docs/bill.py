"""`bom.csv`: everything that is bought, printed and cast, counted in the built files, with
prices."""

import csv
import io
import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lumitip_fab.design import Board, Cabling, Carrier, Mask, Mould, Purchase
from lumitip_fab.design.making import Slicing
from lumitip_fab.pipeline.artefact import Artefact, Made

_HEADER = 84  # of a binary STL: 80 bytes of text, and how many triangles follow
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_PART_G = re.compile(r"^\| .*, part [AB] \| \*\*([\d.]+) g\*\* \|$", re.MULTILINE)
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
}
"""What a part is, by the first letter of its references."""


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
        """Of all of it."""
        return None if self.each is None else round(self.quantity * self.each, 2)


def electronics(
    made: Made, board: Board, carriers: tuple[Carrier, ...], purchase: Purchase
) -> Iterator[Line]:
    """Parts of all boards, alike ones together, the controller, bare boards, and placing."""
    found: dict[tuple[str, str, str], dict[str, int]] = {}
    for path in made.like("boards/*/order/generic_*_bom.csv"):
        for row in csv.DictReader(io.StringIO(made.text(path))):
            host, letter = path.split("/")[1], row["References"][0]
            kind = "photodetector" if (host, letter) == ("receiver", "Q") else _KINDS[letter]
            key = f"{kind} {row['Value']}", row["Manufacturer"], row["Part number"]
            found.setdefault(key, {})[host] = int(row["Quantity"])
    for (item, maker, part), where in sorted(found.items()):
        each = next((price.each for price in purchase.parts if price.of(part)), None)
        told = ", ".join(f"{count} on {name}" for name, count in where.items())
        yield Line("electronics", item, maker, part, told, sum(where.values()), "piece", each)
    yield from _pieces(purchase, "electronics")
    boxes = {"emitter": board.box, "receiver": board.box, **{c.name: c.box for c in carriers}}
    for name, box in boxes.items():
        cm2 = box.width_mm * box.length_mm / 100
        each = round(purchase.board_each + cm2 * purchase.board_per_cm2, 2)
        size = f"{box.width_mm:g} x {box.length_mm:g} mm"
        yield Line("boards", f"{name} board", "", size, "bare", 1, "piece", each)
    placed = sum(sum(where.values()) for where in found.values())
    yield Line(
        "boards",
        "placing and soldering",
        "",
        "",
        "parts on all boards",
        placed,
        "piece",
        purchase.placing_each,
    )


def made_things(
    made: Made, cabling: Cabling, slicing: Slicing, mould: Mould, mask: Mask, purchase: Purchase
) -> Iterator[Line]:
    """Filament, silicone, film and wire."""
    kinds = ("backing", "interface", "mould", "holder", "flange", "fit")
    for pattern in (f"{kind}/*.stl" for kind in kinds):
        for path in made.like(pattern):
            filament = slicing.of(path)
            kg = purchase.filament_kg[filament != slicing.backing]
            grams = round(volume_ml(made.read(path)) * filament.density_g_ml, 2)
            yield Line(
                "prints",
                path,
                "",
                filament.name,
                "solid, brim left out",
                grams,
                "g",
                None if kg is None else kg / _GRAMS,
            )
    notes = [made.text(path) for path in made.like("mould/*_casting.md")]
    grams = sum(float(part) for note in notes for part in _PART_G.findall(note))
    kg = purchase.silicone_kg
    yield Line(
        "casting",
        mould.silicone,
        "",
        "",
        "both fingers, with what stays in the cup",
        round(grams, 2),
        "g",
        None if kg is None else kg / _GRAMS,
    )
    yield Line(
        "mask", mask.film, "", "A4", "a sheet for each finger", 2, "sheet", purchase.film_sheet
    )
    metres: dict[float, float] = {}
    for cable in cabling.cables:
        length = cable.length_mm * len(cable.wires) / 1000
        metres[cable.section_mm2] = metres.get(cable.section_mm2, 0.0) + length
    for section, length in sorted(metres.items()):
        yield Line(
            "wiring",
            f"stranded wire, {section:g} mm²",
            "",
            "",
            "colours and lengths in wiring/cables.csv",
            round(length, 2),
            "m",
            purchase.wire_m,
        )


def fasteners(purchase: Purchase) -> Iterator[Line]:
    """Screws and nuts."""
    yield from _pieces(purchase, "fasteners")


def volume_ml(stl: bytes) -> float:
    """Volume within a closed surface: the sum over its triangles' tetrahedra to the origin."""
    corners = np.frombuffer(stl, _TRIANGLE, offset=_HEADER)["corners"].astype(np.float64)
    a, b, c = corners.transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6000)


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


def bill_of_materials(
    made: Made,
    board: Board,
    carriers: tuple[Carrier, ...],
    cabling: Cabling,
    slicing: Slicing,
    mould: Mould,
    mask: Mask,
    purchase: Purchase,
) -> tuple[Artefact, ...]:
    """One line for each thing, and the sum of those whose price is known.

    Args:
        made: boards' own lists, printed parts, casting notes and cables.
        board: size of the fingers' boards.
        carriers: size of the other boards.
        cabling: sections of the wires.
        slicing: what is printed from what.
        mould: the silicone.
        mask: the film.
        purchase: what else is bought, and prices.
    """
    lines = [
        *electronics(made, board, carriers, purchase),
        *made_things(made, cabling, slicing, mould, mask, purchase),
        *fasteners(purchase),
    ]
    return (Artefact("bom.csv", _table(lines, purchase).encode(), frame=""),)


def _table(lines: list[Line], purchase: Purchase) -> str:
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
                f"{line.quantity:g}",
                line.unit,
                "" if line.each is None else f"{line.each:.4g}",
                "" if line.price is None else f"{line.price:.2f}",
            )
        )
    known = [line.price for line in lines if line.price is not None]
    note = f"{purchase.currency}, {purchase.dated}, {purchase.confidence}: {purchase.source}"
    note += "; what is used, not packs"
    if len(known) < len(lines):
        note += f"; {len(lines) - len(known)} without a price"
    writer.writerow(("total", "", "", "", note, "", "", "", f"{sum(known):.2f}"))
    return file.getvalue()
