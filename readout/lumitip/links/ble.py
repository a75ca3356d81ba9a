"""`ble://Lumitip`: Bluetooth notifications of version 2, or version 1 (the published sensor).

    ble://NAME-OR-ADDRESS?adapter=hci0&scan=8

The default is the only fingertip in reach; `scan` is the longest scan (s). bleak runs on its own
thread, which only queues data; the link's thread decodes them. Needs bleak: the extra `ble`.
"""

import asyncio
import atexit
import contextlib
import dataclasses
import re
import threading
import time
from collections.abc import Callable, Coroutine
from concurrent.futures import CancelledError, Future
from dataclasses import dataclass
from functools import cache
from queue import SimpleQueue
from typing import Any, TypeVar

from lumitip.errors import LinkError, LinkTimeout, MissingExtra, MtuTooSmall, NotConnected, UrlError
from lumitip.frame import Codes
from lumitip.known_layouts import remember
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Cause, Deliver, Fault, Identity, Report
from lumitip.links.thread import ThreadedLink, keep_connected
from lumitip.links.url import Url
from lumitip.protocol.bluetooth import decode_legacy
from lumitip.protocol.packet import ATT_BYTES, ForeignPacketError, Packet, PacketError, decode

try:
    from bleak import BleakClient
    from bleak.exc import BleakError

    from lumitip.links.ble_device import (
        Service,
        Sighting,
        begin,
        find,
        is_fingertip,
        look,
        read_status,
    )
except ModuleNotFoundError as missing:
    raise MissingExtra("ble", "ble://") from missing

T = TypeVar("T")

_CONNECT_S = 20.0


@dataclass(frozen=True)
class Notified:
    """A notification from bleak's thread."""

    t_host: float
    data: bytes


Item = Notified | LinkError


class BleLink(ThreadedLink):
    """Packets of a Bluetooth device."""

    _name = "lumitip-ble"

    def __init__(self, layout: Layout, target: str, adapter: str, scan_s: float, any_design: bool):
        super().__init__()
        self.layout = layout
        self.device_id = f"ble:{target}"
        self._target = target
        self._adapter = adapter
        self._scan_s = scan_s
        self._any_design = any_design
        self._items: SimpleQueue[Item] = SimpleQueue()
        self._cancel: Callable[[], object] = lambda: None
        self._deliver: Deliver

    def stop(self) -> None:
        """Disconnect."""
        self._stopping.set()
        self._items.put(NotConnected("closed"))
        self._cancel()
        super().stop()

    def _run(self, deliver: Deliver, report: Report) -> None:
        self._deliver = deliver
        keep_connected(self._session, report, self._stopping)

    def _session(self, connected: Callable[[str], None]) -> None:
        items: SimpleQueue[Item] = SimpleQueue()
        self._items = items
        client, service = self._await(self._connect(items))
        try:
            connected(f"{self.device_id}, protocol {service.version}")
            while not self._stopping.is_set():
                item = items.get()
                if isinstance(item, LinkError):
                    raise item
                self._deliver(Arrival(item.t_host, self._read(item.data, service)))
        finally:
            shared_loop().submit(_disconnect(client)).result()

    def _read(self, data: bytes, service: Service) -> Packet | Codes | Fault:
        cells = len(self.layout)
        try:
            return decode(data, cells) if service.version == 2 else decode_legacy(data, cells)
        except PacketError as error:
            if service.version == 1 and len(data) < cells:
                raise MtuTooSmall(len(data) + ATT_BYTES, cells + ATT_BYTES) from error
            foreign = error if isinstance(error, ForeignPacketError) else None
            cause: Cause = "length" if error.reason == "length" else "crc"
            return Fault(cause, 1, str(error), foreign)

    async def _connect(self, items: "SimpleQueue[Item]") -> tuple[BleakClient, Service]:
        device = await find(self._target, self._adapter, self._scan_s)
        # Reconnections use the address: other devices may have the same name.
        self._target = device.address
        self.device_id = f"ble:{device.address}"

        def gone(_: BleakClient) -> None:
            items.put(NotConnected(f"{self.device_id} disconnected"))

        def notified(data: bytearray) -> None:
            items.put(Notified(time.monotonic(), bytes(data)))

        client = BleakClient(device, disconnected_callback=gone, timeout=_CONNECT_S)
        try:
            await client.connect()
            service = await begin(client, self.layout, self._any_design, notified, items.put)
            if service.status and not self._any_design:
                remember(self.device_id, self.layout)
        except BaseException:
            await _disconnect(client)
            raise
        return client, service

    def _await(self, coroutine: Coroutine[Any, Any, T]) -> T:
        future = shared_loop().submit(coroutine)
        self._cancel = future.cancel
        if self._stopping.is_set():
            future.cancel()
        return _result(future, self.device_id)


