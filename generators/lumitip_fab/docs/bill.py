"""`bom.csv`: everything that is bought, printed and cast, from the facts of the built files, with
prices; and `order.csv`, what must be bought for it."""

import csv
import io
from collections.abc import Iterator, Mapping
from dataclasses import asdict

from lumitip_fab.design import Bought, Design, Purchase
from lumitip_fab.design.cabling import awg
from lumitip_fab.design.least_size import too_small
from lumitip_fab.design.making import Filament
from lumitip_fab.design.mould import printed_times
from lumitip_fab.design.print_time import print_seconds
from lumitip_fab.docs.orders import amount, money, order_list
from lumitip_fab.pipeline.artefact import Artefact, Files

_KINDS = {
    "C": "capacitor",
    "D": "LED",
    "F": "fuse",
    "J": "connector",
    "L": "inductor",
    "LED": "LED",
    "Q": "transistor",
    "R": "resistor",
    "RN": "resistor array",
    "U": "circuit",
    "VD": "Schottky diode",
    "Y": "crystal",
    "Z": "ESD diode",
}
"""Kind of a part by the letters of its references."""
_ON_BOARD = {
    "receiver": {"Q": "photodetector"},
    "emitter": {"U": "current source"},
    "flange": {"D1": "TVS diode"},
    "breakout": {"D1": "TVS diode"},
}
"""The same where a board has another kind of this letter, or of this part alone."""


def electronics(design: Design, files: Files) -> Iterator[Bought]:
    """Parts of all boards, alike ones together, the controller, bare boards, and placing."""
    purchase = design.purchase
    found: dict[tuple[str, str, str], dict[str, int]] = {}
    placed = 0
    for path in files.like("boards/*/*.kicad_pcb"):
        board = path.split("/")[1]
        if "parts" not in files.facts(path):
            continue  # a panel, whose parts are those of its board
        facts = files.facts(path)
        placed += sum(int(row["quantity"]) for row in facts["parts"])
        for row in (*facts["parts"], *facts["by_hand"]):
            ref = row["refs"].split(",")[0]
            letters, own = ref.rstrip("0123456789"), _ON_BOARD.get(board, {})
            kind = own.get(ref) or own.get(letters) or _KINDS[letters]
            key = f"{kind} {row['value']}", row["manufacturer"], row["part"]
            place = f"{board}, soldered on by hand" if row in facts["by_hand"] else board
            found.setdefault(key, {})[place] = int(row["quantity"])
    for (item, maker, part), where in sorted(found.items()):
        each = purchase.part_each(part)
        boards = ", ".join(f"{count} on {name}" for name, count in where.items())
        yield Bought("electronics", item, maker, part, boards, sum(where.values()), each)
    yield from _pieces(purchase, "electronics")
    boxes = {f.name: design.board.box for f in design.fingers}
    boxes |= {c.name: c.box for c in design.auxiliary_boards}
    for name, box in boxes.items():
        each = purchase.bare_board_each(box)
        size = f"{box.width_mm:g} x {box.length_mm:g} mm"
        yield Bought("boards", f"{name} board", "", size, "bare", 1, each, pack="bare board")
    where_text = "parts that a PCB fab mounts"
    if any(too_small(design)):
        where_text += "; boards too small for it on panels alone: board.panel"
    item = "placing and soldering"
    yield Bought("boards", item, "", "", where_text, placed, purchase.placing_each)


PRINTED = ("backing", "interface", "mould", "holder", "flange", "fit", "gauge")
"""Folders of printed parts, in the order of the bill; a printed mask is the last."""


