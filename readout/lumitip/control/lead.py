"""`Lead`: the line as it will lie when a command takes effect, a frame and an actuator later."""

import math
from dataclasses import replace

from lumitip.control.sight import Sight

SMOOTHING_S = 0.04
"""Time constant over which the turning of the line is averaged: two frames or so (s)."""
_MOST = math.radians(70.0)


class Lead:
    """`sight = lead(sight, dt_s)`: its angle goes on turning as it did, for `lead_s`."""

    def __init__(self, lead_s: float) -> None:
        """A lead that has seen nothing yet.

        Args:
            lead_s: how much later commands take effect; 0 leaves all as it is seen (s).
        """
        self.lead_s = lead_s
        self.reset()

    def reset(self) -> None:
        """Forget what was seen."""
        self._angle: float | None = None
        self._rate = 0.0

    def __call__(self, sight: Sight, dt_s: float) -> Sight:
        """What will be seen of what is seen now, `dt_s` after the one before (s)."""
        if not self.lead_s or sight.height_mm is None:
            self.reset()
            return sight
        if self._angle is not None and dt_s > 0.0:
            fresh = 1.0 - math.exp(-dt_s / SMOOTHING_S)
            self._rate += fresh * ((sight.angle - self._angle) / dt_s - self._rate)
        self._angle = sight.angle
        ahead = sight.angle + self.lead_s * self._rate
        return replace(sight, angle=min(max(ahead, -_MOST), _MOST))
