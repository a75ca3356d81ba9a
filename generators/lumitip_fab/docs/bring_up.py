"""The manual's steps of bringing up: supply, firmware, program; then both boards face to face."""

import math
from collections.abc import Iterator

from lumitip_fab.design import Cabling, Design
from lumitip_fab.docs.wiring import ends_of_fingers, fed
from lumitip_fab.text import passage


def bring_up_steps(design: Design, picture: str = "") -> tuple[str, str]:
    """The firmware loaded, with the LEDs' current; and the first test.

    Args:
        design: for wires, supply and controller.
        picture: of the controller's board, in Markdown.
    """
    switched = design.wiring.emitter_pin is not None
    loaded = _text(
        "loaded",
        picture=f"{picture}\n\n" if picture else "",
        soldered=", a soldering iron, solder, a programmer for SWD" * _has_module(design),
        unplugged="Unplug USB. " * _joined(design),
        gauge=" and `gauge.json`" * bool(design.gauge_cards),
        loading=_loading(design) + "".join(_lights(design)),
        limit_ma=_limit_ma(design),
        tape=design.mould.tape,
        poles=_poles(design.cabling, f"{design.wiring.supply_v:g}V"),
        supply_v=design.wiring.supply_v,
        lit="They are dark until the firmware runs, and draw" if switched else "They draw",
        current_ma=sum(design.wiring.current_ma),
    )
    near = ends_of_fingers(design) & {board.name for board in design.auxiliary_boards}
    beside = f"the {min(near)} board lies" if near else "their other ends lie"
    return loaded, _text("tested", beside=beside)


def _poles(cabling: Cabling, net: str) -> str:
    """Where a bench supply goes: to the wires that lead away from the fingers and their boards."""
    wires = [wire for cable in cabling.cables for wire in cable.wires]
    away = [w for w in wires if w.start.board == "breakout" or w.end.board == "supply"]
    ends = {wire.signal: wire.number for wire in away}
    if not {net, "GND"} <= ends.keys():
        return _text("poles_board", net=f"{net}_IN")  # before fuse and reverse protection
    free = [number for signal, number in ends.items() if signal == "5V" and net != "5V"]
    spared = "".join(_text("poles_free", wire=wire) for wire in free)
    return _text("poles", plus=ends[net], minus=ends["GND"], free=spared)


def _limit_ma(design: Design) -> float:
    """Of a bench supply: twice what the LEDs draw, in tens."""
    return 20 * math.ceil(sum(design.wiring.current_ma) / 10)


def _loading(design: Design) -> str:
    """How the firmware comes onto the controller: a module has no bootloader yet."""
    name = "bootloader" if _has_module(design) else "upload"
    return _text(name, controller=design.controller.title)


def _has_module(design: Design) -> bool:
    return any(board.module for board in design.auxiliary_boards)


def _joined(design: Design) -> bool:
    """Whether the LEDs' supply feeds the controller with no diode before it."""
    lit = any(wire.signal == "5V" for wire in design.cabling.cables[0].wires)
    return lit and fed(design.cabling) and not (design.feed and design.feed.diode)


def _lights(design: Design) -> Iterator[str]:
    """The sign of the breakout's power LED, which the controller feeds."""
    for lit in (lit for lit in design.electrical.indicators if lit.board == "breakout"):
        yield _text("controller_light", lit=lit)


def _text(name: str, /, **values: object) -> str:
    """A passage of the manual with its values."""
    return passage("docs/chapters.md", name).format(**values)
