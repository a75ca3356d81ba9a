"""Packets of version 2, for Bluetooth and serial: one to 255 frames with their times.

Little-endian. Header: magic u8, version u8, design u16, sequence u16, frames u8, bits u8,
time_us u32, period_us u16. Then `frames * cells` ADC codes as one stream of bits, lowest bit
first, padded with zeros to whole bytes. Then a CRC-16/CCITT-FALSE of all before.
"""

import struct
from binascii import crc_hqx
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lumitip.errors import LumitipError
from lumitip.frame import Codes
from lumitip.grid import Integers

MAGIC = 0x4C
VERSION = 2
BITS = (8, 10, 12)
MOST_FRAMES = 255
ATT_BYTES = 3
"""Header of a notification, part of the ATT MTU."""

_HEADER = struct.Struct("<BBHHBBIH")
_CRC = struct.Struct("<H")
HEADER_BYTES = _HEADER.size
CRC_BYTES = _CRC.size

Words = NDArray[np.uint16]


class PacketError(LumitipError, ValueError):
    """Bytes that are not a packet of this fingertip, or values out of range."""

    def __init__(self, reason: str, message: str) -> None:
        super().__init__(message)
        self.reason = reason
        """`"length"`, `"crc"`, `"magic"`, `"version"` or `"bits"`; from `encode` also `"field"`."""


class ForeignPacketError(PacketError):
    """An intact packet of a fingertip with another number of cells."""

    def __init__(self, design: int, cells: int, message: str) -> None:
        super().__init__("length", message)
        self.design = design
        """See `Packet`."""
        self.cells = cells
        """Its number of cells; 0 if it has no frame."""


@dataclass(frozen=True, eq=False)
class Packet:
    """Consecutive frames of one fingertip; compared by identity."""

    design: int
    """First 16 bits of the design hash: `design_code`."""
    sequence: int
    """Number of the first frame, modulo 2**16."""
    bits: int
    """Bits of each code: 8, 10 or 12."""
    time_us: int
    """Device clock of the first frame, modulo 2**32 (us)."""
    period_us: int
    """Time between the frames (us)."""
    values: Codes
    """ADC codes, high is dark, shape `(frames, cells)`: uint8 for 8 bits, else uint16."""

    @property
    def frames(self) -> int:
        """Number of frames."""
        return len(self.values)


def design_code(design_hash: str) -> int:
    """First 16 bits of a design hash (hex)."""
    return int(design_hash[:4], 16)


def frame_bytes(cells: int, bits: int) -> int:
    """Bytes of the values of one frame."""
    return _value_bytes(1, cells, bits)


def packet_bytes(frames: int, cells: int, bits: int) -> int:
    """Bytes of a whole packet."""
    return HEADER_BYTES + _value_bytes(frames, cells, bits) + CRC_BYTES


def needed_mtu(cells: int, bits: int) -> int:
    """Smallest ATT MTU for one frame in a notification: 51 for 32 cells of 8 bits."""
    return ATT_BYTES + packet_bytes(1, cells, bits)


