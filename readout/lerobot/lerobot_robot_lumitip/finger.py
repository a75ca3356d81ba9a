"""`Finger`: an open fingertip that keeps the frames between two observations."""

import threading
import time
from collections import deque
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from lerobot_robot_lumitip.windows import WindowFeatures
from lumitip import Fingertip, Frame
from lumitip.errors import LinkTimeout, StaleFrame
from lumitip.recording import Writer

_HANDOVER_S = 0.05  # for the subscription to pass on the newest frame


class Finger:
    """A fingertip, read by its own thread; made by `reading`."""

    def __init__(self, features: WindowFeatures, tip: Fingertip, writer: Writer | None) -> None:
        self._features = features
        self._names = features.names()
        self._tip = tip
        self._writer = writer
        self._lock = threading.Lock()
        self._frames: deque[Frame] = deque(maxlen=features.window)
        self._last_seq: int | None = None  # of the observation before
        self._failure: Exception | None = None
        self._came = threading.Event()  # a frame, or the failure
        self._ended = False

    @classmethod
    @contextmanager
    def reading(
        cls,
        features: WindowFeatures,
        tip: Fingertip,
        recordings: Path | None,
        timeout_s: float,
    ) -> Iterator["Finger"]:
        """Read a fingertip until the context ends.

        Args:
            features: of this finger.
            tip: stays open.
            recordings: folder of its MCAP recording; `None`: none.
            timeout_s: longest wait for its first frame (s).

        Raises:
            LinkTimeout: if no frame came in time.
            LinkError: why none will come.
            RecordingError: if its recording exists or cannot be written.
        """
        with ExitStack() as stack:
            writer = None
            if recordings is not None:
                recordings.mkdir(parents=True, exist_ok=True)
                path = recordings / f"{features.finger}.mcap"
                writer = stack.enter_context(
                    Writer(path, tip.layout, device_id=tip.device_id, calibration=tip.calibration)
                )
            finger = cls(features, tip, writer)
            stack.callback(finger._end)
            stack.callback(tip.subscribe(finger._add))
            finger._wait_first(timeout_s)
            yield finger

    def observe(self, max_silence_s: float) -> dict[str, float]:
        """The frames since the last call, as features.

        Raises:
            StaleFrame: if the newest frame is older than `max_silence_s` (s).
            LinkError: why no more will come.
            RecordingError: if the recording cannot be written.
        """
        if self._failure is not None:
            raise self._failure
        try:
            self._tip.latest(max_silence_s)
        except StaleFrame as error:
            raise StaleFrame(f"{self._features.finger}: {error}") from error
        with self._lock:
            now_s = time.monotonic()
            frames = list(self._frames)
            self._frames.clear()
        missed = 0
        if frames:
            newest = frames[-1].seq
            before = frames[0].seq - 1 if self._last_seq is None else self._last_seq
            missed, self._last_seq = newest - before - len(frames), newest
        values = self._features.values(frames, now_s, missed, self._tip.calibration)
        return dict(zip(self._names, values, strict=True))

    def _wait_first(self, timeout_s: float) -> None:
        """Wait for a frame of the subscription; the newest of the fingertip may be from before."""
        until_s = time.monotonic() + timeout_s
        while not self._came.is_set():
            try:
                self._tip.wait_latest(max(until_s - time.monotonic(), 0.0))
            except LinkTimeout as error:
                raise LinkTimeout(f"{self._features.finger}: {error}") from error
            self._came.wait(_HANDOVER_S)

    def _add(self, frame: Frame) -> None:
        with self._lock:
            if self._ended:
                return
            try:
                if self._writer is not None:
                    self._writer.write(frame)
            except Exception as error:
                self._failure = error
                self._came.set()
                raise
            self._frames.append(frame)
            self._came.set()

    def _end(self) -> None:
        with self._lock:
            self._ended = True
