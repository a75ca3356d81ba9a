"""`Writer` and `recover`: write frames to an MCAP file that survives a crash of its process."""

import time
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from types import TracebackType

from mcap.writer import Writer as McapWriter

from lumitip import arguments
from lumitip.calibration import Calibration
from lumitip.frame import Frame, RecordedFrame
from lumitip.layout import Layout
from lumitip.recording import message
from lumitip.recording.metadata import NAME, Metadata, checked_start, versions
from lumitip.recording.reader import Reader
from lumitip.values import shown

CHUNK_BYTES = 2048
FLUSH_S = 0.2
TOPIC = "/lumitip/frames"
_SET_S = 0.025  # a step of the wall clock: that of a link is above it


class Writer:
    """Writes a recording; a context manager. One thread at a time.

    Data older than 0.2 s have been passed to the operating system, so that `kill -9` loses no more.
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
        """Create a file.

        Args:
            path: of the file, which must not exist yet.
            layout: the cells of the frames.
            device_id: the device of the frames.
            calibration: of this device, stored in the metadata; frames are raw.
            start_wall: start of the recording, seconds since 1970 (UTC); default: now.
            made_with: versions of software; default: those in use.

        Raises:
            LayoutError: if `layout` is not a layout.
            CalibrationError: if the calibration does not fit or is not valid.
            RecordingError: if the file exists or cannot be written, or another argument is wrong.
        """
        self.path = arguments.path(path, message.RecordingError)
        arguments.layout(layout)
        arguments.instance(device_id, str, "device_id", message.RecordingError)
        if calibration is not None:
            arguments.instance(calibration, Calibration, "calibration", message.RecordingError)
            calibration.check(device_id, layout.design_hash, len(layout))
            calibration.correction()
        self.metadata = Metadata(
            layout,
            device_id,
            calibration,
            checked_start(time.time() if start_wall is None else start_wall),
            versions() if made_with is None else _versions(made_with),
        )
        self.frames = 0
        """Frames written so far."""
        self._last_seq: int | None = None
        self._before: Frame | None = None
        self._set_s = 0.0
        try:
            self._file = self.path.open("xb")
        except FileExistsError as error:
            raise message.RecordingError(f"{path} exists. Choose another name") from error
        except (OSError, ValueError) as error:
            raise message.RecordingError(arguments.unwritable(self.path, error)) from error
        try:
            self._begin()
        except (OSError, ValueError) as error:  # also a device_id that cannot be encoded
            failure = self._failure(error)
            with suppress(OSError):
                self.path.unlink()  # it is empty
            raise failure from error

    def _begin(self) -> None:
        library = f"lumitip {self.metadata.versions.get('lumitip', '')}".strip()
        self._mcap = McapWriter(self._file, chunk_size=CHUNK_BYTES)
        self._mcap.start(profile="ros2", library=library)
        self._mcap.add_metadata(NAME, self.metadata.to_texts())
        schema = self._mcap.register_schema(
            message.SCHEMA_NAME, "ros2msg", message.schema_text().encode()
        )
        self._channel = self._mcap.register_channel(TOPIC, "cdr", schema)
        self._mcap.flush()
        self._flushed = time.monotonic()

    def write(self, frame: Frame | RecordedFrame) -> None:
        """Add a frame.

        Raises:
            RecordingError: if it is not a frame of this layout, or the file is closed or cannot be
                written; in the last case it is closed.
        """
        if not hasattr(frame, "raw"):
            raise message.RecordingError(
                f"the frame is {shown(frame)}; a Frame is needed, such as tip.read()"
            )
        if self._file.closed:
            raise message.RecordingError(f"{self.path} is closed")
        cells = len(self.metadata.layout)
        if frame.raw.shape != (cells,):
            raise message.RecordingError(
                f"the frame has shape {frame.raw.shape}; the layout needs ({cells},)"
            )
        frame = self._steady(frame)
        at_ns = message.stamp_ns(frame.t_wall)
        missing = message.missing_before(frame, self._last_seq)
        data = message.encode(frame, self.metadata.device_id, missing)
        try:
            self._mcap.add_message(self._channel, at_ns, data, at_ns, frame.seq & 0xFFFFFFFF)
            self.frames += 1
            self._last_seq = frame.seq
            now = time.monotonic()
            if now - self._flushed >= FLUSH_S:
                self._mcap.flush()
                self._flushed = now
        except OSError as error:
            raise self._failure(error) from error

    def _steady(self, frame: Frame | RecordedFrame) -> Frame | RecordedFrame:
        """The frame by the computer's clock as it was at the first one: it may be set since."""
        if isinstance(frame, RecordedFrame):
            return frame
        before, self._before = self._before, frame
        if before is not None and frame.t > before.t:  # else its frames have no times of their own
            step_s = (frame.t_wall - before.t_wall) - (frame.t - before.t)
            if abs(step_s) > _SET_S:
                self._set_s += step_s
        return replace(frame, t_wall=frame.t_wall - self._set_s) if self._set_s else frame

    def __repr__(self) -> str:
        return f"<Writer {self.path}: {self.metadata.device_id}, {self.frames} frames>"

    def close(self) -> None:
        """Write the index and end the file; may be repeated.

        Raises:
            RecordingError: if the file cannot be written.
        """
        if self._file.closed:
            return
        try:
            with self._file:
                self._mcap.finish()
        except OSError as error:
            raise self._failure(error) from error

    def _failure(self, error: Exception) -> message.RecordingError:
        with suppress(OSError):  # closing flushes again
            self._file.close()
        return message.RecordingError(f"{self.path}: cannot be written: {error}")

    def __enter__(self) -> "Writer":
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.close()


def _versions(made_with: object) -> dict[str, str]:
    if not isinstance(made_with, Mapping):
        raise message.RecordingError(
            f"made_with is {shown(made_with)}; versions by name are needed, such as "
            "{'robot': '1.0'}"
        )
    return {str(name): str(version) for name, version in made_with.items()}


@dataclass(frozen=True)
class Recovered:
    """The result of `recover`."""

    path: Path
    frames: int
    damage: tuple[str, ...]
    """Damage of the recording, for the user."""


def recover(source: str | Path, target: str | Path, finger: str | None = None) -> Recovered:
    """Copy all readable frames of a recording to a new, complete file.

    Args:
        source: the damaged recording; it is not changed.
        target: the new file, which must not exist yet.
        finger: see `Reader`.

    Raises:
        RecordingError: if nothing can be read, or the target cannot be written; no partial file
            is left.
    """
    reader = Reader(source, tolerant=True, finger=finger)
    path = arguments.path(target, message.RecordingError)
    frames = iter(reader)
    first = next(frames, None)
    if first is None:
        raise message.RecordingError(
            f"{source} has no readable frame: {'; '.join(reader.damage) or 'empty'}"
        )
    metadata = reader.metadata
    writer = Writer(
        path,
        metadata.layout,
        device_id=metadata.device_id,
        calibration=metadata.calibration,
        start_wall=metadata.start_wall,
        made_with=metadata.versions,
    )
    try:
        with writer:
            writer.write(first)
            for frame in frames:
                writer.write(frame)
    except BaseException:
        writer.path.unlink(missing_ok=True)  # a partial file would block the next attempt
        raise
    return Recovered(path, writer.frames, reader.damage)
