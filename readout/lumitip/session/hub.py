"""`Hub`: one link and its readers: state, queues, events. The core of `Fingertip`."""

import logging
import math
import threading
import time
from collections.abc import Callable
from dataclasses import replace

from lumitip.arguments import function, seconds
from lumitip.errors import (
    EndOfRecording,
    FingertipClosed,
    LinkError,
    LinkTimeout,
    LumitipError,
    StaleFrame,
)
from lumitip.frame import Frame
from lumitip.links.base import Arrival, Link, LinkEvent, Report
from lumitip.session.drift import Drift, DriftWatch
from lumitip.session.intake import Intake, Source
from lumitip.session.newest import Newest
from lumitip.session.queues import FrameQueue
from lumitip.session.silence import no_connection, why_silent
from lumitip.session.stats import Counter, Stats

_log = logging.getLogger(__name__)


class Hub:
    """Starts a link and passes its frames to queues. Thread-safe.

    Args:
        link: not yet started.
        any_design: accept frames of another design.
        on_event: called on the link's thread with each event.
    """

    def __init__(self, link: Link, any_design: bool, on_event: Report | None) -> None:
        self.link = link
        self._counter = Counter()
        if on_event is not None:
            function(on_event, "on_event")
        self._on_event = on_event
        source = Source(link.layout, lambda: link.device_id, any_design)
        self.intake = Intake(source, self._counter, self._report)
        self._drift = DriftWatch()
        self._lock = threading.RLock()
        self._changed = threading.Condition(self._lock)
        self._queues: tuple[FrameQueue, ...] = ()
        self._newest: Newest | None = None
        self._wanted = False  # whether the newest frame was asked for
        self._connected = False
        self._was_connected = False
        self._over: LinkError | None = None
        self._at_connection: Callable[[], None] | None = None
        self._refused: LumitipError | None = None

    def start(
        self, timeout_s: float | None, at_connection: Callable[[], None] | None = None
    ) -> None:
        """Start the link and wait until it is connected; `None` waits without limit.

        Args:
            timeout_s: longest wait (s).
            at_connection: called on the link's thread at the first connection, before any frame:
                the name of the device is final then.

        Raises:
            ArgumentError: if the time is wrong; nothing is started.
            LinkTimeout: if it did not connect in time; the link is stopped.
            LinkError: why it did not connect; the link is stopped.
            LumitipError: that of `at_connection`; the link is stopped.
        """
        timeout_s, self._at_connection = seconds(timeout_s), at_connection
        self.link.start(self._deliver, self._report)
        until = math.inf if timeout_s is None else time.monotonic() + timeout_s
        try:
            with self._changed:
                while not (self._was_connected or self._over) and time.monotonic() < until:
                    self._changed.wait(min(until - time.monotonic(), threading.TIMEOUT_MAX))
                if self._refused:
                    raise self._refused
                if not self._was_connected:
                    raise self._over or no_connection(self.link, timeout_s or 0)
        except BaseException as failed:  # Ctrl-C too
            self.close(failed if isinstance(failed, LinkError) else None)
            raise

    def close(self, reason: LinkError | None = None) -> None:
        """Stop the link; readers get the queued frames, then the reason. May be repeated."""
        self._end(reason or FingertipClosed("the fingertip was closed: open it again"))
        self.link.stop()

    @property
    def connected(self) -> bool:
        """Whether the link is connected now."""
        return self._connected

    @property
    def over(self) -> LinkError | None:
        """Why no more frames will come; `None` if they will."""
        return self._over

    @property
    def latest(self) -> Frame | None:
        """The newest frame."""
        return self._newest.frame if self._newest else None

    @property
    def stats(self) -> Stats:
        """Counts, rate and jitter."""
        return self._counter.snapshot()

    @property
    def drift(self) -> Drift | None:
        """Drift of the cells."""
        return self._drift.drift

    def summary(self) -> str:
        """Device, state, cells and counts, in one line."""
        stats = self.stats
        state = (
            str(self._over) if self._over else "connected" if self._connected else "reconnecting"
        )
        lost = "unknown" if stats.dropped is None else sum(stats.dropped.values())
        return (
            f"{self.link.device_id}: {state}; {len(self.link.layout)} cells, "
            f"{stats.received} frames, {stats.rate_hz or 0.0:.1f} Hz, lost: {lost}"
        )

    def queue(
        self, size: int, notify: Callable[[], None] | None = None, counted: bool = True
    ) -> FrameQueue:
        """A queue that gets every frame from now until `remove`; arguments of `FrameQueue`."""
        queue = FrameQueue(size, notify, counted)
        with self._lock:
            self._queues += (queue,)
            self._changed.notify_all()
            over = self._over
        if over:
            queue.close(over)
        return queue

    def remove(self, queue: FrameQueue) -> None:
        """Close a queue."""
        with self._lock:
            self._queues = tuple(q for q in self._queues if q is not queue)
        queue.cancel(FingertipClosed("this reader was closed"))

    def next(self, queue: FrameQueue, timeout_s: float | None) -> Frame:
        """The next frame of a queue.

        Raises:
            LinkTimeout: if no frame came in time.
            LinkError: why no more will come.
            ArgumentError: if the time is wrong.
        """
        timeout_s = seconds(timeout_s)
        frame = queue.get(timeout_s)
        if frame is None:
            raise self.silent(timeout_s)
        return frame

    def newer(self, than: Frame | None, timeout_s: float | None) -> Frame:
        """The newest frame, once it is another one than `than`.

        Raises:
            LinkTimeout: if no other frame came in time.
            LinkError: why no more will come.
            ArgumentError: if the time is wrong.
        """
        timeout_s = seconds(timeout_s, "timeout_s")
        until = math.inf if timeout_s is None else time.monotonic() + timeout_s
        with self._changed:
            while (frame := self.fresh()) is None or frame is than:
                if self._over:
                    raise self._over.with_traceback(None)
                left_s = until - time.monotonic()
                if left_s <= 0.0:
                    break
                self._ask()
                self._changed.wait(min(left_s, threading.TIMEOUT_MAX))
            else:
                return frame
        raise self.silent(timeout_s)

    def pass_over(self, last: Frame | None, max_age_s: float | None) -> Frame | None:
        """The newest frame if a reader must not take it for one of now, else `last`, the last frame
        that the reader got; see `Newest.is_outdated`.

        Raises:
            ArgumentError: if the time is wrong.
        """
        max_age_s, newest = seconds(max_age_s, "timeout_s"), self._newest
        if newest and newest.is_outdated(last is None, self._connected, max_age_s):
            return newest.frame
        return last

    def fresh(self, max_age_s: float | None = None) -> Frame | None:
        """The newest frame, at most `max_age_s` old (s); `None`: of any age, and before the first.

        Raises:
            StaleFrame: if it is older, or there is none.
            LinkError: why no more will come, except at the end of a recording.
            ArgumentError: if the age is wrong.
        """
        max_age_s, newest = seconds(max_age_s, "max_age_s"), self._newest
        self._ask()
        if self._over and not isinstance(self._over, EndOfRecording):
            raise self._over.with_traceback(None)
        if max_age_s is not None:
            age_s = newest.age_s if newest else math.inf
            if age_s > max_age_s:
                found = f"the newest frame is {age_s:.3f} s old" if newest else "no frame came yet"
                raise StaleFrame(f"{found}, max_age_s is {max_age_s:g}: {self._why_silent()}")
        return newest.frame if newest else None

    def _ask(self) -> None:
        """Let a recording that waits for a reader go on."""
        if not self._wanted:
            with self._changed:
                self._wanted = True
                self._changed.notify_all()

    def silent(self, timeout_s: float | None) -> LinkTimeout:
        """The error when no frame came in time."""
        return LinkTimeout(f"no frame in {timeout_s or 0:.3g} s: {self._why_silent()}")

    def _why_silent(self) -> str:
        device_id, unreadable = self.link.device_id, self.stats.unreadable
        return why_silent(device_id, self._connected, unreadable, self.intake.last_fault)

    def _deliver(self, arrival: Arrival) -> None:
        if self._over:
            return
        try:
            frames = self.intake.frames(arrival)
        except LinkError as error:
            # On the link's own thread, which cannot stop itself.
            self._report(LinkEvent("failed", str(error), error))
            return
        if not frames:
            return
        if arrival.patient:
            self._wait_for_reader()
        last = frames[-1]
        with self._changed:
            self._newest = Newest.of(last, arrival)
            self._wanted = False
            self._changed.notify_all()
        for queue in self._queues:
            lost = queue.put(frames, wait=arrival.patient)
            if lost and queue.counted:
                self._counter.lost("queue", lost)
        if self._drift.add(last.raw, last.bits, last.t, last.t_device):
            self._report(LinkEvent("warm", f"{self.link.device_id}: {self._drift.drift}"))

    def _wait_for_reader(self) -> None:
        with self._changed:
            while not (self._queues or self._wanted or self._over):
                self._changed.wait()

    def _report(self, event: LinkEvent) -> None:
        _log.info("%s: %s", event.kind, event.detail)
        if event.kind == "connected":
            self._now_connected()
        elif event.kind == "lost":
            self._connected = False
            self._newest = self._newest and replace(self._newest, cut_off=True)
        elif event.kind in ("failed", "ended"):
            self._end(event.error or EndOfRecording(event.detail))
        if self._on_event:
            try:
                self._on_event(event)
            except Exception:  # noqa: BLE001 - a user's error must not end the link's thread
                _log.exception("on_event failed for %s", event)

    def _now_connected(self) -> None:
        if self._was_connected:
            self._counter.add("reconnects")
            self.intake.reconnected()
        elif self._at_connection:
            try:
                self._at_connection()
            except LumitipError as error:
                self._refused = error
        with self._changed:
            self._connected = self._was_connected = True
            self._changed.notify_all()

    def _end(self, reason: LinkError) -> None:
        with self._changed:
            self._over = self._over or reason
            self._connected = False
            self._changed.notify_all()
            queues = self._queues
        for queue in queues:
            queue.close(self._over)
