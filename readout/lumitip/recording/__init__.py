"""Recordings: self-contained MCAP files with ROS 2 messages.

with Writer("run.mcap", layout, device_id=tip.device_id) as writer:
    for frame in tip.frames():
        writer.write(frame)
for frame in Reader("run.mcap"): ...
"""

from lumitip.errors import MissingExtra
from lumitip.frame import RecordedFrame

try:
    from lumitip.recording.reader import Reader, Summary, fingers, summarise
    from lumitip.recording.tables import export
    from lumitip.recording.writer import Recovered, Writer, recover
except ModuleNotFoundError as error:
    if (error.name or "").partition(".")[0] not in ("mcap", "zstandard"):
        raise
    raise MissingExtra("record", "recording") from error
from lumitip.recording.message import LONGEST_GAP_S, DamagedError, RecordingError
from lumitip.recording.metadata import Metadata

__all__ = [
    "LONGEST_GAP_S",
    "DamagedError",
    "Metadata",
    "Reader",
    "RecordedFrame",
    "RecordingError",
    "Recovered",
    "Summary",
    "Writer",
    "export",
    "fingers",
    "recover",
    "summarise",
]
