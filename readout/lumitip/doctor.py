"""What is wrong with the cells of a fingertip, told from a recording of a few seconds.

Dead, stuck, saturated and noisy cells show themselves by their own values. Swapped cells show
themselves while an object moves over them all: neighbours darken together, so a pair of cells that
would go with each other's neighbours better than with their own looks swapped. That is evidence of
wrong wiring or of another `layout.json`, no proof.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from lumitip.frame import Values
from lumitip.grid import Floats, Integers
from lumitip.layout import Layout

Kind = Literal["dark", "saturated", "stuck", "noisy", "swapped"]

_DARK = 12.75  # a twentieth of full light
_FULL = 254.0
_LEAST_NOISE = 4.0  # counts of 255 that no healthy cell reaches
_NOISE_RATIO = 5.0  # to the median cell
_MOVED = 15.0  # standard deviation of a cell that an object passed
_MOVED_SHARE = 0.8  # of the cells, for neighbours to be compared
_CALM_SHARE = 0.5
_SWAP_GAIN = 0.1
"""Least gain of correlation for each neighbour. On the twin (20 s of a disc, a corner or a
9 mm cable) a sound fingertip stays below 0.01, swaps of distant cells reach 0.3 to 0.8, of
neighbours 0.05 to 0.3: about half of those are not seen. Under a cable thinner than two pitches
that moves to and fro, neighbours differ and sound cells look swapped."""


@dataclass(frozen=True)
class Finding:
    """Something wrong with one cell, or with a pair."""

    kind: Kind
    cells: tuple[int, ...]
    detail: str
    """For people: what was seen, what to look at."""


@dataclass(frozen=True, eq=False)
class Report:
    """What was found."""

    findings: tuple[Finding, ...]
    noise: Values
    """Standard deviation from frame to frame of each cell, 255 is full light, shape `(cells,)`."""
    moved: bool
    """Whether enough moved for swapped cells to show."""


def examine(light: Values, layout: Layout) -> Report:
    """Look for cells that cannot be trusted.

    Args:
        light: not calibrated, 255 is full light, shape `(n, cells)`, at least two frames.
        layout: the cells.

    Raises:
        ValueError: if there are fewer frames or other cells.
    """
    if light.ndim != 2 or len(light) < 2 or light.shape[1] != len(layout):
        raise ValueError(
            f"light of shape {light.shape} given, (2 or more, {len(layout)}) is needed"
        )
    noise = _noise(light)
    findings = _single(light, noise)
    suspect = {cell for finding in findings for cell in finding.cells}
    moving = light.std(axis=0) > _MOVED
    moved = bool(moving.mean() >= _MOVED_SHARE)
    if moved:
        usable = moving & ~np.isin(np.arange(len(layout)), list(suspect))
        findings += _swapped(light, layout.neighbours, usable)
    return Report(tuple(findings), noise, moved)


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
            findings.append(Finding("dark", (cell,), f"never above {high:.0f} of 255: covered "
                                    "all the time, or its LED, detector or wiring is "
                                    "dead"))  # fmt: skip
        elif low >= _FULL:
            findings.append(Finding("saturated", (cell,), f"never below {low:.0f} of 255: the "
                                    "detector is shorted, or its LED is too bright"))  # fmt: skip
        elif low == high and lively:
            findings.append(Finding("stuck", (cell,), f"always {low:.0f} of 255, without noise: "
                                    "the channel is not connected"))  # fmt: skip
        elif noise[cell] > max(_LEAST_NOISE, _NOISE_RATIO * usual):
            findings.append(Finding("noisy", (cell,), f"noise of {noise[cell]:.1f} of 255, "
                                    f"{usual:.1f} is usual here: a loose joint or ambient "
                                    "light"))  # fmt: skip
    return findings


def _swapped(
    light: Values, neighbours: Integers, usable: np.ndarray[tuple[int], np.dtype[np.bool_]]
) -> list[Finding]:
    with np.errstate(invalid="ignore"):
        alike: Floats = np.atleast_2d(np.nan_to_num(np.corrcoef(light.T.astype(np.float64))))
    beside = np.zeros_like(alike)
    beside[neighbours[:, 0], neighbours[:, 1]] = beside[neighbours[:, 1], neighbours[:, 0]] = 1.0
    beside *= np.outer(usable, usable)
    findings = []
    place = np.arange(len(alike))
    for _ in range(len(alike) // 2):
        gain = _gains(alike[np.ix_(place, place)], beside)
        i, j = (int(n) for n in np.unravel_index(int(gain.argmax()), gain.shape))
        if gain[i, j] < _SWAP_GAIN:
            break
        place[[i, j]] = place[[j, i]]
        beside[i] = beside[:, i] = beside[j] = beside[:, j] = 0.0
        told = (
            "each goes with the other's neighbours: is the layout.json that of this board, is the "
            "wiring as it says?"
        )
        findings.append(Finding("swapped", (min(i, j), max(i, j)), told))
    return findings


def _gains(alike: Floats, beside: Floats) -> Floats:
    """By how much swapping two cells would make neighbours alike, for each neighbour."""
    with_other = alike @ beside  # [i, j]: how much i is like the neighbours of j
    own = np.diag(with_other)
    gain = with_other + with_other.T - own[:, None] - own[None, :]
    # A neighbour is not its own neighbour once swapped.
    gain -= 2.0 * beside * (1.0 - alike)
    degree = beside.sum(axis=0)
    both = degree[:, None] + degree[None, :]
    shared: Floats = np.where(
        (degree[:, None] > 0) & (degree[None, :] > 0), gain / np.maximum(both, 1.0), -1.0
    )
    np.fill_diagonal(shared, -1.0)
    return shared
