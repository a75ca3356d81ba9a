"""What a recording holds, in numbers."""

from dataclasses import dataclass
from pathlib import Path

from lumitip.recording.metadata import Metadata
from lumitip.recording.reader import Reader


@dataclass(frozen=True)
class Summary:
    """About a recording as a whole."""

    metadata: Metadata
    frames: int
    seconds: float
    """From the first frame to the last, by the wall clock."""
    lost: int
    """Frames that the device sent and nobody received, as far as it can be told."""
    damage: tuple[str, ...]
    """What is wrong with the file, for people; empty for a sound one."""

    @property
    def rate_hz(self) -> float:
        """Frames a second on average, 0 for less than two frames."""
        return (self.frames - 1) / self.seconds if self.seconds > 0.0 else 0.0


def summarise(path: str | Path) -> Summary:
    """Read a recording from one end to the other, over damage.

    Raises:
        RecordingError: if it is no recording.
    """
    reader = Reader(path, tolerant=True)
    frames, lost, first, last = 0, 0, 0.0, 0.0
    for frame in reader:
        first = first if frames else frame.t_wall
        last = frame.t_wall
        frames += 1
        lost += frame.dropped_before or 0
    return Summary(reader.metadata, frames, last - first, lost, reader.damage)
