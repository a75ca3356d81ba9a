"""`Player`: a recording as a link with pause, seek and speed.

It pauses at the end, so it never reports `"ended"`.
"""

import threading
import time
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np

from lumitip.errors import ViewError
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Deliver, LinkEvent, Report
from lumitip.links.url import Url
from lumitip.recording import LONGEST_GAP_S, Reader

MOST_BYTES = 1 << 29
SLOWEST, FASTEST = 0.1, 16.0


def content_of(path: Path) -> tuple[str, int, int]:
    """Path, time of change and size of a file: the same while its content is."""
    found = path.stat()
    return str(path.resolve()), found.st_mtime_ns, found.st_size


class Player:
    """Plays the frames of a recording. Thread-safe.

    Args:
        path: of the recording; damaged parts are skipped.
        speed: factor.
        finger: name of a fingertip in a file with several.

    Raises:
        LumitipError: if the file is not a recording, is empty or too large, or has several
            fingertips and not the one that is named.
    """

    def __init__(self, path: Path, speed: float = 1.0, finger: str | None = None) -> None:
        reader = Reader(path, tolerant=True, finger=finger)
        self.content = content_of(path)
        """See `content_of`."""
        self.layout: Layout = reader.layout
        self.device_id = reader.metadata.device_id
        self.calibration = reader.metadata.calibration
        most = MOST_BYTES // (1024 + 2 * len(self.layout))
        self._frames = list(islice(reader, most + 1))
        if len(self._frames) > most:
            raise ViewError(
                f"{path} has more than {most} frames, the limit of the player. `lumitip replay` "
                "reads files of any length"
            )
        if not self._frames:
            raise ViewError(f"{path} has no frame")
        self._damage = f"damaged: {'; '.join(reader.damage[:3])}" if reader.damage else ""
        walls = np.array([f.t_wall for f in self._frames])
        # The wall clock may have been set back during the recording.
        steps = np.clip(np.diff(walls, prepend=walls[0]), 0.0, LONGEST_GAP_S)
        self._at_s = np.cumsum(steps)
        self._changed = threading.Condition()
        self._next = 0
        self._speed = speed
        self._playing = True
        self._sought = False
        self._since: tuple[float, float] | None = None
        self._stopping = False
        self._thread: threading.Thread | None = None

    @classmethod
    def of_url(cls, text: str) -> "Player":
        """The player of `replay://FILE?speed=2&finger=NAME`.

        Raises:
            LumitipError: if the address is wrong, or as the class.
        """
        url = Url.parse(text)
        url.allow("speed", "finger")
        speed = url.number("speed", 1.0, SLOWEST, FASTEST)
        return cls(url.path, speed, url.options.get("finger"))

    def start(self, deliver: Deliver, report: Report) -> None:
        """Start playing."""
        self._thread = threading.Thread(
            target=self._run, args=(deliver, report), name="lumitip-player", daemon=True
        )
        self._thread.start()

    def stop(self) -> None:
        """Stop playing."""
        with self._changed:
            self._stopping = True
            self._changed.notify_all()
        if self._thread and self._thread is not threading.current_thread():
            self._thread.join()

    def control(
        self,
        playing: bool | None = None,
        position_s: float | None = None,
        speed: float | None = None,
    ) -> None:
        """Pause or play, seek, change the speed; `None` changes nothing.

        Raises:
            ViewError: if the speed is out of range.
        """
        if speed is not None and not SLOWEST <= speed <= FASTEST:
            raise ViewError(f"speed is {speed:g}; allowed are {SLOWEST:g} to {FASTEST:g}")
        with self._changed:
            if position_s is not None:
                self._next = self._index(position_s)
                self._sought = True
            if playing is not None:
                if playing and self._next >= len(self._frames):
                    self._next = 0
                self._playing = playing
            self._speed = speed or self._speed
            self._since = None
            self._changed.notify_all()

    def status(self) -> dict[str, Any]:
        """State for JSON."""
        with self._changed:
            last = max(0, min(self._next, len(self._frames)) - 1)
            return {
                "playing": self._playing,
                "position_s": float(self._at_s[last]),
                "length_s": float(self._at_s[-1]),
                "speed": self._speed,
                "damage": self._damage,
            }

    def _index(self, position_s: float) -> int:
        """The frame nearest to a time."""
        return int(np.abs(self._at_s - position_s).argmin())

    def _run(self, deliver: Deliver, report: Report) -> None:
        report(LinkEvent("connected", f"a recording of {self.device_id}"))
        first = True
        while (number := self._wait()) is not None:
            deliver(Arrival(time.monotonic(), self._frames[number], patient=first))
            if first:  # time begins when the frame was taken
                first = False
                with self._changed:
                    self._since = None

    def _wait(self) -> int | None:
        """Wait for the next frame; returns its number, `None` to stop."""
        with self._changed:
            while not self._stopping and not self._sought:
                if self._next >= len(self._frames):
                    self._playing = False
                if not self._playing:
                    self._since = None
                    self._changed.wait()
                    continue
                left_s = self._left_s()
                if left_s <= 0:
                    break
                self._changed.wait(left_s)
            # After a seek the frame is sent at once, also while paused.
            self._sought = False
            self._next += 1
            return None if self._stopping else self._next - 1

    def _left_s(self) -> float:
        """Time until the next frame (s), from the last start of playing: errors do not add up."""
        at_s, now = float(self._at_s[self._next]), time.monotonic()
        if self._since is None:
            self._since = now, at_s
        began, began_at_s = self._since
        return began + (at_s - began_at_s) / self._speed - now
