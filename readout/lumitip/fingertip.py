"""`Fingertip`: one open fingertip, with several ways to read it.

    with Fingertip.open("ble://Lumitip", layout="outputs/layout.json") as tip:
        frame = tip.read(timeout=0.5)          # the next frame, in order
        frame = tip.wait_latest(0.5)           # the newest, for control loops
        frame = tip.latest(max_age_s=0.1)      # the newest, never blocks
        block = tip.get_data(num_samples=55)   # (55, cells) with times
        for frame in tip.frames(): ...
        stop = tip.subscribe(print)

The link runs on its own thread. All readers get all frames.
"""

import logging
import math
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Never, overload

from lumitip import arguments
from lumitip.calibration import Calibration, Kind
from lumitip.errors import EndOfRecording, FingertipClosed, LinkError
from lumitip.frame import Block, Frame, ended_early, too_late
from lumitip.layout import Layout
from lumitip.links import open_link
from lumitip.links.base import LinkEvent, Placeable
from lumitip.options import check_options
from lumitip.session.drift import Drift
from lumitip.session.hub import Hub
from lumitip.session.queues import FrameQueue
from lumitip.session.references import References
from lumitip.session.stats import Stats

_log = logging.getLogger(__name__)


class Fingertip:
    """An open fingertip; see `Fingertip.open`. All methods and properties are thread-safe."""

    def __init__(self, hub: Hub, buffer: int, calibrated: bool, timeout_s: float | None) -> None:
        """Start `hub`, with the calibration in force before its first frame."""
        self._hub = hub
        self._buffer = arguments.count(buffer, "buffer")
        self._reading = threading.Lock()
        self._queue: FrameQueue | None = None
        self._handed_out = threading.local()
        self._references: References

        def connected() -> None:
            self._references = References(hub, calibrated)

        hub.start(timeout_s, connected)

    @classmethod
    def open(
        cls,
        url: str,
        layout: Layout | str | Path | None = None,
        *,
        timeout: float | None = 10.0,
        buffer: int = 4096,
        any_design: bool = False,
        calibrated: bool = True,
        on_event: Callable[[LinkEvent], None] | None = None,
        **unknown: Never,
    ) -> "Fingertip":
        """Connect to a fingertip. Several threads may do so at once.

        Args:
            url: `ble://NAME-OR-ADDRESS`, `serial://PORT`, `replay://FILE`, `twin://SHAPE` or
                `tcp://HOST:PORT`, where `lumitip serve` shares a fingertip.
            layout: the `layout.json` that its firmware was built from, or its path; not needed for
                a replay, a twin, a shared fingertip, or one that was used on this computer.
            timeout: of the connection (s); `None`: no limit.
            buffer: frames that may wait for each reader; the oldest are dropped, counted in
                `stats.dropped["queue"]`. 4096 are 8 s at 500 Hz.
            any_design: accept a device of another design.
            calibrated: use the calibration that `tare` saved for this device and design, or that
                of the recording.
            on_event: called on the link's thread with each event of the link; must be fast.

        Raises:
            LumitipError: `LinkTimeout`, `DeviceNotFound`, `AmbiguousDevice`, `WrongDesign`,
                `MtuTooSmall`, `UrlError`, `LayoutError`, `MissingExtra`, `CalibrationError`,
                `ArgumentError` or, for other options, `UnknownOption`, a `TypeError` too.
        """
        check_options(unknown)
        known = None if layout is None else arguments.layout_or_path(layout)
        link = open_link(url, known, any_design, arguments.seconds(timeout))
        return cls(Hub(link, any_design, on_event), buffer, calibrated, timeout)

    def read(self, timeout: float | None = 1.0) -> Frame:
        """The next frame, in order, within `timeout` (s); `None` waits without limit.

        The first call starts the buffer. Threads that call `read` share its frames. If frames
        wait for more than half a second, a warning is logged, and again whenever the delay has
        doubled: use `wait_latest` where only the newest matters.

        Raises:
            LinkTimeout: if no frame came in time; reading may go on, also while the link is cut.
            LinkError: after the last frame: why no more will come.
        """
        frame = self._hub.next(self._read_queue(), timeout)
        if frame is self._hub.latest:
            self._handed_out.frame = frame
        return frame

    def wait_latest(self, timeout_s: float | None = 1.0) -> Frame:
        """The newest frame, once it is newer than the last that this thread got from `read`,
        `latest` or `wait_latest`; waits up to `timeout_s` (s), `None` without limit. A thread that
        got none yet takes none older than `timeout_s`, and none from before while the link is cut.
        Later frames are of any age; from before a cut of the link, at most `timeout_s` old.
        For control loops: nothing queues, a slow loop skips frames. Each thread gets the newest.

        Raises:
            LinkTimeout: if no newer frame came in time.
            LinkError: why no more will come.
        """
        frame = self._handed_out.frame = self._hub.newer(self._pass_over(timeout_s), timeout_s)
        return frame

    def _pass_over(self, max_age_s: float | None) -> Frame | None:
        """Count the newest frame as handed out if it is too old. Returns the last such frame."""
        last: Frame | None = getattr(self._handed_out, "frame", None)
        self._handed_out.frame = last = self._hub.pass_over(last, max_age_s)
        return last

    @overload
    def latest(self, max_age_s: float) -> Frame: ...

    @overload
    def latest(self, max_age_s: float | None = None) -> Frame | None: ...

    def latest(self, max_age_s: float | None = None) -> Frame | None:
        """The newest frame, `None` before the first. Never waits.

        Args:
            max_age_s: largest age, from reading the cells to now (s); of a recording, from its
                arrival. Without it the frame may be of any age, as while the link is cut.

        Raises:
            StaleFrame: if the frame is older than `max_age_s`, or there is none.
            LinkError: why no more will come, except at the end of a recording.
        """
        frame = self._handed_out.frame = self._hub.fresh(max_age_s)
        return frame

    def get_data(self, num_samples: int, timeout: float | None = 10.0) -> Block:
        """The next `num_samples` frames as arrays, all within `timeout` (s).

        Shares the frames with `read`.

        Raises:
            ArgumentError: if `num_samples` is below 1.
            LinkTimeout: if too few came in time; its `block` has those that came.
            EndOfRecording: if too few were left; its `block` has them.
            LinkError: why no more will come.
        """
        number, timeout_s = arguments.count(num_samples, "num_samples"), arguments.seconds(timeout)
        until = math.inf if timeout_s is None else time.monotonic() + timeout_s
        queue, frames = self._read_queue(), list[Frame]()
        try:
            while len(frames) < number:
                frame = queue.get(until - time.monotonic())
                if frame is None:
                    raise too_late(frames, number, timeout_s or 0.0)
                frames.append(frame)
        except EndOfRecording as end:
            raise ended_early(frames, number, end) from None
        return Block.of(frames)

    def frames(self, timeout: float | None = None) -> Iterator[Frame]:
        """Every frame from now to the end of a recording or `close`; each iterator gets all.

        Raises:
            LinkTimeout: if no frame came within `timeout` (s).
            LinkError: why the link has failed.
        """
        queue = self._hub.queue(self._buffer)
        try:
            while True:
                yield self._hub.next(queue, timeout)
        except (EndOfRecording, FingertipClosed):
            return
        finally:
            self._hub.remove(queue)

    def subscribe(self, callback: Callable[[Frame], None]) -> Callable[[], None]:
        """Call `callback` with every frame, on its own thread, until the returned function is
        called. An exception in `callback` is logged and ends the calls."""
        arguments.function(callback, "callback")
        queue = self._hub.queue(self._buffer)

        def call() -> None:
            try:
                while True:
                    callback(self._hub.next(queue, None))
            except LinkError as error:
                _log.debug("subscription ends: %s", error)
            except Exception:  # noqa: BLE001 - a user's error ends only its subscription
                _log.exception("%r failed; it will not be called again", callback)
            finally:
                self._hub.remove(queue)

        threading.Thread(target=call, name="lumitip-subscriber", daemon=True).start()
        return lambda: self._hub.remove(queue)

    @property
    def layout(self) -> Layout:
        """The cells."""
        return self._hub.link.layout

    @property
    def device_id(self) -> str:
        """Bluetooth address, USB serial number or port."""
        return self._hub.link.device_id

    @property
    def simulated(self) -> Placeable | None:
        """Control of the object of a `twin://`; `None` for all others."""
        return self._hub.link if isinstance(self._hub.link, Placeable) else None

    @property
    def connected(self) -> bool:
        """Whether the link is connected now."""
        return self._hub.connected

    @property
    def stats(self) -> Stats:
        """Counts of received and lost frames, rate and jitter."""
        return self._hub.stats

    @property
    def drift(self) -> Drift | None:
        """Drift of the cells during warm-up; `None` in the first 30 s."""
        return self._hub.drift

    @property
    def calibration(self) -> Calibration:
        """The references in use; a new one applies to the next frames.

        Raises:
            CalibrationError: on setting one without light, or of another device or design.
        """
        return self._references.calibration

    @calibration.setter
    def calibration(self, calibration: Calibration) -> None:
        self._references.calibration = calibration

    def tare(
        self, kind: Kind = "empty", *, num_samples: int = 50, keep: bool = True
    ) -> Calibration:
        """Measure a reference of every cell and use it from now on; waits up to 10 s a frame.

        Args:
            kind: `"empty"`: nothing in the grasp; a warning is logged if some cells are darker than
                at the last tare, beside the others. `"dark"`: all light shut off.
            num_samples: frames to average.
            keep: save it for the next `open`; not possible with a recording.

        Raises:
            ArgumentError: if `kind` is unknown, or `num_samples` is below 1.
            CalibrationError: if the cells are not in that state, or saving failed; nothing
                changes.
            LinkError: if a frame did not come.
        """
        return self._references.measure(kind, num_samples, keep)

    def forget(self) -> None:
        """Delete the saved references of this device and design; those in use stay.

        Raises:
            CalibrationError: if they cannot be deleted, or this is a recording.
        """
        self._references.forget()

    def close(self) -> None:
        """Disconnect; may be repeated."""
        self._hub.close()

    def _read_queue(self) -> FrameQueue:
        with self._reading:
            if self._queue is None:
                self._queue = self._hub.queue(self._buffer)
            return self._queue

    def __repr__(self) -> str:
        return f"<Fingertip {self._hub.summary()}>"

    def __enter__(self) -> "Fingertip":
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.close()
