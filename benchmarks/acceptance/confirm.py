"""Refusals judged without the rules that refused: by physics, and by a search for a way out.

A refusal is confirmed if for each of its fields a physical limit, computed here or in `limits` from
the catalogue's figures, leaves no value to choose, and if the search finds none that is accepted.
"""

import math
from dataclasses import dataclass

from acceptance.generator import Design
from acceptance.limits import LIMITS, Values
from acceptance.parts import entries
from acceptance.search import way_out
from acceptance.trial import Trial

SUPPLY_TOLERANCE = 0.05
PUBLISHED_MA = 19.2
"""At which the catalogue's light currents hold."""
NEARLY = 0.95
FIELDS = {
    "page": ("mask.flap_mm",),
    "bed": ("printer.profile",),
    "land patterns": ("emitter.led", "receiver.photodetector"),
    "lines": ("board.track_mm", "board.copper_gap_mm", "board.channel_mm"),
    "cover": ("stack.silicone_mm",),
    "inputs": ("grid.columns", "controller.board", "receiver.multiplexer"),
    "step-down": ("supply.voltage_v", "flange.enabled", "flange.regulator"),
    "module": ("controller.board", "flange.enabled"),
    "base": ("flange.enabled", "coupling.gripper"),
    "plate": ("tip.edge_mm", "stack.floor_mm"),
    "nut": ("holder.screw", "breakout.hole_mm"),
    "block": ("coupling.gripper", "printer.profile", "printer.fit_mm"),
    "groove": ("flex.groove_depth_mm", "stack.floor_mm"),
    "bending": ("backing.variant", "backing.material", "stack.pcb_mm"),
}
ELECTRICAL = ("emitter.current_ma", "emitter.max_heat_w", "emitter.string_leds", "supply.max_ma")
"""Fields of refusals that a lack of current, power or voltage explains."""


@dataclass(frozen=True)
class Verdict:
    """Whether a refusal is confirmed, and by what."""

    confirmed: bool
    text: str


def confirm(design: Design, trial: Trial, search: bool = True) -> Verdict:
    """Judge the refusal of a design.

    Args:
        design: what was refused.
        trial: with its problems.
        search: whether to look for values that would have been accepted where physics has no
            reason, too; it takes some minutes. Where physics has one, the search may deny it.
    """
    known = reasons(Values(design.edits, design.base))
    unexplained = sorted({r.field for r in trial.refusals} - set(known))
    way = way_out(design) if search or not unexplained else None
    if way is not None:
        return Verdict(False, f"NOT CONFIRMED: accepted with {way}")
    if unexplained:
        return Verdict(False, f"NOT CONFIRMED: no physical reason for {', '.join(unexplained)}")
    return Verdict(
        True, "confirmed: " + "; ".join(sorted({known[r.field] for r in trial.refusals}))
    )


def reasons(values: Values) -> dict[str, str]:
    """Physical reasons why a design cannot exist, by the fields that they explain."""
    found: dict[str, str] = {}
    for text in (text for limit in LIMITS for text in limit(values)):
        found |= dict.fromkeys(FIELDS[text.partition(":")[0]], text)
    lack = lack_of_power(values)
    if lack:
        found |= dict.fromkeys(ELECTRICAL, lack)
    return found


def lack_of_power(values: Values) -> str:
    """Why no division into strings feeds all LEDs within the limits of supply and heat.

    Every length of string is tried, at the least current that the detectors need, with whatever
    resistor takes the rest of the voltage.
    """
    led = entries("leds")[values["emitter.led"]]
    volts, need_ma = values["supply.voltage_v"], least_current_ma(values)
    drop_v = led["forward_voltage_v"] - led["forward_tolerance_v"]
    longest = min(math.floor(volts * (1 + SUPPLY_TOLERANCE) / drop_v), values.cells)
    if longest < 1:
        return f"power: an LED of {drop_v:g} V at {volts:g} V"
    if need_ma > led["max_current_ma"]:
        return f"power: {need_ma:.1f} mA needed, the LED takes {led['max_current_ma']:g} mA"
    drawn_ma = math.ceil(values.cells / longest) * need_ma
    if drawn_ma > values.number("supply.max_ma"):
        return f"power: {drawn_ma:.1f} mA needed, {values.number('supply.max_ma'):g} mA there"
    heat_w, most_w = drawn_ma * volts / 1000, values.number("emitter.max_heat_w")
    if heat_w > most_w:
        return f"power: {heat_w:.2f} W needed, {most_w:g} W allowed in the finger"
    return ""


def least_current_ma(values: Values) -> float:
    """Current of the LEDs at which a detector in full light takes nearly all that its pull-up
    gives. Below it no cell reaches 95 % of full scale."""
    detector = entries("photodetectors")[values["receiver.photodetector"]]
    volts = entries("controllers")[values["controller.board"]]["supply_v"]
    full_ua = 1e6 * (volts - detector["saturation_v"]) / values.number("receiver.pull_up_ohm")
    return float(NEARLY * PUBLISHED_MA * full_ua / detector["light_current_ua"])
