"""`order.csv`: what must be bought for one pair of fingers, in whole packs."""

import csv
import io
import math
from collections.abc import Iterable
from dataclasses import asdict, dataclass

from lumitip_fab.design import Bought, Pack, Purchase
from lumitip_fab.pipeline.artefact import Artefact


@dataclass(frozen=True)
class Order:
    """A line of the list to order."""

    item: str
    manufacturer: str
    part: str
    needed: float
    unit: str
    pack: str
    confidence: str
    """Confidence in product and pack; empty where it is bought singly."""
    packs: int
    pack_price: float | None

    @property
    def price(self) -> float | None:
        """Price of all packs."""
        return None if self.pack_price is None else round(self.packs * self.pack_price, 2)


_OF_ITEM = ("boards", "fasteners", "wiring")
"""Groups of which each item has its own pack; of others, lines share one, such as a spool."""


def orders(purchase: Purchase, lines: Iterable[Bought]) -> tuple[Order, ...]:
    """Packs and pieces that are needed, alike ones together, in the order of the bill."""
    needed: dict[tuple[str, str], float] = {}
    first: dict[tuple[str, str], Bought] = {}
    for line in lines:
        shared = line.pack and line.group not in _OF_ITEM
        key = ("", line.pack) if shared else (line.item + line.part, line.pack)
        needed[key] = needed.get(key, 0.0) + line.quantity
        first.setdefault(key, line)
    return tuple(
        _order(first[key], quantity, purchase.pack(key[1])) for key, quantity in needed.items()
    )


def _order(line: Bought, needed: float, pack: Pack | None) -> Order:
    """Whole packs of what is needed; pieces where there is no pack."""
    needed = round(needed, 2)
    if pack is None:
        count = math.ceil(needed)
        maker, part, unit = line.manufacturer, line.part, line.unit
        return Order(line.item, maker, part, needed, unit, "", "", count, line.each)
    count = math.ceil(needed / pack.holds - 1e-9)
    price = pack.price
    if line.group == "boards" and line.each is not None:
        price = round(line.each * pack.holds, 2)
    item = pack.title if line.group == "prints" else line.item
    maker, part = line.manufacturer or pack.manufacturer, line.part
    if line.group == "prints":
        part = pack.product
    return Order(item, maker, part, needed, line.unit, pack.pack, pack.confidence, count, price)


COLUMNS = (
    "item",
    "manufacturer",
    "part",
    "needed",
    "unit",
    "pack",
    "confidence",
    "packs",
    "pack_price",
    "price",
)


def order_list(purchase: Purchase, lines: Iterable[Bought]) -> Artefact:
    """The list to order, with the sum of those whose price is known."""
    found = orders(purchase, lines)
    total = sum(order.price for order in found if order.price is not None)
    unpriced = sum(order.price is None for order in found)
    file = io.StringIO()
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(COLUMNS)
    for order in found:
        row = asdict(order) | {
            "needed": amount(order.needed),
            "pack_price": ""
            if order.pack_price is None
            else f"{order.pack_price:.5f}".rstrip("0").rstrip("."),
            "price": money(order.price),
        }
        writer.writerow([row[column] for column in COLUMNS])
    title = "to buy for one pair of fingers"
    title += f", {unpriced} without a price" if unpriced else ""
    writer.writerow((title, *[""] * (len(COLUMNS) - 2), money(total)))
    facts = {
        "lines": [asdict(order) | {"price": order.price} for order in found if order.pack],
        "single": sum(order.price or 0.0 for order in found if not order.pack),
        "total": total,
    }
    return Artefact("order.csv", file.getvalue().encode(), frame="", facts=facts)


def amount(quantity: float) -> str:
    """A quantity as the bill shows it."""
    return f"{quantity:g}"


def money(price: float | None) -> str:
    """A price as the bill shows it: empty where none is known."""
    return "" if price is None else f"{price:.2f}"
