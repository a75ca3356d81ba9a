"""The transistor between the strings of LEDs and ground, which the controller turns off to measure
ambient light.

strings ── LEDK ── D
                   Q1 G ──┬── LED, from the controller
                   S      R
                   │      │
                  GND    GND
"""

from collections.abc import Iterator

from lumitip_fab.catalogue.controllers import Transistor
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.wiring.sources import SUPPLY_RANGE
from lumitip_fab.derive.wiring.strings import Strings
from lumitip_fab.design import Box, Connector, Part

MOST_DROP = 0.01
"""Of the supply that the transistor may take from the strings."""
STEP_MM = 0.25
APART_MM = 0.6


def refuse_switch(config: Input, strings: Strings, placed: bool, faults: Diagnostics) -> None:
    """Refuse a transistor that this supply, controller or receiver does not go with, or that has no
    room.

    Args:
        config: the input.
        strings: strings of LEDs.
        placed: whether `switch_parts` found room.
        faults: where to refuse.
    """
    for message in _problems(config, strings):
        faults.refuse("emitter.switch", f"is {config.parameters.emitter.switch!r}{message}")
    faults.unless(placed or config.parts.emitter.switch is None, "switch_no_room")


def _problems(config: Input, strings: Strings) -> Iterator[str]:
    part, p = config.parts.emitter.switch, config.parameters
    if part is None:
        return
    if part.channel != "N":
        yield ", a P-channel MOSFET; an N-channel one is needed between LEDs and ground"
        return
    controller, name = config.parts.controller.board, p.controller.board
    if controller.emitter_pin is None:
        yield f'; {name!r} has no emitter_pin in parts/controllers.toml. Add one or use "none".'
    if p.receiver.load == "shared":
        yield (
            '; with receiver.load = "shared" readings in the dark do not settle, so that ambient '
            'light cannot be measured. Use receiver.load = "each", or "none" here.'
        )
    yield from _ratings(part, config, strings)


def _ratings(part: Transistor, config: Input, strings: Strings) -> Iterator[str]:
    supply_v = config.parameters.supply.voltage_v
    gate_v = config.parts.controller.board.supply_v
    if not part.gate_on_v <= gate_v <= part.gate_v:
        yield (
            f", whose gate takes {part.gate_on_v:g} to {part.gate_v:g} V; "
            f"{config.parameters.controller.board!r} gives {gate_v:g} V"
        )
    high_v = (1 + SUPPLY_RANGE) * supply_v
    if part.rated_v < high_v:
        yield f", rated for {part.rated_v:g} V; a supply of {supply_v:g} V needs {high_v:g} V"
    amps = sum(string.high_ma for string in strings.strings) / 1000
    if part.on_ohm is None or part.drain_a is None:
        return  # the catalogue refuses it of an N-channel one
    most_a = min(part.drain_a, MOST_DROP * supply_v / part.on_ohm)
    if amps > most_a:
        yield f"; it carries up to {most_a:.2f} A here, all strings together draw {amps:.2f} A"


def switch_parts(
    config: Input, zone: Box, wires: Connector, taken: tuple[Part, ...]
) -> tuple[Part, ...]:
    """The transistor with its pull-down to the left, on the front between the other parts and the
    wire pads: the nearest place to the pad that switches it.

    Args:
        config: the input.
        zone: where parts may be.
        wires: the emitter's wire pads.
        taken: parts that are placed already, whose resistors are numbered first.

    Returns:
        Both parts; none without a switch, or without room for it.
    """
    part = config.parts.emitter.switch
    if part is None:
        return ()
    chip = config.parts.receiver.resistor
    along, across = chip.over_pads_mm
    width, length = part.body_mm[0], part.lead_span_mm
    left_to_right, high = across + APART_MM + width, max(along, length)
    front = [each.box.grown(APART_MM) for each in taken if each.side == "front"]
    pad_x, pad_y = wires.pads[-1]
    free = [
        (y - pad_y + abs(x - pad_x), x, y)
        for x in steps(zone.x_min_mm, zone.x_max_mm - left_to_right)
        for y in steps(zone.y_min_mm, zone.y_max_mm - high)
        if not any(overlap(Box(x, x + left_to_right, y, y + high), box) for box in front)
    ]
    if not free:
        return ()
    _, x, y = min(free)
    ref = f"R{1 + sum(each.kind == 'resistor' for each in taken)}"
    at = x + left_to_right - width / 2, y + length / 2
    below = x + across / 2, y + along / 2
    return (
        Part("Q1", "switch", *at, width, length, part.body_mm[2], "front"),
        Part(ref, "resistor", *below, across, along, chip.body_mm[2], "front"),
    )


def steps(low_mm: float, high_mm: float) -> list[float]:
    """Places between two ends, in steps."""
    return [low_mm + STEP_MM * i for i in range(int((high_mm - low_mm) / STEP_MM + 1e-9) + 1)]


def overlap(one: Box, other: Box) -> bool:
    """Whether two rectangles have an area in common."""
    return (
        one.x_min_mm < other.x_max_mm
        and other.x_min_mm < one.x_max_mm
        and one.y_min_mm < other.y_max_mm
        and other.y_min_mm < one.y_max_mm
    )
