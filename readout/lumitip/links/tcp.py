"""`tcp://127.0.0.1:8643`: a fingertip that `lumitip serve` shares, on this or another computer.

    tcp://HOST:PORT?token=TEXT

The default port is 8643. The server sends the layout, so none is needed. It prints the token if
clients need one. If the server is gone the link is lost, and connects again once it is back; a
server that vanishes without a word (power cut, pulled cable) is noticed after 11 s. If the server's
device has failed for good, the link fails too.
"""

import errno
import re
import socket
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from lumitip.errors import (
    AccessRefused,
    DeviceFailed,
    LayoutError,
    NotConnected,
    UrlError,
    WrongDesign,
)
from lumitip.layout import Layout
from lumitip.links.base import Arrival, Deliver, Fault, LinkEvent, Report
from lumitip.links.thread import ThreadedLink, keep_connected
from lumitip.links.url import Url
from lumitip.listening import keep_alive
from lumitip.protocol import messages
from lumitip.protocol.messages import Kind, MessageDecoder, MessageError
from lumitip.protocol.packet import ForeignPacketError, PacketError, decode

DEFAULT_PORT = 8643
_CONNECT_S = 5.0
_WAIT_S = 0.2  # timeout of a read, so that `stop` is noticed
_CHUNK_BYTES = 1 << 16
_TARGET = re.compile(r"(\[[0-9A-Fa-f:.%\w]+\]|[^\[\]:/]+)(?::(\d{1,5}))?")


class ServerFull(NotConnected):
    """The server has as many clients as it takes; there may be room later."""


@dataclass(frozen=True)
class Address:
    """Where a server listens."""

    host: str
    port: int = DEFAULT_PORT
    token: str | None = field(default=None, repr=False)

    def __str__(self) -> str:
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"tcp://{host}:{self.port}"


@dataclass(frozen=True)
class Greeting:
    """The first message of a server."""

    device_id: str
    layout: Layout
    connected: bool
    """Whether the server is connected to its device."""


class Connection:
    """A connection to a server; a context manager.

    Args:
        address: of the server.
        stopping: ends the connection when it is set.
        answer_s: longest wait for the server, and then for its greeting.

    Raises:
        NotConnected: if there is no server.
        AccessRefused: if it refuses this client.
    """

    def __init__(
        self, address: Address, stopping: threading.Event, answer_s: float = _CONNECT_S
    ) -> None:
        self._address = address
        self._stopping = stopping
        self._decoder = MessageDecoder()
        try:
            self._socket = socket.create_connection((address.host, address.port), answer_s)
        except OSError as error:
            raise NotConnected(
                f"{address}: {error.strerror or error}. Is `lumitip serve` running there?"
            ) from error
        try:
            keep_alive(self._socket)
            self._socket.settimeout(_WAIT_S)
            self._socket.sendall(messages.encode_request(address.token))
            self._received = self._receive()
            self.greeting = self._greeted(answer_s)
        except BaseException as error:
            self._socket.close()
            if isinstance(error, OSError) and not isinstance(error, NotConnected):
                raise self._lost(error) from error
            raise

    def messages(self) -> Iterator[tuple[float, Kind, bytes]]:
        """The messages with their times of arrival (s), until the link stops.

        Raises:
            NotConnected: if the connection is lost.
        """
        try:
            for message in self._received:
                if message is not None:
                    yield message
        except NotConnected:
            raise
        except OSError as error:
            raise self._lost(error) from error

    def _receive(self) -> Iterator[tuple[float, Kind, bytes] | None]:
        """Messages; `None` when nothing came for a moment."""
        while not self._stopping.is_set():
            try:
                chunk = self._socket.recv(_CHUNK_BYTES)
            except TimeoutError as error:
                if error.errno == errno.ETIMEDOUT:  # of keepalive; `_WAIT_S` has no number
                    raise
                yield None
                continue
            t_host = time.monotonic()
            if not chunk:
                raise NotConnected(f"{self._address}: the server has ended the connection")
            try:
                found = self._decoder.feed(chunk)
            except MessageError as error:
                raise NotConnected(f"{self._address}: {error}") from error
            for kind, payload in found:
                yield t_host, kind, payload

    def _greeted(self, answer_s: float) -> Greeting:
        until = time.monotonic() + answer_s
        for message in self._received:
            if message is None:
                if time.monotonic() > until:
                    break
                continue
            _, kind, payload = message
            record = self._record(payload)
            if kind == Kind.REFUSED:
                refused = ServerFull if record.get("full") is True else AccessRefused
                raise refused(f"{self._address}: {record.get('why')}")
            try:
                layout = Layout.from_json(str(record["layout"]), str(self._address))
                return Greeting(str(record["device_id"]), layout, bool(record["connected"]))
            except (KeyError, LayoutError) as error:
                raise NotConnected(f"{self._address}: the greeting is damaged: {error}") from error
        raise NotConnected(f"{self._address}: no answer. Is `lumitip serve` running there?")

    def _record(self, payload: bytes) -> dict[str, Any]:
        try:
            return messages.decode_json(payload)
        except MessageError as error:
            raise NotConnected(f"{self._address}: {error}") from error

    def _lost(self, error: OSError) -> NotConnected:
        return NotConnected(f"{self._address}: {error.strerror or error}")

    def __enter__(self) -> "Connection":
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()


