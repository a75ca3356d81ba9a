"""The messages of an MCAP recording, and the errors of recordings."""

import math
import struct
from pathlib import Path

import numpy as np

from lumitip.errors import LumitipError
from lumitip.frame import Codes, Frame, RecordedFrame


class RecordingError(LumitipError):
    """A file that cannot be written, or is not a recording of this version."""


class DamagedError(RecordingError):
    """A recording that is truncated or damaged; `lumitip recover` saves the rest."""


LONGEST_GAP_S = 1.0
"""Longest wait for a gap in `lumitip replay` and the live view (s)."""
SCHEMA_NAME = "lumitip_msgs/msg/Frame"


def frames_topic(finger: str) -> str:
    """Topic of the raw codes of a fingertip, in a file with several."""
    return f"/{finger}/frames"


def schema_text() -> str:
    """The definition of the message for ROS 2, with those that it has in it."""
    return Path(__file__).with_name("frame.msg").read_text(encoding="utf-8")


_CDR_LITTLE = b"\x00\x01\x00\x00"
_NUMBERS = struct.Struct("<QddiB3xI")
_TIME = struct.Struct("<iI")
_LENGTH = struct.Struct("<I")
_NANO = 1_000_000_000
_MOST_LOST = (1 << 31) - 1  # the limit of int32
_MOST_SEQ = (1 << 63) - 1  # the limit of int64, for tables and arrays


def stamp_ns(t_wall: float) -> int:
    """A time in nanoseconds, which converts back to the same float."""
    # In two parts: a float of nanoseconds since 1970 has steps of 256.
    seconds = math.floor(t_wall)
    return seconds * _NANO + round((t_wall - seconds) * _NANO)


def missing_before(frame: Frame | RecordedFrame, last_seq: int | None) -> int | None:
    """Frames missing between a frame and the one before it in a file; `None` if unknown.

    Args:
        frame: the frame.
        last_seq: number of the frame before; `None` for the first of the file.
    """
    gap = 0 if last_seq is None else frame.seq - last_seq - 1
    return gap if gap > (frame.dropped_before or 0) else frame.dropped_before


def encode(frame: Frame | RecordedFrame, device_id: str, dropped_before: int | None) -> bytes:
    """Encode a message.

    Args:
        frame: the frame.
        device_id: its device.
        dropped_before: as `missing_before`; `None` if unknown.
    """
    name = device_id.encode() + b"\0"
    sec, nanosec = divmod(stamp_ns(frame.t_wall), _NANO)
    text = _LENGTH.pack(len(name)) + name
    padding = -(len(text) + _TIME.size) % 8
    codes = frame.raw.astype("<u2")
    numbers = _NUMBERS.pack(
        frame.seq,
        float("nan") if frame.t_device is None else frame.t_device,
        frame.t_host,
        -1 if dropped_before is None else min(dropped_before, _MOST_LOST),
        frame.bits,
        codes.size,
    )
    time = _TIME.pack(sec, nanosec)
    return b"".join((_CDR_LITTLE, time, text, bytes(padding), numbers, codes.tobytes()))


def decode(data: bytes, cells: int) -> RecordedFrame:
    """Decode a message.

    Raises:
        RecordingError: if it is not a message of a fingertip with `cells` cells.
    """
    if data[:4] != _CDR_LITTLE:
        raise RecordingError(
            f"a message begins with {data[:4].hex()}; it must be little-endian CDR"
        )
    body = memoryview(data)[4:]
    try:
        sec, nanosec = _TIME.unpack_from(body)
        (length,) = _LENGTH.unpack_from(body, _TIME.size)
        at = _TIME.size + _LENGTH.size + length
        at += -at % 8
        seq, t_device, t_host, dropped, bits, count = _NUMBERS.unpack_from(body, at)
    except struct.error as error:
        raise RecordingError(f"a message of {len(data)} bytes is truncated") from error
    codes = body[at + _NUMBERS.size :]
    if count != cells or len(codes) != 2 * cells or bits not in (8, 10, 12):
        raise RecordingError(
            f"a message has {count} values of {bits} bits in {len(codes)} bytes; {cells} values of "
            "8, 10 or 12 bits are needed"
        )
    raw = np.frombuffer(codes, "<u2")
    out_of_range = int(raw.max()) >> bits or seq > _MOST_SEQ or nanosec >= _NANO
    if out_of_range or not np.isfinite(t_host):
        raise RecordingError("a value or time of a message is out of range")
    kept: Codes = raw.astype(np.uint8) if bits == 8 else raw.astype(np.uint16)
    kept.flags.writeable = False
    return RecordedFrame(
        seq=seq,
        t_device=t_device if np.isfinite(t_device) else None,
        t_host=t_host,
        t_wall=sec + nanosec / _NANO,
        raw=kept,
        bits=bits,
        dropped_before=None if dropped < 0 else dropped,
    )
