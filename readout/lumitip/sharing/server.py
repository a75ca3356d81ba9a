"""`FingertipServer`: shares one fingertip with several programs over TCP."""

import logging
import threading
from pathlib import Path
from types import TracebackType
from urllib.parse import urlencode

import numpy as np

from lumitip import arguments
from lumitip.errors import LinkError, SharingError
from lumitip.layout import Layout
from lumitip.links import open_link
from lumitip.links.base import Arrival, Deliver, Fault, Link, LinkEvent, Prepares, Report
from lumitip.links.occupant import listen_or_explain
from lumitip.links.tcp import DEFAULT_PORT
from lumitip.links.url import Url
from lumitip.listening import is_token, public_host, server_token
from lumitip.protocol import messages
from lumitip.protocol.messages import Kind, MessageError
from lumitip.protocol.packet import Packet, encode
from lumitip.session.hub import Hub
from lumitip.sharing.client import Client, ClientCounts, FullError

_log = logging.getLogger(__name__)
MOST_CLIENTS = 32
MOST_WAITING = 32
"""Connections that have not yet sent their line; of more, the oldest is closed."""
_ACCEPT_S = 0.2  # so that `close` is noticed
_ROOM_S = 0.7  # for clients that have left to be noticed; less than a new one waits
_LAST_S = 2.0  # for the last messages to a client


