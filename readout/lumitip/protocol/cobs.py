"""COBS (Cheshire and Baker, "Consistent overhead byte stuffing", 1999): bytes without a zero.

On a serial line a zero then ends each packet, and a reader finds the next one after any damage.
"""

from lumitip.errors import LumitipError

DELIMITER = b"\0"
_RUN = 254  # most bytes that one code byte stands before


class CobsError(LumitipError, ValueError):
    """Bytes that no encoder made."""


def encode(data: bytes) -> bytes:
    """Bytes without a zero that stand for `data`; the delimiter is not added."""
    out = bytearray()
    *before, last = bytes(data).split(DELIMITER)
    for run in before:
        out += _stuffed(run)
    # A full run stands for no zero, so nothing need follow it at the end.
    return bytes(out + _stuffed(last, closed=bool(last) and len(last) % _RUN == 0))


def encoded_bytes(length: int) -> int:
    """Most bytes that `length` bytes become."""
    return length + max(1, -(-length // _RUN))


def decode(data: bytes) -> bytes:
    """The bytes that `data` stands for.

    Args:
        data: what was between two delimiters.

    Raises:
        CobsError: if it is empty, holds a zero or ends within a run.
    """
    if not data or 0 in data:
        raise CobsError("nothing given" if not data else "a zero given, which only ends packets")
    out = bytearray()
    at, end = 0, len(data)
    while at < end:
        code = data[at]
        if at + code > end:
            raise CobsError(f"{end} bytes given, a run ends {at + code - end} bytes beyond them")
        out += data[at + 1 : at + code]
        at += code
        if code <= _RUN and at < end:
            out += DELIMITER
    return bytes(out)


def _stuffed(run: bytes, closed: bool = False) -> bytearray:
    out = bytearray()
    full = len(run) // _RUN * _RUN
    for at in range(0, full, _RUN):
        out += b"\xff" + run[at : at + _RUN]
    if not closed:
        out.append(len(run) - full + 1)
        out += run[full:]
    return out
