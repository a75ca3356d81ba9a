"""`Fingertip`: one fingertip, read in whichever way suits the program.

    with Fingertip.open("ble://Lumitip", layout="outputs/layout.json") as tip:
        frame = tip.read(timeout=0.5)          # the next frame, in order
        frame = tip.latest()                   # the freshest, never blocks
        block = tip.get_data(num_samples=55)   # (55, cells) with times
        for frame in tip.frames(): ...
        stop = tip.subscribe(print)

The link runs on a thread of its own. Each way of reading gets every frame, whoever else reads.
"""

import logging
import math
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import TracebackType

import numpy as np

from lumitip import arguments
from lumitip.calibration import Calibration, Kind, checked_kind
from lumitip.errors import CalibrationError, EndOfRecording, FingertipClosed, LayoutError, LinkError
from lumitip.frame import Block, Frame, complement, ended_early, too_late
from lumitip.layout import Layout
from lumitip.links import open_link
from lumitip.links.base import Calibrated, LinkEvent
from lumitip.session.drift import Drift
from lumitip.session.hub import Hub
from lumitip.session.queues import FrameQueue
from lumitip.session.stats import Stats
from lumitip.values import shown

_log = logging.getLogger(__name__)


class Fingertip:
    """An open fingertip; made by `Fingertip.open`."""

    def __init__(self, hub: Hub, buffer: int, calibrated: bool) -> None:
        self._hub = hub
        self._buffer = arguments.count(buffer, "buffer")
        self._reading = threading.Lock()
        self._queue: FrameQueue | None = None
        self._calibration = Calibration(self.device_id, self.layout.design_hash)
        if calibrated:
            self.calibration = self._known()

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
    ) -> "Fingertip":
        """Connect to a fingertip. From any thread; several may open at once.

        Args:
            url: `ble://NAME-OR-ADDRESS`, `serial://PORT`, `replay://FILE` or `twin://SHAPE`.
            layout: the `layout.json` that its firmware was built from, read or as a path; a
                replay and a twin bring their own.
            timeout: how long the connection may take (s); `None`: as long as it takes.
            buffer: most frames that wait for each reader; the oldest then make room, counted as
                `stats.dropped["queue"]`. 4096 are 8 s at 500 Hz.
            any_design: read a device of another design all the same.
            calibrated: use the calibration that `tare` kept for this device and design, or that a
                recording was made with.
            on_event: called on the link's thread with whatever happens to the link; keep it short.

        Raises:
            LumitipError: of a class that says what is wrong: `LinkTimeout`, `DeviceNotFound`,
                `AmbiguousDevice`, `WrongDesign`, `MtuTooSmall`, `UrlError`, `LayoutError`,
                `MissingExtra`, `CalibrationError`, `ArgumentError`.
        """
        if isinstance(layout, str | Path):
            layout = Layout.load(layout)
        elif layout is not None and not isinstance(layout, Layout):
            raise LayoutError(f"{shown(layout)} given, a Layout or the path of one is needed")
        hub = Hub(open_link(url, layout, any_design), any_design, on_event)
        hub.start(timeout)
        try:
            return cls(hub, buffer, calibrated)
        except BaseException:
            hub.close()
            raise

    def read(self, timeout: float | None = 1.0) -> Frame:
        """The next frame, in order, waiting up to `timeout` (s), without one as long as it takes.

        The first call begins to keep frames, so what it gives is fresh. From any thread; threads
        that read share the frames out among them.

        Raises:
            LinkTimeout: if none came in time; reading may go on, also while the link is cut.
            LinkError: if none will come any more, once all before are read: why.
        """
        return self._hub.next(self._read_queue(), timeout)

    def latest(self) -> Frame | None:
        """The freshest frame, `None` before the first. Never waits; from any thread.

        While a link is cut this is the last frame before: `frame.t` tells its age.

        Raises:
            LinkError: if no more will come and this is not the end of a recording: why.
        """
        over = self._hub.over
        if over and not isinstance(over, EndOfRecording):
            raise over.with_traceback(None)
        return self._hub.latest

    def get_data(self, num_samples: int, timeout: float | None = 10.0) -> Block:
        """The next `num_samples` frames as arrays, waiting up to `timeout` (s) for all.

        From any thread; takes from the same frames as `read`.

        Raises:
            ArgumentError: if `num_samples` is below 1.
            LinkTimeout: if they did not all come in time; its `block` has those that came.
            EndOfRecording: if fewer were left; its `block` has them, `None` if none was left.
            LinkError: if no more will come: why.
        """
        wanted, within_s = arguments.count(num_samples, "num_samples"), arguments.seconds(timeout)
        until = math.inf if within_s is None else time.monotonic() + within_s
        queue, frames = self._read_queue(), list[Frame]()
        try:
            while len(frames) < wanted:
                frame = queue.get(until - time.monotonic())
                if frame is None:
                    raise too_late(frames, wanted, within_s or 0.0)
                frames.append(frame)
        except EndOfRecording as end:
            raise ended_early(frames, wanted, end) from None
        return Block.of(frames)

    def frames(self, timeout: float | None = None) -> Iterator[Frame]:
        """Every frame from the first step of the loop on, to the end of a recording or `close`.

        Several may run, each on its own thread, each with every frame.

        Raises:
            LinkTimeout: if none came within `timeout` (s); without one it waits.
            LinkError: if the link is given up: why.
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
        """Call `callback` with every frame from now on, on a thread of its own, until the returned
        function is called. From any thread. An exception in it is logged and ends it."""
        arguments.function(callback, "callback")
        queue = self._hub.queue(self._buffer)

        def call() -> None:
            try:
                while True:
                    callback(self._hub.next(queue, None))
            except LinkError as error:
                _log.debug("subscription ends: %s", error)
            except Exception:  # noqa: BLE001 - a user's function ends only its own subscription
                _log.exception("%r failed, it is called no more", callback)
            finally:
                self._hub.remove(queue)

        threading.Thread(target=call, name="lumitip-subscriber", daemon=True).start()
        return lambda: queue.cancel(FingertipClosed("the subscription was stopped"))

    @property
    def layout(self) -> Layout:
        """The cells. From any thread."""
        return self._hub.link.layout

    @property
    def device_id(self) -> str:
        """Bluetooth address, USB serial number or port. From any thread."""
        return self._hub.link.device_id

    @property
    def connected(self) -> bool:
        """Whether the link stands at this moment. From any thread."""
        return self._hub.connected

    @property
    def stats(self) -> Stats:
        """What became of the frames so far. From any thread."""
        return self._hub.stats

    @property
    def drift(self) -> Drift | None:
        """How far the cells wandered while warming up; `None` in the first half minute. From any
        thread."""
        return self._hub.drift

    @property
    def calibration(self) -> Calibration:
        """The references in use; setting them calibrates the frames to come. From any thread.

        Raises:
            CalibrationMismatch: on setting that of another device or design.
        """
        return self._calibration

    @calibration.setter
    def calibration(self, calibration: Calibration) -> None:
        arguments.instance(calibration, Calibration, "calibration", CalibrationError)
        calibration.check(self.device_id, self.layout.design_hash, len(self.layout))
        self._calibration = calibration
        self._hub.intake.correction = calibration.correction()

    def tare(
        self, kind: Kind = "empty", *, num_samples: int = 50, keep: bool = True
    ) -> Calibration:
        """Measure a reference of every cell and use it from now on. From any thread, which waits
        until the frames came, each for up to 10 s.

        Args:
            kind: `"empty"` with nothing in the grasp, or `"dark"` with all light shut off.
            num_samples: frames to average.
            keep: whether the next `open` of this device and design uses it too; not of a
                recording, whose device may have changed since.

        Raises:
            ArgumentError: if there is no such kind, or `num_samples` is below 1.
            CalibrationError: if the cells are not in that state, or it cannot be kept; nothing
                changes.
            LinkError: if the frames did not come.
        """
        kind, wanted = checked_kind(kind), arguments.count(num_samples, "num_samples")
        if keep:
            self._needs_device()
        queue = self._hub.queue(wanted)
        try:
            frames = [self._hub.next(queue, 10.0) for _ in range(wanted)]
        finally:
            self._hub.remove(queue)
        light = np.stack([complement(f.raw, f.bits) for f in frames])
        made = self._calibration.measured(kind, light)
        if keep:
            made.save()
        self.calibration = made
        return made

    def forget(self) -> None:
        """Delete the references kept for this device and design; those in use stay. From any
        thread.

        Raises:
            CalibrationError: if they cannot be deleted, or this is a recording.
        """
        self._needs_device()
        self._calibration.forget()

    def close(self) -> None:
        """Disconnect. From any thread, any number of times."""
        self._hub.close()

    def _needs_device(self) -> None:
        if isinstance(self._hub.link, Calibrated):
            raise CalibrationError(
                f"this is a recording of {self.device_id}, what is kept is for the device: open "
                "the device"
            )

    def _known(self) -> Calibration:
        if isinstance(self._hub.link, Calibrated):
            return self._hub.link.calibration or self._calibration
        return Calibration.kept(self.device_id, self.layout.design_hash, len(self.layout))

    def _read_queue(self) -> FrameQueue:
        with self._reading:
            if self._queue is None:
                self._queue = self._hub.queue(self._buffer)
            return self._queue

    def __enter__(self) -> "Fingertip":
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.close()
