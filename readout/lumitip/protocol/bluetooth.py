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
    """Smallest ATT MTU for one frame in a notification."""
    return ATT_BYTES + cells


def decode_legacy(data: bytes, cells: int) -> NDArray[np.uint8]:
    """Codes of a notification of version 1: 8 bits, high is dark, shape `(cells,)`, read-only.

    Raises:
        PacketError: with reason `"length"`, if there is not one byte per cell: a small MTU cuts
            notifications without an error.
    """
    if len(data) != cells:
        raise PacketError(
            "length",
            f"a frame has {len(data)} bytes; {cells} cells need {cells}, and an ATT MTU of at "
            f"least {legacy_mtu(cells)}",
        )
    return np.frombuffer(bytes(data), np.uint8)


_STATUS = struct.Struct("<BBBB8sHHHH")
STATUS_BYTES = _STATUS.size


class Fault(IntFlag):
    """Faults of the device since power-on, but for `MTU_TOO_SMALL`, which is of now."""

    MTU_TOO_SMALL = 1
    """A frame does not fit into a notification; none is sent."""
    NOTIFY_FAILED = 2
    """The Bluetooth stack rejected a notification; its frames are lost."""
    SERIAL_FULL = 4
    """The serial buffer was full; the frames of a packet are lost."""
    LATE = 8
    """A scan began a whole period late or more; the frames that there was no time for are lost."""
    WATCHDOG = 16
    """The watchdog restarted the device."""
    AMBIENT = 32
    """Ambient light took more than three quarters of a cell's range: it reads as covered."""


FAULT_TEXTS = {
    Fault.NOTIFY_FAILED: "its Bluetooth rejected a notification; frames were lost",
    Fault.SERIAL_FULL: "its serial line was not read in time; frames were lost there",
    Fault.LATE: "a scan began late; frames were lost",
    Fault.WATCHDOG: "its watchdog restarted it",
    Fault.AMBIENT: "ambient light takes most of a cell's range, and the cell reads as covered: "
    "shade the fingers",
}
"""Faults that do not end a connection, in words."""


@dataclass(frozen=True)
class Status:
    """Contents of the status characteristic."""

    firmware: tuple[int, int, int]
    """Version of the firmware."""
    design_hash: str
    """First 16 hexadecimal digits of the design hash."""
    cells: int
    mtu: int
    """ATT MTU of the connection at the last frame: 0 without one, 23 before negotiation."""
    needed_mtu: int
    """Smallest ATT MTU for one frame."""
    faults: Fault
    protocol: int = VERSION

    def encode(self) -> bytes:
        """The bytes of the characteristic.

        Raises:
            PacketError: if a value is out of range.
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
        """Parse the bytes of the characteristic.

        Raises:
            PacketError: if they are too few, or of another version.
        """
        if len(data) < STATUS_BYTES:
            raise PacketError(
                "length", f"a status has {len(data)} bytes; at least {STATUS_BYTES} are needed"
            )
        protocol, *firmware, code, cells, mtu, needed, faults = _STATUS.unpack_from(data)
        if protocol != VERSION:
            raise PacketError(
                "version", f"the protocol is {protocol}; this lumitip supports {VERSION}"
            )
        major, minor, patch = firmware
        return cls((major, minor, patch), code.hex(), cells, mtu, needed, Fault(faults), protocol)
