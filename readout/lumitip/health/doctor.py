"""Faults of the cells of a fingertip, found in a recording of a few seconds.

Dead, stuck, saturated and noisy cells are found from their own values. Swapped cells are found
while an object moves over all cells, see `lumitip.health.swaps`: the wiring or the `layout.json`
is then probably wrong.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from lumitip import arguments
from lumitip.errors import ArgumentError
from lumitip.frame import Values
from lumitip.health.swaps import (
    LEAST_ORDER,
    Mask,
    Pairs,
    enough_pairs,
    offset_classes,
    order,
    swaps,
)
from lumitip.layout import Layout
from lumitip.values import one_line

Kind = Literal["dark", "saturated", "stuck", "noisy", "swapped", "astray"]

_DARK = 12.75  # a twentieth of full light
_FULL = 254.0
_LEAST_NOISE = 4.0  # counts of 255, above any healthy cell
_NOISE_RATIO = 5.0  # to the median cell
_MOVED = 15.0  # standard deviation of a cell that an object passes
_MOVED_SHARE = 0.8  # of the cells, to look for swaps
_CALM_SHARE = 0.5


@dataclass(frozen=True)
class Finding:
    """A fault of one cell, of a pair, or of all."""

    kind: Kind
    cells: tuple[int, ...]
    """Their numbers; empty for all."""
    detail: str
    """Observation and remedy, for the user."""
    sure: bool = True
    """Whether both halves of the recording show it."""


@dataclass(frozen=True, eq=False)
class Report:
    """The result of `examine`."""

    findings: tuple[Finding, ...]
    noise: Values
    """Standard deviation from frame to frame of each cell, 255 is full light, shape `(cells,)`."""
    unseen: str | None
    """Why swapped cells could not be found, for the user; `None` if they could."""

    def __repr__(self) -> str:
        return one_line(self)


def examine(light: Values, layout: Layout) -> Report:
    """Find faulty cells.

    Args:
        light: not calibrated, 255 is full light, shape `(n, cells)`, at least two frames.
        layout: the cells.

    Raises:
        LayoutError: if `layout` is not a layout.
        ArgumentError: if `light` is not an array of this shape.
    """
    arguments.layout(layout)
    light = arguments.numbers(light, "light").astype(np.float32, copy=False)
    if light.ndim != 2 or len(light) < 2 or light.shape[1] != len(layout):
        raise ArgumentError(f"light has shape {light.shape}; (2 or more, {len(layout)}) is needed")
    noise = _noise(light)
    findings = _single(light, noise)
    suspect = {cell for finding in findings for cell in finding.cells}
    moving = light.std(axis=0) > _MOVED
    offsets = offset_classes(layout)
    unseen = _unseen(moving, offsets)
    if unseen is None:
        usable = moving & ~np.isin(np.arange(len(layout)), list(suspect))
        findings += _misplaced(light, offsets, usable)
    return Report(tuple(findings), noise, unseen)


def _unseen(moving: Mask, offsets: Pairs) -> str | None:
    if not enough_pairs(offsets):
        return f"{len(offsets)} cells are too few to find swapped cells"
    share = float(moving.mean())
    if share < _MOVED_SHARE:
        return (
            f"an object moved over {share:.0%} of the cells; {_MOVED_SHARE:.0%} are needed to find "
            "swapped ones. Move an object over all cells, in all directions"
        )
    return None


def _noise(light: Values) -> Values:
    """Standard deviation of each cell from the smaller half of its steps, to exclude movement.

    For normal noise the mean of the smaller half of |a - b| is 0.4592 standard deviations:
    sqrt(2) * sqrt(2 / pi) * (1 - exp(-q**2 / 2)) / 0.5 with q = 0.6745, the median.
    """
    steps = np.sort(np.abs(np.diff(light, axis=0)), axis=0)
    calm = steps[: max(1, round(_CALM_SHARE * len(steps)))]
    noise: Values = (calm.mean(axis=0) / 0.4592).astype(np.float32)
    return noise


def _single(light: Values, noise: Values) -> list[Finding]:
    findings = []
    typical = float(np.median(noise))
    limit = max(_LEAST_NOISE, _NOISE_RATIO * typical)
    least, most = light.min(axis=0), light.max(axis=0)
    varies = bool((most > least).any())
    for cell in range(light.shape[1]):
        low, high = float(least[cell]), float(most[cell])
        if high <= _DARK:
            fault: tuple[Kind, str] = (
                "dark",
                f"never above {high:.0f} of 255: always covered, or its LED, detector or wiring is "
                "dead",
            )
        elif low >= _FULL:
            fault = (
                "saturated",
                f"never below {low:.0f} of 255: detector shorted, or LED too bright",
            )
        elif low == high and varies:
            fault = "stuck", f"always {low:.0f} of 255, without noise: channel not connected"
        elif noise[cell] > limit:
            fault = (
                "noisy",
                f"noise of {noise[cell]:.1f} of 255; the median is {typical:.1f}: loose joint, or "
                "ambient light",
            )
        else:
            continue
        kind, detail = fault
        findings.append(Finding(kind, (cell,), detail))
    return findings


def _misplaced(light: Values, offsets: Pairs, usable: Mask) -> list[Finding]:
    check = "is the layout.json that of this board, and the wiring as in it?"
    value = order(light, offsets, usable)
    if value < LEAST_ORDER:
        detail = (
            f"correlations of cells do not fit the layout (order {value:.2f}; at least "
            f"{LEAST_ORDER} is normal): {check}"
        )
        return [Finding("astray", (), detail)]
    findings = []
    for swap in swaps(light, offsets, usable):
        part = "both halves" if swap.sure else "a part"
        remedy = check if swap.sure else "repeat for longer, moving in all directions"
        detail = (
            f"each fits the other's place better, in {part} of the recording (correlation better "
            f"by {swap.gain:.2f}): {remedy}"
        )
        findings.append(Finding("swapped", swap.cells, detail, swap.sure))
    return findings