class FingertipServer:
    """Connects to a fingertip and shares it until `close`; a context manager. Thread-safe.

    Each of up to 32 clients gets every frame. Of a client that is too slow the oldest frames are
    dropped and counted; the others are not slowed down.
    """

    def __init__(
        self,
        url: str,
        layout: Layout | str | Path | None = None,
        *,
        host: str = "127.0.0.1",
        port: int = DEFAULT_PORT,
        token: str | None = None,
        timeout: float | None = 10.0,
        buffer: int = 512,
        any_design: bool = False,
    ) -> None:
        """Listen, then connect to the fingertip.

        Args:
            url: of the fingertip, see `Fingertip.open`; not of a recording.
            layout: as of `Fingertip.open`.
            host: address to listen on; all but loopback addresses need a token.
            port: 0 is any free one.
            token: secret that clients must send; default: random if needed.
            timeout: of the connection to the fingertip (s); `None`: no limit.
            buffer: frames that may wait for each client; a packet that could not be read counts as
                one.
            any_design: accept a device of another design.

        Raises:
            SharingError: if the address is taken or cannot be used, or `url` is a recording.
            LumitipError: as `Fingertip.open`.
        """
        source = Url.parse(url)
        if source.scheme == "replay":
            raise SharingError(
                f"{source.text} is a file: each program can open it without a server. "
                "ble://, serial://, tcp:// and twin:// can be shared"
            )
        if isinstance(layout, str | Path):
            layout = Layout.load(layout)
        elif layout is not None:
            arguments.layout(layout)
        self._buffer = arguments.count(buffer, "buffer")
        self._host = host
        self._token = server_token(token, host, SharingError)
        self._socket = listen_or_explain(host, port, SharingError)
        self._lock = threading.Lock()
        self._left = threading.Condition(self._lock)
        self._clients: tuple[Client, ...] = ()
        self._waiting: list[Client] = []  # oldest first
        self._threads: list[threading.Thread] = []
        self._stopping = threading.Event()
        self._connected = True
        self._ended: LinkError | None = None
        try:
            link = open_link(url, layout, any_design, arguments.seconds(timeout))
            self._hub = Hub(_Tee(link, self._share), any_design, self._on_event)
            self._hub.start(timeout)
        except BaseException:
            self._socket.close()
            raise
        self._accepting = threading.Thread(target=self._accept, name="lumitip-serve", daemon=True)
        self._accepting.start()

    @property
    def address(self) -> str:
        """Address for `Fingertip.open`, with the token if one is needed."""
        query = f"?{urlencode({'token': self._token})}" if self._token else ""
        return f"tcp://{public_host(self._host, self._socket.getsockname()[1])}{query}"

    @property
    def device_id(self) -> str:
        """See `Fingertip.device_id`."""
        return self._hub.link.device_id

    @property
    def layout(self) -> Layout:
        """The cells."""
        return self._hub.link.layout

    @property
    def clients(self) -> tuple[ClientCounts, ...]:
        """The clients that are connected now."""
        return tuple(client.counts for client in self._clients)

    def __repr__(self) -> str:
        state = "ended" if self._stopping.is_set() else f"{len(self._clients)} clients"
        return f"<FingertipServer {self.device_id} at {self._host}: {state}>"

    def wait(self) -> None:
        """Wait until the device fails for good or `close`.

        Raises:
            LinkError: why the device has failed.
        """
        self._stopping.wait()
        if self._ended:
            raise self._ended.with_traceback(None)

    def close(self) -> None:
        """Disconnect the clients and the fingertip; may be repeated."""
        self._stopping.set()
        self._hub.close()
        self._accepting.join()
        self._socket.close()
        with self._lock:
            waiting = tuple(self._waiting)
        for client in waiting:
            client.close(now=True)
        for client in self._clients:
            client.close(now=self._ended is None)
        for thread in self._threads:
            thread.join(_LAST_S)
        for client in self._clients:
            client.close(now=True)

    def _accept(self) -> None:
        self._socket.settimeout(_ACCEPT_S)
        while not self._stopping.is_set():
            try:
                connection, address = self._socket.accept()
            except TimeoutError:
                continue
            except OSError as error:
                _log.debug("not accepted: %s", error)
                continue
            self._threads = [thread for thread in self._threads if thread.is_alive()]
            connection.settimeout(None)
            client = Client(connection, f"{address[0]}:{address[1]}", self._buffer)
            self._wait_for_line(client)
            thread = threading.Thread(
                target=self._serve, args=(client,), name="lumitip-client", daemon=True
            )
            self._threads.append(thread)
            thread.start()

    def _wait_for_line(self, client: Client) -> None:
        """Note a new client; those that send no line take no room from others."""
        with self._lock:
            self._waiting.append(client)
            oldest = self._waiting.pop(0) if len(self._waiting) > MOST_WAITING else None
        if oldest:
            _log.info("%s has sent no line and makes room for another", oldest.counts.name)
            oldest.close(now=True)

    def _serve(self, client: Client) -> None:
        try:
            client.run(self._join)
        finally:
            with self._lock:
                self._waiting = [one for one in self._waiting if one is not client]
                self._clients = tuple(one for one in self._clients if one is not client)
                self._left.notify_all()
            counts = client.counts
            _log.log(
                logging.WARNING if counts.dropped else logging.INFO,
                "%s has left: %d frames sent, %d dropped",
                counts.name,
                counts.sent,
                counts.dropped,
            )

    def _join(self, client: Client, token: str) -> None:
        if self._token and not is_token(token, self._token):
            raise MessageError(
                "the token is missing or wrong. Open the address that `lumitip serve` has printed"
            )
        with self._lock:
            if not self._left.wait_for(lambda: len(self._clients) < MOST_CLIENTS, _ROOM_S):
                _log.warning("more than %d clients: one was refused", MOST_CLIENTS)
                raise FullError(
                    f"{MOST_CLIENTS} programs read {self.device_id} already, which is the limit. "
                    "End one of them"
                )
            self._waiting = [one for one in self._waiting if one is not client]
            greeting = {
                "device_id": self.device_id,
                "connected": self._connected,
                "layout": self.layout.to_json(),
            }
            client.put(messages.encode_json(Kind.GREETING, greeting))
            self._clients += (client,)
        _log.info("%s has joined", client.counts.name)
        if self._stopping.is_set():
            client.close(now=True)

    def _share(self, arrival: Arrival) -> None:
        content = arrival.content
        if isinstance(content, Packet):
            self._send(messages.encode(Kind.PACKET, encode(content)), content.frames)
        elif isinstance(content, Fault):
            foreign = content.foreign
            record = {
                "cause": content.cause,
                "packets": content.packets,
                "why": content.why,
                "foreign": [foreign.design, foreign.cells] if foreign else None,
            }
            self._send(messages.encode_json(Kind.FAULT, record), 1)
        elif isinstance(content, np.ndarray):
            self._send(messages.encode(Kind.LEGACY, content.tobytes()), 1)

    def _send(self, message: bytes, frames: int = 0) -> None:
        for client in self._clients:
            client.put(message, frames)

    def _on_event(self, event: LinkEvent) -> None:
        if event.kind not in ("connected", "lost", "failed"):
            return
        with self._lock:
            self._connected = event.kind == "connected"
            record = {"kind": event.kind, "detail": event.detail}
            self._send(messages.encode_json(Kind.EVENT, record))
            if event.kind == "failed":
                self._ended = event.error
        if self._ended:
            self._stopping.set()

    def __enter__(self) -> "FingertipServer":
        return self

    def __exit__(
        self, _: type[BaseException] | None, __: BaseException | None, ___: TracebackType | None
    ) -> None:
        self.close()


class _Tee:
    """A link whose arrivals another function gets too."""

    def __init__(self, link: Link, also: Deliver) -> None:
        self._link = link
        self._also = also
        if isinstance(link, Prepares):
            self.why_late = link.why_late

    @property
    def layout(self) -> Layout:
        """See `Link`."""
        return self._link.layout

    @property
    def device_id(self) -> str:
        """See `Link`."""
        return self._link.device_id

    def start(self, deliver: Deliver, report: Report) -> None:
        """See `Link`."""

        def both(arrival: Arrival) -> None:
            self._also(arrival)
            deliver(arrival)

        self._link.start(both, report)

    def stop(self) -> None:
        """See `Link`."""
        self._link.stop()
