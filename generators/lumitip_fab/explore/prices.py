"""What a design's boards cost, by `parts/prices.toml`."""

from lumitip_fab.design import Design
from lumitip_fab.errors import Problem
from lumitip_fab.load import Input
from lumitip_fab.locate import design_folder, parts_file
from lumitip_fab.price_entry import Prices
from lumitip_fab.wording import shown_path


def unpriced(given: Input, prices: Prices, names: set[str]) -> list[Problem]:
    """A fault for each part that has no price."""
    path = parts_file(design_folder(given.sources[0].path), "prices")
    return [
        Problem(shown_path(path), 0, "each", f"has no price of {name!r}: add a line for it")
        for name in sorted(names - set(prices.each))
    ]


def bill(given: Input, design: Design) -> dict[str, int]:
    """How many of each part the two boards and the controller need."""
    p, wiring = given.parameters, design.wiring
    counts = (
        (p.emitter.led, len(design.layout)),
        (p.emitter.resistor, len(wiring.strings)),
        (p.receiver.photodetector, len(design.layout)),
        (p.receiver.multiplexer, wiring.muxes),
        (p.receiver.resistor, wiring.muxes),
        (p.receiver.capacitor, wiring.muxes),
        (p.controller.board, 1),
    )
    needed: dict[str, int] = {}
    for name, count in counts:
        needed[name] = needed.get(name, 0) + count
    return needed


def cost(given: Input, design: Design, prices: Prices) -> float:
    """Parts of both boards, the boards, placing, and the controller.

    Prints, silicone, film and work are not counted.
    """
    needed = bill(given, design)
    placed = sum(needed.values()) - 1  # the controller lies beside the robot
    board_cm2 = design.board.box.width_mm * design.board.box.length_mm / 100.0
    return (
        sum(count * prices.each[name] for name, count in needed.items())
        + 2 * (prices.board.each + board_cm2 * prices.board.per_cm2)
        + placed * prices.placing.each
    )
