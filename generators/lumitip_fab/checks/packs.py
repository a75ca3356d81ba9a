"""`order.csv` against the bill: whole packs of everything that it lists, and the sum."""

import math
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from lumitip_fab.checks.readers.tables import table
from lumitip_fab.checks.result import Measurement, count, unreadable
from lumitip_fab.design import Design, Purchase

READS = ("bom.csv", "order.csv")
_FILE = "order.csv"
_CENT = 0.0051
_ROUNDED = 1e-5  # of an amount: six digits are written


@dataclass(frozen=True)
class Row:
    """A line of the list to order."""

    item: str
    product: str
    """Its manufacturer and order number."""
    needed: float
    unit: str
    pack: str
    confidence: str
    packs: int
    pack_price: float | None
    price: float | None


def measure(outputs: Path, design: Design) -> Iterator[Measurement]:
    """Read the list as whoever orders by it, and count again."""
    try:
        *rows, last = table((outputs / _FILE).read_text(encoding="utf-8"))
        *bill, _ = table((outputs / "bom.csv").read_text(encoding="utf-8"))
        orders = [_row(row) for row in rows]
        used, needed = sum(float(r["quantity"]) for r in bill), sum(r.needed for r in orders)
        total = float(last["price"])
    except (OSError, ValueError, KeyError) as error:
        yield unreadable("packs.readable", _FILE, f"cannot be read: {error!r:.120}")
        return
    note = "of all quantities of the bill"
    yield Measurement("packs.needed", _FILE, needed, used - 0.1, used + 0.1, "units", note)
    amounts = list(_astray(orders, bill, design.purchase))
    yield count("packs.amounts", _FILE, amounts, "lines of other amounts than the bill's")
    yield count(
        "packs.lines",
        _FILE,
        list(_strange(orders, bill, design.purchase)),
        "lines that differ from the bill",
    )
    wrong = [order.item for order in orders if not _enough(order, design.purchase)]
    yield count("packs.enough", _FILE, wrong, "wrong numbers or prices of packs")
    units = {row["item"]: row["unit"] for row in bill}
    other = [order.item for order in orders if not _as_sold(order, units, design.purchase)]
    yield count("packs.units", _FILE, other, "other units or confidence")
    prices = sum(order.price or 0.0 for order in orders)
    currency = design.purchase.currency
    off = abs(prices - total)
    yield Measurement("packs.total", _FILE, off, 0, _CENT, currency, f"of {prices:.2f}")


def _strange(orders: list[Row], bill: list[dict[str, str]], purchase: Purchase) -> Iterator[str]:
    """Lines whose item or product is none of the bill's or of its packs, and lines of the bill of
    which neither is listed."""
    items = {row["item"] for row in bill} | {pack.title for pack in purchase.packs}
    products = {f"{row['manufacturer']} {row['part']}" for row in bill}
    products |= {f"{pack.manufacturer} {pack.product}" for pack in purchase.packs}
    yield from (o.item for o in orders if o.item not in items or o.product not in products)
    names = {name for order in orders for name in (order.item, order.product)}
    titles = {pack.name: pack.title for pack in purchase.packs}
    shared = {pack.name: f"{pack.manufacturer} {pack.product}" for pack in purchase.packs}
    for row in bill:
        product = f"{row['manufacturer']} {row['part']}"
        others = {shared.get(row["part"], ""), titles.get(row["part"], "")}
        if names.isdisjoint({row["item"], product, *others} - {" "}):
            yield row["item"]


def _astray(orders: list[Row], bill: list[dict[str, str]], purchase: Purchase) -> Iterator[str]:
    """Lines that need another amount of a product than the lines of the bill that it is for."""
    wanted: defaultdict[tuple[str, str], float] = defaultdict(float)
    for line in bill:
        wanted[_ordered(line, purchase)] += float(line["quantity"])
    found: defaultdict[tuple[str, str], float] = defaultdict(float)
    for order in orders:
        found[order.item, order.product] += order.needed
    for item, product in sorted({*wanted, *found}):
        needed, used = found[item, product], wanted[item, product]
        if not abs(needed - used) <= max(_ROUNDED * used, _CENT):
            yield f"{item} of {product.strip() or 'any maker'}: {needed:g}, not {used:g}"


def _ordered(line: dict[str, str], purchase: Purchase) -> tuple[str, str]:
    """Item and product by which a line of the bill is ordered: filament by its spool, everything
    else as the bill has it."""
    spool = purchase.pack(line["part"]) if line["group"] == "prints" else None
    if spool:
        return spool.title, f"{spool.manufacturer} {spool.product}"
    return line["item"], f"{line['manufacturer']} {line['part']}"


def _row(row: dict[str, str]) -> Row:
    return Row(
        row["item"],
        f"{row['manufacturer']} {row['part']}",
        float(row["needed"]),
        row["unit"],
        row["pack"],
        row["confidence"],
        int(row["packs"]),
        float(row["pack_price"]) if row["pack_price"] else None,
        float(row["price"]) if row["price"] else None,
    )


def _as_sold(order: Row, units: dict[str, str], purchase: Purchase) -> bool:
    """Whether a line has the unit and the confidence of its pack, or the unit of the bill."""
    if not order.pack:
        return (order.unit, order.confidence) == (units.get(order.item), "")
    packs = {(pack.pack, pack.unit, pack.confidence) for pack in purchase.packs}
    return (order.pack, order.unit, order.confidence) in packs


def _enough(order: Row, purchase: Purchase) -> bool:
    """Whether so many packs hold what is needed, one less does not, and the price is theirs."""
    sizes = {pack.pack: pack.holds for pack in purchase.packs} | {"": 1.0}
    holds = sizes.get(order.pack, math.nan)
    fits = (order.packs - 1) * holds < order.needed <= order.packs * holds
    if order.pack_price is None or order.price is None:
        return fits and order.price is order.pack_price
    return fits and abs(order.packs * order.pack_price - order.price) <= _CENT
