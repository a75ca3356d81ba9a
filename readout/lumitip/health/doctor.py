"""What is wrong with the cells of a fingertip, told from a recording of a few seconds.

Dead, stuck, saturated and noisy cells show themselves by their own values. Swapped cells show
themselves while an object moves over them all, however thin: see `lumitip.health.swaps`. That is
evidence of wrong wiring or of another `layout.json`, and says how good it is.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from lumitip import arguments
from lumitip.errors import ArgumentError
from lumitip.frame import Values
from lumitip.health.swaps import LEAST_ORDER, Mask, Pairs, enough_ways, order, swaps, ways_of
from lumitip.layout import Layout

Kind = Literal["dark", "saturated", "stuck", "noisy", "swapped", "astray"]

_DARK = 12.75  # a twentieth of full light
_FULL = 254.0
_LEAST_NOISE = 4.0  # counts of 255 that no healthy cell reaches
_NOISE_RATIO = 5.0  # to the median cell
_MOVED = 15.0  # standard deviation of a cell that an object passed
_MOVED_SHARE = 0.8  # of the cells, for neighbours to be compared
_CALM_SHARE = 0.5


@dataclass(frozen=True)
class Finding:
    """Something wrong with one cell, with a pair, or with all."""

    kind: Kind
    cells: tuple[int, ...]
    """Their numbers; empty if it is all of them."""
    detail: str
    """For people: what was seen, what to look at."""
    sure: bool = True
    """Whether both halves of the recording say so; otherwise look again, for longer."""


@dataclass(frozen=True, eq=False)
class Report:
    """What was found."""

    findings: tuple[Finding, ...]
    noise: Values
    """Standard deviation from frame to frame of each cell, 255 is full light, shape `(cells,)`."""
    unseen: str | None
    """Why swapped cells could not show, for people; `None` if they could."""


def examine(light: Values, layout: Layout) -> Report:
    """Look for cells that cannot be trusted.

    Args:
        light: not calibrated, 255 is full light, shape `(n, cells)`, at least two frames.
        layout: the cells.

    Raises:
        LayoutError: if it is no layout.
        ArgumentError: if they are no numbers, or there are fewer frames or other cells.
    """
    arguments.layout(layout)
    light = arguments.numbers(light, "light").astype(np.float32, copy=False)
    if light.ndim != 2 or len(light) < 2 or light.shape[1] != len(layout):
        raise ArgumentError(
            f"light of shape {light.shape} given, (2 or more, {len(layout)}) is needed"
        )
    noise = _noise(light)
    findings = _single(light, noise)
    suspect = {cell for finding in findings for cell in finding.cells}
    moving = light.std(axis=0) > _MOVED
    ways = ways_of(layout)
    unseen = _unseen(moving, ways)
    if unseen is None:
        usable = moving & ~np.isin(np.arange(len(layout)), list(suspect))
        findings += _misplaced(light, ways, usable)
    return Report(tuple(findings), noise, unseen)


def _unseen(moving: Mask, ways: Pairs) -> str | None:
    if not enough_ways(ways):
        return f"of {len(ways)} cells, too few lie alike for swapped ones to show"
    share = float(moving.mean())
    if share < _MOVED_SHARE:
        return (
            f"something moved over {share:.0%} of the cells, for swapped ones to show at least "
            f"{_MOVED_SHARE:.0%} are needed: move an object over all of them, in all directions"
        )
    return None


def _noise(light: Values) -> Values:
    """Deviation from frame to frame, of the calmest steps, so that a passing object counts little.

    For normal noise the mean of the lower half of |a - b| is 0.4592 of its standard deviation:
    sqrt(2) * sqrt(2 / pi) * (1 - exp(-q**2 / 2)) / 0.5 with q = 0.6745, the median.
    """
    steps = np.sort(np.abs(np.diff(light, axis=0)), axis=0)
    calm = steps[: max(1, round(_CALM_SHARE * len(steps)))]
    noise: Values = (calm.mean(axis=0) / 0.4592).astype(np.float32)
    return noise


def _single(light: Values, noise: Values) -> list[Finding]:
    findings = []
    usual = float(np.median(noise))
    least, most = light.min(axis=0), light.max(axis=0)
    lively = bool((most > least).any())
    for cell in range(light.shape[1]):
        low, high = float(least[cell]), float(most[cell])
        if high <= _DARK:
            findings.append(
                Finding(
                    "dark",
                    (cell,),
                    f"never above {high:.0f} of 255: covered "
                    "all the time, or its LED, detector or wiring is "
                    "dead",
                )
            )
        elif low >= _FULL:
            findings.append(
                Finding(
                    "saturated",
                    (cell,),
                    f"never below {low:.0f} of 255: the "
                    "detector is shorted, or its LED is too bright",
                )
            )
        elif low == high and lively:
            findings.append(
                Finding(
                    "stuck",
                    (cell,),
                    f"always {low:.0f} of 255, without noise: the channel is not connected",
                )
            )
        elif noise[cell] > max(_LEAST_NOISE, _NOISE_RATIO * usual):
            findings.append(
                Finding(
                    "noisy",
                    (cell,),
                    f"noise of {noise[cell]:.1f} of 255, "
                    f"{usual:.1f} is usual here: a loose joint or ambient "
                    "light",
                )
            )
    return findings


def _misplaced(light: Values, ways: Pairs, usable: Mask) -> list[Finding]:
    ordered = order(light, ways, usable)
    if ordered < LEAST_ORDER:
        told = (
            f"pairs that lie alike do not darken alike (order {ordered:.2f}, usual is "
            f"{LEAST_ORDER} or more): is the layout.json that of this board, is the wiring as it "
            "says?"
        )
        return [Finding("astray", (), told)]
    return [
        Finding(
            "swapped",
            swap.cells,
            f"each goes with the other's surroundings, in "
            f"{'both halves' if swap.sure else 'a part'} of the recording "
            f"(nearer by {swap.gain:.2f} of correlation): "
            + (
                "is the layout.json that of this board, is the wiring as it says?"
                if swap.sure
                else "look again, longer, and move in all directions"
            ),
            swap.sure,
        )
        for swap in swaps(light, ways, usable)
    ]
