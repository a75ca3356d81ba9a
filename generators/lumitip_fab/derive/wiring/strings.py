"""Series strings of LEDs: which cells, what sets their current, and the rules that they keep."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from lumitip.grid import Integers
from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.derive.finger.cells import Cells
from lumitip_fab.derive.wiring.ratings import MOST_RESISTOR_LOAD
from lumitip_fab.derive.wiring.sources import (
    COLDEST_C,
    HOTTEST_C,
    LEAST_RESISTOR_SHARE,
    String,
    least_supply_v,
    longest_with_resistor,
    longest_with_source,
    resistor_string,
    source_problems,
    source_string,
)

MOST_CURRENT_SPREAD = 0.05  # between strings


@dataclass(frozen=True)
class Strings:
    """The strings of a finger."""

    cells: tuple[tuple[int, ...], ...]
    strings: tuple[String, ...]
    """Resistors and currents of each."""

    @property
    def resistor_ohm(self) -> tuple[float, ...]:
        """Resistor that carries the current of each string."""
        return tuple(string.ohm for string in self.strings)

    @property
    def current_ma(self) -> tuple[float, ...]:
        """Nominal current of each string."""
        return tuple(string.nominal_ma for string in self.strings)

    @property
    def set_ohm(self) -> tuple[float, ...]:
        """Resistor at the SET of each current source; empty without sources."""
        return tuple(string.set_ohm for string in self.strings if string.set_ohm is not None)


def lengths(cells: int, longest: int) -> tuple[int, ...]:
    """LEDs of each string: as few strings as possible, which differ by at most one LED."""
    count = math.ceil(cells / longest)
    return tuple(cells // count + (i < cells % count) for i in range(count))


def string_of(config: Input, leds: int, current_ma: float) -> String:
    """A string of LEDs for a current."""
    made = source_string if config.parameters.emitter.drive == "source" else resistor_string
    return made(config, leds, current_ma)


def strings_of(config: Input, longest: int) -> tuple[String, ...]:
    """All strings of a finger with at most so many LEDs in each."""
    cells, current = sum(config.parameters.grid.columns), config.parameters.emitter.current_ma
    by_length = {n: string_of(config, n, current) for n in set(lengths(cells, longest))}
    return tuple(by_length[n] for n in lengths(cells, longest))


def longest_string(config: Input) -> int:
    """Most LEDs in a string that the supply feeds; 0 if not even one."""
    if config.parameters.emitter.drive == "source":
        return longest_with_source(config)
    return longest_with_resistor(config)


def derive_strings(config: Input, cells: Cells, faults: Diagnostics) -> Strings:
    """The fewest strings that the supply allows, differing by at most one LED."""
    p = config.parameters
    longest = min(longest_string(config), p.emitter.string_leds)
    if longest < 1:
        faults.refuse(*_too_low(config))
        return Strings((), ())
    groups = np.array_split(_winding(cells), len(lengths(len(cells), longest)))
    current = p.emitter.current_ma
    by_length = {n: string_of(config, n, current) for n in {group.size for group in groups}}
    strings = Strings(
        tuple(_from_the_gripper(cells, group) for group in groups),
        tuple(by_length[group.size] for group in groups),
    )
    for field, message in string_problems(config, strings.strings):
        faults.refuse(field, message)
    return strings


def _too_low(config: Input) -> tuple[str, str]:
    """Field and message where the supply does not feed a single LED."""
    p, led = config.parameters, config.parts.emitter.led
    if p.emitter.drive == "source":
        return "emitter.drive", (
            f'is "source"; one LED and {p.emitter.source!r} need {least_supply_v(config):.2f} V at '
            f"the worst case, supply.voltage_v = {p.supply.voltage_v:g} is less. Use "
            '"resistor", or a higher supply.'
        )
    return "supply.voltage_v", (
        f"is {p.supply.voltage_v:g}; one LED needs {led.forward_voltage_v:g} V and its "
        "resistor 10 % of the supply: at least "
        f"{led.forward_voltage_v / (1 - LEAST_RESISTOR_SHARE):.2f} is needed"
    )


def string_problems(config: Input, strings: tuple[String, ...]) -> Iterator[tuple[str, str]]:
    """Field and message of every rule that strings break: ratings at the worst case, spread of
    currents, supply and heat."""
    p = config.parameters
    led, volts = config.parts.emitter.led, p.supply.voltage_v
    package, current = config.parts.emitter.resistor, p.emitter.current_ma
    highest = max(string.high_ma for string in strings)
    if max(highest, current) > led.max_current_ma:
        yield (
            "emitter.current_ma",
            f"is {current:g}, up to {highest:.1f} mA with all tolerances, {COLDEST_C:g} to "
            f"{HOTTEST_C:g} °C; {p.emitter.led!r} is rated for {led.max_current_ma:g} mA. Reduce "
            "it, or emitter.string_leds.",
        )
    load = max(string.high_load_w for string in strings)
    allowed = MOST_RESISTOR_LOAD * package.power_w
    if load > allowed:
        yield (
            "emitter.resistor",
            f"is {p.emitter.resistor!r}, with a power of up to {1000 * load:.0f} mW at "
            f"{current:g} mA, all tolerances, {COLDEST_C:g} to {HOTTEST_C:g} °C; the limit is "
            f"{1000 * allowed:.0f} mW ({100 * MOST_RESISTOR_LOAD:g} % of its rating). Use a larger "
            "one, or fewer emitter.string_leds.",
        )
    if p.emitter.drive == "source":
        yield from source_problems(config, strings)
    nominal = [string.nominal_ma for string in strings]
    spread = max(nominal) / min(nominal) - 1
    if spread > MOST_CURRENT_SPREAD:
        yield (
            "emitter.current_ma",
            f"is {current:g}; the currents of the strings differ by {100 * spread:.1f} %; "
            f"at most {100 * MOST_CURRENT_SPREAD:g} % is allowed",
        )
    if sum(nominal) > p.supply.max_ma:
        yield (
            "supply.max_ma",
            f"is {p.supply.max_ma:g}; {len(strings)} strings at {current:g} mA draw "
            f"{sum(nominal):.1f} mA. Increase it or reduce emitter.current_ma.",
        )
    heat_w = sum(nominal) * volts / 1000
    if heat_w > p.emitter.max_heat_w:
        yield (
            "emitter.max_heat_w",
            f"is {p.emitter.max_heat_w:g}; {len(strings)} strings at {current:g} mA "
            f"from {volts:g} V produce {heat_w:.2f} W in the finger. Increase it or reduce "
            "emitter.current_ma.",
        )


def _winding(cells: Cells) -> Integers:
    """The cells up one column and down the next, so that successive cells are near each other."""
    order = np.lexsort((np.where(cells.column % 2, cells.row, -cells.row), cells.column))
    return np.asarray(order, dtype=np.int64)


def _from_the_gripper(cells: Cells, string: Integers) -> tuple[int, ...]:
    """A string from its end nearer to the gripper, where its resistor is."""
    first, last = cells.y_mm[string[[0, -1]]]
    return tuple(string[:: -1 if last < first else 1].tolist())
