"""`Reader` and `summarise`: the frames of a recording, also of a damaged one."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import BinaryIO

from mcap.records import Channel, Message, Schema
from mcap.records import Metadata as MetadataRecord

from lumitip import arguments
from lumitip.frame import RecordedFrame
from lumitip.layout import Layout
from lumitip.recording.message import (
    SCHEMA_NAME,
    DamagedError,
    RecordingError,
    decode,
    frames_topic,
    missing_before,
)
from lumitip.recording.metadata import FINGER, NAME, Metadata
from lumitip.recording.records import Fault, records


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
        with opened(self.path) as stream:
            self.finger, self.metadata = read_metadata(stream, str(path), finger)

    def __repr__(self) -> str:
        return f"<Reader {self.path}: {self.metadata.device_id}, {self.layout!r}>"

    @property
    def layout(self) -> Layout:
        """The cells of the frames."""
        return self.metadata.layout

    def __iter__(self) -> Iterator[RecordedFrame]:
        """Yield the frames. `dropped_before` counts those too that the file has lost.

        Raises:
            DamagedError: at the first damage, unless tolerant.
            RecordingError: if the file cannot be opened.
        """
        self.damage = ()
        frames, last_seq = 0, None
        with opened(self.path) as stream:
            for found in read_frames(stream, len(self.layout), self.finger):
                if isinstance(found, RecordedFrame):
                    missing = missing_before(found, last_seq)
                    frames, last_seq = frames + 1, found.seq
                    yield replace(found, dropped_before=missing)
                    continue
                self.damage += (found.why,)
                if not self.tolerant:
                    raise DamagedError(
                        f"{self.path}: {found.why}, after {frames} frames. "
                        f"`lumitip recover {self.path}` saves the readable frames"
                    )


@dataclass(frozen=True)
class Summary:
    """Summary of a recording."""

    metadata: Metadata
    frames: int
    seconds: float
    """From the first frame to the last, by the wall clock."""
    lost: int
    """Frames missing in the file, as far as known: lost on the link, not taken in time by the
    program that recorded, or in a damaged part."""
    lost_known: bool
    """Whether that is all of them: the published firmware does not number its frames."""
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
    frames, lost, known, first, last = 0, 0, True, 0.0, 0.0
    for frame in reader:
        first = first if frames else frame.t_wall
        last = frame.t_wall
        frames += 1
        lost += frame.dropped_before or 0
        known = known and frame.dropped_before is not None
    return Summary(reader.metadata, frames, last - first, lost, known, reader.damage)


def fingers(path: str | Path) -> tuple[str, ...]:
    """Names of the fingertips of a file, in its order; one that is empty in a recording of one.

    Raises:
        RecordingError: if the file cannot be read or is not a recording.
    """
    file = arguments.path(path, RecordingError)
    with opened(file) as stream:
        return tuple(_texts(stream, str(path)))


def opened(path: Path) -> BinaryIO:
    """The file, to be read.

    Raises:
        RecordingError: if it cannot be.
    """
    try:
        stream = path.open("rb")
        if not stream.seekable():
            stream.close()
            raise OSError("it is a pipe; a file is needed")
        return stream
    except (OSError, ValueError) as error:
        raise RecordingError(f"{path}: cannot be read: {error}") from error


def read_metadata(stream: BinaryIO, source: str, finger: str | None = None) -> tuple[str, Metadata]:
    """Name and metadata of a fingertip; all are before the first chunk. The name is empty in a file
    with one fingertip.

    Raises:
        RecordingError: if the stream is not a recording, or ends too early, or has several
            fingertips and not the one that is named.
    """
    texts = _texts(stream, source)
    chosen = next(iter(texts)) if finger is None and len(texts) == 1 else finger
    if chosen not in texts:
        raise RecordingError(_unknown_finger(source, finger, list(texts)))
    try:
        return chosen, Metadata.from_texts(texts[chosen])
    except RecordingError as error:
        raise RecordingError(f"{source}: {error}") from error


def _texts(stream: BinaryIO, source: str) -> dict[str, dict[str, str]]:
    """Metadata of each fingertip of a file, by name."""
    texts: dict[str, dict[str, str]] = {}
    for record in records(stream):
        if isinstance(record, MetadataRecord) and record.name == NAME:
            texts[record.metadata.get(FINGER, "")] = record.metadata
        if isinstance(record, Fault) and not texts:
            raise RecordingError(f"{source} is no MCAP recording, or is cut off: {record.why}")
        if isinstance(record, Schema | Channel | Message | Fault):
            break
    if not texts:
        raise RecordingError(f"{source} is an MCAP file, but not a recording of a fingertip")
    return texts


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
    # In a recording of one fingertip the only channel may be in a damaged chunk.
    ours: dict[int, bool] = {}
    schemas: dict[int, Schema] = {}
    for record in records(stream):
        if isinstance(record, Fault):
            yield record
        elif isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            schema = schemas.get(record.schema_id)
            whose = not finger or record.topic == frames_topic(finger)
            cdr = record.message_encoding == "cdr"
            known = schema is not None and schema.name == SCHEMA_NAME
            ours[record.id] = known and cdr and whose
        elif isinstance(record, Message) and ours.get(record.channel_id, not finger):
            try:
                yield decode(record.data, cells)
            except RecordingError as error:
                yield Fault(str(error), ends=False)
