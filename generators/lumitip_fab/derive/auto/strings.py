"""First values of drive, current, strings and resistors of the LEDs, and of the pull-ups:
together."""

import math
from collections.abc import Iterator
from dataclasses import replace

from lumitip_fab.config.automatic import Value, automatic_fields
from lumitip_fab.config.load import Input
from lumitip_fab.derive.wiring.ratings import e24, sold_to
from lumitip_fab.derive.wiring.settling import light_share, most_pull_up_ohm
from lumitip_fab.derive.wiring.sources import longest_with_resistor
from lumitip_fab.derive.wiring.strings import (
    lengths,
    longest_string,
    string_problems,
    strings_of,
)
from lumitip_fab.design.electrical import CUT_OFF_SHARE

CURRENT_STEP = 0.95  # from one current that is tried to the next
FULL_SHARE = 0.95
"""Of the current that saturates a pull-up, what a bare cell takes by the catalogue, within half a
step of the E24 series. More would hide what dims a cell by less than the rest."""
STEADY_SHARE = 0.3
"""Share of the supply across a resistor that a choice of this program leaves, if the ratings allow:
with half of it the current changes twice as much with supply and temperature."""


def choose_strings(config: Input, steady: bool = False) -> Iterator[tuple[str, Value, str]]:
    """Automatic values of drive, current, LEDs of a string, resistor and pull-up. Where no
    combination passes, the one with resistors that breaks the fewest rules.

    Args:
        config: the input.
        steady: prefer strings that leave a resistor `STEADY_SHARE`, as with an automatic drive.
    """
    refused, steady = "", steady or "emitter.drive" in config.automatic
    for driven in _drives(config):
        for tried, longest in _candidates(driven, steady):
            problem = next(string_problems(tried, strings_of(tried, longest)), None)
            if problem is None:
                yield from _drive_proposals(tried, refused)
                yield from _proposals(tried, longest)
                return
            refused = refused or f"with current sources {problem[0]} {problem[1]}"
        refused = refused or "the supply does not feed an LED and a current source"
    *_, driven = _drives(config)
    least = min(_currents(driven), default=driven.parameters.emitter.current_ma)
    lowest = [c for c in _candidates(driven, steady) if c[0].parameters.emitter.current_ma == least]
    if lowest:
        tried, longest = min(lowest, key=_broken)
        yield from _drive_proposals(tried, refused)
        yield from _proposals(tried, longest)


def choose_resistors(config: Input, reason: str) -> Iterator[tuple[str, Value, str]]:
    """The same without current sources, for a reason."""
    fixed = replace(config, automatic=config.automatic - {"emitter.drive"})
    yield "emitter.drive", "resistor", reason
    yield from choose_strings(_driven(fixed, "resistor"), steady=True)


def _drives(config: Input) -> Iterator[Input]:
    """The input with each drive that may be chosen."""
    automatic = "emitter.drive" in config.automatic
    for drive in ("source", "resistor") if automatic else (config.parameters.emitter.drive,):
        yield _driven(config, drive)


def _driven(config: Input, drive: str) -> Input:
    """The input with a drive, and with its resistors on the side that belongs to it."""
    values = {"emitter.drive": drive}
    if "emitter.resistor_side" in config.automatic:
        values["emitter.resistor_side"] = "front" if drive == "source" else "back"
    return config.with_values(values)


def _candidates(config: Input, steady: bool) -> Iterator[tuple[Input, int]]:
    """Currents, packages and lengths to try, in the order in which they are preferred."""
    for current in _currents(config):
        for lengths_tried in _lengths(config, steady):
            for resistor in _resistors(config):
                values = {"emitter.current_ma": current, "emitter.resistor": resistor}
                tried = config.with_values(values)
                yield from ((tried, longest) for longest in lengths_tried)


def _drive_proposals(config: Input, refused: str) -> Iterator[tuple[str, Value, str]]:
    emitter = config.parameters.emitter
    held = "it holds the current whatever supply and temperature do"
    if "emitter.drive" in config.automatic:
        yield "emitter.drive", emitter.drive, held if emitter.drive == "source" else refused
    side = "beside the current sources" if emitter.drive == "source" else "as published"
    yield "emitter.resistor_side", emitter.resistor_side, side


def _broken(candidate: tuple[Input, int]) -> int:
    return len(list(string_problems(candidate[0], strings_of(*candidate))))


