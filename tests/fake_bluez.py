"""`org.bluez` on a private D-Bus: what bleak's unmodified Linux back end talks to in the tests.

It offers one adapter and the devices that a test adds. Each stands for a `Peer`: one that a test
scripts, or a real GATT server (`bumble_peer`). Runs on a thread of its own.
"""

import asyncio
import itertools
import threading
from collections.abc import Awaitable, Callable
from typing import Any

from dbus_fast import BusType, Message, MessageType, Variant
from dbus_fast.aio import MessageBus

from bluetooth_peers import Peer

ADAPTER = "/org/bluez/hci0"


class FakeBluez:
    """The service. Its methods may be called from any thread."""

    def __init__(self, address: str) -> None:
        self._address = address
        self._objects: dict[str, dict[str, dict[str, Variant]]] = {}
        self._peers: dict[str, Peer] = {}
        self._scans = 0
        self._tasks: set[asyncio.Task[None]] = set()
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="fake-bluez")
        self._thread.start()
        self.run(self._start())

    def run(self, coroutine: Awaitable[Any]) -> Any:
        """Run a coroutine in the fake's loop and wait for it."""

        async def awaited() -> Any:
            return await coroutine

        return asyncio.run_coroutine_threadsafe(awaited(), self._loop).result(20.0)

    def call(self, function: Callable[..., None], *arguments: object) -> None:
        """Call a function in the fake's loop and wait for it."""

        async def called() -> None:
            function(*arguments)

        self.run(called())

    def stop(self) -> None:
        """Leave the bus."""

        async def leave() -> None:
            for task in self._tasks:
                task.cancel()
            self._bus.disconnect()
            await self._bus.wait_for_disconnect()

        self.run(leave())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    def add(self, peer: Peer) -> None:
        """Switch a device on: it advertises."""
        self.call(self._add, peer)

    def cut(self, peer: Peer) -> None:
        """Lose the connection to a device."""
        self.call(self._lost, _path(peer))

    def remove(self, peer: Peer) -> None:
        """Switch a device off: it is gone, connected or not."""
        self.call(self._remove, peer)

    def connected(self, peer: Peer) -> bool:
        """Whether a device is connected."""
        return bool(self._objects[_path(peer)]["org.bluez.Device1"]["Connected"].value)

    async def _start(self) -> None:
        self._bus = MessageBus(bus_address=self._address, bus_type=BusType.SYSTEM)
        await self._bus.connect()
        self._bus.add_message_handler(self._handle)
        self._objects[ADAPTER] = {
            "org.bluez.Adapter1": {
                "Address": Variant("s", "00:00:5E:00:53:01"),
                "Powered": Variant("b", True),
                "Roles": Variant("as", ["central"]),
            }
        }
        await self._bus.request_name("org.bluez")

    def _add(self, peer: Peer) -> None:
        self._peers[_path(peer)] = peer
        device = {
            "Adapter": Variant("o", ADAPTER),
            "Address": Variant("s", peer.address),
            "Alias": Variant("s", peer.name),
            "Name": Variant("s", peer.name),
            "UUIDs": Variant("as", peer.advertised),
            "RSSI": Variant("n", -50),
            "Paired": Variant("b", False),
            "Connected": Variant("b", False),
            "ServicesResolved": Variant("b", False),
        }
        self._show(_path(peer), "org.bluez.Device1", device)

    def _remove(self, peer: Peer) -> None:
        self._lost(_path(peer))
        del self._peers[_path(peer)]
        self._hide(_path(peer))

    def _lost(self, path: str) -> None:
        if not self._objects[path]["org.bluez.Device1"]["Connected"].value:
            return
        self._peers[path].lost()
        self._change(path, "org.bluez.Device1", ServicesResolved=Variant("b", False))
        self._change(path, "org.bluez.Device1", Connected=Variant("b", False))
        for inner in [p for p in self._objects if p.startswith(path + "/")]:
            self._hide(inner)

    def _handle(self, message: Message) -> Message | bool | None:
        if message.message_type is not MessageType.METHOD_CALL:
            return None
        if message.member == "GetManagedObjects":
            return Message.new_method_return(message, "a{oa{sa{sv}}}", [self._objects])
        work = {
            "SetDiscoveryFilter": self._nothing,
            "StartDiscovery": self._start_discovery,
            "StopDiscovery": self._stop_discovery,
            "Connect": self._connect,
            "Disconnect": self._disconnect,
            "ReadValue": self._read,
            "StartNotify": self._subscribe,
            "StopNotify": self._nothing,
        }.get(message.member or "")
        if work is None or message.path not in self._objects:
            return None
        task = self._loop.create_task(self._answer(work, message))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return True

    async def _answer(self, work: Callable[[str], Awaitable[bytes | None]], call: Message) -> None:
        assert call.path
        try:
            value = await work(call.path)
        except ConnectionError as error:
            self._bus.send(Message.new_error(call, "org.bluez.Error.Failed", str(error)))
            return
        reply = ("", []) if value is None else ("ay", [value])
        self._bus.send(Message.new_method_return(call, *reply))

    async def _nothing(self, _: str) -> None:
        return None

    async def _start_discovery(self, _: str) -> None:
        self._scans += 1
        task = self._loop.create_task(self._advertise())
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _stop_discovery(self, _: str) -> None:
        self._scans -= 1

    async def _advertise(self) -> None:
        strengths = itertools.cycle((-50, -51))
        while self._scans:
            for path in self._peers:
                if not self._objects[path]["org.bluez.Device1"]["Connected"].value:
                    rssi = Variant("n", next(strengths))
                    self._change(path, "org.bluez.Device1", RSSI=rssi)
            await asyncio.sleep(0.02)

    async def _connect(self, path: str) -> None:
        peer = self._peers[path]
        handles = itertools.count(1)
        places: dict[str, str] = {}

        def notify(uuid: str, data: bytes) -> None:
            if uuid in places and places[uuid] in self._objects:
                self._change(
                    places[uuid], "org.bluez.GattCharacteristic1", Value=Variant("ay", data)
                )

        services, mtu = await peer.connect(notify, lambda: self._lost(path))
        for uuid, characteristics in services.items():
            service = f"{path}/service{next(handles):04x}"
            self._show(
                service,
                "org.bluez.GattService1",
                {
                    "UUID": Variant("s", uuid),
                    "Device": Variant("o", path),
                    "Primary": Variant("b", True),
                },
            )
            for inner, flags in characteristics.items():
                places[inner] = f"{service}/char{next(handles):04x}"
                self._show(
                    places[inner],
                    "org.bluez.GattCharacteristic1",
                    {
                        "UUID": Variant("s", inner),
                        "Service": Variant("o", service),
                        "Flags": Variant("as", flags),
                        "MTU": Variant("q", mtu),
                    },
                )
        self._change(path, "org.bluez.Device1", Connected=Variant("b", True))
        self._change(path, "org.bluez.Device1", ServicesResolved=Variant("b", True))

    async def _disconnect(self, path: str) -> None:
        await self._peers[path].disconnect()
        self._lost(path)

    async def _read(self, path: str) -> bytes:
        return await self._peers[path[:-21]].read(self._uuid(path))

    async def _subscribe(self, path: str) -> None:
        await self._peers[path[:-21]].subscribe(self._uuid(path))

    def _uuid(self, path: str) -> str:
        return str(self._objects[path]["org.bluez.GattCharacteristic1"]["UUID"].value)

    def _show(self, path: str, interface: str, properties: dict[str, Variant]) -> None:
        self._objects[path] = {interface: properties}
        self._signal(
            "/",
            "org.freedesktop.DBus.ObjectManager",
            "InterfacesAdded",
            "oa{sa{sv}}",
            [path, self._objects[path]],
        )

    def _hide(self, path: str) -> None:
        interfaces = list(self._objects.pop(path))
        self._signal(
            "/",
            "org.freedesktop.DBus.ObjectManager",
            "InterfacesRemoved",
            "oas",
            [path, interfaces],
        )

    def _change(self, path: str, interface: str, **changed: Variant) -> None:
        self._objects[path][interface] |= changed
        self._signal(
            path,
            "org.freedesktop.DBus.Properties",
            "PropertiesChanged",
            "sa{sv}as",
            [interface, changed, []],
        )

    def _signal(self, path: str, interface: str, member: str, kind: str, body: list[Any]) -> None:
        self._bus.send(Message.new_signal(path, interface, member, kind, body))


def _path(peer: Peer) -> str:
    return f"{ADAPTER}/dev_{peer.address.replace(':', '_')}"
