"""Bluetooth: UUIDs, the status characteristic, and the frames of the published firmware."""

import struct
from dataclasses import dataclass
from enum import IntFlag

import numpy as np
from numpy.typing import NDArray

from lumitip.protocol.packet import ATT_BYTES, VERSION, PacketError

SERVICE = "7d1c0001-6c75-4d69-9469-700000000000"
FRAMES = "7d1c0002-6c75-4d69-9469-700000000000"
"""Notifies packets: `lumitip.protocol.packet`."""
STATUS = "7d1c0003-6c75-4d69-9469-700000000000"
"""Read and notified: `lumitip.protocol.bluetooth`."""


LEGACY_SERVICE = "0000ecbc-0000-1000-8000-00805f9b34fb"
LEGACY_FRAMES = "0000c134-0000-1000-8000-00805f9b34fb"
"""Read and notified."""


def legacy_mtu(cells: int) -> int:
    """The smallest ATT MTU at which a notification takes a frame."""
    return ATT_BYTES + cells


def decode_legacy(data: bytes, cells: int) -> NDArray[np.uint8]:
    """The frame that a notification of version 1 is.

    Returns:
        Pull-up voltage of each cell, 8 bits, dark is high, shape `(cells,)`, read-only.

    Raises:
        PacketError: of reason `"length"`, if there is not one byte for each cell: at a small MTU
            the rest of the value never comes, and no layer says so.
    """
    if len(data) != cells:
        raise PacketError(
            "length",
            f"{len(data)} bytes given, {cells} cells have {cells}: if there are fewer, an ATT MTU "
            f"of at least {legacy_mtu(cells)} is needed",
        )
    return np.frombuffer(bytes(data), np.uint8)


_STATUS = struct.Struct("<BBBB8sHHHH")
STATUS_BYTES = _STATUS.size


class Fault(IntFlag):
    """What is, or since power-on was, wrong on the device."""

    MTU_TOO_SMALL = 1
    """A frame does not fit into a notification, so none is sent."""
    NOTIFY_FAILED = 2
    """The Bluetooth stack refused a notification: its frames are lost."""
    SERIAL_FULL = 4
    """The serial line did not take a packet: its frames are lost there."""
    LATE = 8
    """A scan began later than its period asks."""
    WATCHDOG = 16
    """The watchdog started the device anew."""


@dataclass(frozen=True)
class Status:
    """What the status characteristic holds."""

    firmware: tuple[int, int, int]
    """Version of the firmware."""
    design_hash: str
    """First 16 hexadecimal digits of the hash of the design it was made for."""
    cells: int
    mtu: int
    """ATT MTU in force; 23 until a computer asks for more."""
    needed_mtu: int
    """The smallest at which a frame fits into a notification."""
    faults: Fault
    protocol: int = VERSION

    def encode(self) -> bytes:
        """The bytes of the characteristic.

        Raises:
            PacketError: if a value is outside what it can carry.
        """
        try:
            code = int(self.design_hash, 16).to_bytes(8, "big")
            return _STATUS.pack(
                self.protocol,
                *self.firmware,
                code,
                self.cells,
                self.mtu,
                self.needed_mtu,
                self.faults,
            )
        except (struct.error, ValueError, OverflowError) as error:
            raise PacketError("field", f"{self}: cannot be sent: {error}") from error

    @classmethod
    def decode(cls, data: bytes) -> "Status":
        """Read the bytes of the characteristic.

        Raises:
            PacketError: if there are too few, or they are of another version.
        """
        if len(data) < STATUS_BYTES:
            raise PacketError(
                "length", f"{len(data)} bytes given, a status has {STATUS_BYTES} or more"
            )
        protocol, *firmware, code, cells, mtu, needed, faults = _STATUS.unpack_from(data)
        if protocol != VERSION:
            raise PacketError(
                "version", f"protocol {protocol} given, this lumitip speaks {VERSION}"
            )
        major, minor, patch = firmware
        return cls((major, minor, patch), code.hex(), cells, mtu, needed, Fault(faults), protocol)
