"""`Reader` and `summarise`: the frames of a recording, also of a damaged one."""

import io
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, BinaryIO, NamedTuple, cast

import zstandard
from mcap.exceptions import EndOfFile, InvalidMagic, McapError
from mcap.records import Channel, Chunk, Footer, McapRecord, Message, Schema
from mcap.records import Metadata as MetadataRecord
from mcap.stream_reader import StreamReader, breakup_chunk

from lumitip import arguments
from lumitip.frame import RecordedFrame
from lumitip.layout import Layout
from lumitip.recording.message import (
    SCHEMA_NAME,
    DamagedError,
    RecordingError,
    decode,
    frames_topic,
)
from lumitip.recording.metadata import FINGER, NAME, Metadata

_MOST_BYTES = 64 * 2**20  # of one record: far above those of `Writer`
# Exceptions of the libraries for damaged bytes (MemoryError for a wrong length), and OSError of a
# failed or removed disk.
_FAULTS = (
    McapError,
    ValueError,
    struct.error,
    zstandard.ZstdError,
    RuntimeError,
    EOFError,
    OverflowError,
    MemoryError,
    KeyError,
    IndexError,
    TypeError,
    OSError,
)


class Fault(NamedTuple):
    """Damage of a file."""

    why: str
    ends: bool
    """Whether nothing after it can be read."""


class Reader:
    """Frames of a recording, in order; can be iterated repeatedly."""

    def __init__(self, path: str | Path, tolerant: bool = False, finger: str | None = None) -> None:
        """Read the metadata.

        Args:
            path: of the file.
            tolerant: skip damaged parts and list them in `damage`.
            finger: name of a fingertip in a file with several, as `lumitip foxglove` writes.

        Raises:
            RecordingError: if the file cannot be read or is not a recording, or has several
                fingertips and not the one that is named.
        """
        self.path = arguments.path(path, RecordingError)
        self.tolerant = tolerant
        self.damage: tuple[str, ...] = ()
        """Damage found in the last or current iteration, for the user."""
        with self._open() as stream:
            self.finger, self.metadata = read_metadata(stream, str(path), finger)

    def __repr__(self) -> str:
        return f"<Reader {self.path}: {self.metadata.device_id}, {self.layout!r}>"

    @property
    def layout(self) -> Layout:
        """The cells of the frames."""
        return self.metadata.layout

    def __iter__(self) -> Iterator[RecordedFrame]:
        """Yield the frames.

        Raises:
            DamagedError: at the first damage, unless tolerant.
            RecordingError: if the file cannot be opened.
        """
        self.damage = ()
        frames = 0
        with self._open() as stream:
            for found in read_frames(stream, len(self.layout), self.finger):
                if isinstance(found, RecordedFrame):
                    frames += 1
                    yield found
                    continue
                self.damage += (found.why,)
                if not self.tolerant:
                    raise DamagedError(
                        f"{self.path}: {found.why}, after {frames} frames. "
                        f"`lumitip recover {self.path}` saves the readable frames"
                    )

    def _open(self) -> BinaryIO:
        try:
            stream = self.path.open("rb")
            if not stream.seekable():
                stream.close()
                raise OSError("it is a pipe; a file is needed")
            return stream
        except (OSError, ValueError) as error:
            raise RecordingError(f"{self.path}: cannot be read: {error}") from error


@dataclass(frozen=True)
class Summary:
    """Summary of a recording."""

    metadata: Metadata
    frames: int
    seconds: float
    """From the first frame to the last, by the wall clock."""
    lost: int
    """Frames sent but not received, as far as known."""
    damage: tuple[str, ...]
    """Damage of the file, for the user."""

    @property
    def rate_hz(self) -> float:
        """Mean frame rate; 0 for less than two frames."""
        return (self.frames - 1) / self.seconds if self.seconds > 0.0 else 0.0


def summarise(path: str | Path, finger: str | None = None) -> Summary:
    """Read a whole recording, skipping damaged parts.

    Args:
        path: of the file.
        finger: see `Reader`.

    Raises:
        RecordingError: if it is not a recording.
    """
    reader = Reader(path, tolerant=True, finger=finger)
    frames, lost, first, last = 0, 0, 0.0, 0.0
    for frame in reader:
        first = first if frames else frame.t_wall
        last = frame.t_wall
        frames += 1
        lost += frame.dropped_before or 0
    return Summary(reader.metadata, frames, last - first, lost, reader.damage)


