"""What a connected Bluetooth device is asked for: its status, then its frames."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from bleak import BleakClient
from bleak.backends.characteristic import BleakGATTCharacteristic

from lumitip.errors import DeviceNotFound, LinkError, MtuTooSmall, WrongDesign
from lumitip.layout import Layout
from lumitip.protocol.legacy import LEGACY_FRAMES
from lumitip.protocol.packet import PacketError
from lumitip.protocol.status import Status
from lumitip.protocol.uuids import FRAMES, STATUS

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
