"""The manual's test of a photodetector's ends with a multimeter, simulated by ngspice."""

from pathlib import Path

import pytest

from lumitip_fab.docs.boards import LIT_V
from spice_runs import needs_ngspice, simulated

OVER_RANGE_V = 2.0
"""A meter that shows at most this in its diode test: the least of common ones."""

NETLIST = """meter at a phototransistor
.model part npn(is=1e-14 bf={gain} br={reverse_gain})
.model clamp d
I1 0 red {meter_a:g}
D1 red most clamp
V1 most 0 2.2
Q1 {collector} base {emitter} part
I2 {collector} base {light_a:g}
.op
.control
run
let shown = v(red)
print shown
.endc
.end
"""
"""The meter drives a current, by at most some 2.8 V; light makes a current from collector to
base."""


def shown_v(
    folder: Path,
    light_ma: float,
    gain: float,
    reverse_gain: float,
    *,
    exchanged: bool = False,
    meter_a: float = 1e-3,
) -> float:
    """Voltage at the red probe.

    Args:
        folder: for the netlist.
        light_ma: collector current in the light.
        gain: hFE.
        reverse_gain: the same with collector and emitter exchanged.
        exchanged: the red probe at the emitter.
        meter_a: current of the meter.
    """
    collector, emitter = ("0", "red") if exchanged else ("red", "0")
    text = NETLIST.format(
        collector=collector,
        emitter=emitter,
        light_a=light_ma * 1e-3 / gain,
        gain=gain,
        reverse_gain=reverse_gain,
        meter_a=meter_a,
    )
    return simulated(text, folder)["shown"]


@needs_ngspice
@pytest.mark.parametrize("gain", [100.0, 300.0, 1000.0])
@pytest.mark.parametrize("reverse_gain", [0.5, 2.0, 5.0])
def test_one_way_round_shows_a_voltage_in_the_light(
    gain: float, reverse_gain: float, tmp_path: Path
) -> None:
    for light_ma in (3.0, 10.0):
        assert 0.0 < shown_v(tmp_path, light_ma, gain, reverse_gain) <= LIT_V
        other = shown_v(tmp_path, light_ma, gain, reverse_gain, exchanged=True)
        assert other > OVER_RANGE_V, f"{light_ma} mA"
    assert shown_v(tmp_path, 0.1, gain, reverse_gain) > OVER_RANGE_V, "in the shade"


@needs_ngspice
def test_a_low_current_does_not_tell_the_ends_apart(tmp_path: Path) -> None:
    """A resistance range drives some µA: the light passes it both ways."""
    ways = [shown_v(tmp_path, 3.0, 300.0, 2.0, exchanged=e, meter_a=1e-6) for e in (False, True)]
    assert max(ways) < 0.1
