"""A Bluetooth device: how it is found, and what is read from its characteristics."""

import asyncio
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from bleak import BleakClient, BleakScanner
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak.backends.device import BLEDevice
from bleak.backends.scanner import AdvertisementData

from lumitip.errors import AmbiguousDevice, DeviceNotFound, LinkError, MtuTooSmall, WrongDesign
from lumitip.layout import Layout
from lumitip.protocol.bluetooth import (
    FRAMES,
    LEGACY_FRAMES,
    LEGACY_SERVICE,
    SERVICE,
    STATUS,
    Status,
)
from lumitip.protocol.packet import PacketError

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


_HASH_DIGITS = 16  # of the design hash, what the status carries


@dataclass(frozen=True)
class Service:
    """What a device offers."""

    version: Literal[1, 2]
    status: Status | None
    """Of version 2, as it was on connecting."""


async def begin(
    client: BleakClient,
    layout: Layout,
    any_design: bool,
    notified: Callable[[bytearray], None],
    failed: Callable[[LinkError], None],
) -> Service:
    """Check a connected device and have it send.

    Args:
        client: connected.
        layout: the cells that are expected.
        any_design: whether a device of another design will do.
        notified: takes each notification of frames; called in bleak's loop, so it only queues.
        failed: takes what turns out wrong later, likewise.

    Raises:
        LinkError: if it is no fingertip, of another design, or its frames do not fit.
    """

    def frames(_: BleakGATTCharacteristic, data: bytearray) -> None:
        notified(data)

    def status_changed(_: BleakGATTCharacteristic, data: bytearray) -> None:
        try:
            check_mtu(Status.decode(bytes(data)))
        except (LinkError, PacketError) as error:
            failed(error if isinstance(error, LinkError) else LinkError(str(error)))

    if client.services.get_characteristic(FRAMES):
        status = await _status(client)
        check(status, layout, any_design, client.address)
        await client.start_notify(STATUS, status_changed)
        # StartNotify, not AcquireNotify: its socket overflows without a word when it is not read.
        await client.start_notify(FRAMES, frames, bluez={"use_start_notify": True})
        return Service(2, status)
    if client.services.get_characteristic(LEGACY_FRAMES):
        await client.start_notify(LEGACY_FRAMES, frames, bluez={"use_start_notify": True})
        return Service(1, None)
    raise DeviceNotFound(
        f"{client.address} has no fingertip's service: another device of that name? "
        "`lumitip scan` lists fingertips"
    )


def check(status: Status, layout: Layout, any_design: bool, address: str) -> None:
    """Refuse a device that cannot be read with this layout.

    Raises:
        WrongDesign: if its cells or, unless `any_design`, its design are others.
        MtuTooSmall: if its frames do not fit.
    """
    expected = layout.design_hash[:_HASH_DIGITS]
    if status.cells != len(layout) or (status.design_hash != expected and not any_design):
        raise WrongDesign(status.design_hash, expected, f"ble:{address}")
    check_mtu(status)


def check_mtu(status: Status) -> None:
    """Refuse a device whose frames do not fit.

    Raises:
        MtuTooSmall: with both numbers.
    """
    if status.mtu < status.needed_mtu:
        raise MtuTooSmall(status.mtu, status.needed_mtu)


async def _status(client: BleakClient) -> Status:
    try:
        return Status.decode(bytes(await client.read_gatt_char(STATUS)))
    except PacketError as error:
        raise LinkError(f"{client.address}: status cannot be read: {error}") from error
