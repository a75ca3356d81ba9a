"""A real GATT server behind the fake `org.bluez`: bumble's controllers, host and ATT, in process.

What a computer's Bluetooth stack does over the air, the fake does here over bumble's link: it
connects, asks for an MTU, finds the services, reads and subscribes. So the MTU is negotiated, and
values are cut off by it, as real ones are.
"""

import asyncio
from collections.abc import Callable

from bumble.controller import Controller
from bumble.device import Connection, Device, Peer
from bumble.gatt import Characteristic, CharacteristicValue, Service
from bumble.hci import Address
from bumble.host import Host
from bumble.link import LocalLink
from bumble.transport.common import AsyncPipeSink

_CENTRAL = "F0:F0:F0:F0:F0:F0"
Notify = Callable[[str, bytes], None]


class BumblePeer:
    """A device with one service; `central_mtu` is what the computer asks for, 23 not to ask."""

    def __init__(
        self,
        name: str,
        address: str,
        service: str,
        characteristics: dict[str, list[str]],
        central_mtu: int,
    ) -> None:
        self.name, self.address = name, address
        self.advertised = [service]
        self._uuids = {service: characteristics}
        self._central_mtu = central_mtu
        self.values: dict[str, bytes] = {}
        self.mtu = 23
        """In force, as the device sees it."""
        self._served: dict[str, Characteristic[bytes]] = {}
        self._found: dict[str, object] = {}
        self._link = LocalLink()
        self._connection: Connection | None = None
        self._notify: Notify = lambda *_: None

    async def power_on(self) -> None:
        """Begin to advertise; in the loop that all else runs in."""
        self._device = await self._made(self.name, self.address)
        for service, characteristics in self._uuids.items():
            for uuid, flags in characteristics.items():
                kinds = [getattr(Characteristic.Properties, flag.upper()) for flag in flags]
                self._served[uuid] = Characteristic(
                    uuid,
                    Characteristic.Properties(sum(kinds)),
                    Characteristic.Permissions.READABLE,
                    CharacteristicValue(read=lambda _, uuid=uuid: self.values[uuid]),
                )
            self._device.add_service(Service(service, list(self._served.values())))
        self._device.on(Device.EVENT_CONNECTION, self._on_connection)
        self._central = await self._made("central", _CENTRAL)
        await self._device.start_advertising(
            auto_restart=True, advertising_interval_min=20.0, advertising_interval_max=20.0
        )

    async def connect(
        self, notify: Notify, gone: Callable[[], None]
    ) -> tuple[dict[str, dict[str, list[str]]], int]:
        self._notify = notify
        connection = await self._central.connect(Address(self.address))
        connection.on(Connection.EVENT_DISCONNECTION, lambda _: gone())
        self._connection = connection
        peer = Peer(connection)
        mtu = 23
        if self._central_mtu > 23:
            mtu = await peer.request_mtu(self._central_mtu)
        await peer.discover_all()
        for uuid in next(iter(self._uuids.values())):
            (self._found[uuid],) = peer.get_characteristics_by_uuid(_uuid(uuid))
        return self._uuids, mtu

    async def disconnect(self) -> None:
        if self._connection:
            connection, self._connection = self._connection, None
            await connection.disconnect()

    def lost(self) -> None:
        """The connection is gone; bumble knows."""

    async def read(self, uuid: str) -> bytes:
        return bytes(await self._found[uuid].read_value())

    async def subscribe(self, uuid: str) -> None:
        await self._found[uuid].subscribe(lambda value: self._notify(uuid, bytes(value)))

    async def notify(self, uuid: str, value: bytes) -> None:
        """Send a notification, cut off by the MTU as ATT does."""
        await self._device.notify_subscribers(self._served[uuid], value)
        await asyncio.sleep(0)

    async def _made(self, name: str, address: str) -> Device:
        controller = Controller(name, link=self._link, public_address=address)
        device = Device(name, Address(address), host=Host(controller, AsyncPipeSink(controller)))
        await device.power_on()
        return device

    def _on_connection(self, connection: Connection) -> None:
        self.mtu = connection.att_mtu

        def changed() -> None:
            self.mtu = connection.att_mtu

        connection.on(Connection.EVENT_CONNECTION_ATT_MTU_UPDATE, changed)


def _uuid(text: str) -> object:
    from bumble.core import UUID

    return UUID(text)
