"""Finding a Bluetooth device by its name or address, and listing the fingertips in sight."""

import asyncio
import re
from collections.abc import Callable
from typing import Any

from bleak import BleakScanner
from bleak.backends.device import BLEDevice
from bleak.backends.scanner import AdvertisementData

from lumitip.errors import AmbiguousDevice, DeviceNotFound
from lumitip.protocol.legacy import LEGACY_SERVICE
from lumitip.protocol.uuids import SERVICE

SETTLE_S = 1.5  # devices advertise at least once a second: a namesake shows itself by then
_ADDRESS = re.compile(r"([0-9A-F]{2}:){5}[0-9A-F]{2}|[0-9A-F]{8}(-[0-9A-F]{4}){3}-[0-9A-F]{12}")
"""A Bluetooth address, or the UUID that Apple's systems give instead."""

Sighting = tuple[BLEDevice, AdvertisementData]


async def find(target: str, adapter: str, scan_s: float) -> BLEDevice:
    """The device of a name or address; without one the only fingertip in sight.

    Raises:
        DeviceNotFound: if there is none.
        AmbiguousDevice: if there are several, with their addresses.
    """
    by_address = bool(_ADDRESS.fullmatch(target.upper()))

    def wanted(sighting: Sighting) -> bool:
        device, told = sighting
        if by_address:
            return device.address.upper() == target.upper()
        if not target:
            return is_fingertip(told)
        return target in (told.local_name, device.name)

    seen = await look(adapter, scan_s, wanted, 0.0 if by_address else SETTLE_S)
    found = [device for device, told in seen.values() if wanted((device, told))]
    if not found:
        names = sorted({told.local_name or device.name or "" for device, told in seen.values()})
        raise DeviceNotFound(
            f"{target or 'any fingertip'!r} not seen in {scan_s:g} s; seen were "
            f"{', '.join(filter(None, names)) or 'none'}: is it switched on, near, and not "
            "connected to another computer?"
        )
    if len(found) > 1:
        raise AmbiguousDevice(target, [device.address for device in found], "ble")
    return found[0]


async def look(
    adapter: str, scan_s: float, until: Callable[[Sighting], bool], settle_s: float
) -> dict[str, Sighting]:
    """Scan until a sighting is as wanted and `settle_s` more, at most `scan_s`, by address."""
    seen: dict[str, Sighting] = {}
    enough = asyncio.Event()

    def sighted(device: BLEDevice, told: AdvertisementData) -> None:
        seen[device.address] = (device, told)
        if until((device, told)):
            enough.set()

    options: dict[str, Any] = {"bluez": {"adapter": adapter}} if adapter else {}
    async with BleakScanner(sighted, **options):
        try:
            async with asyncio.timeout(scan_s):
                await enough.wait()
                await asyncio.sleep(settle_s)
        except TimeoutError:
            return seen
    return seen


def is_fingertip(told: AdvertisementData) -> bool:
    """Whether an advertisement names the service of version 2 or 1."""
    return bool({SERVICE, LEGACY_SERVICE} & {uuid.lower() for uuid in told.service_uuids})
