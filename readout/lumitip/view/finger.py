"""`Finger`: one fingertip as the live view sees it, read on a thread of its own."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from lumitip.errors import LinkError
from lumitip.fingertip import Fingertip
from lumitip.frame import Frame
from lumitip.layout import Layout
from lumitip.links.base import LinkEvent
from lumitip.processing import Contact, Processor
from lumitip.session.hub import Hub
from lumitip.view.recorder import Recorder

if TYPE_CHECKING:
    from lumitip.view.player import Player

_log = logging.getLogger(__name__)

KEPT = 256  # frames that a browser may catch up on
_MESSAGE_BYTES = 1 << 16


class Sink(Protocol):
    """Something that takes every frame besides the browsers."""

    def take(self, finger: "Finger", frame: Frame) -> None:
        """Take a frame, on the finger's thread."""


class Finger:
    """Reads every frame of a fingertip and keeps the last few. From any thread.

    Args:
        url: as it was given, for people.
        tip: open; closed together with the finger.
        sinks: each takes every frame too.
        player: what gives the frames, if they were recorded before.
    """

    def __init__(
        self,
        url: str,
        tip: Fingertip,
        sinks: tuple[Sink, ...] = (),
        player: "Player | None" = None,
    ) -> None:
        self.url = url
        self.tip = tip
        self.player = player
        self.count = 0
        """Frames read so far."""
        self.since = 0.0
        """`Frame.t` of the first frame (s)."""
        self.state = "connected"
        self.detail = ""
        self._given_up = False
        self._sinks = sinks
        self._processor = Processor(tip.layout)
        self._said: tuple[Frame, Contact] | None = None
        self._frames: deque[tuple[Frame, float]] = deque(maxlen=KEPT)
        self._most = max(1, min(KEPT, _MESSAGE_BYTES // (2 * len(tip.layout))))
        self._began = time.monotonic()
        self._lock = threading.Lock()
        self._recorder = Recorder()
        self._changed: Callable[[], None] = _nothing
        self._thread = threading.Thread(target=self._run, name="lumitip-view", daemon=True)

    @classmethod
    def open(
        cls,
        url: str,
        layout: Layout | Path | None = None,
        sinks: tuple[Sink, ...] = (),
        **options: Any,
    ) -> "Finger":
        """Connect to a fingertip; not yet read. `options` are those of `Fingertip.open`.

        Raises:
            LumitipError: as `Fingertip.open`.
        """
        if url.partition("://")[0].lower() == "replay":
            from lumitip.view.player import Player

            return cls.play(url, Player.of_url(url), sinks)
        events = _Later()
        tip = Fingertip.open(url, layout, on_event=events, **options)
        return events.to(cls(url, tip, sinks))

    @classmethod
    def play(cls, url: str, player: "Player", sinks: tuple[Sink, ...] = ()) -> "Finger":
        """A recording as a finger; not yet read."""
        events = _Later()
        hub = Hub(player, any_design=True, on_event=events)
        hub.start(timeout_s=5.0)
        return events.to(cls(url, Fingertip(hub, KEPT, calibrated=True), sinks, player))

    def start(self, changed: Callable[[], None]) -> None:
        """Begin to read; `changed` is called on the reading thread after each frame or event."""
        self._changed = changed
        self._began = time.monotonic()
        self._thread.start()

    def close(self) -> None:
        """End the recording, disconnect and stop reading."""
        self.tip.close()
        if self._thread.is_alive():
            self._thread.join()
        self._recorder.stop()

    def newer(self, count: int) -> tuple[list[tuple[Frame, float]], int]:
        """Frames after the first `count`, each with when it was read, newest last.

        Returns:
            As many of the newest as a message holds, and how many older ones are left out.
        """
        with self._lock:
            fresh = self.count - count
            number = min(fresh, self._most)
            frames = list(self._frames)[-number:] if number else []
        return frames, fresh - len(frames)

    def contact(self, frame: Frame) -> Contact:
        """What a frame says; worked out once for all browsers that show the same frame."""
        said = self._said
        if said is None or said[0] is not frame:
            said = self._said = frame, self._processor(frame.values)
        return said[1]

    def on_event(self, event: LinkEvent) -> None:
        """What happens to the link."""
        if self._given_up:
            return  # the link may live on, but nobody reads it
        states = {"connected": "connected", "lost": "lost", "ended": "ended", "failed": "failed"}
        self.state = states.get(event.kind, self.state)
        self.detail = event.detail
        self._changed()

    def record(self, path: Path) -> None:
        """Write every frame from now on to a file.

        Raises:
            LumitipError: if a recording runs already, or the file cannot be written.
        """
        self._recorder.start(path, self.tip)

    def stop_recording(self) -> Path | None:
        """End the recording; returns its file, `None` if there was none."""
        return self._recorder.stop()

    def status(self) -> dict[str, Any]:
        """State and statistics, as JSON can say them."""
        stats = self.tip.stats
        drift = self.tip.drift
        return {
            "state": self.state,
            "detail": self.detail,
            "read": self.count,
            "silent_s": self._silent_s(),
            "received": stats.received,
            "dropped": None if stats.dropped is None else dict(stats.dropped),
            "overflowed": stats.overflowed,
            "unreadable": stats.unreadable,
            "repeated": stats.repeated,
            "reconnects": stats.reconnects,
            "restarts": stats.restarts,
            "rate_hz": stats.rate_hz,
            "jitter_ms": stats.jitter_ms,
            "drift": None if drift is None else str(drift),
            "calibrated": self.tip.calibration.correction() is not None,
            "recording": self._recorder.status(),
            "player": self.player.status() if self.player else None,
        }

    def _silent_s(self) -> float | None:
        """Time since the last frame or the start; `None` of a replay, which may stand."""
        with self._lock:
            since = self._frames[-1][1] if self._frames else self._began
        return None if self.player else time.monotonic() - since

    def _run(self) -> None:
        try:
            for frame in self.tip.frames():
                self._take(frame)
            self.state = "ended"
        except LinkError as error:
            self._give_up(str(error))
        except BaseException as error:  # noqa: BLE001 - of a sink, Rerun's panics are no Exception
            _log.error("%s is read no more", self.url, exc_info=error)
            self._give_up(f"{type(error).__name__}: {error}")
        self._changed()

    def _give_up(self, why: str) -> None:
        self._given_up = True
        self.state, self.detail = "failed", why

    def _take(self, frame: Frame) -> None:
        with self._lock:
            if not self.count:
                self.since = frame.t
            self.count += 1
            self._frames.append((frame, time.monotonic()))
        self._recorder.write(frame)
        for sink in self._sinks:
            sink.take(self, frame)
        self._changed()


class _Later:
    """Hands events to a finger that is made after the link has begun to report them."""

    def __init__(self) -> None:
        self._finger: Finger | None = None

    def __call__(self, event: LinkEvent) -> None:
        if self._finger:
            self._finger.on_event(event)

    def to(self, finger: Finger) -> Finger:
        """Hand them to this one from now on."""
        self._finger = finger
        return finger


def _nothing() -> None:
    pass
