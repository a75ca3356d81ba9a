"""`Finger`: one fingertip of the live view, read on its own thread."""

import logging
import threading
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from lumitip.calibration import Kind
from lumitip.errors import LinkError, ViewError
from lumitip.fingertip import Fingertip
from lumitip.frame import Frame
from lumitip.layout import Layout
from lumitip.links.base import LinkEvent
from lumitip.links.url import redacted
from lumitip.processing import Contact, Processor
from lumitip.session.hub import Hub
from lumitip.view.estimating import EXPECTED, Estimates, Expected
from lumitip.view.recorder import Recorder

if TYPE_CHECKING:
    from lumitip.view.player import Player

_log = logging.getLogger(__name__)

KEPT = 256  # frames kept for slow browsers
_MESSAGE_BYTES = 1 << 16


class Sink(Protocol):
    """A receiver of every frame besides the browsers."""

    def take(self, finger: "Finger", frame: Frame) -> None:
        """Called with each frame on the finger's thread."""


class Finger:
    """Reads every frame of a fingertip and keeps the last ones. Thread-safe.

    Args:
        url: address, for the user.
        tip: open; `close` closes it.
        sinks: receive every frame too.
        player: the source of the frames of a recording.
        expected: by the estimates.
    """

    def __init__(
        self,
        url: str,
        tip: Fingertip,
        sinks: tuple[Sink, ...] = (),
        player: "Player | None" = None,
        expected: Expected = EXPECTED,
    ) -> None:
        self.url = redacted(url)
        self.tip = tip
        self.player = player
        self.count = 0
        """Number of frames read."""
        self.since = 0.0
        """`Frame.t` of the first frame (s)."""
        self.state = "connected"
        self.detail = ""
        self.estimates = Estimates(tip.layout, expected)
        self.warning = ""
        """A fault that does not end the reading."""
        self._failed = False
        self._sinks = sinks
        self._processor = Processor(tip.layout)
        self._cached: tuple[Frame, Contact] | None = None
        self._frames: deque[tuple[Frame, float]] = deque(maxlen=KEPT)
        self._most = max(1, min(KEPT, _MESSAGE_BYTES // (2 * len(tip.layout))))
        self._began = time.monotonic()
        self._lock = threading.Lock()
        self._recorder = Recorder()
        self._taring = False
        self._references = threading.Lock()  # held while a tare or a recording starts
        self._changed: Callable[[], None] = lambda: None
        self._thread = threading.Thread(target=self._run, name="lumitip-view", daemon=True)

    @classmethod
    def open(
        cls,
        url: str,
        layout: Layout | Path | None = None,
        sinks: tuple[Sink, ...] = (),
        *,
        timeout: float | None = 10.0,
        any_design: bool = False,
        gap_mm: float | None = None,
        diameter_mm: float | None = None,
    ) -> "Finger":
        """Connect to a fingertip; arguments as of `Fingertip.open` and `Expected.of`.

        Raises:
            LumitipError: as `Fingertip.open`, or if gap or diameter is out of range.
        """
        if url.partition("://")[0].lower() == "replay":
            from lumitip.view.player import Player

            expected = Expected.of(url, gap_mm, diameter_mm)
            return cls.play(url, Player.of_url(url), sinks, expected)
        events = _Later()
        tip = Fingertip.open(url, layout, timeout=timeout, any_design=any_design, on_event=events)
        try:
            return events.to(cls(url, tip, sinks, None, Expected.of(url, gap_mm, diameter_mm)))
        except BaseException:
            tip.close()
            raise

    @classmethod
    def play(
        cls,
        url: str,
        player: "Player",
        sinks: tuple[Sink, ...] = (),
        expected: Expected = EXPECTED,
    ) -> "Finger":
        """A finger that replays a recording."""
        events = _Later()
        hub = Hub(player, any_design=True, on_event=events)
        tip = Fingertip(hub, KEPT, calibrated=True, timeout_s=5.0)
        return events.to(cls(url, tip, sinks, player, expected))

    def start(self, changed: Callable[[], None]) -> None:
        """Start reading; `changed` is called on the reading thread after each frame or event."""
        self._changed = changed
        self._began = time.monotonic()
        self._thread.start()
        self.estimates.start(changed)

    def close(self) -> None:
        """End the recording, disconnect and stop reading."""
        self.tip.close()
        self.estimates.close()
        if self._thread.is_alive():
            self._thread.join()
        self._recorder.stop()

    def newer(self, count: int) -> tuple[list[tuple[Frame, float]], int]:
        """Frames after the first `count`, each with its time of reading, newest last.

        Returns:
            The newest, as many as fit into a message; and the number of those skipped.
        """
        with self._lock:
            fresh = self.count - count
            number = min(fresh, self._most)
            frames = list(self._frames)[-number:] if number else []
        return frames, fresh - len(frames)

    def contact(self, frame: Frame) -> Contact:
        """The contact of a frame; computed once for all browsers."""
        cached = self._cached
        if cached is None or cached[0] is not frame:
            cached = self._cached = frame, self._processor(frame.values)
        return cached[1]

    def on_event(self, event: LinkEvent) -> None:
        """Update the state from an event of the link."""
        if self._failed:
            return  # reading has stopped
        if event.kind in ("connected", "lost", "ended", "failed"):
            self.state = event.kind
        self.detail = event.detail
        self._changed()

    def tare(self, kind: Kind) -> None:
        """Measure a reference, but not during a recording, which has the references of its start.

        Raises:
            LumitipError: as `Fingertip.tare`, or if a recording or another tare is running.
        """
        with self._references:
            self._refuse_while_taring("tare again afterwards")
            recording = self._recorder.status()
            if recording and recording["on"]:
                raise ViewError(
                    f"{recording['file']} is being recorded with the references of its start. "
                    "Stop it, then tare"
                )
            self._taring = True
        try:
            self.tip.tare(kind)
        finally:
            self._taring = False

    def record(self, path: Path) -> None:
        """Start a recording.

        Raises:
            LumitipError: as `Recorder.start`, or if a reference is being measured.
        """
        with self._references:
            self._refuse_while_taring("record afterwards")
            self._recorder.start(path, self.tip)

    def _refuse_while_taring(self, remedy: str) -> None:
        if self._taring:
            raise ViewError(f"{self.tip.device_id}: a reference is being measured; {remedy}")

    def stop_recording(self) -> Path | None:
        """End the recording; returns its file, `None` if there was none."""
        return self._recorder.stop()

    def is_recording_to(self, name: str) -> bool:
        """Whether a recording of this name is being written."""
        recording = self._recorder.status()
        return recording is not None and recording["on"] and recording["file"] == name

    def status(self) -> dict[str, Any]:
        """State and statistics for JSON."""
        stats = self.tip.stats
        drift = self.tip.drift
        return {
            "state": self.state,
            "detail": self.detail,
            "warning": self.warning,
            "read": self.count,
            "silent_s": self._silent_s(),
            **vars(stats),
            "dropped": None if stats.dropped is None else dict(stats.dropped),
            "drift": None if drift is None else str(drift),
            "calibrated": self.tip.calibration.correction() is not None,
            "estimates": {"state": self.estimates.state, "detail": self.estimates.detail},
            "taring": self._taring,
            "recording": self._recorder.status(),
            "scene": self.tip.simulated.placement() if self.tip.simulated else None,
            "player": self.player.status() if self.player else None,
        }

    def _silent_s(self) -> float | None:
        """Time since the last frame or the start (s); `None` for a replay, which may be paused."""
        with self._lock:
            since = self._frames[-1][1] if self._frames else self._began
        return None if self.player else time.monotonic() - since

    def _run(self) -> None:
        try:
            for frame in self.tip.frames():
                self._take(frame)
            self.state = "ended"
        except LinkError as error:
            self._fail(str(error))
        except Exception as error:  # noqa: BLE001 - the thread ends; the page says why
            _log.exception("reading of %s has stopped", self.url)
            self._fail(f"{type(error).__name__}: {error}")
        self._changed()

    def _fail(self, why: str) -> None:
        self._failed = True
        self.state, self.detail = "failed", why
        self._recorder.fail(why)

    def _take(self, frame: Frame) -> None:
        with self._lock:
            if not self.count:
                self.since = frame.t
            self.count += 1
            self._frames.append((frame, time.monotonic()))
        self._recorder.write(frame)
        for sink in self._sinks:
            try:
                sink.take(self, frame)
            except BaseException as error:  # noqa: BLE001 - panics of Rerun are no Exception
                self._drop(sink, error)
        self._changed()

    def _drop(self, failed: Sink, error: BaseException) -> None:
        """Send no more frames to a sink that has failed; reading and recording go on."""
        self._sinks = tuple(sink for sink in self._sinks if sink is not failed)
        name = type(failed).__name__
        self.warning = f"{name} has failed and gets no more frames: {type(error).__name__}: {error}"
        _log.error("%s: %s", self.url, self.warning, exc_info=error)


class _Later:
    """Passes events to a finger that is created after the link has started."""

    def __init__(self) -> None:
        self._finger: Finger | None = None

    def __call__(self, event: LinkEvent) -> None:
        if self._finger:
            self._finger.on_event(event)

    def to(self, finger: Finger) -> Finger:
        """Pass events to this finger from now on."""
        self._finger = finger
        return finger
