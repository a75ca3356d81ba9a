"""`bom.csv`: everything that is bought, printed and cast, with prices and their sum."""

import csv
import io

from lumitip_fab.artefact import Artefact
from lumitip_fab.design import Board, Cabling, Carrier, Mask, Mould, Purchase
from lumitip_fab.design.slicing import Slicing
from lumitip_fab.made import Made
from lumitip_fab.parts_list.count import Line, electronics, fasteners, made_things

COLUMNS = (
    "group", "item", "manufacturer", "part", "for", "quantity", "unit", "unit_price", "price",
)  # fmt: skip


def bill_of_materials(
    made: Made, board: Board, carriers: tuple[Carrier, ...], cabling: Cabling, slicing: Slicing,
    mould: Mould, mask: Mask, purchase: Purchase,
) -> tuple[Artefact, ...]:  # fmt: skip
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
        writer.writerow((
            line.group, line.item, line.manufacturer, line.part, line.where,
            f"{line.quantity:g}", line.unit, "" if line.each is None else f"{line.each:.4g}",
            "" if line.price is None else f"{line.price:.2f}",
        ))  # fmt: skip
    known = [line.price for line in lines if line.price is not None]
    note = f"{purchase.currency}, {purchase.dated}, {purchase.confidence}: {purchase.source}"
    note += "; what is used, not packs"
    if len(known) < len(lines):
        note += f"; {len(lines) - len(known)} without a price"
    writer.writerow(("total", "", "", "", note, "", "", "", f"{sum(known):.2f}"))
    return file.getvalue()
