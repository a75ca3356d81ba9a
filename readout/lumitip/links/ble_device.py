"""Search for a Bluetooth device, and checks of its status."""

import asyncio
import logging
import re
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from bleak import BleakClient, BleakScanner
from bleak.backends.characteristic import BleakGATTCharacteristic
from bleak.backends.device import BLEDevice
from bleak.backends.scanner import AdvertisementData

from lumitip import errors
from lumitip.layout import Layout
from lumitip.protocol.bluetooth import (
    FAULT_TEXTS,
    FRAMES,
    LEGACY_FRAMES,
    LEGACY_SERVICE,
    SERVICE,
    STATUS,
    Fault,
    Status,
)
from lumitip.protocol.packet import PacketError

_log = logging.getLogger(__name__)

MTU_WAIT_S = 2.0
"""Longest wait for the MTU: a device updates its status with each frame. Until then the status
names 0 or, before the two ends have agreed, a smaller MTU."""
_AGAIN_S = 0.1
SETTLE_S = 1.5  # devices advertise once a second: enough to see others of the same name
_ADDRESS = re.compile(r"([0-9A-F]{2}:){5}[0-9A-F]{2}|[0-9A-F]{8}(-[0-9A-F]{4}){3}-[0-9A-F]{12}")
"""A Bluetooth address, or the UUID that macOS uses instead."""

Sighting = tuple[BLEDevice, AdvertisementData]


async def find(target: str, adapter: str, scan_s: float) -> BLEDevice:
    """The device with a name or address; without one the only fingertip in reach.

    Raises:
        DeviceNotFound: if there is none.
        AmbiguousDevice: if there are several.
    """
    by_address = bool(_ADDRESS.fullmatch(target.upper()))

    def matches(sighting: Sighting) -> bool:
        device, advertisement = sighting
        if by_address:
            return device.address.upper() == target.upper()
        if not target:
            return is_fingertip(advertisement)
        return target in (advertisement.local_name, device.name)

    seen = await look(adapter, scan_s, matches, 0.0 if by_address else SETTLE_S)
    found = [sighting[0] for sighting in seen.values() if matches(sighting)]
    if not found:
        names = sorted({heard.local_name or device.name or "" for device, heard in seen.values()})
        raise errors.DeviceNotFound(
            f"{target or 'any fingertip'!r} was not found in {scan_s:g} s; found were "
            f"{', '.join(filter(None, names)) or 'none'}. Is it switched on, in reach, and not "
            "connected to another computer?"
        )
    if len(found) > 1:
        raise errors.AmbiguousDevice(target, [device.address for device in found], "ble")
    return found[0]


async def look(
    adapter: str, scan_s: float, until: Callable[[Sighting], bool], settle_s: float
) -> dict[str, Sighting]:
    """Scan until `until` is true and `settle_s` longer, at most `scan_s`; results by address."""
    seen: dict[str, Sighting] = {}
    enough = asyncio.Event()

    def sighted(device: BLEDevice, advertisement: AdvertisementData) -> None:
        seen[device.address] = (device, advertisement)
        if until((device, advertisement)):
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


def is_fingertip(advertisement: AdvertisementData) -> bool:
    """Whether an advertisement names the service of version 2 or 1."""
    return bool({SERVICE, LEGACY_SERVICE} & {uuid.lower() for uuid in advertisement.service_uuids})


_HASH_DIGITS = 16  # of the design hash in the status


@dataclass(frozen=True)
class Service:
    """The protocol of a device."""

    version: Literal[1, 2]
    status: Status | None
    """Status of version 2, read at connection."""


