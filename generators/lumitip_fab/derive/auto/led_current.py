"""Current, strings and resistors of the LEDs, chosen together: full light first, small parts next.

Of all combinations that pass every rule of `lumitip_fab.derive.wiring.string_problems` the first is
taken: the largest current, then the smallest resistor package, then the fewest strings.
"""

import math
from collections.abc import Iterator

from lumitip_fab.automatic import FIELDS, Value
from lumitip_fab.derive.led_strings import String, lengths, longest_string, sold_ohm, string_of
from lumitip_fab.derive.wiring import string_problems
from lumitip_fab.load import Input

CURRENT_STEP = 0.95  # from one current that is tried to the next
SATURATION_MARGIN = 1.5  # light current at a bare cell, times what saturates its pull-up
MOST_PULL_UP = 2.0  # times the published one; a channel settles that much slower


def choose_strings(given: Input) -> Iterator[tuple[str, Value, str]]:
    """Automatic values among current, LEDs of a string, resistor and pull-up. Where nothing passes,
    those that ask least of supply, heat and ratings: then the rules say what is missing."""
    for current in _currents(given):
        for resistor in _resistors(given):
            for longest in _lengths(given):
                tried = given.with_values(
                    {"emitter.current_ma": current, "emitter.resistor": resistor}
                )
                found = _strings(tried, longest)
                if not any(string_problems(tried, found)):
                    yield from _proposals(tried, longest)
                    return
    least = min(_currents(given), default=given.parameters.emitter.current_ma)
    candidates = [
        (given.with_values({"emitter.current_ma": least, "emitter.resistor": resistor}), longest)
        for resistor in _resistors(given)
        for longest in _lengths(given)
    ]
    if candidates:
        yield from _proposals(*min(candidates, key=_broken))


def _broken(candidate: tuple[Input, int]) -> int:
    return len(list(string_problems(candidate[0], _strings(*candidate))))


def _strings(given: Input, longest: int) -> tuple[String, ...]:
    cells, current = sum(given.parameters.grid.columns), given.parameters.emitter.current_ma
    by_length = {n: string_of(given, n, current) for n in set(lengths(cells, longest))}
    return tuple(by_length[n] for n in lengths(cells, longest))


def _proposals(given: Input, longest: int) -> Iterator[tuple[str, Value, str]]:
    p = given.parameters
    strings = _strings(given, longest)
    package = given.catalogue.resistors[p.emitter.resistor]
    load, volts = max(s.high_load_w for s in strings), p.supply.voltage_v
    full = float(FIELDS["emitter.current_ma"].start)
    reason = "current of the published sensor"
    if p.emitter.current_ma < full:
        reason = (
            f"less than {full:g} mA: {len(strings)} strings from {volts:g} V keep to "
            f"supply.max_ma, emitter.max_heat_w = {p.emitter.max_heat_w:g} and their resistors"
        )
    yield "emitter.current_ma", p.emitter.current_ma, reason
    yield (
        "emitter.string_leds", max(lengths(sum(p.grid.columns), longest)),
        f"{len(strings)} strings: as few as {volts:g} V and the resistors allow",
    )  # fmt: skip
    yield (
        "emitter.resistor", p.emitter.resistor,
        f"takes up to {1000 * load:.0f} mW over all tolerances, rated {1000 * package.power_w:.0f}",
    )  # fmt: skip
    start = float(FIELDS["receiver.pull_up_ohm"].start)
    factor = min(_least_ma(given, start) / p.emitter.current_ma, MOST_PULL_UP)
    ohm = start if factor <= 1 else sold_ohm(start * factor)
    reason = f"a bare cell saturates it at {p.emitter.current_ma:g} mA"
    if p.emitter.current_ma * SATURATION_MARGIN < _least_ma(given, ohm):
        reason = (
            f"{MOST_PULL_UP:g} times the published {start:g}, with more a channel settles too "
            f"slowly; at {p.emitter.current_ma:g} mA a bare cell does not saturate it"
        )
    yield "receiver.pull_up_ohm", ohm, reason


def _currents(given: Input) -> Iterator[float]:
    """From the published current, or the LED's largest, down to what the detectors need."""
    p = given.parameters
    if "emitter.current_ma" not in given.automatic:
        yield p.emitter.current_ma
        return
    full = float(FIELDS["emitter.current_ma"].start)
    least = least_current_ma(given)
    current = full
    while current >= least:
        yield round(current, 1)
        current *= CURRENT_STEP


def least_current_ma(given: Input) -> float:
    """LED current with which a bare cell still saturates, with a margin."""
    ohm = given.parameters.receiver.pull_up_ohm
    return _least_ma(
        given, ohm * (MOST_PULL_UP if "receiver.pull_up_ohm" in given.automatic else 1)
    )


def lowest_ma(given: Input) -> float:
    """Current below which a search does not go that chooses it; 0 where the user wrote it."""
    if "emitter.current_ma" not in given.automatic:
        return 0.0
    return _least_ma(given, given.parameters.receiver.pull_up_ohm)


def _least_ma(given: Input, ohm: float) -> float:
    """LED current with which a bare cell saturates a pull-up, with a margin.

    The catalogue's `light_current_ua` is for the published current.
    """
    p, parts = given.parameters, given.catalogue
    detector = parts.photodetectors[p.receiver.photodetector]
    supply_v = parts.controllers[p.controller.board].supply_v
    saturated_ua = 1e6 * (supply_v - detector.saturation_v) / ohm
    full = float(FIELDS["emitter.current_ma"].start)
    return full * SATURATION_MARGIN * saturated_ua / detector.light_current_ua


def _resistors(given: Input) -> Iterator[str]:
    """Packages from small to large."""
    if "emitter.resistor" not in given.automatic:
        yield given.parameters.emitter.resistor
        return
    known = given.catalogue.resistors
    yield from sorted(known, key=lambda name: math.prod(known[name].body_mm[:2]))


def _lengths(given: Input) -> Iterator[int]:
    """Most LEDs in a string, fewer and fewer."""
    longest = longest_string(given)
    if "emitter.string_leds" not in given.automatic:
        longest = min(longest, given.parameters.emitter.string_leds)
        if longest:
            yield longest
        return
    cells, before = sum(given.parameters.grid.columns), 0
    for most in range(longest, 0, -1):
        count = math.ceil(cells / most)
        if count != before:
            yield most
        before = count
