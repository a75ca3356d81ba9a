"""Packets of version 2, the same over Bluetooth and serial: one to 255 frames with their times.

Little-endian. Header: magic u8, version u8, design u16, sequence u16, frames u8, bits u8,
time_us u32, period_us u16; then the values, `frames * cells` raw ADC codes as one stream of bits,
lowest bit first, filled up with zeros to whole bytes; then a CRC-16/CCITT-FALSE over all before.
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
"""Of an ATT MTU, what a notification spends on its own header."""

_HEADER = struct.Struct("<BBHHBBIH")
_CRC = struct.Struct("<H")
HEADER_BYTES = _HEADER.size
CRC_BYTES = _CRC.size

Words = NDArray[np.uint16]


class PacketError(LumitipError, ValueError):
    """Bytes that are no packet of this fingertip, or values that no packet can carry."""

    def __init__(self, reason: str, message: str) -> None:
        super().__init__(message)
        self.reason = reason
        """`"length"`, `"crc"`, `"magic"`, `"version"` or `"bits"`; of `encode` also `"field"`."""


class ForeignPacketError(PacketError):
    """An undamaged packet of a fingertip with another number of cells."""

    def __init__(self, design: int, cells: int, message: str) -> None:
        super().__init__("length", message)
        self.design = design
        """As of `Packet`."""
        self.cells = cells
        """How many cells it is of; 0 where it says that it has no frame."""


@dataclass(frozen=True, eq=False)
class Packet:
    """Consecutive frames of one fingertip; compared by identity, `encode` tells equal ones."""

    design: int
    """First 16 bits of the design hash: `design_code`."""
    sequence: int
    """Number of the first frame, modulo 2**16."""
    bits: int
    """Bits of each code: 8, 10 or 12."""
    time_us: int
    """Device time of the first frame, modulo 2**32 (us)."""
    period_us: int
    """Time from frame to frame within the packet (us)."""
    values: Codes
    """Raw ADC codes, dark is high, shape `(frames, cells)`: uint8 of 8 bits, else uint16."""

    @property
    def frames(self) -> int:
        """How many frames there are."""
        return len(self.values)


def design_code(design_hash: str) -> int:
    """What packets carry of a design hash (hex): its first 16 bits."""
    return int(design_hash[:4], 16)


def frame_bytes(cells: int, bits: int) -> int:
    """Bytes that the values of a single frame take."""
    return _value_bytes(1, cells, bits)


def packet_bytes(frames: int, cells: int, bits: int) -> int:
    """Bytes of a whole packet."""
    return HEADER_BYTES + _value_bytes(frames, cells, bits) + CRC_BYTES


def needed_mtu(cells: int, bits: int) -> int:
    """The smallest ATT MTU at which a notification takes a frame: 51 for 32 cells of 8 bits."""
    return ATT_BYTES + packet_bytes(1, cells, bits)


def largest_batch(mtu: int, cells: int, bits: int) -> int:
    """Whole frames that fit into one notification at an ATT MTU; 0 where not even one does."""
    room = mtu - ATT_BYTES - HEADER_BYTES - CRC_BYTES
    return min(max(room, 0) * 8 // (cells * bits), MOST_FRAMES)


def encode(packet: Packet) -> bytes:
    """The bytes of a packet.

    Raises:
        PacketError: if a field or a value is outside what a packet can carry.
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
    """The packet that these bytes are.

    Args:
        data: one whole packet.
        cells: cells of the fingertip it should come from.

    Raises:
        PacketError: if the bytes are no such packet; nothing is returned in part.
        ForeignPacketError: if they are one of another number of cells, as its checksum proves.
    """
    data = bytes(data)  # Bluetooth libraries reuse their buffers
    least = HEADER_BYTES + CRC_BYTES
    if len(data) < least:
        raise PacketError("length", f"{len(data)} bytes given, a packet has {least} or more")
    fields = _HEADER.unpack_from(data)
    magic, version, design, sequence, frames, bits, time_us, period_us = fields
    if magic != MAGIC:
        raise PacketError("magic", f"first byte 0x{magic:02x} given, a packet has 0x{MAGIC:02x}")
    if version != VERSION:
        raise PacketError(
            "version",
            f"version {version} given, this lumitip reads {VERSION}: install the lumitip that "
            "made the firmware, or flash the firmware of this design again",
        )
    if bits not in BITS:
        raise PacketError("bits", f"{bits} bits given, allowed are {BITS}")
    end = len(data) - CRC_BYTES
    whole = crc_hqx(data[:end], 0xFFFF) == _CRC.unpack_from(data, end)[0]
    wanted = packet_bytes(frames, cells, bits)
    if frames < 1 or len(data) != wanted:
        told = (
            f"{len(data)} bytes given, {frames} frames of {cells} cells at {bits} bits have "
            f"{wanted}: the packet "
        )
        if not whole:
            raise PacketError("length", told + "was cut off")
        found = (end - HEADER_BYTES) * 8 // (frames * bits) if frames else 0
        raise ForeignPacketError(design, found, told + f"comes from a fingertip of {found} cells")
    if not whole:
        raise PacketError("crc", f"{len(data)} bytes whose checksum does not fit: damaged")
    codes = _unpacked(data[HEADER_BYTES:end], frames * cells, bits)
    values = codes.reshape(frames, cells)
    values.flags.writeable = False
    return Packet(design, sequence, bits, time_us, period_us, values)


def _check(packet: Packet, values: Codes) -> None:
    if packet.bits not in BITS:
        raise PacketError("bits", f"{packet.bits} bits given, allowed are {BITS}")
    limits = {"design": 16, "sequence": 16, "time_us": 32, "period_us": 16}
    for name, width in limits.items():
        given = getattr(packet, name)
        if not 0 <= given < 1 << width:
            raise PacketError("field", f"{name}: {given} given, at most {(1 << width) - 1}")
    if values.ndim != 2 or values.dtype.kind not in "ui":
        raise PacketError(
            "field",
            f"values: whole numbers of shape (frames, cells) are needed, "
            f"{values.dtype} of shape {values.shape} given",
        )
    if not 1 <= len(values) <= MOST_FRAMES or not values.shape[1]:
        raise PacketError(
            "length",
            f"{len(values)} frames of {values.shape[1]} cells given, a "
            f"packet has 1 to {MOST_FRAMES} frames of at least a cell",
        )
    if int(values.min()) < 0 or int(values.max()) >> packet.bits:
        raise PacketError(
            "bits",
            f"values from {values.min()} to {values.max()} given, {packet.bits} bits hold 0 to "
            f"{(1 << packet.bits) - 1}",
        )


def _value_bytes(frames: int, cells: int, bits: int) -> int:
    return (frames * cells * bits + 7) // 8


def _packed(codes: Codes, bits: int) -> bytes:
    if bits == 8:
        return codes.astype(np.uint8).tobytes()
    # As few codes as fill whole bytes are shifted into one 64-bit word, whose low bytes count.
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
    # Two neighbouring bytes, read at any address, hold a whole code of 10 or 12 bits.
    words: Words = np.ndarray((len(data) - 1,), "<u2", data, strides=(1,))
    taken: Words = (words[first] >> shift) & np.uint16((1 << bits) - 1)
    return taken


@lru_cache(maxsize=64)
def _places(count: int, bits: int) -> tuple[Integers, Words]:
    """First byte of each code, and how far it is shifted in it."""
    bit = np.arange(count, dtype=np.int64) * bits
    return bit // 8, (bit % 8).astype(np.uint16)
