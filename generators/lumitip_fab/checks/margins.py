"""Margins of different units on one scale, so that the tightest of all can be named."""

import math
from collections.abc import Iterable

from lumitip_fab.checks.result import Measurement

DRAWN_AT_THE_LIMIT = frozenset(
    {
        "board.clearance",
        "board.edge_clearance",
        "board.hot_loop_ground",
        "board.silk_cells",
        "board.silk_gap",
        "board.silk_letters",
        "board.silk_lines",
        "board.supply_width",
        "board.track_width",
        "board.via_ring",
        "wiring.current",
    }
)
"""Checks whose figure is meant to stand at its limit: tracks, gaps and letters are drawn with the
smallest permitted dimension, shares reach 100 %, and a list repeats a computed value."""


def relative_margin(measurement: Measurement) -> float | None:
    """The margin as a share of what it could be, comparable across units.

    0 is at the limit, negative is outside. The scale is

    - half the range, where both limits bind: 1 is in the middle of the tolerance;
    - the upper limit, for a magnitude that is at best 0: 1 is no deviation at all;
    - the limit itself, where there is only one: 1 is twice a lower limit, or 0 for an upper one.

    `None` where there is no such scale: exact values, a limit of 0, no limit, and figures that
    could not be measured.
    """
    low, high, measured = measurement.low, measurement.high, measurement.measured
    if math.isnan(measured) or low == high:
        return None
    if low == 0 <= measured:
        scale = high
    elif math.isfinite(low) and math.isfinite(high):
        scale = (high - low) / 2
    else:
        scale = abs(low if math.isfinite(low) else high)
    if scale == 0 or math.isinf(scale):
        return None
    return float(measurement.margin / scale)


def tightest(
    measurements: Iterable[Measurement], count: int
) -> tuple[tuple[float, Measurement], ...]:
    """The smallest relative margins with their measurements, at most one of each check; without
    what failed and what is drawn at its limit on purpose."""
    least: dict[str, tuple[float, Measurement]] = {}
    for m in measurements:
        share = relative_margin(m)
        if share is None or not m.passed or m.check in DRAWN_AT_THE_LIMIT:
            continue
        if m.check not in least or share < least[m.check][0]:
            least[m.check] = (share, m)
    return tuple(sorted(least.values(), key=lambda pair: pair[0])[:count])
