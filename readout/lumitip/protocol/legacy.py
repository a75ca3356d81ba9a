"""Version 1, the published sensor (arXiv 2306.05902): one byte a cell, and nothing else.

There is no number and no time of a frame, so nobody can tell how many were lost.
"""

import numpy as np
from numpy.typing import NDArray

from lumitip.protocol.packet import ATT_BYTES, PacketError

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
