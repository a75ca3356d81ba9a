"""Parts to buy and their packs, with the prices of the catalogue; a missing price stays open."""

from collections.abc import Mapping

from lumitip_fab.catalogue.ordering import Prices
from lumitip_fab.config.load import Input
from lumitip_fab.derive.finger.stack import stiff_mm
from lumitip_fab.derive.making.supplies import Used
from lumitip_fab.derive.mount.fasteners import screw_length_mm
from lumitip_fab.design import Clamp, Flange, Holder, Mount
from lumitip_fab.design.mould import MOULDS
from lumitip_fab.design.ordering import Bought, Pack, PartPrice, Purchase


def derive_purchase(
    config: Input,
    mount: Mount,
    clamps: tuple[Clamp, ...],
    holders: tuple[Holder, ...],
    flanges: tuple[Flange, ...],
    used: tuple[Used, ...],
) -> Purchase:
    """Screws, controller and supplies, and the prices of everything else."""
    p, prices = config.parameters, config.catalogue.prices
    packs = _packs(config)
    pieces = [
        *_controller(config, prices),
        *(_supply(each, packs.get(each.pack)) for each in used),
        *_bolts(mount, packs),
        *(each for clamp in clamps for each in _of_clamps(clamp, packs)),
        *(each for holder in holders for each in _screws(holder, packs)),
        *(each for flange in flanges for each in _of_flange(config, flange, packs)),
    ]
    return Purchase(
        currency=prices.currency,
        dated=prices.dated,
        source=prices.source,
        confidence=prices.confidence,
        pieces=tuple(pieces),
        parts=_parts(config, prices),
        board_each=prices.board.each,
        board_per_cm2=prices.board.per_cm2,
        placing_each=prices.placing.each,
        silicone=p.mould.silicone,
        film=p.mask.film,
        packs=tuple(packs.values()),
    )


def _packs(config: Input) -> dict[str, Pack]:
    """Every pack of the catalogue, by name."""
    known, prices = config.catalogue.packs, config.catalogue.prices
    return {
        name: Pack(
            name,
            entry.title or name,
            entry.manufacturer,
            entry.product,
            entry.pack,
            entry.holds,
            entry.unit,
            prices.pack.get(name),
            entry.confidence,
            entry.colours,
        )
        for name, entry in known.items()
    }


def _supply(used: Used, pack: Pack | None) -> Bought:
    """What a design uses out of a pack; without a pack, its name alone."""
    if pack is None:
        return Bought("supplies", used.pack, "", "", used.where, used.quantity, None, used.unit)
    return Bought(
        "supplies",
        pack.title,
        pack.manufacturer,
        pack.product,
        used.where,
        used.quantity,
        pack.each,
        pack.unit,
        pack.name,
    )


def _fastener(
    item: str, standard: str, where: str, count: int, name: str, packs: Mapping[str, Pack]
) -> Bought:
    """A fastener, in its pack where one is known."""
    pack = packs.get(name)
    each = pack.each if pack else None
    return Bought(
        "fasteners", item, "", standard, where, count, each, pack=pack.name if pack else ""
    )


def _controller(config: Input, prices: Prices) -> list[Bought]:
    """A controller board; a module is a part of the flange's board."""
    name = config.parameters.controller.board
    if config.catalogue.controllers[name].module:
        return []
    title = config.title("controller.board")
    return [
        Bought(
            "electronics",
            title,
            "",
            title,
            "reads the receiver; with its pin headers",
            1,
            prices.each.get(name),
        )
    ]


def _bolts(mount: Mount, packs: Mapping[str, Pack]) -> list[Bought]:
    item = f"{mount.bolt} x {mount.bolt_length_mm:g} socket head screw"
    into = mount.bolt_length_mm - mount.land_mm
    where = f"finger bolts, {into:.1f} mm into its thread: measure how deep that is"
    count, name = 2 * len(mount.bolt_u_mm), f"{mount.bolt} socket head screw"
    return [_fastener(item, "ISO 4762", where, count, name, packs)]


def _of_clamps(clamp: Clamp, packs: Mapping[str, Pack]) -> list[Bought]:
    """Screws of both clamps, each with a nut on the rail and one on the clamp."""
    thread, count = clamp.screw.name, MOULDS * len(clamp.screws)
    screw, where = (
        f"{thread} x {clamp.screw_length_mm:g} countersunk screw",
        "clamps of both moulds",
    )
    return [
        _fastener(screw, "ISO 7046", where, count, f"{thread} screw", packs),
        _fastener(f"{thread} nut", "ISO 4032", where, 2 * count, f"{thread} nut", packs),
    ]


def _screws(holder: Holder, packs: Mapping[str, Pack]) -> list[Bought]:
    """Screws through the breakout board into nuts under its holder."""
    thread, count = holder.screw, len(holder.holes)
    screw = f"{thread} x {holder.screw_length_mm:g} screw"
    where = "breakout on its holder"
    return [
        _fastener(screw, "ISO 4762", where, count, f"{thread} screw", packs),
        _fastener(f"{thread} nut", "ISO 4032", where, count, f"{thread} nut", packs),
    ]


def _of_flange(config: Input, flange: Flange, packs: Mapping[str, Pack]) -> list[Bought]:
    """Screws of its board, its locating pin, and its bolts, longer than the gripper's own."""
    count = len(flange.screws)
    through = flange.board_z_mm - flange.seat_z_mm + stiff_mm(config.parameters)
    length = screw_length_mm(through, config.catalogue.fasteners[flange.screw])
    screw = f"{flange.screw} x {length:g} countersunk screw"
    pin = f"{flange.pin_mm:g} x {flange.pin_length_mm:g} parallel pin"
    bolt, nut = f"{flange.bolt} socket head screw", f"{flange.screw} nut"
    ordered = f"{bolt}, length by step Look at the coupling"
    longer = f"flange bolts, {flange.top_z_mm:.1f} mm longer than the gripper's own"
    where = "board of the flange"
    rows = (
        (screw, "ISO 7046", where, count, f"{flange.screw} screw"),
        (nut, "ISO 4032", where, count, nut),
        (pin, "ISO 2338", "flange to coupling, glued in", 1, "parallel pin"),
        (ordered, "ISO 4762", longer, len(flange.bolts), bolt),
    )
    return [_fastener(*row, packs) for row in rows]


def _parts(config: Input, prices: Prices) -> tuple[PartPrice, ...]:
    """Everything in the catalogue that has an order number and a price."""
    price_of: dict[str, float] = {}
    for kind in type(config.catalogue).model_fields:
        entries = getattr(config.catalogue, kind)
        for name, entry in entries.items() if isinstance(entries, Mapping) else ():
            order = getattr(getattr(entry, "module", None) or entry, "order_number", None)
            if order is not None and name in prices.each:
                price_of[order] = prices.each[name]
    return tuple(PartPrice(part, price) for part, price in sorted(price_of.items()))