class TcpLink(ThreadedLink):
    """A shared fingertip; see the module."""

    _name = "lumitip-tcp"

    def __init__(self, address: Address, layout: Layout, any_design: bool) -> None:
        super().__init__()
        self.layout = layout
        self.device_id = f"tcp:{address.host}:{address.port}"
        self._address = address
        self._any_design = any_design
        self._deliver: Deliver
        self._report: Report

    def _run(self, deliver: Deliver, report: Report) -> None:
        self._deliver, self._report = deliver, report
        keep_connected(self._session, report, self._stopping)

    def _session(self, connected: Callable[[str], None]) -> None:
        with Connection(self._address, self._stopping) as connection:
            greeting = connection.greeting
            if greeting.layout != self.layout and not self._any_design:
                found, expected = greeting.layout.design_hash, self.layout.design_hash
                raise WrongDesign(found[:16], expected[:16], str(self._address))
            self.device_id = greeting.device_id
            connected(f"{self.device_id} at {self._address}")
            if not greeting.connected:
                self._event("lost", f"{self.device_id} is not connected to its server")
            for t_host, kind, payload in connection.messages():
                try:
                    self._message(t_host, kind, payload)
                except (MessageError, ValueError, TypeError, IndexError) as error:
                    raise NotConnected(f"{self._address}: a damaged message: {error}") from error

    def _message(self, t_host: float, kind: Kind, payload: bytes) -> None:
        if kind == Kind.EVENT:
            record = messages.decode_json(payload)
            self._event(str(record.get("kind")), str(record.get("detail")))
        elif kind in (Kind.PACKET, Kind.LEGACY, Kind.FAULT):
            self._deliver(Arrival(t_host, self._content(kind, payload)))

    def _event(self, kind: str, detail: str) -> None:
        if kind == "failed":
            raise DeviceFailed(f"{self._address}: {detail}")
        if kind == "lost":
            self._report(LinkEvent("lost", detail, NotConnected(detail)))
        elif kind == "connected":
            self._report(LinkEvent("connected", detail))

    def _content(self, kind: Kind, payload: bytes) -> Any:
        cells = len(self.layout)
        if kind == Kind.FAULT:
            return _fault(messages.decode_json(payload))
        if kind == Kind.LEGACY:
            codes = np.frombuffer(payload, np.uint8)
            text = f"a legacy frame has {codes.size} cells; the layout has {cells}"
            return codes if codes.size == cells else Fault("length", 1, text)
        try:
            return decode(payload, cells)
        except PacketError as error:
            foreign = error if isinstance(error, ForeignPacketError) else None
            return Fault("length" if error.reason == "length" else "crc", 1, str(error), foreign)


def _fault(record: dict[str, Any]) -> Fault:
    why = str(record.get("why"))
    foreign = record.get("foreign")
    return Fault(
        "length" if record.get("cause") == "length" else "crc",
        int(record.get("packets", 1)),
        why,
        ForeignPacketError(int(foreign[0]), int(foreign[1]), why) if foreign else None,
    )


def greeting_of(address: Address, answer_s: float = _CONNECT_S) -> Greeting:
    """Ask a server for its device.

    Args:
        address: of the server.
        answer_s: longest wait for the server, and then for its greeting.

    Raises:
        NotConnected: if there is no server.
        AccessRefused: if it refuses this client.
    """
    with Connection(address, threading.Event(), answer_s) as connection:
        return connection.greeting


def make(url: Url, layout: Layout | None, any_design: bool) -> TcpLink:
    """The link of an address; without a layout the server is asked for it.

    Raises:
        UrlError: if host, port or option is wrong.
        NotConnected: if the layout is needed and there is no server.
        AccessRefused: if it is needed and the server refuses this client.
    """
    url.allow("token")
    match = _TARGET.fullmatch(url.target)
    port = int(match[2] or DEFAULT_PORT) if match else 0
    if match is None or not 0 < port < 1 << 16:
        raise UrlError(f"the address is {url.text!r}; one like tcp://127.0.0.1:8643 is needed")
    address = Address(match[1].strip("[]"), port, url.options.get("token"))
    return TcpLink(address, layout or greeting_of(address).layout, any_design)