def largest_batch(mtu: int, cells: int, bits: int) -> int:
    """Number of frames that fit into one notification; may be 0."""
    room = mtu - ATT_BYTES - HEADER_BYTES - CRC_BYTES
    return min(max(room, 0) * 8 // (cells * bits), MOST_FRAMES)


def encode(packet: Packet) -> bytes:
    """The bytes of a packet.

    Raises:
        PacketError: if a field or a value is out of range.
    """
    values = packet.values
    _check(packet, values)
    head = _HEADER.pack(
        MAGIC,
        VERSION,
        packet.design,
        packet.sequence,
        len(values),
        packet.bits,
        packet.time_us,
        packet.period_us,
    )
    body = head + _packed(values.ravel(), packet.bits)
    return body + _CRC.pack(crc_hqx(body, 0xFFFF))


def decode(data: bytes, cells: int) -> Packet:
    """Parse one whole packet of a fingertip with `cells` cells.

    Raises:
        PacketError: if the bytes are not such a packet.
        ForeignPacketError: if they are an intact packet of another number of cells.
    """
    data = bytes(data)  # Bluetooth libraries reuse their buffers
    least = HEADER_BYTES + CRC_BYTES
    if len(data) < least:
        raise PacketError("length", f"a packet has {len(data)} bytes; at least {least} are needed")
    fields = _HEADER.unpack_from(data)
    magic, version, design, sequence, frames, bits, time_us, period_us = fields
    if magic != MAGIC:
        raise PacketError("magic", f"the first byte is 0x{magic:02x}; a packet has 0x{MAGIC:02x}")
    end = len(data) - CRC_BYTES
    whole = crc_hqx(data[:end], 0xFFFF) == _CRC.unpack_from(data, end)[0]
    if not whole and (version != VERSION or bits not in BITS):
        raise _wrong_checksum(data)
    if version != VERSION:
        raise PacketError(
            "version",
            f"the version is {version}; this lumitip reads {VERSION}. Install the lumitip that "
            "wrote the firmware, or flash the firmware of this design again",
        )
    if bits not in BITS:
        raise PacketError("bits", f"bits is {bits}; allowed are {BITS}")
    length = packet_bytes(frames, cells, bits)
    if frames < 1 or len(data) != length:
        text = (
            f"a packet has {len(data)} bytes; {frames} frames of {cells} cells with {bits} bits "
            f"have {length}: it "
        )
        if not whole:
            raise PacketError("length", text + "was cut off")
        found = (end - HEADER_BYTES) * 8 // (frames * bits) if frames else 0
        raise ForeignPacketError(design, found, text + f"comes from a fingertip of {found} cells")
    if not whole:
        raise _wrong_checksum(data)
    codes = _unpacked(data[HEADER_BYTES:end], frames * cells, bits)
    values = codes.reshape(frames, cells)
    values.flags.writeable = False
    return Packet(design, sequence, bits, time_us, period_us, values)


def _wrong_checksum(data: bytes) -> PacketError:
    return PacketError("crc", f"the checksum of {len(data)} bytes is wrong")


def _check(packet: Packet, values: Codes) -> None:
    if packet.bits not in BITS:
        raise PacketError("bits", f"bits is {packet.bits}; allowed are {BITS}")
    limits = {"design": 16, "sequence": 16, "time_us": 32, "period_us": 16}
    for name, width in limits.items():
        value = getattr(packet, name)
        if not 0 <= value < 1 << width:
            raise PacketError("field", f"{name} is {value}; the limit is {(1 << width) - 1}")
    if values.ndim != 2 or values.dtype.kind not in "ui":
        raise PacketError(
            "field",
            f"values are {values.dtype} of shape {values.shape}; integers of shape (frames, cells) "
            "are needed",
        )
    if not 1 <= len(values) <= MOST_FRAMES or not values.shape[1]:
        raise PacketError(
            "length",
            f"values have {len(values)} frames of {values.shape[1]} cells; 1 to {MOST_FRAMES} "
            "frames of at least one cell are needed",
        )
    if int(values.min()) < 0 or int(values.max()) >> packet.bits:
        raise PacketError(
            "bits",
            f"values are from {values.min()} to {values.max()}; {packet.bits} bits allow 0 to "
            f"{(1 << packet.bits) - 1}",
        )


def _value_bytes(frames: int, cells: int, bits: int) -> int:
    return (frames * cells * bits + 7) // 8


def _packed(codes: Codes, bits: int) -> bytes:
    if bits == 8:
        return codes.astype(np.uint8).tobytes()
    # The smallest group of codes that fills whole bytes goes into the low bytes of a 64-bit word.
    group = {10: 4, 12: 2}[bits]
    filled = np.zeros((-(-codes.size // group), group), np.uint64)
    filled.ravel()[: codes.size] = codes
    words = np.bitwise_or.reduce(filled << (np.arange(group, dtype=np.uint64) * bits), axis=1)
    lanes = words.astype("<u8").view(np.uint8).reshape(-1, 8)[:, : group * bits // 8]
    packed: bytes = lanes.tobytes()
    return packed[: _value_bytes(1, codes.size, bits)]


def _unpacked(data: bytes, count: int, bits: int) -> Codes:
    if bits == 8:
        return np.frombuffer(data, np.uint8)
    first, shift = _places(count, bits)
    # Each code of 10 or 12 bits is within two neighbouring bytes.
    words: Words = np.ndarray((len(data) - 1,), "<u2", data, strides=(1,))
    taken: Words = (words[first] >> shift) & np.uint16((1 << bits) - 1)
    return taken


@lru_cache(maxsize=64)
def _places(count: int, bits: int) -> tuple[Integers, Words]:
    """First byte of each code, and its shift within it."""
    bit = np.arange(count, dtype=np.int64) * bits
    return bit // 8, (bit % 8).astype(np.uint16)
