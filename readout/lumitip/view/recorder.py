"""`Recorder`: the recording of a finger."""

import logging
import threading
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lumitip.errors import LumitipError, ViewError
from lumitip.fingertip import Fingertip
from lumitip.frame import Frame

if TYPE_CHECKING:
    from lumitip.recording import Writer

_log = logging.getLogger(__name__)


class Recorder:
    """The current recording of a finger. Thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._writer: Writer | None = None
        self._path: Path | None = None
        self._frames = 0
        self._error: str | None = None

    def start(self, path: Path, tip: Fingertip) -> None:
        """Start a recording.

        Raises:
            LumitipError: if one is running, or the file cannot be written.
        """
        from lumitip.recording import Writer

        with self._lock:
            if self._writer:
                raise ViewError(f"{self._path} is being recorded. Stop it first")
            path.parent.mkdir(parents=True, exist_ok=True)
            self._writer = Writer(
                path, tip.layout, device_id=tip.device_id, calibration=tip.calibration
            )
            self._path, self._frames, self._error = path, 0, None

    def write(self, frame: Frame) -> None:
        """Write a frame if a recording is running; an error ends it."""
        with self._lock:
            if not self._writer:
                return
            try:
                self._writer.write(frame)
                self._frames += 1
            except (OSError, LumitipError) as error:
                self._error = f"the recording ended: {error}"
                _log.warning("%s: %s", self._path, self._error)
                self._writer = None

    def fail(self, why: str) -> None:
        """End a recording whose frames have ended by an error."""
        with self._lock:
            if not self._writer:
                return
            writer, self._writer = self._writer, None
            self._error = f"the recording ended: {why}"
            _log.warning("%s: %s", self._path, self._error)
            try:
                writer.close()
            except (OSError, LumitipError) as error:
                self._error += f"; then: {error}"

    def stop(self) -> Path | None:
        """End the recording; returns its file, `None` if there was none."""
        with self._lock:
            if not self._writer:
                return None
            writer, self._writer = self._writer, None
            writer.close()
            return self._path

    def status(self) -> dict[str, Any] | None:
        """State of the recording for JSON, `None` before the first."""
        with self._lock:
            if self._path is None:
                return None
            return {
                "on": self._writer is not None,
                "file": self._path.name,
                "frames": self._frames,
                "error": self._error,
            }
