"""`Pace`: work on frames in order; where the work is too slow for that, on the newest."""

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

from lumitip import Frame

BEHIND_S = 0.05
"""Longest wait of a frame (s). Not shorter: Bluetooth delivers the frames of a connection interval
together, which is not a reason to skip any."""


@dataclass
class Published:
    """Frames published since the node was configured."""

    number: int = 0
    skipped: int = 0
    """Received while the node was active, and not published: it was behind."""
    newest_s: float | None = None
    """When the cells of the last one were read; before the first, when the node was activated
    (`time.monotonic`, s). `None` while the node is not active."""


class Pace:
    """Calls `work` with frames on its own thread, until `stop`.

    Once a frame has waited for `BEHIND_S`, `work` gets only the newest one, until it has to wait
    for a frame again.

    Args:
        work: called with a frame and the time of its arrival (`time.monotonic`, s); must not raise.
        every: whether nothing is skipped; `put` waits instead.
        published: where skipped frames are counted.
    """

    def __init__(
        self, work: Callable[[Frame, float], None], every: bool, published: Published
    ) -> None:
        self._work = work
        self._every = every
        self._published = published
        self._waiting: deque[tuple[Frame, float]] = deque()
        self._changed = threading.Condition()
        self._behind = self._stopped = False
        self._thread = threading.Thread(target=self._run, name="lumitip-publisher", daemon=True)
        self._thread.start()

    def put(self, frame: Frame) -> None:
        """Add a frame that has just arrived; after `stop` it is discarded."""
        with self._changed:
            while self._every and self._waiting and not self._stopped:
                self._changed.wait()
            if self._stopped:
                return
            self._waiting.append((frame, time.monotonic()))
            self._skip()  # here too: the queue stays short while `work` hangs
            self._changed.notify_all()

    def stop(self) -> None:
        """Discard the waiting frames and end the thread, after the frame that it works on."""
        with self._changed:
            self._stopped = True
            self._waiting.clear()
            self._changed.notify_all()
        self._thread.join()

    def _run(self) -> None:
        while waiting := self._next():
            self._work(*waiting)

    def _next(self) -> tuple[Frame, float] | None:
        with self._changed:
            while not self._waiting and not self._stopped:
                self._behind = False
                self._changed.wait()
            if self._stopped:
                return None
            self._skip()
            self._changed.notify_all()
            return self._waiting.popleft()

    def _skip(self) -> None:
        _, since_s = self._waiting[0]
        if time.monotonic() - since_s > BEHIND_S:
            self._behind = True
        if self._behind and not self._every:
            while len(self._waiting) > 1:
                self._waiting.popleft()
                self._published.skipped += 1
