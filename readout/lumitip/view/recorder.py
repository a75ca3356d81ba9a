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
    """The current recording of a finger. Thread-safe.

    The disk may be slow, so `status` waits for nothing: it returns what the last step has left.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._writer: Writer | None = None
        self._status: dict[str, Any] | None = None  # replaced, never changed

    def start(self, path: Path, tip: Fingertip) -> None:
        """Start a recording.

        Raises:
            LumitipError: if one is running, or the file cannot be written.
        """
        from lumitip.recording import Writer

        with self._lock:
            if self._writer:
                raise ViewError(f"{self._writer.path} is being recorded. Stop it first")
            path.parent.mkdir(parents=True, exist_ok=True)
            self._writer = Writer(
                path, tip.layout, device_id=tip.device_id, calibration=tip.calibration
            )
            self._status = {"on": True, "file": path.name, "frames": 0, "error": None}

    def write(self, frame: Frame) -> None:
        """Write a frame if a recording is running; an error ends it."""
        with self._lock:
            if not self._writer:
                return
            try:
                self._writer.write(frame)
            except (OSError, LumitipError) as error:
                self._ended(str(error))
            else:
                self._status = {**(self._status or {}), "frames": self._writer.frames}

    def fail(self, why: str) -> None:
        """End a recording whose frames have ended by an error."""
        with self._lock:
            if not self._writer:
                return
            try:
                self._writer.close()
            except (OSError, LumitipError) as error:
                why = f"{why}; then: {error}"
            self._ended(why)

    def stop(self) -> Path | None:
        """End the recording; returns its file, `None` if there was none.

        Raises:
            LumitipError: if it cannot be completed.
        """
        with self._lock:
            if not self._writer:
                return None
            path = self._writer.path
            try:
                self._writer.close()
            except (OSError, LumitipError) as error:
                self._ended(str(error))
                raise
            self._ended(None)
            return path

    def _ended(self, why: str | None) -> None:
        error = None if why is None else f"the recording ended: {why}"
        if error:
            _log.warning("%s: %s", self._writer and self._writer.path, error)
        self._writer = None
        self._status = {**(self._status or {}), "on": False, "error": error}

    def status(self) -> dict[str, Any] | None:
        """State of the recording for JSON, `None` before the first. Never waits."""
        return self._status
