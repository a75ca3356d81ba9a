"""Strings with resistors at low supplies, and the fuse before them."""

from typing import Any

import pytest

from lumitip_fab.config.load import load
from lumitip_fab.derive import derive, resolve

pytestmark = pytest.mark.slow

AUTOMATIC = '[emitter]\ndrive = "auto"\n[supply]\nvoltage_v = {}.0\n'


@pytest.mark.parametrize("volts", [5, 6, 9])
def test_resistors_that_stand_for_current_sources_hold_the_current(file: Any, volts: int) -> None:
    """With the fewest strings it would be 3.9 to 41.6 mA from 6 and 9 V, 8.6 to 32.4 mA from 5."""
    design = derive(load(file(AUTOMATIC.format(volts))))
    strings = design.electrical.strings
    assert strings.regulation is None
    left_v = volts - max(map(len, design.wiring.strings)) * strings.forward_v
    assert left_v >= 0.3 * volts
    assert min(strings.low_ma) > 0.6 * strings.target_ma
    assert max(strings.high_ma) < 1.4 * strings.target_ma
    (reason,) = [c.reason for c in design.choices if c.field == "emitter.string_leds"]
    assert f"% of {volts} V is left to each resistor" in reason


def test_written_resistors_are_as_few_as_the_supply_allows(file: Any) -> None:
    design = derive(load(file("[supply]\nvoltage_v = 9.0\n")))
    assert max(map(len, design.wiring.strings)) == 6


@pytest.mark.parametrize("columns", ["[5, 4, 5, 4, 5, 4, 5]", "[9, 8, 9, 8, 9, 8]"])
def test_a_fuse_carries_the_worst_case_of_all_strings(file: Any, columns: str) -> None:
    config = resolve(load(file(f"{AUTOMATIC.format(5)}[grid]\ncolumns = {columns}\n"))).config
    high_ma = sum(derive(config).electrical.strings.high_ma)
    assert 1000 * 0.75 * config.parts.flange.fuse.rated_a > high_ma


def test_a_larger_fuse_comes_before_less_light(file: Any) -> None:
    """More than the largest fuse carries is dimmed to that one, not to the smallest."""
    text = AUTOMATIC.format(5) + "max_ma = 1000\n[grid]\ncolumns = [9, 9, 9, 9, 9, 9, 9]\n"
    config = resolve(load(file(text.replace("[supply]", "max_heat_w = 4.0\n[supply]")))).config
    assert config.value("flange.fuse") == "1A 1206"
    high_ma = sum(derive(config).electrical.strings.high_ma)
    assert 0.75 * 500 < high_ma < 0.75 * 1000
