"""Recordings: the file that a writer makes, and the same in other chunks, or none, and without
checksums, so that damage reaches the messages."""

import io
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter

from fuzz.layouts import layouts
from lumitip import Layout
from lumitip.recording import RecordedFrame, RecordingError, Writer
from lumitip.recording.message import SCHEMA_NAME, encode, frames_topic, schema_text
from lumitip.recording.metadata import FINGER, NAME
from lumitip.recording.reader import read_frames, read_metadata

_MOST_FRAMES = 1000  # of the few that are in the files, however the damage repeats them


@cache
def recordings() -> tuple[bytes, ...]:
    """A few frames of a small fingertip."""
    layout = Layout.from_json(layouts()[0].decode())
    frames = [
        RecordedFrame(
            number,
            0.1 * number,
            5.0 + number,
            1e9 + number,
            np.full(len(layout), number, np.uint8),
            8,
            None if number else 0,
        )
        for number in range(4)
    ]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "run.mcap"
        with Writer(path, layout, device_id="AA:BB", start_wall=1e9, made_with={}) as writer:
            for frame in frames:
                writer.write(frame)
        whole = path.read_bytes()
    texts = writer.metadata.to_texts()
    kinds: tuple[dict[str, Any], ...] = (
        {"compression": CompressionType.NONE},
        {"compression": CompressionType.LZ4},
        {"use_chunking": False},
    )
    others = (_unguarded(texts, frames, kind, "/lumitip/frames") for kind in kinds)
    named = _unguarded(texts | {FINGER: "left"}, frames, kinds[0], frames_topic("left"))
    return whole, *others, named


def _unguarded(
    texts: dict[str, str], frames: list[RecordedFrame], kind: dict[str, Any], topic: str
) -> bytes:
    """The same frames in another kind of file, without checksums."""
    bare = io.BytesIO()
    mcap = McapWriter(bare, enable_crcs=False, **kind)
    mcap.start(profile="ros2")
    mcap.add_metadata(NAME, texts)
    schema = mcap.register_schema(SCHEMA_NAME, "ros2msg", schema_text().encode())
    channel = mcap.register_channel(topic, "cdr", schema)
    for frame in frames:
        mcap.add_message(channel, 0, encode(frame, "AA:BB", frame.dropped_before), 0)
    mcap.finish()
    return bare.getvalue()


def read_recording(data: bytes) -> None:
    """Read metadata and all frames; damage inside is reported, never raised."""
    stream = io.BytesIO(data)
    try:
        finger, metadata = read_metadata(stream, "input")
        cells, refused = len(metadata.layout), None
    except RecordingError as error:
        finger, cells, refused = "", 3, error
    for found, frame in enumerate(read_frames(stream, cells, finger)):
        assert found < _MOST_FRAMES
        if isinstance(frame, RecordedFrame):
            assert frame.raw.shape == (cells,)
            assert int(frame.raw.max()) < 1 << frame.bits
    if refused is not None:
        raise refused
