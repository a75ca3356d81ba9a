"""An electrostatic discharge into a wire, and the pulse that it drives into the pin behind it.

```
generator ──┬── R ──┬── pin, its diodes at the supply and at ground
            L       C
            Z
```
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Values = NDArray[np.float64]
_PEAKS_A = 16.6, 9.3
_RISE_NS, _FALL_NS = (1.1, 12.0), (2.0, 37.0)
_POWER, _FOR_KV = 1.8, 4.0
"""Current of the generator at 4 kV by IEC 61000-4-2: two pulses, each with rise and fall."""
_STEP_NS, _END_NS = 0.02, 200.0
FORWARD_V = 0.7
"""Of the diode against ground, at a negative discharge."""


@dataclass(frozen=True)
class Clamp:
    """The diode at a wire, with the inductance of the way over it."""

    breakdown_v: float
    dynamic_ohm: float
    inductance_nh: float


def generator_a(time_ns: Values, kilovolt: float) -> Values:
    """Current of the generator over time; shape as `time_ns`."""
    total = np.zeros_like(time_ns)
    for peak_a, rise, fall in zip(_PEAKS_A, _RISE_NS, _FALL_NS, strict=True):
        scale = math.exp(-(rise / fall) * (_POWER * fall / rise) ** (1 / _POWER))
        grown = (time_ns / rise) ** _POWER
        total += peak_a / scale * grown / (1 + grown) * np.exp(-time_ns / fall)
    return total * kilovolt / _FOR_KV


def pin_pulse_a(
    clamp: Clamp, series_ohm: float, capacitor_pf: float, supply_v: float, kilovolt: float
) -> float:
    """Largest current through the diodes of a pin, of a discharge of either sign.

    All of the generator's current is taken to go through the diode, and the pin's own diodes to
    conduct at once, so that it is an upper bound.
    """
    time_ns = np.arange(0.0, _END_NS, _STEP_NS)
    current = generator_a(time_ns, kilovolt)
    over_v = clamp.dynamic_ohm * current + clamp.inductance_nh * np.gradient(current, _STEP_NS)
    high = _through(over_v + clamp.breakdown_v, supply_v, supply_v / 2, series_ohm, capacitor_pf)
    low = _through(over_v + FORWARD_V, 0.0, -supply_v / 2, series_ohm, capacitor_pf)
    return max(high, low)


def _through(
    line_v: Values, held_v: float, start_v: float, series_ohm: float, capacitor_pf: float
) -> float:
    """Largest current into a pin that does not rise above some voltage."""
    if not capacitor_pf > 0:
        return float((line_v - held_v).max()) / series_ohm
    pin_v, most_a = start_v, 0.0
    for volts in line_v.tolist():
        through_a = (volts - pin_v) / series_ohm
        pin_v += through_a * _STEP_NS * 1e3 / capacitor_pf
        if pin_v >= held_v:
            pin_v = held_v
            most_a = max(most_a, (volts - held_v) / series_ohm)
    return most_a