def materials(design: Design, files: Files) -> Iterator[Bought]:
    """Filament, silicone, film of the mask unless it is printed, and wire."""
    slicing, purchase = design.slicing, design.purchase
    printed = design.mask.route == "tpu"
    kinds = (*PRINTED, "mask") if printed else PRINTED
    for path in (path for kind in kinds for path in files.like(f"{kind}/*.stl")):
        filament = slicing.of(path)
        facts, name = files.facts(path), filament.name
        number = printed_times(design.mould_accessories, path)
        grams = round(number * facts["volume_mm3"] / 1000 * filament.density_g_ml, 2)
        where = f"some {_minutes(facts, filament, design)} min, solid, brim left out"
        where = f"{number} times, each {where}" if number > 1 else where
        yield Bought("prints", path, "", name, where, grams, purchase.unit_price(name), "g", name)
    mixes = [files.facts(path) for path in files.like("mould/*_casting.md")]
    grams = sum(mix["part_a_g"] + mix["part_b_g"] for mix in mixes) + sum(design.mould.trial_g)
    grams, title = round(grams, 2), design.mould.silicone
    where = "both fingers, with what stays in the cup, and the trial"
    yield _packed(purchase, "casting", purchase.silicone, title, where, grams, "g")
    if not printed:
        where = "a sheet of A4 for each finger"
        yield _packed(purchase, "mask", purchase.film, design.mask.film, where, 2, "sheet")
    metres: dict[float, float] = {}
    colours: dict[float, set[str]] = {}
    for cable in design.cabling.cables:
        length = cable.length_mm * len(cable.wires) / 1000
        metres[cable.section_mm2] = metres.get(cable.section_mm2, 0.0) + length
        colours.setdefault(cable.section_mm2, set()).update(wire.colour for wire in cable.wires)
    for section, length in sorted(metres.items()):
        where = f"{len(colours[section])} colours: wiring/cables.csv has their lengths"
        item = f"stranded wire, {section:g} mm² (AWG {awg(section)})"
        used = round(length, 2)
        yield _packed(purchase, "wiring", "stranded wire", item, where, used, "m")


TESTED = 2
"""Loose parts of each kind whose marked terminal is to be tested before the boards are ordered."""


def loose_parts(design: Design) -> Iterator[Bought]:
    """LEDs and photodetectors for the test of their marked terminals: a PCB fab that places those
    of the boards sends none."""
    where = "test of the marked terminals, before the boards"
    for kind, part in design.packages.unmarked.items():
        item, number = f"{kind} {part.order_number}, loose", part.order_number
        each = design.purchase.part_each(number)
        yield Bought("supplies", item, part.manufacturer, number, where, TESTED, each)


def _minutes(facts: Mapping[str, float], filament: Filament, design: Design) -> int:
    """Time to print a part, to whole minutes."""
    brim = filament != design.slicing.sheet
    return round(print_seconds(facts, filament, design.printing, brim) / 60)


def _packed(
    purchase: Purchase, group: str, name: str, item: str, where: str, quantity: float, unit: str
) -> Bought:
    """Something out of a pack; with its name alone where no pack is known."""
    pack = purchase.pack(name)
    if pack is None:
        return Bought(group, item, "", "", where, quantity, None, unit)
    maker, product = pack.manufacturer, pack.product
    return Bought(group, item, maker, product, where, quantity, pack.each, unit, name)


def _pieces(purchase: Purchase, group: str) -> Iterator[Bought]:
    return (piece for piece in purchase.pieces if piece.group == group)


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
        *loose_parts(design),
        *_pieces(purchase, "supplies"),
        *_pieces(purchase, "fasteners"),
    ]
    priced = [line.price for line in lines if line.price is not None]
    note = f"{purchase.currency}, {purchase.dated}, {purchase.confidence}: {purchase.source}"
    note += "; what one pair of fingers uses: packs are in order.csv"
    if len(priced) < len(lines):
        note += f"; {len(lines) - len(priced)} without a price"
    facts = {
        "lines": [asdict(line) | {"price": line.price} for line in lines],
        "total": sum(priced),
        "prices": note,
    }
    bill = Artefact("bom.csv", _table(lines, note, sum(priced)), frame="", facts=facts)
    return bill, order_list(purchase, lines)


def _table(lines: list[Bought], note: str, total: float) -> bytes:
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
    writer.writerow(
        ("total", "used by one pair of fingers", "", "", note, "", "", "", money(total))
    )
    return file.getvalue().encode()
