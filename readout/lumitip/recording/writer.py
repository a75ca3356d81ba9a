"""`Writer`: frames to an MCAP file that survives the death of its process."""

import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType

from mcap.writer import Writer as McapWriter

from lumitip import arguments
from lumitip.calibration import Calibration
from lumitip.layout import Layout
from lumitip.recording.message import (
    SCHEMA_NAME,
    SCHEMA_TEXT,
    Recordable,
    RecordingError,
    encode,
    stamp_ns,
)
from lumitip.recording.metadata import NAME, Metadata, begun, versions
from lumitip.values import shown

CHUNK_BYTES = 2048
FLUSH_S = 0.2
TOPIC = "/lumitip/frames"


class Writer:
    """Writes a recording; a context manager. One thread at a time.

    What is older than 0.2 s when a frame is written is in the hands of the operating system, so
    that a process killed with `kill -9` loses no more than that.
    """

    def __init__(
        self,
        path: str | Path,
        layout: Layout,
        *,
        device_id: str,
        calibration: Calibration | None = None,
        start_wall: float | None = None,
        made_with: Mapping[str, str] | None = None,
    ) -> None:
        """Begin a file.

        Args:
            path: of the file, which must not exist yet.
            layout: the cells that the frames are of.
            device_id: the device that they come from.
            calibration: of this device, kept along; the frames are written raw.
            start_wall: when the recording began, seconds since 1970 (UTC); now.
            made_with: versions to tell, of the software that runs.

        Raises:
            LayoutError: if it is no layout.
            CalibrationMismatch: if the calibration is of another device, design or number of cells.
            CalibrationError: if a cell of it reads no more with an empty grasp than in the dark.
            RecordingError: if the file is there already or cannot be written, or another argument
                cannot be so.
        """
        self.path = arguments.path(path, RecordingError)
        arguments.layout(layout)
        arguments.instance(device_id, str, "device_id", RecordingError)
        if calibration is not None:
            arguments.instance(calibration, Calibration, "calibration", RecordingError)
            calibration.check(device_id, layout.design_hash, len(layout))
            calibration.correction()
        self.metadata = Metadata(
            layout,
            device_id,
            calibration,
            begun(time.time() if start_wall is None else start_wall),
            versions() if made_with is None else _told(made_with),
        )
        self.frames = 0
        """Frames written so far."""
        try:
            self._file = self.path.open("xb")
        except FileExistsError as error:
            raise RecordingError(f"{path} is there already: give another name") from error
        except (OSError, ValueError) as error:
            raise RecordingError(f"{path}: cannot be written: {error}") from error
        try:
            self._begin()
        except (OSError, ValueError) as error:  # also a device_id that no file can hold
            given_up = self._given_up(error)
            with suppress(OSError):
                self.path.unlink()  # it holds nothing, and would be in the way
            raise given_up from error

    def _begin(self) -> None:
        library = f"lumitip {self.metadata.versions.get('lumitip', '')}".strip()
        self._mcap = McapWriter(self._file, chunk_size=CHUNK_BYTES)
        self._mcap.start(profile="ros2", library=library)
        self._mcap.add_metadata(NAME, self.metadata.to_texts())
        schema = self._mcap.register_schema(SCHEMA_NAME, "ros2msg", SCHEMA_TEXT.encode())
        self._channel = self._mcap.register_channel(TOPIC, "cdr", schema)
        self._mcap.flush()
        self._flushed = time.monotonic()

    def write(self, frame: Recordable) -> None:
        """Add a frame.

        Raises:
            RecordingError: if it is no frame, or one of another number of cells, or the file is
                closed or cannot be written; after the last it is closed as well as can be.
        """
        if not hasattr(frame, "raw"):
            raise RecordingError(f"{shown(frame)} given, a frame is needed, such as tip.read()")
        if self._file.closed:
            raise RecordingError(f"{self.path} is closed")
        cells = len(self.metadata.layout)
        if frame.raw.shape != (cells,):
            raise RecordingError(f"{frame.raw.shape} codes given, the layout has ({cells},)")
        at_ns = stamp_ns(frame.t_wall)
        data = encode(frame, self.metadata.device_id)
        try:
            self._mcap.add_message(self._channel, at_ns, data, at_ns, frame.seq & 0xFFFFFFFF)
            self.frames += 1
            now = time.monotonic()
            if now - self._flushed >= FLUSH_S:
                self._mcap.flush()
                self._flushed = now
        except OSError as error:
            raise self._given_up(error) from error

    def close(self) -> None:
        """Write the index and end the file; once is enough.

        Raises:
            RecordingError: if the file cannot be written.
        """
        if self._file.closed:
            return
        try:
            with self._file:
                self._mcap.finish()
        except OSError as error:
            raise self._given_up(error) from error

    def _given_up(self, error: Exception) -> RecordingError:
        with suppress(OSError):  # closing writes what waits once more
            self._file.close()
        return RecordingError(f"{self.path}: cannot be written: {error}")

    def __enter__(self) -> "Writer":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


def _told(made_with: object) -> dict[str, str]:
    if not isinstance(made_with, Mapping):
        raise RecordingError(
            f"made_with: {shown(made_with)} given, versions by name are needed: {{'robot': '1.0'}}"
        )
    return {str(name): str(version) for name, version in made_with.items()}