def _proposals(config: Input, longest: int) -> Iterator[tuple[str, Value, str]]:
    p = config.parameters
    strings = strings_of(config, longest)
    package = config.parts.emitter.resistor
    load, volts = max(s.high_load_w for s in strings), p.supply.voltage_v
    full = float(automatic_fields()["emitter.current_ma"].start)
    named = "1 string" if len(strings) == 1 else f"{len(strings)} strings"
    reason = "current of the published sensor"
    if p.emitter.current_ma < full:
        reason = (
            f"less than {full:g} mA: with {named} from {volts:g} V, it keeps to "
            f"supply.max_ma, emitter.max_heat_w = {p.emitter.max_heat_w:g} and the ratings"
        )
    yield "emitter.current_ma", p.emitter.current_ma, reason
    leds = max(lengths(sum(p.grid.columns), longest))
    reason = f"{named}: as few as {volts:g} V and the ratings allow"
    if p.emitter.drive == "resistor" and leds < longest_with_resistor(config):
        left = 100 * (1 - leds * config.parts.emitter.led.forward_voltage_v / volts)
        reason = f"{named}: {left:.0f} % of {volts:g} V is left to each resistor"
    yield "emitter.string_leds", leds, reason
    yield (
        "emitter.resistor",
        p.emitter.resistor,
        f"takes up to {1000 * load:.0f} mW over all tolerances, rated {1000 * package.power_w:.0f}",
    )
    ohm, reason = _pull_up(config)
    yield "receiver.pull_up_ohm", ohm, reason


def _pull_up(config: Input) -> tuple[float, str]:
    """Pull-up with which a bare cell uses `FULL_SHARE` of its range, or the one nearest to it that
    is fast enough; and the reason."""
    current_ma = config.parameters.emitter.current_ma
    start = float(automatic_fields()["receiver.pull_up_ohm"].start)
    wanted = max(1.0, FULL_SHARE / light_share(config, current_ma, start)) * start
    most = most_pull_up_ohm(config)
    ohm = min(e24(wanted), sold_to(most))
    share = light_share(config, current_ma, ohm)
    if share > CUT_OFF_SHARE:
        return ohm, f"a bare cell is cut off: its light is {share:.1f} times its range"
    if wanted > most:
        return ohm, (
            f"with more than {ohm:g} a channel settles too slowly; at {current_ma:g} mA a bare "
            f"cell uses {100 * share:.0f} % of its range"
        )
    return ohm, f"a bare cell uses nearly all of its range at {current_ma:g} mA"


def _currents(config: Input) -> Iterator[float]:
    """From the published current, or the LED's largest, down to what the detectors need."""
    p = config.parameters
    if "emitter.current_ma" not in config.automatic:
        yield p.emitter.current_ma
        return
    full = float(automatic_fields()["emitter.current_ma"].start)
    least, current = min(least_current_ma(config), full), full
    while current >= least:
        yield round(current, 1)
        current *= CURRENT_STEP


def dimmer(config: Input) -> Iterator[dict[str, tuple[Value, str]]]:
    """Lower currents in turn, each with the pull-up with which a bare cell keeps its range: values
    with their reasons, by field. None where the file sets one of them."""
    current, pull_up = "emitter.current_ma", "receiver.pull_up_ohm"
    if not {current, pull_up} <= config.automatic:
        return
    emitter = config.parameters.emitter
    for lower in (ma for ma in _currents(config) if ma < emitter.current_ma):
        dimmed = config.with_values({current: lower})
        proposed = _proposals(dimmed, emitter.string_leds)
        yield {name: (value, why) for name, value, why in proposed if name in {current, pull_up}}


def least_current_ma(config: Input) -> float:
    """LED current with which a bare cell uses nearly all of its range."""
    automatic = "receiver.pull_up_ohm" in config.automatic
    return _least_ma(
        config,
        most_pull_up_ohm(config) if automatic else config.parameters.receiver.pull_up_ohm,
    )


def lowest_ma(config: Input) -> float:
    """Lowest current that a search may choose; 0 where the file sets the current."""
    if "emitter.current_ma" not in config.automatic:
        return 0.0
    return _least_ma(config, config.parameters.receiver.pull_up_ohm)


def _least_ma(config: Input, ohm: float) -> float:
    """LED current with which a bare cell takes `FULL_SHARE` of what saturates a pull-up."""
    return FULL_SHARE / light_share(config, 1.0, ohm)


def _resistors(config: Input) -> Iterator[str]:
    """Packages from small to large."""
    if "emitter.resistor" not in config.automatic:
        yield config.parameters.emitter.resistor
        return
    known = config.catalogue.resistors
    yield from sorted(known, key=lambda name: math.prod(known[name].body_mm[:2]))


def _lengths(config: Input, steady: bool) -> Iterator[tuple[int, ...]]:
    """Lengths of the longest string to try, in descending order; in a second group those that leave
    a resistor too little to hold the current."""
    longest = longest_string(config)
    if "emitter.string_leds" not in config.automatic:
        longest = min(longest, config.parameters.emitter.string_leds)
        yield (longest,) if longest else ()
        return
    cells, most = sum(config.parameters.grid.columns), longest
    if steady and config.parameters.emitter.drive == "resistor":
        most = min(longest_with_resistor(config, STEADY_SHARE), longest)
    counts = sorted({math.ceil(cells / each) for each in range(1, longest + 1)})
    each_length = [math.ceil(cells / count) for count in counts]
    yield tuple(leds for leds in each_length if leds <= most)
    yield tuple(leds for leds in each_length if leds > most)
