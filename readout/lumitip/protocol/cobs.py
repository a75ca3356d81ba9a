"""Packets on a serial line: COBS, and a decoder of the stream.

COBS (Cheshire and Baker, "Consistent overhead byte stuffing", 1999) removes all zeros, so that a
zero can end each packet, and a reader finds the next packet after any damage.
"""

from lumitip.errors import LumitipError
from lumitip.protocol.packet import MOST_FRAMES, Packet, PacketError, packet_bytes
from lumitip.protocol.packet import decode as decode_packet

DELIMITER = b"\0"
_RUN = 254  # most bytes after one code byte


class CobsError(LumitipError, ValueError):
    """Bytes that are not COBS."""


def encode(data: bytes) -> bytes:
    """Encode `data`, without a delimiter."""
    out = bytearray()
    *before, last = bytes(data).split(DELIMITER)
    for run in before:
        out += _stuffed(run)
    # A full run implies no zero, so it may be the last one.
    return bytes(out + _stuffed(last, closed=bool(last) and len(last) % _RUN == 0))


def encoded_bytes(length: int) -> int:
    """Largest encoded size of `length` bytes."""
    return length + max(1, -(-length // _RUN))


def decode(data: bytes) -> bytes:
    """Decode the bytes between two delimiters.

    Raises:
        CobsError: if `data` is empty, contains a zero or ends within a run.
    """
    if not data or 0 in data:
        raise CobsError("a zero within the data" if data else "there are no data")
    out = bytearray()
    at, end = 0, len(data)
    while at < end:
        code = data[at]
        if at + code > end:
            raise CobsError(f"a run ends {at + code - end} bytes after the {end} bytes of data")
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


class StreamDecoder:
    """Decodes the packets of a serial stream, in bounded memory. Not thread-safe.

    Args:
        cells: cells of the fingertip.
        mid_stream: the first bytes may be the end of a packet, which is not counted as dropped.
    """

    def __init__(self, cells: int, mid_stream: bool = False) -> None:
        self.dropped = {"crc": 0, "length": 0}
        """Packets that could not be decoded: wrong `"length"`, or other damage."""
        self.last_error: LumitipError | None = None
        """The error of the last one."""
        self._cells = cells
        self._partial = mid_stream
        self._most = encoded_bytes(packet_bytes(MOST_FRAMES, cells, 12))
        self._rest = bytearray()
        self._overlong = False

    def feed(self, chunk: bytes) -> list[Packet]:
        """The packets that end within this chunk."""
        *ended, rest = chunk.split(DELIMITER)
        packets = []
        for piece in ended:
            self._hold(piece)
            if packet := self._decoded():
                packets.append(packet)
        self._hold(rest)
        return packets

    def _hold(self, piece: bytes) -> None:
        if len(self._rest) + len(piece) > self._most and not self._overlong:
            # Reported at once: another kind of device may never send a delimiter.
            self._overlong = True
            self._rest.clear()
            text = f"more than {self._most} bytes without a delimiter: is this a fingertip?"
            self._drop(PacketError("length", text))
        if not self._overlong:
            self._rest += piece

    def _decoded(self) -> Packet | None:
        """The packet that the delimiter has ended."""
        data, overlong, partial = bytes(self._rest), self._overlong, self._partial
        self._rest.clear()
        self._overlong = self._partial = False
        if overlong or not data:
            return None  # reported already, or several delimiters in a row
        try:
            return decode_packet(decode(data), self._cells)
        except (PacketError, CobsError) as error:
            if partial:
                self.last_error = error
            else:
                self._drop(error)
            return None

    def _drop(self, error: LumitipError) -> None:
        self.last_error = error
        self.dropped["length" if _by_length(error) else "crc"] += 1


def _by_length(error: LumitipError) -> bool:
    # A truncated packet usually ends within a run.
    return isinstance(error, CobsError) or getattr(error, "reason", "") == "length"
