"""Section of the wires that feed the LEDs: for their current, and for the voltage that it loses."""

from lumitip_fab.config.load import Input
from lumitip_fab.derive.wiring.strings import longest_string, strings_of

MOST_A_PER_MM2 = 3.0  # in a bundle; a common figure for thin wires without cooling
MOST_DROP = 0.02  # of the LEDs' supply, both ways
COPPER_OHM_MM2_PER_M = 0.0178
SOLD_MM2 = (0.05, 0.08, 0.14, 0.25, 0.34, 0.5, 0.75, 1.0, 1.5, 2.5, 4.0)
REACH_MM = 60.0  # of a wire on its finger and in its bends, at most


def section_mm2(config: Input, current_ma: float, way_mm: float) -> float:
    """The configured section or, where that is too thin, the smallest sold one that carries a
    current.

    Args:
        config: for the section that is asked for, and the supply.
        current_ma: through the wire.
        way_mm: of the wires from the supply, one after the other.
    """
    supply_v, asked = config.parameters.supply.voltage_v, config.parameters.wiring.section_mm2
    amps = current_ma / 1000
    for_drop = 2 * way_mm / 1000 * amps * COPPER_OHM_MM2_PER_M / (MOST_DROP * supply_v)
    least = max(amps / MOST_A_PER_MM2, for_drop)
    if asked >= least:
        return asked
    return next((sold for sold in SOLD_MM2 if sold >= least), least)


def emitter_section_mm2(config: Input) -> float:
    """Section of the wires at the emitter, or more: their exact lengths are not known yet."""
    wiring = config.parameters.wiring
    own_mm = REACH_MM + config.parts.coupling.gripper.stroke_mm / 2
    way_mm = wiring.supply_mm + wiring.controller_mm + 2 * wiring.slack_mm + own_mm
    return section_mm2(config, most_lit_ma(config), way_mm)


def most_lit_ma(config: Input) -> float:
    """Current of all strings at the worst case; 0 where the supply feeds none."""
    longest = min(longest_string(config), config.parameters.emitter.string_leds)
    return sum(string.high_ma for string in strings_of(config, longest)) if longest else 0.0
