"""Packets out of a stream of bytes, however it is cut up, in bounded memory."""

from lumitip.errors import LumitipError
from lumitip.protocol import cobs
from lumitip.protocol.packet import MOST_FRAMES, Packet, PacketError, decode, packet_bytes


class StreamDecoder:
    """Finds the packets of a serial line. Not thread-safe: feed it from one thread.

    Args:
        cells: cells of the fingertip.
        mid_stream: whether the first bytes may be the end of a packet that began before anyone
            listened; a damaged first one is then not counted as dropped.
    """

    def __init__(self, cells: int, mid_stream: bool = False) -> None:
        self.dropped = {"crc": 0, "length": 0}
        """Packets that could not be read: of a wrong `"length"`, or damaged otherwise."""
        self.last_error: LumitipError | None = None
        """Why the last of them could not be read."""
        self._cells = cells
        self._partial = mid_stream
        self._most = cobs.encoded_bytes(packet_bytes(MOST_FRAMES, cells, 12))
        self._rest = bytearray()
        self._overlong = False

    def feed(self, chunk: bytes) -> list[Packet]:
        """The packets that end within this chunk, in order."""
        *ended, rest = chunk.split(cobs.DELIMITER)
        packets = []
        for piece in ended:
            self._hold(piece)
            packet = self._taken()
            if packet is not None:
                packets.append(packet)
        self._hold(rest)
        return packets

    def _hold(self, piece: bytes) -> None:
        if len(self._rest) + len(piece) > self._most and not self._overlong:
            # Told at once: what sends no delimiter at all, like text, may never send one.
            self._overlong = True
            self._rest.clear()
            told = f"more than {self._most} bytes without a delimiter: is this a fingertip?"
            self._refuse(PacketError("length", told))
        if not self._overlong:
            self._rest += piece

    def _taken(self) -> Packet | None:
        """The packet held back, now that its delimiter is here."""
        data, overlong, partial = bytes(self._rest), self._overlong, self._partial
        self._rest.clear()
        self._overlong = self._partial = False
        if overlong or not data:
            return None  # it was told already; delimiters may be sent in a row
        try:
            return decode(cobs.decode(data), self._cells)
        except (PacketError, cobs.CobsError) as error:
            if partial:
                self.last_error = error
            else:
                self._refuse(error)
            return None

    def _refuse(self, error: LumitipError) -> None:
        self.last_error = error
        self.dropped["length" if _by_length(error) else "crc"] += 1


def _by_length(error: LumitipError) -> bool:
    # A packet cut off on the line mostly ends within a run of its COBS form.
    return isinstance(error, cobs.CobsError) or getattr(error, "reason", "") == "length"