def sightings(seconds: float) -> list[Sighting]:
    """The fingertips that advertise within some seconds, sorted by address.

    Raises:
        LinkError: if Bluetooth cannot be used.
    """
    seen = _result(shared_loop().submit(look("", seconds, lambda _: False, 0.0)), "Bluetooth")
    return [seen[address] for address in sorted(seen) if is_fingertip(seen[address][1])]


def _result(future: "Future[T]", what: str) -> T:
    try:
        return future.result()
    except LinkError:
        raise
    except TimeoutError as error:
        raise LinkTimeout(f"{what}: no answer. Is it in reach?") from error
    except CancelledError as error:
        raise NotConnected(f"{what}: closed while connecting") from error
    except (BleakError, OSError, EOFError) as error:
        text = str(error) or type(error).__name__
        raise NotConnected(f"{what}: {text}. Is Bluetooth switched on?") from error


async def _disconnect(client: BleakClient) -> None:
    try:
        await client.disconnect()
    except (BleakError, OSError, EOFError, TimeoutError):
        return  # already disconnected


def make(url: Url, layout: Layout, any_design: bool) -> BleLink:
    """The link of an address.

    Raises:
        UrlError: if an option or the name of the adapter is wrong.
    """
    return BleLink(layout, url.target, *_options(url), any_design)


def _options(url: Url) -> tuple[str, float]:
    """Adapter, and longest scan (s)."""
    url.allow("adapter", "scan")
    scan_s = url.number("scan", 8.0, 0.1, 600.0)
    adapter = url.options.get("adapter", "")
    if not re.fullmatch(r"\w*", adapter, re.ASCII):
        raise UrlError(f"{url.text!r}: adapter is {adapter}; a name like hci0 is needed")
    return adapter, scan_s


def identify(url: Url, timeout_s: float | None) -> Identity:
    """The design that a device names in its status.

    Raises:
        UrlError: as `make`.
        LayoutError: if it has the published firmware, which names none.
        LinkError: if it is not found in time, or is not a fingertip.
    """
    adapter, scan_s = _options(url)
    return _result(shared_loop().submit(_asked(url, adapter, scan_s, timeout_s)), url.text)


async def _asked(url: Url, adapter: str, scan_s: float, timeout_s: float | None) -> Identity:
    async with asyncio.timeout(timeout_s):
        device = await find(url.target, adapter, scan_s)
        client = BleakClient(device, timeout=_CONNECT_S)
        try:
            await client.connect()
            status = await read_status(client)
        finally:
            await _disconnect(client)
    return Identity(
        f"ble:{device.address}",
        status.design_hash,
        status.cells,
        dataclasses.replace(url, target=device.address),
    )


class LoopThread:
    """The event loop of bleak on its own thread, until the program ends.

    All Bluetooth links share it, because bleak keeps state for each loop.
    """

    def __init__(self) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(
            target=self._loop.run_forever, name="lumitip-bleak", daemon=True
        )
        self._thread.start()
        atexit.register(self._end)

    def submit(self, coroutine: Coroutine[Any, Any, T]) -> "Future[T]":
        """Run a coroutine on the loop. From any other thread."""
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop)

    def _end(self) -> None:
        # Cancelled tasks disconnect their device; otherwise the system keeps it connected after
        # the program ends, and no other program can find it.
        with contextlib.suppress(TimeoutError):
            self.submit(_cancel_all()).result(5.0)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(5.0)


async def _cancel_all() -> None:
    tasks = asyncio.all_tasks() - {asyncio.current_task()}
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


@cache
def shared_loop() -> LoopThread:
    """The loop of all Bluetooth links, started on first use."""
    return LoopThread()
