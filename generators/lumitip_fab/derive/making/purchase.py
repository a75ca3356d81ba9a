"""Parts to buy, with the prices of the catalogue; a missing price stays open."""

from collections.abc import Mapping

from lumitip_fab.catalogue.ordering import Prices
from lumitip_fab.config.load import Input
from lumitip_fab.derive.finger.stack import is_flex, stiff_mm
from lumitip_fab.derive.mount.fasteners import screw_length_mm
from lumitip_fab.design import Flange, Holder, Mount
from lumitip_fab.design.making import Slicing
from lumitip_fab.design.ordering import Bought, PartPrice, Purchase


def derive_purchase(
    config: Input,
    mount: Mount,
    holders: tuple[Holder, ...],
    flanges: tuple[Flange, ...],
    slicing: Slicing,
) -> Purchase:
    """Screws and controller, and the prices of everything else."""
    p, prices = config.parameters, config.catalogue.prices
    pieces = [
        *_controller(config, prices),
        *_bolts(mount, prices),
        _glue(config, prices),
        *(each for holder in holders for each in _screws(holder, prices)),
        *(each for flange in flanges for each in _of_flange(config, flange, prices)),
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
        filament_kg=tuple(
            (name, prices.kg[name])
            for name in dict.fromkeys(f.name for f in slicing.filaments)
            if name in prices.kg
        ),
        silicone_kg=prices.kg.get(p.mould.silicone),
        film_sheet=prices.sheet.get(p.mask.film),
        wire_m=prices.wire_m,
    )


def _controller(config: Input, prices: Prices) -> list[Bought]:
    """A controller board; a module is a part of the flange's board."""
    name = config.parameters.controller.board
    if config.catalogue.controllers[name].module:
        return []
    title = config.title("controller.board")
    return [Bought("electronics", title, "", title, "reads the receiver", 1, prices.each.get(name))]


def _bolts(mount: Mount, prices: Prices) -> list[Bought]:
    item = f"{mount.bolt} x {mount.bolt_length_mm:g} socket head screw"
    into = mount.bolt_length_mm - mount.land_mm
    where = f"fingers to gripper, {into:.1f} mm into its thread: measure how deep that is"
    count = 2 * len(mount.bolt_u_mm)
    each = prices.each.get(f"{mount.bolt} socket head screw")
    return [Bought("fasteners", item, "", "ISO 4762", where, count, each)]


def _glue(config: Input, prices: Prices) -> Bought:
    """A pack of the glue that holds boards or interfaces: some drops are used."""
    name = config.parameters.backing.glue
    where = (
        "boards in their backings" if not is_flex(config.parameters) else "interfaces on backings"
    )
    return Bought(
        "fasteners", config.title("backing.glue"), "", "", where, 1, prices.each.get(name)
    )


def _screws(holder: Holder, prices: Prices) -> list[Bought]:
    """Screws through the breakout board into nuts under its holder."""
    thread, count = holder.screw, len(holder.holes)
    screw = f"{thread} x {holder.screw_length_mm:g} screw"
    where = "breakout on its holder"
    return [
        Bought(
            "fasteners", screw, "", "ISO 4762", where, count, prices.each.get(f"{thread} screw")
        ),
        Bought(
            "fasteners",
            f"{thread} nut",
            "",
            "ISO 4032",
            where,
            count,
            prices.each.get(f"{thread} nut"),
        ),
    ]


def _of_flange(config: Input, flange: Flange, prices: Prices) -> list[Bought]:
    """Screws of its board, its locating pin, and the gripper's bolts, which must be longer."""
    count = len(flange.screws)
    through = flange.board_z_mm - flange.seat_z_mm + stiff_mm(config.parameters)
    length = screw_length_mm(through, config.catalogue.fasteners[flange.screw])
    screw = f"{flange.screw} x {length:g} countersunk screw"
    pin = f"{flange.pin_mm:g} x {flange.pin_length_mm:g} parallel pin"
    bolt = f"{flange.bolt} socket head screw"
    where = "board of the flange"
    rows = (
        (screw, "ISO 7046", where, count, f"{flange.screw} screw"),
        (f"{flange.screw} nut", "ISO 4032", where, count, f"{flange.screw} nut"),
        (pin, "ISO 2338", "flange to coupling, glued in", 1, "parallel pin"),
        (
            bolt,
            "ISO 4762",
            f"gripper to robot, {flange.top_z_mm:.1f} mm longer than its own",
            len(flange.bolts),
            bolt,
        ),
    )
    return [
        Bought("fasteners", item, "", part, at, n, prices.each.get(price))
        for item, part, at, n, price in rows
    ]


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