async def begin(
    client: BleakClient,
    layout: Layout,
    any_design: bool,
    notified: Callable[[bytearray], None],
    failed: Callable[[errors.LinkError], None],
) -> Service:
    """Check a connected device and subscribe to its frames.

    Args:
        client: connected.
        layout: the expected cells.
        any_design: accept a device of another design.
        notified: called with each notification, in bleak's loop: must only queue it.
        failed: called with later errors, likewise.

    Raises:
        LinkError: if it is not a fingertip, of another design, or its MTU is too small.
    """

    def frames(_: BleakGATTCharacteristic, data: bytearray) -> None:
        notified(data)

    reported = Fault(0)

    def report(status: Status) -> None:
        nonlocal reported
        for fault, text in FAULT_TEXTS.items():
            if fault in status.faults and fault not in reported:
                _log.warning("%s: %s", client.address, text)
        reported = status.faults

    def status_changed(_: BleakGATTCharacteristic, data: bytearray) -> None:
        try:
            status = Status.decode(bytes(data))
            report(status)
            check_mtu(status)
        except (errors.LinkError, PacketError) as error:
            failed(error if isinstance(error, errors.LinkError) else errors.LinkError(str(error)))

    if client.services.get_characteristic(FRAMES):
        status = await _checked(client, layout, any_design)
        report(status)
        await client.start_notify(STATUS, status_changed)
        # StartNotify, because the socket of AcquireNotify drops data silently.
        await client.start_notify(FRAMES, frames, bluez={"use_start_notify": True})
        return Service(2, status)
    if client.services.get_characteristic(LEGACY_FRAMES):
        await client.start_notify(LEGACY_FRAMES, frames, bluez={"use_start_notify": True})
        return Service(1, None)
    raise _no_fingertip(client)


async def _checked(client: BleakClient, layout: Layout, any_design: bool) -> Status:
    """The status of a device that matches, once its MTU is large enough.

    Raises:
        LinkError: as `check`; `MtuTooSmall` only after `MTU_WAIT_S`.
    """
    until = time.monotonic() + MTU_WAIT_S
    while True:
        status = await _status(client)
        try:
            check(status, layout, any_design, client.address)
        except errors.MtuTooSmall:
            if time.monotonic() >= until:
                raise
            await asyncio.sleep(_AGAIN_S)
        else:
            return status


def check(status: Status, layout: Layout, any_design: bool, address: str) -> None:
    """Reject a device that does not match the layout.

    Raises:
        WrongDesign: if its number of cells or, unless `any_design`, its design differ.
        MtuTooSmall: if a frame does not fit.
    """
    expected = layout.design_hash[:_HASH_DIGITS]
    if status.cells != len(layout) or (status.design_hash != expected and not any_design):
        raise errors.WrongDesign(status.design_hash, expected, f"ble:{address}")
    check_mtu(status)


def check_mtu(status: Status) -> None:
    """Reject a connection whose MTU is too small.

    Raises:
        MtuTooSmall: if a frame does not fit.
    """
    if status.mtu < status.needed_mtu:
        raise errors.MtuTooSmall(status.mtu, status.needed_mtu)


async def read_status(client: BleakClient) -> Status:
    """The status of a connected device.

    Raises:
        LayoutError: if it has the published firmware, which has none.
        DeviceNotFound: if it is not a fingertip.
        LinkError: if the status cannot be read.
    """
    if client.services.get_characteristic(STATUS):
        return await _status(client)
    if client.services.get_characteristic(LEGACY_FRAMES):
        raise errors.LayoutError(
            f"{client.address} has the published firmware, which does not name its design. Add its "
            "layout.json: layout='outputs/layout.json', or --layout outputs/layout.json"
        )
    raise _no_fingertip(client)


def _no_fingertip(client: BleakClient) -> errors.DeviceNotFound:
    return errors.DeviceNotFound(
        f"{client.address} is not a fingertip: it has no such service. `lumitip scan` lists "
        "fingertips"
    )


async def _status(client: BleakClient) -> Status:
    try:
        return Status.decode(bytes(await client.read_gatt_char(STATUS)))
    except PacketError as error:
        raise errors.LinkError(f"{client.address}: the status cannot be read: {error}") from error
