"""`Recorder`: the file that a finger is recorded to while the page says so."""

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
    """The file that frames are written to, if any. From any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._writer: Writer | None = None
        self._path: Path | None = None
        self._frames = 0
        self._error: str | None = None

    def start(self, path: Path, tip: Fingertip) -> None:
        """Begin a file.

        Raises:
            LumitipError: if one is being written already, or it cannot be.
        """
        from lumitip.recording import Writer

        with self._lock:
            if self._writer:
                raise ViewError(f"{self._path} is being recorded: stop it first")
            path.parent.mkdir(parents=True, exist_ok=True)
            self._writer = Writer(
                path, tip.layout, device_id=tip.device_id, calibration=tip.calibration
            )
            self._path, self._frames, self._error = path, 0, None

    def write(self, frame: Frame) -> None:
        """Write a frame if a recording runs; one that fails is ended and says so."""
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

    def stop(self) -> Path | None:
        """End the file; returns it, `None` if there was none."""
        with self._lock:
            if not self._writer:
                return None
            writer, self._writer = self._writer, None
            writer.close()
            return self._path

    def status(self) -> dict[str, Any] | None:
        """File, frames and fault of the recording, `None` before the first."""
        with self._lock:
            if self._path is None:
                return None
            return {
                "on": self._writer is not None,
                "file": self._path.name,
                "frames": self._frames,
                "error": self._error,
            }
