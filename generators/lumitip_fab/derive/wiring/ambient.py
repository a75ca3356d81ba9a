"""Times of a frame from which the firmware takes the ambient light."""

import math

from lumitip_fab.config.load import Input
from lumitip_fab.derive.diagnostics import Diagnostics
from lumitip_fab.design.electrical import AmbientScan, Channel

RADIO_US, CONVERSION_US = 2750, 30
"""As in `settings.h` of the firmware: of a frame, for radio and USB; and of one conversion."""
NEAR_COUNTS, COUNTS = 0.5, 255
MOST_PERIOD_US = 65535
"""As `settings.h` and packets of the firmware allow."""
STEP_US = 500
"""Periods are multiples of it."""
THERMAL_V = 0.02585


def derive_ambient(config: Input, channel: Channel, faults: Diagnostics) -> AmbientScan | None:
    """Waits and period where the LEDs can be switched; refused where a frame takes too long."""
    if config.parts.emitter.switch is None:
        return None
    light_us = _light_us(config.parameters.receiver.pull_up_ohm, channel)
    scanned_us = scan_us(config, channel.wait_us or channel.settle_us)
    period_us = STEP_US * math.ceil((2 * (light_us + scanned_us) + RADIO_US) / STEP_US)
    faults.unless(
        period_us <= MOST_PERIOD_US,
        "frame_long",
        frame_ms=period_us / 1000,
        most_ms=MOST_PERIOD_US / 1000,
    )
    return AmbientScan(
        light_us=light_us,
        near_counts=NEAR_COUNTS,
        scan_us=scanned_us,
        period_us=period_us,
    )


def scan_us(config: Input, wait_us: float) -> float:
    """Shortest scan of all cells with this wait for each input of the multiplexers."""
    inputs: int = 2 ** len(config.parts.receiver.multiplexer.select)
    return inputs * wait_us + sum(config.parameters.grid.columns) * CONVERSION_US


def _light_us(pull_up_ohm: float, channel: Channel) -> float:
    """From full light to darkness, within `NEAR_COUNTS`; into the light it is faster.

    The base of a phototransistor gives back its charge through the collector's current I / B. Its
    capacitance C_b to the collector sees the whole step, and the two to collector and emitter see
    the base's own, which is the thermal voltage V_t for each factor e of current. While the error E
    of the reading falls from the supply S, that takes B C_b R (ln(S / E) + 2 V_t / E). Dark
    current, left out, only shortens it.
    """
    gain, base_pf = channel.gain[1], channel.base_pf[1]
    error_v = NEAR_COUNTS / COUNTS * channel.supply_v
    share = math.log(channel.supply_v / error_v) + 2 * THERMAL_V / error_v
    return (gain * base_pf + channel.detector_pf) * 1e-6 * pull_up_ohm * share
