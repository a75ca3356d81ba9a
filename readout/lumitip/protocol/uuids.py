"""Bluetooth service and characteristics of version 2; those of version 1 are in `legacy`."""

SERVICE = "7d1c0001-6c75-4d69-9469-700000000000"
FRAMES = "7d1c0002-6c75-4d69-9469-700000000000"
"""Notifies packets: `lumitip.protocol.packet`."""
STATUS = "7d1c0003-6c75-4d69-9469-700000000000"
"""Read and notified: `lumitip.protocol.status`."""
