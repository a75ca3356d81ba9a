"""`Reader`: the frames of a recording, also of one that broke off."""

import io
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import IO, BinaryIO, NamedTuple, cast

import zstandard
from mcap.exceptions import McapError
from mcap.records import Channel, Chunk, Footer, McapRecord, Message, Schema
from mcap.records import Metadata as MetadataRecord
from mcap.stream_reader import StreamReader, breakup_chunk

from lumitip import arguments
from lumitip.layout import Layout
from lumitip.recording.message import (
    SCHEMA_NAME,
    DamagedError,
    RecordedFrame,
    RecordingError,
    decode,
)
from lumitip.recording.metadata import NAME, Metadata

_MOST_BYTES = 64 * 2**20  # of one record: far above any that `Writer` makes
# All that damaged bytes make the libraries raise, MemoryError by lengths that are nonsense; and
# OSError of a disk that fails or was taken away.
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
    """Damage at some place of a file."""

    why: str
    ends: bool
    """Whether nothing can be read behind it."""


class Reader:
    """Frames of a recording, in order; iterate as often as you like."""

    def __init__(self, path: str | Path, tolerant: bool = False) -> None:
        """Read what the recording says about itself.

        Args:
            path: of the file.
            tolerant: read over damage as well as can be, and tell it in `damage`.

        Raises:
            RecordingError: if the file cannot be read or is no recording.
        """
        self.path = arguments.path(path, RecordingError)
        self.tolerant = tolerant
        self.damage: tuple[str, ...] = ()
        """What was wrong in the last iteration, for people; filled as it goes on."""
        with self._open() as stream:
            self.metadata = read_metadata(stream, str(path))

    @property
    def layout(self) -> Layout:
        """The cells that the frames are of."""
        return self.metadata.layout

    def __iter__(self) -> Iterator[RecordedFrame]:
        """Yield the frames.

        Raises:
            DamagedError: where the file is damaged or cannot be read any more, after the frames
                before; not if tolerant.
            RecordingError: if the file cannot be opened any more.
        """
        self.damage = ()
        frames = 0
        with self._open() as stream:
            for found in read_frames(stream, len(self.layout)):
                if isinstance(found, RecordedFrame):
                    frames += 1
                    yield found
                    continue
                self.damage += (found.why,)
                if not self.tolerant:
                    raise DamagedError(
                        f"{self.path}: {found.why}, after {frames} frames: "
                        f"`lumitip recover {self.path}` saves what is left"
                    )

    def _open(self) -> BinaryIO:
        try:
            stream = self.path.open("rb")
            if not stream.seekable():
                stream.close()
                raise OSError("it is a pipe, a file is needed")
            return stream
        except (OSError, ValueError) as error:
            raise RecordingError(f"{self.path}: cannot be read: {error}") from error


def read_metadata(stream: BinaryIO, source: str) -> Metadata:
    """What a recording says about itself; it stands before the first chunk.

    Raises:
        RecordingError: if the stream is no recording, or breaks off before.
    """
    for record in _records(stream):
        if isinstance(record, MetadataRecord) and record.name == NAME:
            try:
                return Metadata.from_texts(record.metadata)
            except RecordingError as error:
                raise RecordingError(f"{source}: {error}") from error
        if isinstance(record, Fault):
            raise RecordingError(f"{source}: is no recording, or broke off at once: {record.why}")
        if isinstance(record, Chunk | Message):
            break
    raise RecordingError(f"{source}: is MCAP, but no recording of a fingertip")


def read_frames(stream: BinaryIO, cells: int) -> Iterator[RecordedFrame | Fault]:
    """Frames and damage of a recording, in order. Never raises for damage."""
    ours: set[int] = set()
    schemas: dict[int, Schema] = {}
    for record in _unpacked(stream):
        if isinstance(record, Fault):
            yield record
        elif isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            schema = schemas.get(record.schema_id)
            if schema and schema.name == SCHEMA_NAME and record.message_encoding == "cdr":
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
            yield Fault(f"a chunk cannot be read ({_told(error)})", ends=False)
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
    """Records of the file, chunks as a whole, and at last the fault that it breaks off with."""
    try:
        bounded = _Bounded(stream)
    except OSError as error:
        yield Fault(f"it cannot be read ({_told(error)})", ends=True)
        return
    given = cast(IO[bytes], bounded)
    records = StreamReader(given, emit_chunks=True, record_size_limit=_MOST_BYTES).records
    while True:
        try:
            record = next(records)
        except StopIteration:
            return
        except _FAULTS as error:
            at = bounded.tell()
            yield Fault(f"it breaks off near byte {at} ({_told(error)})", ends=True)
            return
        yield record
        if isinstance(record, Footer):
            return


class _Bounded:
    """A stream that is never asked for more than it has, which would be reserved first."""

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


def _told(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
