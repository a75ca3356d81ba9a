"""`Newest`: the newest frame of a link, its age, and whether a reader may still take it."""

import time
from dataclasses import dataclass

from lumitip.frame import Frame, RecordedFrame
from lumitip.links.base import Arrival


@dataclass(frozen=True, eq=False)
class Newest:
    """The newest frame of a link."""

    frame: Frame
    read_s: float
    """When it was read, of a recording when it arrived; by `time.monotonic` (s)."""
    cut_off: bool = False
    """Whether the link was cut since."""

    @classmethod
    def of(cls, frame: Frame, arrival: Arrival) -> "Newest":
        """The last frame of an arrival."""
        as_arrived = isinstance(arrival.content, RecordedFrame) or frame.t_device is None
        return cls(frame, arrival.t_host if as_arrived else min(frame.t, frame.t_host))

    @property
    def age_s(self) -> float:
        """Time since it was read (s)."""
        return time.monotonic() - self.read_s

    def is_outdated(self, first: bool, connected: bool, max_age_s: float | None) -> bool:
        """Whether a reader that waits for a frame of now must pass it over.

        Args:
            first: whether the reader got no frame yet.
            connected: whether the link is connected now.
            max_age_s: its longest wait (s); `None`: without limit.
        """
        too_old = max_age_s is not None and self.age_s > max_age_s
        if first:
            return too_old or not connected
        return self.cut_off and (too_old or max_age_s is None)
