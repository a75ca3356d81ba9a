"""Recordings: MCAP files with ROS 2 messages that need no other file to be read.

with Writer("run.mcap", layout, device_id=tip.device_id) as writer:
    for frame in tip.frames():
        writer.write(frame)
for frame in Reader("run.mcap"): ...
"""

from lumitip.errors import MissingExtra

try:
    from lumitip.recording.reader import Reader
    from lumitip.recording.recovery import Recovered, recover
    from lumitip.recording.summary import Summary, summarise
    from lumitip.recording.tables import export
    from lumitip.recording.writer import Writer
except ModuleNotFoundError as error:
    if (error.name or "").partition(".")[0] not in ("mcap", "zstandard"):
        raise
    raise MissingExtra("record", "recording") from error
from lumitip.recording.message import LONGEST_GAP_S, DamagedError, RecordedFrame, RecordingError
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
    "recover",
    "summarise",
]
