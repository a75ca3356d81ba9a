"""The far ends of Bluetooth connections that `fake_bluez` offers, and one that a test scripts."""

from collections.abc import Callable
from typing import Protocol

Notify = Callable[[str, bytes], None]
Services = dict[str, dict[str, list[str]]]


class Peer(Protocol):
    """The far end of a Bluetooth connection; everything runs in the fake's loop."""

    address: str
    name: str
    advertised: list[str]
    """UUIDs of its services in its advertisement."""

    async def connect(self, notify: Notify, gone: Callable[[], None]) -> tuple[Services, int]:
        """Connect; returns services with their characteristics' flags, and the ATT MTU."""

    async def disconnect(self) -> None: ...

    def lost(self) -> None: ...

    async def read(self, uuid: str) -> bytes: ...

    async def subscribe(self, uuid: str) -> None: ...


class ScriptedPeer:
    """A device in the hands of a test: `values` are what reading a characteristic gives."""

    def __init__(self, name: str, address: str, services: Services, mtu: int = 247) -> None:
        self.name, self.address, self.mtu = name, address, mtu
        self.services = services
        self.advertised = list(services)
        self.values: dict[str, bytes] = {}
        self.subscribed: set[str] = set()
        self.connections = 0
        self.refuse = 0
        """How many of the next attempts to connect fail."""
        self._notify: Notify = lambda *_: None

    async def connect(self, notify: Notify, _: Callable[[], None]) -> tuple[Services, int]:
        if self.refuse:
            self.refuse -= 1
            raise ConnectionError("le-connection-abort-by-peer")
        self.connections += 1
        self.subscribed.clear()
        self._notify = notify
        return self.services, self.mtu

    async def disconnect(self) -> None:
        self.lost()

    def lost(self) -> None:
        self.subscribed.clear()

    async def read(self, uuid: str) -> bytes:
        return self.values[uuid]

    async def subscribe(self, uuid: str) -> None:
        self.subscribed.add(uuid)

    def notify(self, uuid: str, data: bytes) -> None:
        """Send a notification, if someone subscribed; in the fake's loop."""
        if uuid in self.subscribed:
            self._notify(uuid, data)