def read_metadata(stream: BinaryIO, source: str, finger: str | None = None) -> tuple[str, Metadata]:
    """Name and metadata of a fingertip; all are before the first chunk. The name is empty in a file
    with one fingertip.

    Raises:
        RecordingError: if the stream is not a recording, or ends too early, or has several
            fingertips and not the one that is named.
    """
    texts: dict[str, dict[str, str]] = {}
    for record in _records(stream):
        if isinstance(record, MetadataRecord) and record.name == NAME:
            texts[record.metadata.get(FINGER, "")] = record.metadata
        if isinstance(record, Fault) and not texts:
            raise RecordingError(f"{source} is no MCAP recording, or is cut off: {record.why}")
        if isinstance(record, Chunk | Message | Fault):
            break
    if not texts:
        raise RecordingError(f"{source} is an MCAP file, but not a recording of a fingertip")
    chosen = next(iter(texts)) if finger is None and len(texts) == 1 else finger
    if chosen not in texts:
        raise RecordingError(_unknown_finger(source, finger, list(texts)))
    try:
        return chosen, Metadata.from_texts(texts[chosen])
    except RecordingError as error:
        raise RecordingError(f"{source}: {error}") from error


def _unknown_finger(source: str, finger: str | None, names: list[str]) -> str:
    if names == [""]:
        return f"finger is {finger!r:.60}; {source} has one fingertip, which has no name"
    asked = "no finger was named" if finger is None else f"finger is {finger!r:.60}"
    return f"{asked}; {source} has {', '.join(map(repr, names))}: choose one"


def read_frames(stream: BinaryIO, cells: int, finger: str = "") -> Iterator[RecordedFrame | Fault]:
    """Frames and damage of a recording, in order. Never raises for damage.

    Args:
        stream: the file.
        cells: of each frame.
        finger: whose frames, in a file with several fingertips.
    """
    ours: set[int] = set()
    schemas: dict[int, Schema] = {}
    for record in _unpacked(stream):
        if isinstance(record, Fault):
            yield record
        elif isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            schema = schemas.get(record.schema_id)
            whose = not finger or record.topic == frames_topic(finger)
            cdr = record.message_encoding == "cdr"
            if schema and schema.name == SCHEMA_NAME and cdr and whose:
                ours.add(record.id)
        elif isinstance(record, Message) and record.channel_id in ours:
            try:
                yield decode(record.data, cells)
            except RecordingError as error:
                yield Fault(str(error), ends=False)


def _unpacked(stream: BinaryIO) -> Iterator[McapRecord | Fault]:
    """Records of the file, those within chunks included."""
    for record in _records(stream):
        if not isinstance(record, Chunk):
            yield record
            continue
        try:
            inside = _opened(record)
        except _FAULTS as error:
            yield Fault(f"a chunk cannot be read ({_text(error)})", ends=False)
        else:
            yield from inside


def _opened(chunk: Chunk) -> list[McapRecord]:
    size = chunk.uncompressed_size
    if chunk.compression == "zstd":
        size = max(size, zstandard.frame_content_size(chunk.data))
    if size > _MOST_BYTES:
        raise ValueError(f"{size} bytes")
    return breakup_chunk(chunk, validate_crc=True)


def _records(stream: BinaryIO) -> Iterator[McapRecord | Fault]:
    """Records of the file, with whole chunks; the last may be a fault."""
    try:
        bounded = _Bounded(stream)
    except OSError as error:
        yield Fault(f"it cannot be read ({_text(error)})", ends=True)
        return
    source = cast(IO[bytes], bounded)
    records = StreamReader(source, emit_chunks=True, record_size_limit=_MOST_BYTES).records
    while True:
        try:
            record = next(records)
        except StopIteration:
            return
        except _FAULTS as error:
            at = bounded.tell()
            yield Fault(f"it ends near byte {at} ({_text(error)})", ends=True)
            return
        yield record
        if isinstance(record, Footer):
            return


class _Bounded:
    """A stream that limits reads to its size: Python allocates what is asked for first."""

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream
        self._left = stream.seek(0, io.SEEK_END)
        self._size = self._left
        stream.seek(0)

    def read(self, size: int = -1) -> bytes:
        data = self._stream.read(self._left if size < 0 else min(size, self._left))
        self._left -= len(data)
        return data

    def tell(self) -> int:
        return self._size - self._left


def _text(error: BaseException) -> str:
    if isinstance(error, InvalidMagic):
        return "not the bytes that begin and end an MCAP file"
    if isinstance(error, struct.error | EOFError | EndOfFile):
        return "the bytes of a record are missing"
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
