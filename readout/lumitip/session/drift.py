"""Drift of the cells during warm-up, measured without an empty grasp.

LEDs lose light as they warm up. Each cell's maximum in a first and in a later span of time shows
the drift, if the cell was free for a moment in both; otherwise it shows the object.
"""

from dataclasses import dataclass

import numpy as np

from lumitip.frame import Codes, Values, complement
from lumitip.values import one_line

WARM_UP_S = 300.0
_SMOOTH_S = 0.5
_SPAN_S = 15.0


@dataclass(frozen=True, eq=False)
class Drift:
    """Change of the cells' maxima since the first span."""

    watched_s: float
    """Time between the first and the last span (s)."""
    change: Values
    """Change of light of each cell, 255 is full light, not calibrated, shape `(cells,)`."""
    warm: bool
    """Whether five minutes have passed since power-on, or for a legacy device since the start."""

    def __repr__(self) -> str:
        return one_line(self)

    def __str__(self) -> str:
        least, most = float(self.change.min()), float(self.change.max())
        state = "warm" if self.warm else "warming up"
        return f"{state}; cells changed by {least:+.1f} to {most:+.1f} in {self.watched_s:.0f} s"


class DriftWatch:
    """Measures the drift. Call `add` from one thread; read `drift` from any."""

    def __init__(self) -> None:
        self.drift: Drift | None = None
        """`None` before the end of the second span."""
        self._first: tuple[float, Values] | None = None
        self._span_from = self._part_from = -np.inf
        self._sum: Values | None = None
        self._number = 0
        self._brightest: Values | None = None

    def add(self, raw: Codes, bits: int, t: float, t_device: float | None) -> bool:
        """Add a frame, fields as in `Frame`; returns whether the warm-up has just ended."""
        light = complement(raw, bits)
        if self._sum is None:
            self._span_from, self._part_from, self._sum = t, t, np.zeros_like(light)
        self._sum += light
        self._number += 1
        if t - self._part_from < _SMOOTH_S:
            return False
        mean: Values = self._sum / np.float32(self._number)
        self._brightest = mean if self._brightest is None else np.maximum(self._brightest, mean)
        self._part_from, self._number = t, 0
        self._sum[:] = 0
        if t - self._span_from < _SPAN_S:
            return False
        return self._span_ended(self._brightest, t, t_device)

    def _span_ended(self, brightest: Values, t: float, t_device: float | None) -> bool:
        self._span_from, self._brightest = t, None
        if self._first is None:
            self._first = t, brightest
            return False
        since, before = self._first
        on_s = t - since if t_device is None else t_device
        was_warm = self.drift.warm if self.drift else on_s - (t - since) >= WARM_UP_S
        self.drift = Drift(t - since, brightest - before, warm=on_s >= WARM_UP_S)
        return self.drift.warm and not was_warm
