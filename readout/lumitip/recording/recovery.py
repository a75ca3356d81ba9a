"""Saving what is left of a recording that broke off or has holes."""

from dataclasses import dataclass
from pathlib import Path

from lumitip import arguments
from lumitip.recording.message import RecordingError
from lumitip.recording.reader import Reader
from lumitip.recording.writer import Writer


@dataclass(frozen=True)
class Recovered:
    """What was saved."""

    path: Path
    frames: int
    damage: tuple[str, ...]
    """What was wrong, for people; empty for a sound recording."""


def recover(source: str | Path, target: str | Path) -> Recovered:
    """Write what can be read of a recording to a new file with an index and an end.

    Args:
        source: of the damaged recording; it stays as it is.
        target: of the new one, which must not exist yet.

    Raises:
        RecordingError: if nothing can be read, or the target cannot be written; nothing is left
            of it then.
    """
    reader, path = Reader(source, tolerant=True), arguments.path(target, RecordingError)
    frames = iter(reader)
    first = next(frames, None)
    if first is None:
        raise RecordingError(f"{source}: holds no frame: {'; '.join(reader.damage) or 'empty'}")
    was = reader.metadata
    writer = Writer(
        path,
        was.layout,
        device_id=was.device_id,
        calibration=was.calibration,
        start_wall=was.start_wall,
        made_with=was.versions,
    )
    try:
        with writer:
            writer.write(first)
            for frame in frames:
                writer.write(frame)
    except BaseException:
        writer.path.unlink(missing_ok=True)  # half of it would be in the way of the next attempt
        raise
    return Recovered(path, writer.frames, reader.damage)
