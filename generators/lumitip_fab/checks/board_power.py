"""Load of the string resistors at the worst case, by a calculation of the checks' own: values,
packages and LEDs are those of the board file, ratings those of the packages' data sheets."""

import math
import re
from collections.abc import Iterator

from scipy.optimize import brentq

from lumitip_fab.checks.board_read import Read, ohm
from lumitip_fab.checks.result import Measurement

THERMAL_V = 0.02585
SUPPLY_HIGH, RESISTOR_LOW = 1.05, 0.99
MOST_SHARE = 0.8
"""Of the rating: thick-film chips are rated to 70 °C; at 87 °C 0.8 of it is left."""
RATED_W = {"1608": 0.1, "2012": 0.125, "3216": 0.25, "3225": 0.5, "5025": 0.75}
"""Rated power by size in tenths of a millimetre (Yageo RC_L series)."""
_SIZE = re.compile(r"RESC(\d{4})X")


def measure_loads(read: Read, chains: tuple[int, ...]) -> Iterator[Measurement]:
    """The largest load of a string resistor, as a share of its rating.

    Args:
        read: the emitter's board.
        chains: LEDs that the copper puts behind each resistor, R1 first.
    """
    volts = float(read.finger.connector.signals[1].removesuffix("V"))
    shares = [_share(read, f"R{i}", leds, volts) for i, leds in enumerate(chains, start=1)]
    worst = max(range(len(shares)), key=lambda i: (math.isnan(shares[i]), shares[i]))
    note = f"R{worst + 1}, over the tolerances of supply, LEDs and resistor"
    yield read.figure("resistor_load", 100 * shares[worst], 0, 100 * MOST_SHARE, "%", note)


def _share(read: Read, ref: str, leds: int, volts: float) -> float:
    part = read.parts.get(ref)
    size = _SIZE.match(part.footprint) if part else None
    if part is None or size is None or size[1] not in RATED_W:
        return math.nan
    resistance = ohm(part.value) * RESISTOR_LOW
    amps = _highest_a(read, volts * SUPPLY_HIGH, leds, resistance)
    return amps**2 * resistance / RATED_W[size[1]]


def _highest_a(read: Read, volts: float, leds: int, resistance: float) -> float:
    """Current with every LED at its lowest forward voltage."""
    told = read.design.electrical.strings
    slope = told.ideality * THERMAL_V

    def missing_v(amps: float) -> float:
        each = told.forward_v - told.forward_tolerance_v
        each += slope * math.log(1000 * amps / told.target_ma)
        return volts - leds * each - amps * resistance

    return float(brentq(missing_v, 1e-12, volts / resistance + 1e-9))
