"""`FrameQueue`: a bounded queue between the thread of a link and a reader."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable, Sequence

from lumitip.errors import ArgumentError, LinkError
from lumitip.frame import Frame

_log = logging.getLogger(__name__)

PATIENCE_S = 5.0
"""Time that a recording waits for an idle reader (s)."""
BEHIND_S = 0.5
"""Time that a frame may wait in a queue without a warning (s)."""
_CAUGHT_UP_S = 0.1  # a reader that is less behind is warned at `BEHIND_S` again


class FrameQueue:
    """Frames in order; when full, the oldest are dropped. Thread-safe.

    Args:
        size: largest number of frames.
        notify: called on the link's thread after each change.
        counted: whether dropped frames count as lost; not if only the newest is wanted.
    """

    def __init__(
        self, size: int, notify: Callable[[], None] | None = None, counted: bool = True
    ) -> None:
        if size < 1:
            raise ArgumentError(f"buffer is {size}; at least 1 frame is needed")
        self.counted = counted
        self._frames: deque[tuple[Frame, float]] = deque(maxlen=size)
        self._changed = threading.Condition()
        self._notify = notify
        self._closed: LinkError | None = None
        self._waits = self._idle = False
        self._warns = counted  # of the frames that came last
        self._warns_at_s = BEHIND_S

    def put(self, frames: Sequence[Frame], wait: bool = False) -> int:
        """Add frames; returns the number of frames dropped.

        Args:
            frames: in order.
            wait: wait for room instead; but not for a reader idle for `PATIENCE_S`.
        """
        with self._changed:
            while wait and self._frames and self._full(len(frames)) and not self._gone():
                self._waits = True
                self._idle = not self._changed.wait(PATIENCE_S)
            before, now_s = len(self._frames), time.monotonic()
            self._frames.extend((frame, now_s) for frame in frames)
            self._warns = self.counted and not wait  # a recording waits for its reader
            lost = before + len(frames) - len(self._frames)
            self._changed.notify_all()
        if self._notify:
            self._notify()
        return lost

    def close(self, reason: LinkError) -> None:
        """End the queue: after its last frame, `get` raises the reason."""
        with self._changed:
            self._closed = self._closed or reason
            self._changed.notify_all()
        if self._notify:
            self._notify()

    def cancel(self, reason: LinkError) -> None:
        """Close the queue and discard its frames."""
        with self._changed:
            self._frames.clear()
        self.close(reason)

    def get(self, timeout_s: float | None) -> Frame | None:
        """The next frame, or `None` after `timeout_s`; no limit if that is `None`.

        Raises:
            LinkError: the reason, if the queue is closed and empty.
        """
        until = None if timeout_s is None else time.monotonic() + timeout_s
        with self._changed:
            while not self._frames:
                if self._closed:
                    raise self._closed.with_traceback(None)
                left = None if until is None else until - time.monotonic()
                if left is not None and left <= 0:
                    return None
                self._changed.wait(None if left is None else min(left, threading.TIMEOUT_MAX))
            self._idle = False
            if self._waits:
                self._waits = False
                self._changed.notify_all()
            frame, since_s = self._frames.popleft()
            waiting, behind_s = len(self._frames), time.monotonic() - since_s
            warns = self._warns and self._is_news(behind_s)
        if warns:
            _log.warning(
                "%s: this reader is %.1f s behind, %d frames wait in its queue. Use wait_latest() "
                "if only the newest frame matters; to get every frame, read faster",
                frame.device_id,
                behind_s,
                waiting,
            )
        return frame

    def _is_news(self, behind_s: float) -> bool:
        """Whether a delay is due for a warning: the first long one, and each doubling of it."""
        news = behind_s > self._warns_at_s
        if news:
            self._warns_at_s = 2.0 * behind_s
        elif behind_s < _CAUGHT_UP_S:
            self._warns_at_s = BEHIND_S
        return news

    def _gone(self) -> bool:
        return self._idle or self._closed is not None

    def _full(self, more: int) -> bool:
        return len(self._frames) + more > (self._frames.maxlen or 0)
